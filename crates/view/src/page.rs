//! Where the page comes from, and what is shown where there is none.
use std::path::PathBuf;

/// The page. Its scripts and styles hold [`durer_page::NONCE_MARKER`], in whose place a number goes that is new at each
/// request: without it they are not run.
#[derive(Clone, Debug)]
pub enum PageSource {
    /// As it was built.
    Built,
    /// A file that is read again at each request: for those who work on the page.
    File(PathBuf),
}

impl PageSource {
    /// What is sent.
    pub(crate) fn html(&self, nonce: &str) -> String {
        let page = match self {
            Self::Built => durer_page::live().map(str::to_owned).map_err(|e| e.to_string()),
            Self::File(file) => std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display())),
        };
        page.map_or_else(|why| excuse(&why), |page| page.replace(durer_page::NONCE_MARKER, nonce))
    }
}

/// A page without anything.
fn excuse(why: &str) -> String {
    let why = why.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>durer</title></head>\n\
         <body><h1>There is no page to show</h1><p>{why}</p></body>\n</html>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_no_markup() {
        assert!(excuse("<script>").contains("<p>&lt;script></p>"));
        assert!(PageSource::File("no such file".into()).html("").contains("no such file"));
    }
}
