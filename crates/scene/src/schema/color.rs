//! Colour parameters, and spectra: files of wavelength and value (`.spd`), lists, names. What is measured keeps its curve
//! beside the colour that stands for it where rays carry red, green and blue.
use durer_core::spectrum::{
    Color, Curve, HELIUM_D, LightColor, Named, Sampled, curve, named, named_curve, named_light,
    spectrum_names,
};

use super::{Args, ParamDefault};
use crate::{AssetError, Data, Location, TextureValue, ValueType, nearest_word};

/// A colour, or the index of the colour texture that gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorInput {
    /// The same everywhere.
    Constant(Color),
    /// Index in [`crate::SceneDesc::textures`].
    Texture(u32),
    /// A measured curve, the same everywhere, and the colour that stands for it.
    Curve(Color, Curve),
}

impl ColorInput {
    /// The colour if it is the same everywhere.
    pub fn even(&self) -> Option<Color> {
        match self {
            Self::Constant(color) | Self::Curve(color, _) => Some(*color),
            Self::Texture(_) => None,
        }
    }
}

/// The colour of a light, or the index of the colour texture that gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum LightInput {
    /// The same everywhere.
    Even(LightColor),
    /// Index in [`crate::SceneDesc::textures`].
    Texture(u32),
}

/// A spectrum that was found, with its word if it has one.
enum Spectrum {
    Named(String, Named),
    Sampled(Sampled),
}

impl Args<'_> {
    /// A colour.
    pub fn color(&mut self, name: &str) -> Color {
        self.color_input(name).even().unwrap_or(Color::BLACK)
    }

    /// A colour or a colour texture; complains about a texture or spectrum that does not exist.
    pub fn color_input(&mut self, name: &str) -> ColorInput {
        if self.spec(name).is_some_and(|spec| spec.is_light()) {
            return match self.light_input(name) {
                LightInput::Even(light) => ColorInput::Constant(light.color),
                LightInput::Texture(index) => ColorInput::Texture(index),
            };
        }
        if let Some(plain) = self.plain(name) {
            return plain;
        }
        match self.spectrum(name) {
            Some(Spectrum::Named(word, known)) => match named_curve(&word) {
                Some(curve) => ColorInput::Curve(known.color, curve),
                None => ColorInput::Constant(known.color),
            },
            Some(Spectrum::Sampled(s)) => ColorInput::Curve(s.share(), Curve::measured(&s)),
            None => ColorInput::Constant(Color::BLACK),
        }
    }

    /// The colour of a light.
    pub fn light_color(&mut self, name: &str) -> LightColor {
        match self.light_input(name) {
            LightInput::Even(light) => light,
            LightInput::Texture(_) => LightColor::default(),
        }
    }

    /// The colour of a light, or a colour texture.
    pub fn light_input(&mut self, name: &str) -> LightInput {
        if let Some(param) = self.param(name)
            && let (ValueType::Blackbody, Data::Floats(v)) = (param.ty, &param.data)
        {
            return LightInput::Even(LightColor::blackbody(v.first().copied().unwrap_or(0.0)));
        }
        match self.plain(name) {
            Some(ColorInput::Texture(index)) => return LightInput::Texture(index),
            Some(ColorInput::Constant(color) | ColorInput::Curve(color, _)) => {
                return LightInput::Even(color.into());
            }
            None => {}
        }
        LightInput::Even(match self.spectrum(name) {
            Some(Spectrum::Named(word, known)) => {
                named_light(&word).unwrap_or_else(|| LightColor::from(known.color))
            }
            Some(Spectrum::Sampled(s)) => LightColor::measured(&s),
            None => LightColor::default(),
        })
    }

    /// What parameter `name` says if it is no spectrum.
    fn plain(&mut self, name: &str) -> Option<ColorInput> {
        let Some(param) = self.param(name) else {
            let ParamDefault::Triple(rgb) = self.default(name) else {
                return Some(ColorInput::Constant(Color::BLACK));
            };
            return Some(ColorInput::Constant(Color { rgb }));
        };
        match (param.ty, &param.data) {
            (ValueType::Texture, Data::Strings(v)) => {
                let found = self.texture(param, v, TextureValue::Color);
                Some(found.map_or(ColorInput::Constant(Color::BLACK), ColorInput::Texture))
            }
            (ValueType::Rgb, Data::Floats(v)) => Some(ColorInput::Constant(match v.as_slice() {
                [r, g, b, ..] => Color::new(*r, *g, *b),
                _ => Color::BLACK,
            })),
            (ValueType::Blackbody, Data::Floats(v)) => {
                Some(ColorInput::Constant(LightColor::blackbody(v.first().copied().unwrap_or(0.0)).color))
            }
            _ => None,
        }
    }

    /// An index of refraction where one number is wanted: of a spectrum, that at 587.6 nm.
    pub fn index(&mut self, name: &str) -> f32 {
        self.refraction(name).0
    }

    /// An index of refraction, and how it changes with wavelength if it does. Both are checked against the range.
    pub fn refraction(&mut self, name: &str) -> (f32, Option<Curve>) {
        if self.param(name).is_none_or(|param| param.ty != ValueType::Spectrum) {
            return (self.float(name), None);
        }
        let (value, curve) = match self.spectrum(name) {
            Some(Spectrum::Named(word, known)) => (known.number, named_curve(&word)),
            Some(Spectrum::Sampled(s)) => (s.nearest(HELIUM_D), Some(Curve::nearest(&s))),
            None => return (1.0, None),
        };
        if let Some(spec) = self.spec(name) {
            let at =
                |nm: &str, value: f32| format!("\"{name}\" is {value} {nm}, expected {}", spec.expected());
            let is_outside = |value: f32| !spec.allows(value);
            if is_outside(value) {
                self.error(name, at("at 587.6 nm", value));
            } else if let Some(value) = curve.iter().flat_map(Curve::ends).find(|v| is_outside(*v)) {
                self.error(name, at("at some wavelengths", value));
            }
        }
        (value, curve.filter(|curve| !curve.is_flat()))
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
            Spectrum::Named(..) => None,
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
                    return Some(Spectrum::Named(word.clone(), known));
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
