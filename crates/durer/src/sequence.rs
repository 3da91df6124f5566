//! One picture after another of a scene that moves. What does not move is made once; each picture has the bits that it has
//! alone.
use durer_io::import::Imported;
use durer_render::compile::{CompileOptions, Kept};
use durer_scene::Diagnostics;

use crate::{Options, Prepared, environment, prepare::prepared, transport::integrator_node};

/// A scene at one moment after another.
pub struct Sequence {
    /// The scene as it was described for the last picture; complaints of the first picture, then errors only.
    pub imported: Imported,
    options: Options,
    kept: Option<Kept>,
}

impl Sequence {
    /// A scene that was opened for `options` ([`crate::open_for`]).
    pub fn new(imported: Imported, options: Options) -> Self {
        Self { imported, options, kept: None }
    }

    /// What the options are at `time` seconds.
    pub fn options_at(&self, time: f32) -> Options {
        Options { time, ..self.options.clone() }
    }

    /// The scene at `time` seconds; `None` if [`Self::imported`] holds an error.
    pub fn at(&mut self, time: f32) -> Option<Prepared> {
        let options = self.options_at(time);
        // What is said of the first picture would be said of each.
        let is_first = self.kept.is_none();
        let said = std::mem::take(&mut self.imported.diagnostics);
        // It was opened for its own moment.
        if !is_first || time != self.options.time {
            self.imported.turn_to(options.moment());
        }
        let has_faults = said.has_errors();
        let prepared = if has_faults { None } else { self.prepared(&options) };
        let new = std::mem::replace(&mut self.imported.diagnostics, said);
        if is_first || new.has_errors() {
            self.imported.diagnostics.append(new);
        }
        prepared
    }

    fn prepared(&mut self, options: &Options) -> Option<Prepared> {
        let Imported { desc, assets, diagnostics, reel, .. } = &mut self.imported;
        if diagnostics.has_errors() {
            return None;
        }
        let desc = &*environment::within(desc, options, assets, diagnostics)?;
        let node = integrator_node(desc, options, diagnostics);
        let kept = &mut self.kept;
        prepared(
            desc,
            &node,
            options,
            diagnostics,
            |options: &CompileOptions, diagnostics: &mut Diagnostics| {
                let with = (&*assets as &dyn durer_scene::Assets, options);
                let (scene, new) = match kept.take() {
                    None => Kept::first(desc, with, diagnostics),
                    // A description that holds all moments is still the same.
                    Some(kept) if reel.is_none() => kept.again(desc, with, diagnostics),
                    Some(kept) => kept.moved(desc, with, diagnostics),
                }?;
                *kept = Some(new);
                Some(scene)
            },
        )
    }
}
