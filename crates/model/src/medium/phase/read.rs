//! Phase functions as parameters of media.
use std::sync::Arc;

use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use super::{super::matter::Matter, Blend, Drops, Flakes, HenyeyGreenstein, Phase, Table};

/// The words of those that a blend can have.
const PARTS: &[&str] = &["henyeygreenstein", "waterdrops", "rayleigh", "table", "sggx"];

/// Reads a part of a blend from its word and numbers: those of "phasevalues" where it has none.
fn part(text: &str, values: &[f32], size: [usize; 3]) -> Result<Phase, String> {
    let mut words = text.split_whitespace();
    let word = words.next().unwrap_or_default();
    let own = words.map(|w| w.parse::<f32>().ok().filter(|v| v.is_finite()));
    let own = own
        .collect::<Option<Vec<f32>>>()
        .ok_or_else(|| format!("\"{text}\": expected a word and numbers"))?;
    let many = if own.is_empty() { values } else { &own };
    match (word, own.as_slice()) {
        ("henyeygreenstein", []) => Ok(Phase::HenyeyGreenstein(HenyeyGreenstein::new(0.0))),
        ("henyeygreenstein", [g]) if g.abs() <= 1.0 => Ok(Phase::HenyeyGreenstein(HenyeyGreenstein::new(*g))),
        ("waterdrops", []) => Ok(Phase::Drops(Arc::new(Drops::new()))),
        ("rayleigh", []) => Ok(Phase::Rayleigh),
        ("table", _) => table(many),
        ("sggx", _) => Ok(Phase::Flakes(Arc::new(Flakes::new(size, many)?))),
        ("henyeygreenstein", _) => Err(format!("\"{text}\": expected a mean cosine from -1 to 1")),
        ("waterdrops" | "rayleigh", _) => Err(format!("\"{text}\": {word} has no numbers")),
        _ => Err(format!("\"{word}\" is no phase function, expected one of {}", PARTS.join(", "))),
    }
}

fn table(values: &[f32]) -> Result<Phase, String> {
    let wrong = || "a table is of two or more values, none below 0 and not all 0".to_owned();
    Ok(Phase::Table(Arc::new(Table::new(values).ok_or_else(wrong)?)))
}

impl Phase {
    /// The parameter `phase`.
    pub(in super::super) const WHICH: ParamSpec = ParamSpec::new(
        "phase",
        ParamType::Choice(&["henyeygreenstein", "waterdrops", "rayleigh", "table", "sggx", "blend"]),
        ParamDefault::Text("henyeygreenstein"),
        "Where particles send light: henyeygreenstein (by \"g\"), waterdrops (as round drops of water do, with rainbows), \
         rayleigh (as molecules of air do), table (by cosines, \"phasevalues\"), sggx (as flakes do that mirror, \
         \"phasevalues\"), or blend (\"phases\" side by side).",
    );
    /// The parameter `phasevalues`.
    pub(in super::super) const VALUES: ParamSpec = ParamSpec::new(
        "phasevalues",
        ParamType::Floats,
        ParamDefault::Unset,
        "Of table: how much goes on at even steps of the cosine of the deflection, from -1 (back) to 1 (on). Of sggx: xx, yy, zz, \
         xy, xz, yz of the flakes' matrix along the axes of world space, or these for each place.",
    );
    /// The parameter `phases`.
    pub(in super::super) const PARTS: ParamSpec = ParamSpec::new(
        "phases",
        ParamType::Texts,
        ParamDefault::Unset,
        "Of blend: phase functions, with their numbers, such as \"henyeygreenstein 0.8\", \"rayleigh\" or \"table 1 0 2\". A \
         table or sggx without numbers has \"phasevalues\".",
    );
    /// The parameter `phaseweights`.
    pub(in super::super) const WEIGHTS: ParamSpec = ParamSpec::new(
        "phaseweights",
        ParamType::Floats,
        ParamDefault::Unset,
        "Of blend: how much of each part there is, for all places or for each; the same of all if it is left out.",
    )
    .range(0.0, f32::INFINITY);
    /// The parameter `phasesize`.
    pub(in super::super) const SIZE: ParamSpec = ParamSpec::new(
        "phasesize",
        ParamType::Ints,
        ParamDefault::Unset,
        "Places along x, y and z, if \"phasevalues\" of sggx or \"phaseweights\" change: in the medium's box, or in the unit \
         cube of one without bounds. The outermost values go on.",
    )
    .range(1.0, 65_536.0);

    /// Reads it, and what it needs.
    pub(in super::super) fn read(args: &mut Args<'_>) -> Self {
        let word = args.text(Self::WHICH.name);
        let heeded: &[&str] = match word {
            "henyeygreenstein" => &["g"],
            "table" => &["phasevalues"],
            "sggx" => &["phasevalues", "phasesize"],
            "blend" => &["phases", "phasevalues", "phaseweights", "phasesize"],
            _ => &[],
        };
        for name in [Matter::G, Self::VALUES, Self::PARTS, Self::WEIGHTS, Self::SIZE].map(|spec| spec.name) {
            if args.is_set(name) && !heeded.contains(&name) {
                args.warning(name, format!("\"{name}\" has no effect beside the phase function \"{word}\""));
            }
        }
        let size = match *args.ints(Self::SIZE.name) {
            [] => [1; 3],
            [x, y, z] => [x, y, z].map(|n| n.unsigned_abs() as usize),
            ref other => {
                args.error(Self::SIZE.name, format!("\"phasesize\" has {} numbers, expected 3", other.len()));
                [1; 3]
            }
        };
        let values = args.floats(Self::VALUES.name);
        let (at, made) = match word {
            "henyeygreenstein" => {
                return Self::HenyeyGreenstein(HenyeyGreenstein::new(args.float(Matter::G.name)));
            }
            "blend" => blend(args, size),
            "table" | "sggx" => (Self::VALUES.name, part(word, values, size)),
            _ => (Self::WHICH.name, part(word, &[], size)),
        };
        made.unwrap_or_else(|why| {
            args.error(at, why);
            Self::Rayleigh
        })
    }
}

/// The parameter to complain about, and what is made of it.
fn blend(args: &Args<'_>, size: [usize; 3]) -> (&'static str, Result<Phase, String>) {
    let (values, texts) = (args.floats(Phase::VALUES.name), args.texts(Phase::PARTS.name));
    if texts.len() < 2 {
        return (Phase::PARTS.name, Err("\"phase\" \"blend\" needs two or more \"phases\"".to_owned()));
    }
    let parts = texts.iter().map(|text| part(text, values, size)).collect::<Result<Vec<_>, _>>();
    let even = vec![1.0; texts.len()];
    let weights = args.floats(Phase::WEIGHTS.name);
    let weights = if weights.is_empty() { &even } else { weights };
    match parts {
        Err(why) => (Phase::PARTS.name, Err(why)),
        Ok(parts) => {
            (Phase::WEIGHTS.name, Blend::new(parts, size, weights).map(|blend| Phase::Blend(Arc::new(blend))))
        }
    }
}
