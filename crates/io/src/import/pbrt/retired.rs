//! Words of pbrt-v2 and v3 that pbrt-v4 no longer has, each with what it writes instead. (Some kinds of material still answer
//! to their old word: their schemas say which.)
use std::path::Path;

use durer_scene::{Diagnostics, Location, Severity, counted};

use super::{input::Word, params::ParamList};

/// What kind it is a kind of, the word, and what to do.
const KINDS: &[(&str, &str, &str)] = &[
    ("material", "plastic", "\"coateddiffuse\", with \"reflectance\" for Kd"),
    ("material", "substrate", "\"coateddiffuse\", with \"reflectance\" for Kd"),
    ("material", "uber", "\"coateddiffuse\" for what is opaque, \"dielectric\" for what is clear"),
    ("material", "metal", "\"conductor\""),
    ("material", "shinymetal", "\"conductor\""),
    ("material", "translucent", "\"diffusetransmission\""),
    ("material", "fourier", "\"measured\""),
    ("material", "kdsubsurface", "\"subsurface\""),
    ("sampler", "lowdiscrepancy", "\"paddedsobol\""),
    ("sampler", "02sequence", "\"paddedsobol\""),
    ("sampler", "maxmindist", "\"pmj02bn\""),
    ("sampler", "random", "\"independent\""),
    ("sampler", "adaptive", "\"zsobol\""),
    ("sampler", "bestcandidate", "\"zsobol\""),
    ("integrator", "directlighting", "\"path\" with \"integer maxdepth\" 1"),
    ("camera", "environment", "\"spherical\""),
    ("shape", "cone", "nothing of the kind; write it as a mesh"),
    ("shape", "hyperboloid", "nothing of the kind; write it as a mesh"),
    ("shape", "paraboloid", "nothing of the kind; write it as a mesh"),
    ("shape", "heightfield", "nothing of the kind; write it as a mesh"),
    ("shape", "heightfield2", "nothing of the kind; write it as a mesh"),
    ("shape", "nurbs", "nothing of the kind; write it as a mesh"),
    ("texture", "uv", "nothing of the kind"),
];

/// A parameter and what to do; none of these names means anything to a kind of pbrt-v4 or of ours.
const PARAMS: &[(&str, &str)] = &[
    ("Kd", "\"reflectance\""),
    ("Ks", "\"reflectance\" of a conductor, or a coated material"),
    ("Kr", "\"reflectance\" of a conductor; a dielectric has none"),
    ("Kt", "\"transmittance\" of diffusetransmission; a dielectric has none"),
    ("mapname", "\"filename\""),
    ("bumpmap", "\"displacement\""),
    ("maxsampleluminance", "\"maxcomponentvalue\""),
    ("shadowalpha", "\"alpha\""),
];

/// What the hints about such words begin with.
const OLDER: &str = "this is an older pbrt's word; ";

/// Says first, of a file of an older version, that it is one, and keeps a few of the errors as examples.
pub(super) fn summarize(path: &Path, diagnostics: &mut Diagnostics) {
    const MOST: usize = 5;
    const HINTS: [&str; 4] = [OLDER, "this is pbrt-v2's word", "this is pbrt-v3's word", "pbrt-v4 writes"];
    let is_old = |hint: &String| HINTS.iter().any(|begin| hint.starts_with(begin));
    let old = diagnostics.iter().filter(|d| d.hint.as_ref().is_some_and(is_old)).count();
    if old < 2 {
        return;
    }
    let all = std::mem::take(diagnostics);
    let at = Location::Path { file: path.display().to_string(), pointer: String::new() };
    diagnostics.error(at.clone(), "this looks like a pbrt-v2 or pbrt-v3 file; durer reads pbrt-v4");
    // One example of each.
    let mut shown: Vec<&str> = Vec::new();
    for said in all.iter().filter(|said| said.severity == Severity::Error) {
        if shown.len() < MOST && !shown.contains(&said.message.as_str()) {
            shown.push(&said.message);
            diagnostics.error(said.at.clone(), said.message.clone()).hint.clone_from(&said.hint);
        }
    }
    let more = all.error_count() - shown.len();
    if more > 0 {
        diagnostics.error(at, format!("{} like these", counted(more, "more error")));
    }
    for said in all.iter().filter(|said| said.severity != Severity::Error) {
        let kept = match said.severity {
            Severity::Warning => diagnostics.warning(said.at.clone(), said.message.clone()),
            _ => diagnostics.note(said.at.clone(), said.message.clone()),
        };
        kept.hint.clone_from(&said.hint);
    }
}

/// Complains about `kind` if it is a retired word for a `family`; says whether it did.
pub(super) fn complain(family: &str, kind: &Word, diagnostics: &mut Diagnostics) -> bool {
    let Some((_, word, now)) = KINDS.iter().find(|line| line.0 == family && line.1 == kind.text) else {
        return false;
    };
    let message = format!("unknown {family} \"{word}\"");
    diagnostics.error(kind.at, message).hint(format!("{OLDER}pbrt-v4 has {now}"));
    true
}

/// Takes retired parameters out of `params`, with a complaint each.
pub(super) fn sift(params: &mut ParamList, diagnostics: &mut Diagnostics) {
    params.retain(|param| {
        let Some((name, now)) = PARAMS.iter().find(|line| line.0 == param.name) else { return true };
        let hint = format!("{OLDER}pbrt-v4 has {now}");
        diagnostics.error(param.at.clone(), format!("unknown parameter \"{name}\"")).hint(hint);
        false
    });
}
