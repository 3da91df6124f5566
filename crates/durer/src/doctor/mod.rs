//! The scene doctor: why a picture is black, blank or blown out, and what to try.
//!
//! Pictures fail for few reasons: nothing is where the camera looks, the camera is inside of something, no light arrives,
//! paths end before they find any, the exposure is off, or something is a thousand times too large. A few eye rays and a
//! few samples tell which.
mod exposure;
mod geometry;
mod glass;
mod light;
mod look;
mod paths;
mod size;

use durer_scene::{Diagnostics, Location, SceneDesc, Severity};

use crate::{Prepared, film::Pixel};
use exposure::{Light, Trouble};
use look::Look;
use paths::Survey;

/// Something odd.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// What it is, in a sentence.
    pub message: String,
    /// What to try.
    pub remedy: Option<String>,
}

impl Finding {
    fn note(message: impl Into<String>) -> Self {
        Self { severity: Severity::Note, message: message.into(), remedy: None }
    }
    fn warning(message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::note(message) }
    }
    fn remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(remedy.into()), ..self }
    }
    /// Adds it to a list of complaints.
    pub fn tell(&self, diagnostics: &mut Diagnostics) {
        let told = match self.severity {
            Severity::Note => diagnostics.note(Location::None, &self.message),
            Severity::Warning | Severity::Error => diagnostics.warning(Location::None, &self.message),
        };
        if let Some(remedy) = &self.remedy {
            told.hint(remedy);
        }
    }
}

/// What is odd about a scene, its picture taken on trial: what most likely spoils it comes first.
pub fn examine(desc: &SceneDesc, prepared: &Prepared) -> Vec<Finding> {
    let mut found = Vec::new();
    let built = prepared.scene.accel.stats();
    if built.triangles + built.user_primitives > 0 {
        let survey = Survey::take(prepared);
        let light = survey.light.clone();
        found.extend(causes(desc, prepared, &survey, Light { light, exposure: 0.0 }));
    }
    found.extend(glass::turned(prepared));
    found.extend(geometry::findings(desc, prepared));
    found
}

/// Why a picture that was taken with this exposure, in stops, is black or blown out; nothing if it is neither.
pub fn explain(desc: &SceneDesc, prepared: &Prepared, pixels: &[Pixel], exposure: f32) -> Vec<Finding> {
    let light = Light::of(pixels, exposure);
    match light.trouble() {
        None => Vec::new(),
        Some(_) => causes(desc, prepared, &Survey::take(prepared), light),
    }
}

/// What keeps the eye from seeing anything, by what of the picture is lit.
fn causes(desc: &SceneDesc, prepared: &Prepared, survey: &Survey, light: Light) -> Vec<Finding> {
    let look = Look::take(prepared);
    let trouble = light.trouble();
    let mut found: Vec<Finding> = look.finding(desc, prepared, trouble).into_iter().collect();
    let Some(trouble) = trouble else { return found };
    if trouble == Trouble::Dark {
        found.extend(light::findings(prepared, &look));
        found.extend(survey.ends(prepared));
    }
    found.extend(light.finding(trouble));
    found.extend(size::units(desc, prepared, trouble));
    found
}
