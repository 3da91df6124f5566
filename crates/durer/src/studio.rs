//! A scene that is changed and prepared again and again, as on the live page: geometry is built once.
use durer_io::import::Imported;
use durer_render::{
    Scene,
    compile::{CompileOptions, Kept},
};
use durer_scene::{Diagnostics, Node, SceneDesc};

use crate::{Options, Prepared, environment, prepare::prepared, transport::integrator_node};

/// An opened scene with everything in its description that options ask for and that was made up: surroundings, the
/// integrator, a camera, lights.
pub struct Studio {
    /// The scene as it was opened.
    pub imported: Imported,
    /// What is left to ask for: film, time, lens.
    pub options: Options,
    /// What compilations share.
    pub kept: Kept,
}

impl Studio {
    /// Opens a scene. What it is prepared to has the bits of [`crate::prepare`].
    ///
    /// # Errors
    /// The scene with its complaints.
    pub fn open(mut imported: Imported, options: &Options) -> Result<(Self, Prepared), Box<Imported>> {
        match Self::prepared(&mut imported, options) {
            Some((prepared, kept)) => {
                let mut studio = Self { imported, options: options.clone(), kept };
                studio.complete(&prepared);
                Ok((studio, prepared))
            }
            None => Err(Box::new(imported)),
        }
    }

    fn prepared(imported: &mut Imported, options: &Options) -> Option<(Prepared, Kept)> {
        let Imported { desc, assets, diagnostics, .. } = imported;
        if diagnostics.has_errors() {
            return None;
        }
        if let Some(file) = &options.environment {
            *desc = environment::surround(desc, file, assets, diagnostics)?;
        }
        let node = integrator_node(desc, options, diagnostics);
        let mut kept = None;
        let prepared = prepared(desc, &node, options, diagnostics, |options, diagnostics| {
            let (scene, new) = Kept::first(desc, (&*assets, options), diagnostics)?;
            kept = Some(new);
            Some(scene)
        })?;
        desc.integrator = Some(node);
        Some((prepared, kept?))
    }

    /// Puts into the description what was made up, and takes from the options what the description has now.
    fn complete(&mut self, prepared: &Prepared) {
        let (desc, options) = (&mut self.imported.desc, &mut self.options);
        if desc.cameras.is_empty() {
            desc.cameras.push(self.kept.camera.clone());
        }
        desc.lights.clone_from(&self.kept.lights);
        let view = &prepared.scene.view;
        *options = Options {
            integrator: None,
            show: None,
            max_depth: None,
            min_contribution: None,
            shadows: None,
            distribution: Default::default(),
            environment: None,
            width: Some(view.width),
            height: Some(view.height),
            scale: None,
            sampler: Some(prepared.settings.sampler),
            ..options.clone()
        };
    }

    /// Prepares the scene as it is wanted, with the geometry of `kept`. `None` if there was an error.
    pub fn again(
        &self,
        wanted: Wanted<'_>,
        kept: &Kept,
        diagnostics: &mut Diagnostics,
    ) -> Option<(Prepared, Kept)> {
        let Wanted { desc, integrator, options } = wanted;
        let mut new = None;
        let again = |options: &CompileOptions, diagnostics: &mut Diagnostics| {
            let (scene, kept) = kept.again(desc, (&self.imported.assets, options), diagnostics)?;
            new = Some(kept);
            Some(scene)
        };
        let prepared = prepared(desc, integrator, options, diagnostics, again)?;
        Some((prepared, new?))
    }

    /// The same where only cameras, integrator, sampler, filter and film differ from those of `scene`. Takes next to no time.
    pub fn retake(
        &self,
        wanted: Wanted<'_>,
        (kept, scene): (&Kept, &Scene),
        diagnostics: &mut Diagnostics,
    ) -> Option<Prepared> {
        let Wanted { desc, integrator, options } = wanted;
        let retake = |options: &CompileOptions, diagnostics: &mut Diagnostics| {
            kept.retake(scene, desc, (&self.imported.assets, options), diagnostics)
        };
        prepared(desc, integrator, options, diagnostics, retake)
    }
}

/// What a studio prepares.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// The scene that was opened but for cameras, materials, lights, sampler, filter and film.
    pub desc: &'a SceneDesc,
    /// Light transport, whatever the description says.
    pub integrator: &'a Node,
    /// Film, time and lens.
    pub options: &'a Options,
}
