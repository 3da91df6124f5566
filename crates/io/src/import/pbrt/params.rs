//! Parameter lists: `"type name" value` or `"type name" [ values ]`, any number of them.
//!
//! A bad parameter is reported and left out; reading goes on with the next one.
use durer_scene::{Data, Param, Params, ValueType};

use super::{
    input::{Input, Reported},
    lexer::{Token, TokenKind},
    number::{self, NotNumber},
};

/// No kind takes nearly as many; keeps the search for duplicates cheap.
pub(super) const MOST_PARAMS: usize = 256;

/// The type words.
const TYPES: &[(&str, ValueType)] = &[
    ("float", ValueType::Float),
    ("integer", ValueType::Integer),
    ("bool", ValueType::Bool),
    ("string", ValueType::String),
    ("rgb", ValueType::Rgb),
    ("spectrum", ValueType::Spectrum),
    ("blackbody", ValueType::Blackbody),
    ("texture", ValueType::Texture),
    ("point3", ValueType::Point3),
    ("point", ValueType::Point3),
    ("vector3", ValueType::Vector3),
    ("vector", ValueType::Vector3),
    ("normal", ValueType::Normal),
    ("normal3", ValueType::Normal),
    ("point2", ValueType::Point2),
    ("vector2", ValueType::Vector2),
];

/// Parameters as read, in order.
pub(super) type ParamList = Vec<Param>;

/// Takes the parameter called `name` out of `list`.
pub(super) fn take(list: &mut ParamList, name: &str) -> Option<Param> {
    let index = list.iter().position(|p| p.name == name)?;
    Some(list.remove(index))
}

/// What a node stores.
pub(super) fn stored(list: ParamList) -> Params {
    let mut params = Params::new();
    for param in list {
        params.push(param);
    }
    params
}

/// What a declaration string says.
struct Declaration {
    ty: ValueType,
    name: String,
}

