//! How a file is read: limits, and which of several pictures that it may hold.
use std::path::PathBuf;

use durer_core::math::Interval;
use durer_scene::Limits;

/// What is asked of a file beyond being read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// How large things may become.
    pub limits: Limits,
    /// Which of its animations moves the scene.
    pub play: Play,
    /// When.
    pub moment: Moment,
    /// The name, or else the index, of the set of materials that it wears; its own if `None`.
    pub variant: Option<String>,
    /// Values for the names that a scene of Mitsuba leaves open (`-Dname=value`).
    pub definitions: Vec<(String, String)>,
    /// The folder that files may be read from: that of the scene, or one above it. The scene's own if `None`.
    pub root: Option<PathBuf>,
}

/// Which animation of a file is played.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Play {
    /// None: the scene is at rest.
    #[default]
    Rest,
    /// The first, if there is one.
    First,
    /// The one of this name, else of this index; those of all if the word is `all`.
    Named(String),
}

/// When a scene is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// In seconds.
    pub time: f32,
    /// From when to when the shutter is open, in seconds.
    pub shutter: Interval,
}

impl Default for Moment {
    fn default() -> Self {
        Self { time: 0.0, shutter: Interval::point(0.0) }
    }
}

impl From<Limits> for Reading {
    fn from(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }
}
