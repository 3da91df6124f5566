//! Numbers one after another, as text or as bytes.
use super::header::Scalar;
use crate::import::text::{Complaint, Part, float, leading_float, leading_integer};

/// What is said where a text ends too early.
pub(super) const MISSING: &str = "a number is missing behind this";

/// Where numbers come from.
pub(super) trait Numbers {
    /// The next number.
    fn float(&mut self, ty: Scalar) -> Result<f32, Complaint>;
    /// The next whole number.
    fn integer(&mut self, ty: Scalar) -> Result<i64, Complaint>;
    /// Passes over `count` numbers.
    fn skip(&mut self, ty: Scalar, count: usize) -> Result<(), Complaint>;
    /// A complaint about the number read last.
    fn fault(&self, message: String) -> Complaint;
}

/// Numbers as words.
pub(super) struct Written<'t> {
    rest: Part<'t>,
    last: Part<'t>,
}

impl<'t> Written<'t> {
    pub(super) fn new(text: Part<'t>) -> Self {
        Self { rest: text, last: text }
    }
    /// Goes to the next word.
    #[inline]
    fn ahead(&mut self) {
        let space = self.rest.bytes.iter().position(|b| !b.is_ascii_whitespace());
        self.rest = self.rest.split(space.unwrap_or(self.rest.bytes.len())).1;
    }
    /// Passes over `len` bytes of a word.
    #[inline]
    fn pass(&mut self, len: usize) {
        (self.last, self.rest) = self.rest.split(len);
    }
    /// The next word, if there is one.
    pub(super) fn left(&mut self) -> Option<Part<'t>> {
        self.ahead();
        let end = self.rest.bytes.iter().position(u8::is_ascii_whitespace);
        let (word, _) = self.rest.split(end.unwrap_or(self.rest.bytes.len()));
        (!word.bytes.is_empty()).then_some(word)
    }
    fn word(&mut self) -> Result<Part<'t>, Complaint> {
        let Some(word) = self.left() else {
            let end = self.last.range().end;
            let start = self.last.range().start.max(end.saturating_sub(60));
            return Err(Complaint::error(start..end, MISSING));
        };
        self.pass(word.bytes.len());
        Ok(word)
    }
}

impl Numbers for Written<'_> {
    #[inline]
    fn float(&mut self, _: Scalar) -> Result<f32, Complaint> {
        self.ahead();
        if let Some((value, len)) = leading_float(self.rest.bytes) {
            self.pass(len);
            return Ok(value);
        }
        let word = self.word()?;
        let message =
            || Complaint::error(word.range(), format!("expected a number, found \"{}\"", word.shown()));
        float(word.bytes).ok_or_else(message)
    }
    #[inline]
    fn integer(&mut self, _: Scalar) -> Result<i64, Complaint> {
        self.ahead();
        if let Some((value, len)) = leading_integer(self.rest.bytes) {
            self.pass(len);
            return Ok(value);
        }
        let word = self.word()?;
        let message = format!("expected a whole number, found \"{}\"", word.shown());
        Err(Complaint::error(word.range(), message))
    }
    fn skip(&mut self, _: Scalar, count: usize) -> Result<(), Complaint> {
        (0..count).try_for_each(|_| self.word().map(|_| ()))
    }
    fn fault(&self, message: String) -> Complaint {
        Complaint::error(self.last.range(), message)
    }
}

/// Numbers as bytes.
pub(super) struct Packed<'t> {
    pub(super) rest: Part<'t>,
    pub(super) big: bool,
}

impl Packed<'_> {
    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Complaint> {
        let Some((first, rest)) = self.rest.bytes.split_first_chunk::<N>() else {
            return Err(self.fault("the file ends in the middle of its data".to_owned()));
        };
        self.rest = Part { bytes: rest, at: self.rest.at + N };
        let mut bytes = *first;
        if self.big {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl Numbers for Packed<'_> {
    #[inline]
    fn float(&mut self, ty: Scalar) -> Result<f32, Complaint> {
        match ty {
            Scalar::F32 => self.take().map(f32::from_le_bytes),
            Scalar::F64 => self.take().map(|b| f64::from_le_bytes(b) as f32),
            whole => self.integer(whole).map(|v| v as f32),
        }
    }
    #[inline]
    fn integer(&mut self, ty: Scalar) -> Result<i64, Complaint> {
        match ty {
            Scalar::I8 => self.take().map(|b| i8::from_le_bytes(b).into()),
            Scalar::U8 => self.take().map(|b| u8::from_le_bytes(b).into()),
            Scalar::I16 => self.take().map(|b| i16::from_le_bytes(b).into()),
            Scalar::U16 => self.take().map(|b| u16::from_le_bytes(b).into()),
            Scalar::I32 => self.take().map(|b| i32::from_le_bytes(b).into()),
            Scalar::U32 => self.take().map(|b| u32::from_le_bytes(b).into()),
            Scalar::F32 | Scalar::F64 => self.float(ty).map(|v| v as i64),
        }
    }
    fn skip(&mut self, ty: Scalar, count: usize) -> Result<(), Complaint> {
        let bytes = count.saturating_mul(ty.size());
        if bytes > self.rest.bytes.len() {
            return Err(self.fault(format!("a list of {count} values is longer than the file")));
        }
        self.rest = self.rest.split(bytes).1;
        Ok(())
    }
    fn fault(&self, message: String) -> Complaint {
        Complaint::whole(format!("{message}, at byte {}", self.rest.at))
    }
}
