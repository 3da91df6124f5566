//! Colour parameters, and spectra until rays carry wavelengths: files of wavelength and value (`.spd`), lists, names.
use durer_core::spectrum::{Color, HELIUM_D, Named, Sampled, blackbody, curve, named, spectrum_names};

use super::{Args, ParamDefault, args::range_text};
use crate::{AssetError, Data, Location, TextureValue, ValueType, nearest_word};

/// A colour, or the index of the colour texture that gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorInput {
    /// The same everywhere.
    Constant(Color),
    /// Index in [`crate::SceneDesc::textures`].
    Texture(u32),
}

/// A spectrum that was found.
enum Spectrum {
    Named(Named),
    Sampled(Sampled),
}

impl Args<'_> {
    /// A colour.
    pub fn color(&mut self, name: &str) -> Color {
        match self.color_input(name) {
            ColorInput::Constant(c) => c,
            ColorInput::Texture(_) => Color::BLACK,
        }
    }

    /// A colour or a colour texture; complains about a texture or spectrum that does not exist.
    pub fn color_input(&mut self, name: &str) -> ColorInput {
        let Some(param) = self.param(name) else {
            let ParamDefault::Triple(rgb) = self.default(name) else {
                return ColorInput::Constant(Color::BLACK);
            };
            return ColorInput::Constant(Color { rgb });
        };
        let color = match (param.ty, &param.data) {
            (ValueType::Texture, Data::Strings(v)) => {
                let found = self.texture(param, v, TextureValue::Color);
                return found.map_or(ColorInput::Constant(Color::BLACK), ColorInput::Texture);
            }
            (ValueType::Rgb, Data::Floats(v)) => match v.as_slice() {
                [r, g, b, ..] => Color::new(*r, *g, *b),
                _ => Color::BLACK,
            },
            (ValueType::Blackbody, Data::Floats(v)) => blackbody(v.first().copied().unwrap_or(0.0)),
            _ => match self.spectrum(name) {
                Some(Spectrum::Named(known)) => known.color,
                Some(Spectrum::Sampled(s)) if self.spec(name).is_some_and(|spec| spec.is_light()) => {
                    s.light()
                }
                Some(Spectrum::Sampled(s)) => s.share(),
                None => Color::BLACK,
            },
        };
        ColorInput::Constant(color)
    }

    /// An index of refraction: a number, or the value of a spectrum at 587.6 nm, which is checked against the range.
    pub fn index(&mut self, name: &str) -> f32 {
        if self.param(name).is_none_or(|param| param.ty != ValueType::Spectrum) {
            return self.float(name);
        }
        let value = match self.spectrum(name) {
            Some(Spectrum::Named(known)) => known.number,
            Some(Spectrum::Sampled(s)) => s.nearest(HELIUM_D),
            None => return 1.0,
        };
        if let Some(spec) = self.spec(name)
            && !(value >= spec.range.0 && value <= spec.range.1)
        {
            self.error(name, format!("\"{name}\" is {value} at 587.6 nm, expected {}", range_text(spec)));
        }
        value
    }

    /// The curve over wavelengths that parameter `name` gives or names; `None` if it is left out, no curve (a colour or a
    /// texture), or after a complaint.
    pub fn curve(&mut self, name: &str) -> Option<Sampled> {
        let param = self.param(name)?;
        if param.ty != ValueType::Spectrum {
            return None;
        }
        if let Data::Strings(words) = &param.data
            && let Some(known) = words.first().and_then(|word| curve(word))
        {
            return Some(known);
        }
        match self.spectrum(name)? {
            Spectrum::Sampled(sampled) => Some(sampled),
            Spectrum::Named(_) => None,
        }
    }

    /// The spectrum that parameter `name` gives or names; `None` after a complaint.
    fn spectrum(&mut self, name: &str) -> Option<Spectrum> {
        let param = self.param(name)?;
        let sampled = match &param.data {
            Data::Floats(values) => Sampled::new(values),
            Data::Strings(words) => {
                let word = words.first()?;
                if let Some(known) = named(word) {
                    return Some(Spectrum::Named(known));
                }
                match self.bytes(word) {
                    Some(Ok(bytes)) => read_spd(&bytes).map_err(|why| format!("{word}: {why}")),
                    Some(Err(AssetError::Missing { .. })) | None => {
                        self.unknown_spectrum(name, word);
                        return None;
                    }
                    Some(Err(error)) => Err(error.to_string()),
                }
            }
            _ => return None,
        };
        match sampled {
            Ok(sampled) => Some(Spectrum::Sampled(sampled)),
            Err(message) => {
                self.error(name, message);
                None
            }
        }
    }

    fn unknown_spectrum(&mut self, name: &str, word: &str) {
        let hint = match nearest_word(word, spectrum_names()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => {
                "expected a file of wavelengths (nm) and values, or a name such as \"glass-BK7\"".to_owned()
            }
        };
        let at = self.param(name).map_or(Location::None, |param| param.at.clone());
        let message = format!("there is no spectrum \"{word}\", neither by that name nor as a file");
        self.error_at(at, message).hint(hint);
    }
}

/// Reads wavelength (nm) and value in turn; `#` begins a comment.
fn read_spd(bytes: &[u8]) -> Result<Sampled, String> {
    // A file of a spectrum has some hundred lines; nothing is gained from millions.
    const MOST: usize = 1 << 20;
    let text = String::from_utf8_lossy(bytes);
    let mut values = Vec::new();
    for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let line = line.split('#').next().unwrap_or("");
        for word in line.split([' ', '\t', ',']).filter(|word| !word.is_empty()) {
            let value = word.parse::<f32>().ok().filter(|v| v.is_finite());
            let shown: String = word.chars().take(40).collect();
            values.push(value.ok_or_else(|| format!("line {number}: expected a number, found {shown}"))?);
        }
        if values.len() > MOST {
            return Err(format!("more than {MOST} numbers"));
        }
    }
    Sampled::new(&values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spd_files_hold_pairs_and_comments() {
        let text = "\u{feff}# nm value\r\n400 0.5 # first\r\n\r\n\t700,1.5\r\n# caf\u{e9}";
        assert_eq!(read_spd(text.as_bytes()), Sampled::new(&[400.0, 0.5, 700.0, 1.5]));
        assert!(read_spd(b"# caf\xe9\n1 2").is_ok());
        let wrong = |text: &str| read_spd(text.as_bytes()).err().unwrap_or_default();
        assert_eq!(wrong("400 0.5\n500 low"), "line 2: expected a number, found low");
        assert!(wrong("400").contains("pairs") && wrong("").contains("pairs"));
        assert!(wrong("500 1 400 1").contains("must rise"));
    }
}
