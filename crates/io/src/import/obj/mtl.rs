//! The MTL text: materials as written.
use std::ops::Range;

use durer_scene::nearest_word;

use crate::import::text::{Complaint, Part, Words, float};

/// A material; what it does not say is `None`.
#[derive(Debug, Default)]
pub(super) struct Material {
    pub(super) name: String,
    pub(super) kd: Option<[f32; 3]>,
    pub(super) ks: Option<[f32; 3]>,
    pub(super) ke: Option<[f32; 3]>,
    pub(super) tf: Option<[f32; 3]>,
    pub(super) ns: Option<f32>,
    pub(super) ni: Option<f32>,
    pub(super) d: Option<f32>,
    pub(super) tr: Option<f32>,
    pub(super) pr: Option<f32>,
    pub(super) pm: Option<f32>,
    pub(super) illum: Option<u32>,
    pub(super) maps: Vec<(Slot, Map)>,
    /// The number of the file it is in.
    pub(super) library: usize,
}

/// What an image is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Slot {
    Diffuse,
    Emission,
    Opacity,
    /// Heights, or a normal map.
    Bump,
    Normal,
    Roughness,
    Metallic,
}

/// An image with its options.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub(super) file: String,
    /// Where the file is named.
    pub(super) at: Range<usize>,
    pub(super) scale: [f32; 2],
    pub(super) offset: [f32; 2],
    pub(super) clamp: bool,
    /// `-bm`
    pub(super) strength: f32,
    /// `-imfchan`, as a channel of ours.
    pub(super) channel: Option<&'static str>,
}

const MAPS: [(&str, Slot); 11] = [
    ("map_Kd", Slot::Diffuse),
    ("map_Ke", Slot::Emission),
    ("map_d", Slot::Opacity),
    ("map_Bump", Slot::Bump),
    ("map_bump", Slot::Bump),
    ("bump", Slot::Bump),
    ("Bump", Slot::Bump),
    ("norm", Slot::Normal),
    ("map_Kn", Slot::Normal),
    ("map_Pr", Slot::Roughness),
    ("map_Pm", Slot::Metallic),
];

