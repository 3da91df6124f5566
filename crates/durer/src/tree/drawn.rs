//! How a ray was chosen, as the document says it.
use serde::{Deserialize, Serialize};

use super::{
    capture::of_weight,
    number::{Number, Rgb},
};
use crate::{
    probe::{Choice, ChosenBy},
    spectrum::Basis,
};

/// How a ray was chosen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Drawn {
    /// `light` where a light was sampled, `sharp` where there is but one direction, `joined` where it leads to a walk from the
    /// other end, else the lobe's name.
    pub from: String,
    /// The lobe, if it was one that chose.
    pub lobe: Option<String>,
    /// How many rays share this one's place.
    pub rays: u32,
    /// Probability with which this light was chosen among all, or a path's sharp direction; 1 where there was no choice.
    pub chance: Number,
    /// Probability with which chance let the ray live (Russian roulette); 1 where it was not asked.
    pub kept: Number,
    /// Density of the choice, 1/sr.
    pub pdf: Option<Number>,
    /// Density with which the other way of choosing gives the same direction, 1/sr.
    pub other_pdf: Option<Number>,
    /// The weight of this way against the other.
    pub mis: Option<Number>,
    /// The value of the reflectance distribution, 1/sr.
    pub f: Option<Rgb>,
    /// Cosine of the angle between the ray and the surface that it leaves.
    pub cos: Option<Number>,
}

pub(super) fn drawn(basis: &Basis, choice: &Choice) -> Drawn {
    let from = match choice.by {
        ChosenBy::Light => "light",
        ChosenBy::Sharp => "sharp",
        ChosenBy::Joined => "joined",
        ChosenBy::Lobe => choice.lobe.unwrap_or("lobe"),
    };
    Drawn {
        from: from.to_owned(),
        lobe: choice.lobe.map(str::to_owned),
        rays: choice.rays,
        chance: Number(choice.chance),
        kept: Number(choice.kept),
        pdf: choice.pdf.map(Number),
        other_pdf: choice.other_pdf.map(Number),
        mis: choice.mis.map(Number),
        f: choice.f.map(|f| of_weight(basis, f)),
        cos: choice.cos.map(Number),
    }
}
