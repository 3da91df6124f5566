//! Drawings as Dürer's machine made them: from cast rays alone.
//!
//! In 1525 Albrecht Dürer showed how to draw a lute with a thread: it leads from a fixed point through a frame to a point
//! of the thing, and where it passes the frame a dot is set. Whoever chooses the points well has the outline. Here the
//! thread is a ray, and the points are chosen by comparing neighbours: between two rays a line passes where the surface
//! ends ([`Kind::Silhouette`]), folds ([`Kind::Crease`]) or meets another thing ([`Kind::Boundary`]). Hidden lines need no
//! removal: no ray sees them. It works for all that rays can meet.
//!
//! [`draw`] casts a lattice of rays, finds where lines cross it by halving, follows the lines from cell to cell, in smaller
//! cells where lines meet or things are small, joins them to trails, and fits curves.
#![forbid(unsafe_code)]

mod bezier;
mod change;
mod corner;
mod eye;
mod hatch;
mod lattice;
mod line;
mod net;
mod search;
mod strand;
mod svg;
mod trail;

use std::sync::atomic::AtomicBool;

use durer_render::{Scene, drive::Progress, film::Tile};

pub use bezier::Piece;
pub use durer_core::glam::DVec2;
pub use hatch::{FINEST_HATCH, Tones, hatch};
pub use line::Line;
pub use svg::{Paper, Style, svg};

use change::Judge;
use eye::Eye;
use lattice::{Grid, Lattice};
use net::Net;
use search::Searcher;
use strand::Strands;

/// Why a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A surface ends, and what is seen beside it lies behind it.
    Silhouette,
    /// Two things meet.
    Boundary,
    /// A surface folds.
    Crease,
    /// It is dark there.
    Hatch,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Silhouette, Self::Boundary, Self::Crease, Self::Hatch];

    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Silhouette => "silhouette",
            Self::Boundary => "boundary",
            Self::Crease => "crease",
            Self::Hatch => "hatch",
        }
    }
}

/// How a drawing is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// Rays along the edge of a pixel, at least 1. More find smaller things; lines stay where they are.
    pub rays: u32,
    /// Angle between the normals of both sides from which on a fold is drawn, in degrees, above 0.
    pub crease: f64,
    /// How far a curve may pass by the points that were found, in pixels, above 0.
    pub tolerance: f64,
    /// Worker threads, at least 1. The drawing does not depend on their number.
    pub threads: usize,
    /// The part of the picture that is drawn; all of it if there is none. Lines are where they are in the whole.
    pub window: Option<Tile>,
}

impl Default for Machine {
    fn default() -> Self {
        Self { rays: 1, crease: 40.0, tolerance: 0.04, threads: 1, window: None }
    }
}

impl Machine {
    /// How many steps [`draw`] tells of, for a picture of this size.
    pub fn steps(&self, size: [u32; 2]) -> u64 {
        let [columns, rows] = Grid::new(self.part(size), self.rays.max(1)).cells.map(u64::from);
        2 * (columns + 1) * (rows + 1)
    }

    /// Rays along the edge of a pixel that a picture of this size needs: small ones hold more in a pixel.
    pub fn rays_for(size: [u32; 2]) -> u32 {
        ROW.div_ceil(size[0].max(size[1]).max(1)).clamp(1, MOST_RAYS)
    }

    /// What is drawn of a picture of this size.
    fn part(&self, [width, height]: [u32; 2]) -> Tile {
        let all = Tile { x0: 0, y0: 0, x1: width, y1: height };
        self.window.map_or(all, |part| Tile {
            x0: part.x0.min(width),
            y0: part.y0.min(height),
            x1: part.x1.clamp(part.x0.min(width), width),
            y1: part.y1.clamp(part.y0.min(height), height),
        })
    }
}

/// Lines on a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The part of the picture that is drawn, in pixels. Lines may reach a little beyond.
    pub part: Tile,
    /// The lines.
    pub lines: Vec<Line>,
    /// How many rays were cast.
    pub rays: u64,
}

/// Rays along the longer edge of a picture at least, as far as [`MOST_RAYS`] allows.
const ROW: u32 = 1280;
/// Rays along the edge of a pixel, if nobody asks for more.
const MOST_RAYS: u32 = 8;
/// A fold is followed while it is at least this share as sharp as it must be to be drawn.
const FADING: f32 = 0.75;

/// Draws what the camera of a scene sees; `None` if `cancel` was set meanwhile.
///
/// # Errors
/// If the system gives no threads.
pub fn draw(
    scene: &Scene,
    machine: &Machine,
    progress: &dyn Progress,
    cancel: &AtomicBool,
) -> Result<Option<Drawing>, rayon::ThreadPoolBuildError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(machine.threads.max(1)).build()?;
    Ok(pool.install(|| draw_here(scene, machine, progress, cancel)))
}

fn draw_here(
    scene: &Scene,
    machine: &Machine,
    progress: &dyn Progress,
    cancel: &AtomicBool,
) -> Option<Drawing> {
    let part = machine.part([scene.view.width, scene.view.height]);
    let eye = Eye::new(scene);
    let crease = line::radians(machine.crease) as f32;
    let searcher = Searcher { eye: &eye, judge: Judge { crease: FADING * crease } };
    let grid = Grid::new(part, machine.rays.max(1));
    let lattice = Lattice::cast(&eye, grid, progress, cancel)?;
    let crossed = lattice.crossed(&searcher, progress, cancel)?;
    let net = Net::follow(&searcher, &lattice, crossed, cancel)?;
    let pen = line::Pen { tolerance: machine.tolerance, crease };
    let trails = trail::trails(&Strands::of(&net));
    let lines = trails.iter().filter_map(|trail| pen.line(trail)).collect();
    Some(Drawing { part, lines, rays: eye.rays() })
}
