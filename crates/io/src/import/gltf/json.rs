//! The JSON text, and what is wrong with one that is none, in plain words and with its line.
use serde_json::{Error, Value, error::Category};

/// Parses `text`, whose outermost value must be an object.
///
/// # Errors
/// Says what is wrong, and in which line.
pub(super) fn parse(text: &[u8]) -> Result<Value, String> {
    match serde_json::from_slice(text) {
        Ok(value @ Value::Object(_)) => Ok(value),
        Ok(other) => {
            let found = super::element::kind(&other);
            Err(format!("the top level of the file must be an object {{ ... }}, found {found}"))
        }
        Err(error) => Err(explain(&error, text)),
    }
}

fn explain(error: &Error, text: &[u8]) -> String {
    let said = error.to_string();
    let what = said.split(" at line ").next().unwrap_or_default();
    let line = error.line();
    if error.classify() == Category::Eof {
        let within = match what.rsplit(' ').next() {
            Some("list") => "an array",
            Some("object") => "an object",
            Some("string") => "a string",
            _ => "a value",
        };
        return format!("the file ends in the middle of {within} (line {line}): it was probably cut off");
    }
    let what = match what {
        "expected value" => "a value is missing",
        "trailing characters" => "something stands behind the end of the document",
        "trailing comma" => "a comma stands before a closing bracket",
        "key must be a string" => "expected a name in quotes",
        "recursion limit exceeded" => "brackets are nested too deep",
        "expected ident" => "expected true, false or null",
        what => what,
    };
    let (line, column) = (line, error.column());
    format!("not valid JSON: {what} in line {line}, column {column}: {}", excerpt(text, line, column))
}

/// The part of a line around a column, both counted from 1.
fn excerpt(text: &[u8], line: usize, column: usize) -> String {
    const BEFORE: usize = 40;
    const MOST: usize = 60;
    let bytes = text.split(|&b| b == b'\n').nth(line.saturating_sub(1)).unwrap_or_default();
    let start = column.saturating_sub(BEFORE).min(bytes.len());
    let end = (start + MOST).min(bytes.len());
    let part = String::from_utf8_lossy(bytes.get(start..end).unwrap_or_default());
    let part: String = part.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let dots = |cut: bool| if cut { "..." } else { "" };
    format!("`{}{}{}`", dots(start > 0), part.trim(), dots(end < bytes.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong(text: &str) -> String {
        parse(text.as_bytes()).err().unwrap_or_default()
    }

    #[test]
    fn a_cut_off_text_is_called_so() {
        let cut = |within: &str, line| {
            format!("the file ends in the middle of {within} (line {line}): it was probably cut off")
        };
        assert_eq!(wrong("{\n\"a\": 1"), cut("an object", 2));
        assert_eq!(wrong("{\"a\": ["), cut("an array", 1));
        assert_eq!(wrong("{\"a"), cut("a string", 1));
    }

    #[test]
    fn faults_are_shown_with_their_line() {
        let said = "not valid JSON: a comma stands before a closing bracket in line 2, column 5: `1, ]}`";
        assert_eq!(wrong("{\"a\": [\n 1, ]}"), said);
        let long = wrong(&format!("{{{}\"b\" 1}}", "\"a\": 1, ".repeat(100)));
        assert!(long.contains("line 1, column 806") && long.len() < 200 && long.contains(": `..."), "{long}");
        assert_eq!(wrong("[1]"), "the top level of the file must be an object { ... }, found an array");
    }
}