const VALUES: [&str; 13] =
    ["newmtl", "Ka", "Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "Pr", "Pm", "illum"];

/// Words that are known and change little: silently passed over.
const IGNORED: [&str; 6] = ["Ka", "map_Ka", "map_aat", "sharpness", "Km", "map_Tr"];

/// Words that are known and would change the picture.
const UNSUPPORTED: [&str; 16] = [
    "map_Ks", "map_Ns", "disp", "map_disp", "decal", "refl", "map_refl", "Ps", "map_Ps", "Pc", "Pcr",
    "aniso", "anisor", "map_Tf", "map_RMA", "map_ORM",
];

/// All materials, and what is wrong with the text: warnings only, as a model without a material can be seen.
pub(super) fn parse(file: &[u8]) -> (Vec<Material>, Vec<Complaint>) {
    let mut reader = Reader { materials: Vec::new(), complaints: Vec::new(), said: Vec::new() };
    if matches!(file, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) || file.iter().take(4096).any(|&b| b == 0) {
        let message = "not a text; its materials are drawn in grey";
        return (Vec::new(), vec![Complaint::whole(message).warning().hint("UTF-16 must be saved as UTF-8")]);
    }
    let skip = if file.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    for line in Part::whole(file).split(skip).1.continued_lines() {
        let mut words = line.words();
        if let Some(word) = words.next().filter(|w| !w.bytes.starts_with(b"#")) {
            reader.statement(word, words);
        }
    }
    (reader.materials, reader.complaints)
}

struct Reader {
    materials: Vec<Material>,
    complaints: Vec<Complaint>,
    /// Words that were complained about.
    said: Vec<String>,
}

impl Reader {
    fn warn(&mut self, at: Range<usize>, message: String) {
        // A binary file must not print a book.
        if self.complaints.len() < 20 {
            self.complaints.push(Complaint::error(at, message).warning());
        }
    }

    fn statement(&mut self, word: Part<'_>, words: Words<'_>) {
        let key = known(word.text());
        if key == "newmtl" {
            let name = words.rest().trim().text();
            self.materials.push(Material { name, ..Material::default() });
            return;
        }
        if IGNORED.contains(&key.as_str()) {
            return;
        }
        if let Some((_, slot)) = MAPS.iter().find(|(name, _)| *name == key) {
            let map = self.map(words);
            if let (Some(material), Some(map)) = (self.materials.last_mut(), map) {
                material.maps.push((*slot, map));
            }
            return;
        }
        match key.as_str() {
            "Kd" | "Ks" | "Ke" | "Tf" => {
                let color = self.color(word, words);
                if let Some(material) = self.materials.last_mut() {
                    *match key.as_str() {
                        "Kd" => &mut material.kd,
                        "Ks" => &mut material.ks,
                        "Ke" => &mut material.ke,
                        _ => &mut material.tf,
                    } = color;
                }
            }
            "Ns" | "Ni" | "d" | "Tr" | "Pr" | "Pm" | "illum" => {
                let value = self.value(word, words);
                if let Some(material) = self.materials.last_mut() {
                    material.set(&key, value);
                }
            }
            _ => self.strange(&key, word),
        }
    }

    fn strange(&mut self, key: &str, word: Part<'_>) {
        if self.said.iter().any(|s| s == key) || self.said.len() > 8 {
            return;
        }
        self.said.push(key.to_owned());
        if UNSUPPORTED.contains(&key) {
            self.warn(word.range(), format!("{key} is not supported yet; drawn without it"));
            return;
        }
        let known = MAPS.iter().map(|(name, _)| *name).chain(VALUES).chain(UNSUPPORTED);
        let near =
            nearest_word(key, known).map(|near| format!("; did you mean \"{near}\"?")).unwrap_or_default();
        self.warn(word.range(), format!("unknown word \"{}\"; its lines are skipped{near}", word.shown()));
    }

    fn number(&mut self, word: Part<'_>) -> Option<f32> {
        let number = float(word.bytes).filter(|v| v.is_finite());
        if number.is_none() {
            self.warn(word.range(), format!("\"{}\" is not a number", word.shown()));
        }
        number
    }

    fn value(&mut self, key: Part<'_>, mut words: Words<'_>) -> Option<f32> {
        let Some(mut word) = words.next() else {
            self.warn(key.range(), "a number is missing".to_owned());
            return None;
        };
        if word.bytes == b"-halo" {
            self.warn(word.range(), "-halo is not supported: the surface is as opaque everywhere".to_owned());
            word = words.next()?;
        }
        self.number(word)
    }

    /// Three numbers, or one for all.
    fn color(&mut self, key: Part<'_>, mut words: Words<'_>) -> Option<[f32; 3]> {
        let Some(first) = words.next() else {
            self.warn(key.range(), "a colour is missing".to_owned());
            return None;
        };
        if matches!(first.bytes, b"spectral" | b"xyz") {
            self.warn(first.range(), "only colours of red, green and blue are read".to_owned());
            return None;
        }
        let red = self.number(first)?;
        let (green, blue) = match (words.next(), words.next()) {
            (Some(green), Some(blue)) => (green, blue),
            (None, _) => return Some([red.max(0.0); 3]),
            (Some(_), None) => {
                let message = "expected 1 or 3 numbers, found 2: the first is used for all";
                self.warn(key.range(), message.to_owned());
                return Some([red.max(0.0); 3]);
            }
        };
        Some([red, self.number(green)?, self.number(blue)?].map(|c| c.max(0.0)))
    }

    /// Options and the file name, which may hold spaces.
    fn map(&mut self, mut words: Words<'_>) -> Option<Map> {
        let mut map = Map {
            file: String::new(),
            at: 0..0,
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
            strength: 1.0,
            channel: None,
        };
        loop {
            let rest = words.rest().trim();
            let word = words.next()?;
            match word.bytes {
                b"-s" => map.scale = self.triple(&mut words, 1.0),
                b"-o" => map.offset = self.triple(&mut words, 0.0),
                b"-t" => {
                    if self.triple(&mut words, 0.0) != [0.0; 2] {
                        self.unsupported(word);
                    }
                }
                b"-clamp" => map.clamp = words.next().is_some_and(|w| w.bytes == b"on"),
                b"-bm" => map.strength = words.next().and_then(|w| self.number(w)).unwrap_or(1.0),
                b"-imfchan" => map.channel = words.next().and_then(channel),
                // They are on by default, and say how images are filtered.
                b"-blendu" | b"-blendv" | b"-texres" | b"-boost" => drop(words.next()),
                b"-cc" | b"-type" => {
                    words.next();
                    self.unsupported(word);
                }
                b"-mm" => {
                    let (base, gain) = (words.next()?, words.next()?);
                    if self.number(base) != Some(0.0) || self.number(gain) != Some(1.0) {
                        self.unsupported(word);
                    }
                }
                _ => {
                    map.at = rest.range();
                    map.file = rest.text().trim_matches('"').to_owned();
                    return Some(map);
                }
            }
        }
    }

    fn unsupported(&mut self, option: Part<'_>) {
        self.warn(option.range(), format!("the option {} is not supported", option.shown()));
    }

    /// One to three numbers; the third is for textures in space.
    fn triple(&mut self, words: &mut Words<'_>, default: f32) -> [f32; 2] {
        let mut values = [default; 3];
        for value in &mut values {
            let mut ahead = words.clone();
            match ahead.next().and_then(|w| float(w.bytes)).filter(|v| v.is_finite()) {
                Some(number) => *value = number,
                None => break,
            }
            *words = ahead;
        }
        let [u, v, _] = values;
        [u, v]
    }
}

/// A word as this file spells it: programs disagree about letter case.
fn known(word: String) -> String {
    let maps = MAPS.iter().map(|(name, _)| *name);
    let mut all = maps.chain(VALUES).chain(IGNORED).chain(UNSUPPORTED);
    all.find(|name| name.eq_ignore_ascii_case(&word)).map_or(word, str::to_owned)
}

fn channel(word: Part<'_>) -> Option<&'static str> {
    match word.bytes {
        b"r" => Some("r"),
        b"g" => Some("g"),
        b"b" => Some("b"),
        b"m" => Some("a"),
        _ => Some("luminance"),
    }
}

impl Material {
    fn set(&mut self, key: &str, value: Option<f32>) {
        match key {
            "Ns" => self.ns = value,
            "Ni" => self.ni = value,
            "d" => self.d = value,
            "Tr" => self.tr = value,
            "Pr" => self.pr = value,
            "Pm" => self.pm = value,
            _ => self.illum = value.map(|v| v as u32),
        }
    }
    /// The image for `slot`; the last one counts.
    pub(super) fn map(&self, slot: Slot) -> Option<&Map> {
        self.maps.iter().rev().find(|(s, _)| *s == slot).map(|(_, map)| map)
    }
    /// True if nothing of it can be seen: `d` is 0, it is no glass and no image says where it is.
    pub(super) fn is_invisible(&self) -> bool {
        let glass = matches!(self.illum, Some(3..=7 | 9));
        self.opacity() == 0.0 && self.map(Slot::Opacity).is_none() && !glass
    }
    /// Share of the surface that is there, by `d`, else by `Tr`. A `Tr` of 1 alone would leave nothing to see: programs
    /// that write it, such as MeshLab, mean the opposite.
    pub(super) fn opacity(&self) -> f32 {
        let by_tr = self.tr.filter(|t| *t != 1.0).map(|t| 1.0 - t);
        self.d.or(by_tr).unwrap_or(1.0).clamp(0.0, 1.0)
    }
}
