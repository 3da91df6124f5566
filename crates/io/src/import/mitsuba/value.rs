//! Numbers, vectors, colours and spectra as text.
use durer_scene::{Diagnostics, Span};

use super::object::Value;
use crate::import::color::linear;

/// The numbers in `text`, between which white space and commas stand.
pub(super) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty());
    words.map(number).collect()
}

/// One number.
pub(super) fn number(word: &str) -> Result<f64, String> {
    let word = word.trim();
    let found = word.parse::<f64>().ok().filter(|v| v.is_finite() && v.abs() <= f64::from(f32::MAX));
    found.ok_or_else(|| format!("expected a number, found \"{word}\""))
}

/// A truth value.
pub(super) fn truth(word: &str) -> Result<bool, String> {
    match word.trim().to_lowercase().as_str() {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(format!("expected true or false, found \"{word}\"")),
    }
}

/// One or three numbers.
pub(super) fn triple(text: &str) -> Result<[f64; 3], String> {
    match *numbers(text)? {
        [v] => Ok([v; 3]),
        [x, y, z] => Ok([x, y, z]),
        ref other => Err(format!("expected three numbers, found {}", other.len())),
    }
}

/// A colour: one number, three, or `#rrggbb` in sRGB, as all are with `encoded`.
pub(super) fn color(text: &str, encoded: bool) -> Result<[f32; 3], String> {
    if let Some(hex) = text.trim().strip_prefix('#') {
        let channel = |i: usize| hex.get(2 * i..2 * i + 2).and_then(|d| u8::from_str_radix(d, 16).ok());
        let [Some(r), Some(g), Some(b)] = [channel(0), channel(1), channel(2)] else {
            return Err(format!("expected a colour such as #ff8000, found \"{text}\""));
        };
        return Ok([r, g, b].map(|c| linear(f32::from(c) / 255.0)));
    }
    let rgb = triple(text)?.map(|v| v as f32);
    Ok(if encoded { rgb.map(linear) } else { rgb })
}

/// A spectrum: one number, or `nm:value` pairs.
pub(super) fn spectrum(text: &str) -> Result<Value, String> {
    if !text.contains(':') {
        return match *numbers(text)? {
            [v] => Ok(Value::Even(v as f32)),
            // What 0.x called a spectrum of three numbers is a colour.
            [r, g, b] => Ok(Value::Color([r, g, b].map(|v| v as f32))),
            ref other => Err(format!("expected a number or nm:value pairs, found {} numbers", other.len())),
        };
    }
    let mut curve = Vec::new();
    for pair in text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()) {
        let (nm, value) =
            pair.split_once(':').ok_or_else(|| format!("expected nm:value, found \"{pair}\""))?;
        curve.extend([number(nm)? as f32, number(value)? as f32]);
    }
    checked(curve)
}

/// A spectrum of a file: a wavelength in nm and a value on each line; `#` begins a comment.
pub(super) fn spectrum_file(text: &str) -> Result<Value, String> {
    let mut curve = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or("");
        curve.extend(numbers(line)?.into_iter().map(|v| v as f32));
    }
    checked(curve)
}

fn checked(curve: Vec<f32>) -> Result<Value, String> {
    durer_core::spectrum::Sampled::new(&curve).map(|_| Value::Curve(curve))
}

/// What `parsed` says, or a complaint.
pub(super) fn told<T>(parsed: Result<T, String>, at: Span, said: &mut Diagnostics) -> Option<T> {
    match parsed {
        Ok(value) => Some(value),
        Err(message) => {
            said.error(at, message);
            None
        }
    }
}
