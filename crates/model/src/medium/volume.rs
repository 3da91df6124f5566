//! What floats at a place and scatters, absorbs or glows, of any kind.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Point3, Ray, Transform},
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::Voxels;

use super::{
    HenyeyGreenstein, Phase,
    cloud::Wisps,
    glow::Glow,
    grid::{Grid, between},
    majorant::{Majorants, Steps},
    matter::Matter,
    rgbgrid::Colored,
};

/// How much stuff is where.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Field {
    /// The same everywhere, without bounds.
    Even(Matter),
    /// The same stuff in a box, as dense as a grid says.
    Dense(Matter, Grid<f32>),
    /// The same, with most of the grid left out.
    Sparse(Matter, Voxels),
    /// The same as dense as noise makes it.
    Wisps(Matter, Wisps),
    /// Stuff in a box that a grid says all of.
    Colored(Colored),
}

/// A volume, in render space once placed.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    field: Field,
    glow: Glow,
    phase: Phase,
    /// Bounds on the density, in the unit cube that the box becomes.
    majorants: Majorants,
    /// The box, in the medium's own space.
    medium_from_cube: DAffine3,
    cube_from_render: Transform,
    render_from_cube: Transform,
}

/// What there is at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Local {
    /// Absorption and scattering coefficient, 1/m.
    pub(super) sigma_a: Spectrum,
    pub(super) sigma_s: Spectrum,
    /// Radiance that is added on the way, per metre.
    pub(super) added: Spectrum,
}

impl Volume {
    pub(super) fn new(field: Field, glow: Glow, phase: Phase) -> Self {
        let majorants = match &field {
            Field::Even(_) | Field::Wisps(..) => Majorants::even(1.0),
            Field::Sparse(_, voxels) => Majorants::new(voxels.size, |span| voxels.most_in(span)),
            Field::Dense(_, grid) => Majorants::new(grid.size(), |span| grid.most_in(span, |v| *v)),
            Field::Colored(colored) => Majorants::new(colored.size(), |span| colored.most_in(span)),
        };
        Self {
            field,
            glow,
            phase,
            majorants,
            medium_from_cube: DAffine3::IDENTITY,
            cube_from_render: Transform::IDENTITY,
            render_from_cube: Transform::IDENTITY,
        }
    }

    /// One that is not there.
    pub fn nothing() -> Self {
        let matter = Matter { sigma_a: Color::BLACK, sigma_s: Color::BLACK };
        Self::new(Field::Even(matter), Glow::DARK, Phase::HenyeyGreenstein(HenyeyGreenstein::new(0.0)))
    }

    /// In the box with these corners.
    pub(super) fn within(self, [low, high]: [[f32; 3]; 2]) -> Self {
        let [low, high] = [low, high].map(|p| DVec3::from(p.map(f64::from)));
        let medium_from_cube = DAffine3::from_translation(low) * DAffine3::from_scale(high - low);
        Self { medium_from_cube, ..self }
    }

    /// In the box that the unit cube becomes.
    pub(super) fn at_place(self, medium_from_cube: DAffine3) -> Self {
        Self { medium_from_cube, ..self }
    }

    /// Moves the volume from its own space into render space; false if that flattens it.
    #[must_use]
    pub fn place(&mut self, render_from_medium: &DAffine3) -> bool {
        self.render_from_cube = Transform::from_f64(&(*render_from_medium * self.medium_from_cube));
        self.cube_from_render = self.render_from_cube.inverse();
        self.phase.place(&self.cube_from_render);
        self.is_even() && self.phase.is_even() || self.render_from_cube.is_invertible()
    }

    /// How it scatters.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }
    /// True if it scatters anywhere.
    pub fn scatters(&self) -> bool {
        match &self.field {
            Field::Even(matter)
            | Field::Dense(matter, _)
            | Field::Sparse(matter, _)
            | Field::Wisps(matter, _) => matter.scatters(),
            Field::Colored(colored) => colored.scatters(),
        }
    }
    /// True if it is the same everywhere.
    pub fn is_even(&self) -> bool {
        matches!(self.field, Field::Even(_))
    }
    /// Absorption and scattering coefficient at a point of render space, 1/m.
    pub fn coefficients(&self, basis: Basis, p: Point3) -> (Spectrum, Spectrum) {
        let local = self.at(basis, p);
        (local.sigma_a, local.sigma_s)
    }

    /// At a point of render space.
    pub(super) fn at(&self, basis: Basis, p: Point3) -> Local {
        let p = match self.is_even() {
            true => [0.5; 3],
            false => self.cube_from_render.point(p).to_array(),
        };
        let of = |matter: &Matter, density: f32| {
            let (sigma_a, sigma_s) = (basis.unbounded(matter.sigma_a), basis.unbounded(matter.sigma_s));
            (sigma_a * density, sigma_s * density)
        };
        let (sigma_a, sigma_s) = match &self.field {
            Field::Even(matter) => of(matter, 1.0),
            Field::Dense(matter, grid) => of(matter, grid.at(p).max(0.0)),
            Field::Sparse(matter, voxels) => of(matter, between(voxels.size, p, |index| voxels.value(index))),
            Field::Wisps(matter, wisps) => of(matter, wisps.at(p)),
            Field::Colored(colored) => of(&colored.at(p), 1.0),
        };
        Local { sigma_a, sigma_s, added: sigma_a * self.glow.at(basis, p) }
    }

    /// True if it sends out nothing.
    pub fn is_dark(&self) -> bool {
        self.glow.is_dark()
    }

    /// What of the ray from `t0` to `t1` is in the box, in steps with a bound on the density of each. No lane of absorption
    /// and scattering together is larger than that times [`Volume::most`].
    pub(super) fn steps(&self, ray: &Ray, span: (f32, f32)) -> Steps<'_> {
        let (o, d) = (self.cube_from_render.point(ray.o), self.cube_from_render.vector(ray.d));
        self.majorants.steps((o.to_array(), d.to_array()), span)
    }
    /// The cells of [`Volume::steps`].
    pub(super) fn majorants(&self) -> &Majorants {
        &self.majorants
    }
    /// Where the unit cube of the cells lies.
    pub(super) fn render_from_cube(&self) -> &Transform {
        &self.render_from_cube
    }
    /// The cell of a point of render space; `None` outside the box.
    pub(super) fn cell(&self, p: Point3) -> Option<usize> {
        self.majorants.cell(self.cube_from_render.point(p).to_array())
    }
    /// The bound on absorption and scattering together at a point of render space, 1/m.
    pub(super) fn bound(&self, basis: Basis, p: Point3) -> f32 {
        self.cell(p).map_or(0.0, |cell| self.most(basis) * self.majorants.bound(cell))
    }
    /// See [`Volume::steps`].
    pub(super) fn most(&self, basis: Basis) -> f32 {
        match &self.field {
            Field::Even(matter)
            | Field::Dense(matter, _)
            | Field::Sparse(matter, _)
            | Field::Wisps(matter, _) => {
                (basis.unbounded(matter.sigma_a) + basis.unbounded(matter.sigma_s)).max()
            }
            Field::Colored(_) => basis.headroom(),
        }
    }
}
