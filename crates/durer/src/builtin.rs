//! The scenes in the binary: `.pbrt` files of our own.
//!
//! A new one is one file in `scenes/` and one line in [`SCENES`].

use durer_io::import::{Imported, pbrt};

/// A scene in the binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Builtin {
    /// What the command line calls it.
    pub name: &'static str,
    /// One line about it.
    pub doc: &'static str,
    /// The scene file.
    pub text: &'static str,
}

/// All of them; the first is the default.
pub const SCENES: &[Builtin] = &[
    Builtin {
        name: "whitted",
        doc: "hollow glass ball and mirror ball over a checkerboard, after Whitted's picture of 1980",
        text: include_str!("../scenes/whitted.pbrt"),
    },
    Builtin {
        name: "cook",
        doc: "five pool balls in motion, after the picture \"1984\" by Thomas Porter",
        text: include_str!("../scenes/cook.pbrt"),
    },
    Builtin {
        name: "durer",
        doc: "a lute, the frame and the thread that draws it, after Dürer's woodcut of 1525",
        text: include_str!("../scenes/durer.pbrt"),
    },
    Builtin {
        name: "bokeh",
        doc: "a brass pawn in focus, lights before and behind it in the shape of the lens's six blades",
        text: include_str!("../scenes/bokeh.pbrt"),
    },
    Builtin {
        name: "shutter",
        doc: "a wheel that turns, balls that fly and bounce and one at rest, while the shutter is open",
        text: include_str!("../scenes/shutter.pbrt"),
    },
    Builtin {
        name: "penumbra",
        doc: "umbra and penumbra in colour: shadows of a red sphere, a green disk and a blue rectangle",
        text: include_str!("../scenes/penumbra.pbrt"),
    },
    Builtin {
        name: "caustic",
        doc: "what glass balls and a brass ring do with the light of a small lamp, found by particles",
        text: include_str!("../scenes/caustic.pbrt"),
    },
    Builtin {
        name: "pool",
        doc: "the tiled floor of a pool under waves in the sun, found by photons",
        text: include_str!("../scenes/pool.pbrt"),
    },
    Builtin {
        name: "cornell",
        doc: "the Cornell box with its published geometry, lit by the light in its ceiling",
        text: include_str!("../scenes/cornell.pbrt"),
    },
    Builtin {
        name: "fog",
        doc: "sunbeams in the haze of a hall, and lanterns that fade with the distance",
        text: include_str!("../scenes/fog.pbrt"),
    },
    Builtin {
        name: "jade",
        doc: "a knot of jade before a lamp, whose light walks in it, with a ball of marble and an egg of wax",
        text: include_str!("../scenes/jade.pbrt"),
    },
    Builtin {
        name: "curls",
        doc: "blond, red and brown curls of hair before a lamp that shines through them",
        text: include_str!("../scenes/curls.pbrt"),
    },
    Builtin {
        name: "snell",
        doc: "Snell's window: the sky from under water, and the floor mirrored around it",
        text: include_str!("../scenes/snell.pbrt"),
    },
    Builtin {
        name: "beaker",
        doc: "water that reaches into the wall of its glass, with ice and a straw",
        text: include_str!("../scenes/beaker.pbrt"),
    },
    Builtin {
        name: "mirrors",
        doc: "a ball between two mirrors at 60 degrees, and its five images",
        text: include_str!("../scenes/mirrors.pbrt"),
    },
    Builtin {
        name: "glass-plate",
        doc: "three plates of coloured glass before a white sky: what they leave by all orders of reflection",
        text: include_str!("../scenes/glass-plate.pbrt"),
    },
    Builtin {
        name: "prism",
        doc: "white light and five lines of a spectrum, seen through a prism of flint glass (in wavelengths)",
        text: include_str!("../scenes/prism.pbrt"),
    },
    Builtin {
        name: "rainbow",
        doc: "two bows and the dark band between, in a shower of round drops of water (in wavelengths)",
        text: include_str!("../scenes/rainbow.pbrt"),
    },
];

/// The built-in scene of this name.
pub fn find(name: &str) -> Option<&'static Builtin> {
    SCENES.iter().find(|s| s.name == name)
}

impl Builtin {
    /// Parses it.
    pub fn import(&self) -> Imported {
        let mut imported = Imported::new("".into(), Default::default());
        imported.desc.name = self.name.to_owned();
        pbrt::read_text(&format!("{}.pbrt", self.name), self.text, &mut imported);
        imported
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Options, prepare};

    #[test]
    fn every_scene_prepares_without_complaint() {
        for scene in SCENES {
            let mut imported = scene.import();
            assert!(prepare(&mut imported, &Options::default()).is_some(), "{}", scene.name);
            assert!(imported.diagnostics.is_empty(), "{}: {:?}", scene.name, imported.diagnostics);
        }
    }
}