impl Input<'_> {
    /// The parameters of a directive.
    pub(super) fn params(&mut self) -> Result<ParamList, Reported> {
        let mut list: ParamList = Vec::new();
        loop {
            let token = self.lexer.peek();
            if token.kind == TokenKind::Unclosed {
                self.lexer.next();
                return Err(self.unexpected(token, ""));
            }
            if !token.is_string() {
                return if list.is_empty() { Ok(list) } else { self.no_surplus(token).map(|()| list) };
            }
            if list.len() >= MOST_PARAMS {
                self.error(self.lexer.span(token), format!("more than {MOST_PARAMS} parameters"));
                return Err(Reported);
            }
            self.lexer.next();
            match self.param(token, &list) {
                Some(param) => list.push(param),
                None if self.diagnostics.is_full() => return Err(Reported),
                None => {}
            }
        }
    }

    /// One parameter whose declaration is `head`; `None` after a complaint.
    fn param(&mut self, head: Token, before: &[Param]) -> Option<Param> {
        let declared = self.declaration(head);
        let data = self.values(head, declared.as_ref()).ok()?;
        let (Declaration { ty, name }, (data, end)) = (declared?, data?);
        let span = self.lexer.range(head.start, end);
        if before.iter().any(|p| p.name == name) {
            self.error(span, format!("the parameter \"{name}\" is given twice"));
            return None;
        }
        Some(Param { name, ty, data, at: span.into() })
    }

    /// Complains about `"float x" 1 2`.
    fn no_surplus(&mut self, token: Token) -> Result<(), Reported> {
        let text = self.lexer.text(token);
        let value = number::float64(text).is_ok() || matches!(text, "true" | "false");
        if token.kind != TokenKind::Word || !value {
            return Ok(());
        }
        let message = format!("one value too many: {text}");
        self.error(self.lexer.span(token), message).hint("several values are written in [ ]");
        Err(Reported)
    }

    /// Reads `"type name"`; `None` after a complaint.
    fn declaration(&mut self, token: Token) -> Option<Declaration> {
        let inside = self.unescaped(token).ok()?;
        let mut words = inside.split_ascii_whitespace();
        let (Some(word), Some(name), None) = (words.next(), words.next(), words.next()) else {
            let found = self.describe(token);
            let message = format!("expected a parameter such as \"float radius\", found {found}");
            self.error(self.lexer.span(token), message);
            return None;
        };
        if let Some((_, ty)) = TYPES.iter().find(|(w, _)| *w == word) {
            return Some(Declaration { ty: *ty, name: name.to_owned() });
        }
        let at = token.start + 1 + inside.find(word).unwrap_or(0);
        let at = self.lexer.range(at, at + word.len());
        if matches!(word, "color" | "xyz") {
            self.error(at, format!("unknown parameter type \"{word}\"")).hint("pbrt-v4 writes \"rgb\"");
        } else {
            self.diagnostics.unknown(at, "parameter type", word, TYPES.iter().map(|t| t.0));
        }
        None
    }

    /// Reads the values behind a declaration; without one they are skipped. Returns them and where they end.
    fn values(
        &mut self,
        head: Token,
        declared: Option<&Declaration>,
    ) -> Result<Option<(Data, usize)>, Reported> {
        let first = self.lexer.peek();
        if first.kind == TokenKind::Open {
            self.lexer.next();
            return self.list(head, first, declared);
        }
        let Some(declared) = declared else {
            // Without a type a string may be the value or the next declaration.
            let value = matches!(first.kind, TokenKind::Word) && !self.is_directive(first);
            if value || (first.is_string() && !self.is_declaration(first)) {
                self.lexer.next();
            }
            return Ok(None);
        };
        let numeric = !matches!(declared.ty, ValueType::String | ValueType::Texture | ValueType::Spectrum);
        let next_one = numeric && first.is_string() && self.is_declaration(first);
        if next_one || matches!(first.kind, TokenKind::End | TokenKind::Close) || self.is_directive(first) {
            self.error(self.lexer.span(head), format!("\"{}\" has no value", declared.name));
            return Err(Reported);
        }
        self.lexer.next();
        let mut data = empty(declared.ty, first);
        self.value(&mut data, declared, first)?;
        let at = (head, first.end);
        self.check_count(&data, declared, at)?;
        Ok(Some((data, first.end)))
    }

    /// The rest of a bracketed list.
    fn list(
        &mut self,
        head: Token,
        open: Token,
        declared: Option<&Declaration>,
    ) -> Result<Option<(Data, usize)>, Reported> {
        let first = self.lexer.peek();
        let mut data = declared.map(|d| (d, empty(d.ty, first)));
        loop {
            match &mut data {
                Some((_, Data::Floats(values))) => self.lexer.numbers(values),
                Some((_, Data::Ints(values))) => self.lexer.numbers(values),
                _ => {}
            }
            let token = self.lexer.peek();
            match token.kind {
                TokenKind::Close => {
                    self.lexer.next();
                    let Some((declared, data)) = data else {
                        return Ok(None);
                    };
                    self.check_count(&data, declared, (head, token.end))?;
                    return Ok(Some((data, token.end)));
                }
                TokenKind::End => return Err(self.not_closed(open)),
                TokenKind::Word if self.starts_directive(token) => return Err(self.not_closed(open)),
                TokenKind::Plain if self.numeric(&data) && self.is_declaration(token) => {
                    return Err(self.not_closed(open));
                }
                _ => {}
            }
            self.lexer.next();
            if let Some((declared, data)) = &mut data
                && self.value(data, declared, token).is_err()
            {
                self.skip_list();
                return Err(Reported);
            }
        }
    }

    /// PERF: nearly every word of a list is a number, so most words are told apart by their first byte.
    fn starts_directive(&self, token: Token) -> bool {
        self.lexer.text(token).starts_with(|c: char| c.is_ascii_uppercase()) && self.is_directive(token)
    }

    fn numeric(&self, data: &Option<(&Declaration, Data)>) -> bool {
        !matches!(data, Some((_, Data::Strings(_))))
    }

    fn not_closed(&mut self, open: Token) -> Reported {
        self.error(self.lexer.span(open), "this [ is not closed");
        Reported
    }

    /// True if a string reads like `"float radius"`.
    fn is_declaration(&self, token: Token) -> bool {
        let mut words = self.lexer.inside(token).split_ascii_whitespace();
        let typed = words.next().is_some_and(|w| TYPES.iter().any(|t| t.0 == w));
        typed && words.next().is_some() && words.next().is_none()
    }

    /// After an error within a list: behind its end, or at what cannot be in it.
    fn skip_list(&mut self) {
        loop {
            let token = self.lexer.peek();
            let stop = match token.kind {
                TokenKind::End => true,
                TokenKind::Word => self.starts_directive(token),
                TokenKind::Plain => self.is_declaration(token),
                _ => false,
            };
            if stop {
                return;
            }
            self.lexer.next();
            if token.kind == TokenKind::Close {
                return;
            }
        }
    }

    /// Appends the value of one token.
    fn value(&mut self, data: &mut Data, declared: &Declaration, token: Token) -> Result<(), Reported> {
        let word = token.kind == TokenKind::Word;
        match data {
            Data::Floats(values) if word => match number::float32(self.lexer.text(token)) {
                Ok(value) => values.push(value),
                Err(why) => return Err(self.bad_value(declared, token, Some(why))),
            },
            Data::Ints(values) if word => match number::int32(self.lexer.text(token)) {
                Ok(value) => values.push(value),
                Err(why) => return Err(self.bad_value(declared, token, Some(why))),
            },
            Data::Bools(values) if word || token.is_string() => {
                let text = if word { self.lexer.text(token) } else { self.lexer.inside(token) };
                match text {
                    "true" => values.push(true),
                    "false" => values.push(false),
                    _ => return Err(self.bad_value(declared, token, None)),
                }
            }
            Data::Strings(values) if token.is_string() => values.push(self.unescaped(token)?),
            _ => return Err(self.bad_value(declared, token, None)),
        }
        Ok(())
    }

    fn bad_value(&mut self, declared: &Declaration, token: Token, why: Option<NotNumber>) -> Reported {
        let expected = match declared.ty {
            ValueType::Bool => "true or false",
            ValueType::Integer => "an integer",
            ValueType::String => "a string",
            ValueType::Texture => "the name of a texture in quotes",
            _ => "a number",
        };
        let expected = format!("{expected} for \"{} {}\"", declared.ty.word(), declared.name);
        match why {
            Some(why) => self.not_number(token, why, &expected),
            None => self.unexpected(token, &expected),
        }
    }

    /// Points need three numbers each; spectra need pairs.
    fn check_count(
        &mut self,
        data: &Data,
        declared: &Declaration,
        at: (Token, usize),
    ) -> Result<(), Reported> {
        let Data::Floats(values) = data else { return Ok(()) };
        let arity = if declared.ty == ValueType::Spectrum { 2 } else { declared.ty.arity() };
        if values.len().is_multiple_of(arity) {
            return Ok(());
        }
        let (head, end) = at;
        let message = format!(
            "\"{}\" has {} numbers, \"{}\" needs {arity} per value",
            declared.name,
            values.len(),
            declared.ty.word()
        );
        self.error(self.lexer.range(head.start, end), message);
        Err(Reported)
    }
}

/// No values yet; the first one decides what a spectrum is.
fn empty(ty: ValueType, first: Token) -> Data {
    match ty {
        ValueType::Bool => Data::Bools(Vec::new()),
        ValueType::Integer => Data::Ints(Vec::new()),
        ValueType::String | ValueType::Texture => Data::Strings(Vec::new()),
        ValueType::Spectrum if first.is_string() => Data::Strings(Vec::new()),
        _ => Data::Floats(Vec::new()),
    }
}
