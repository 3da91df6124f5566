//! Flakes that mirror, whose normals are spread as those of an ellipsoid (Heitz, Dupuy, Crassin and Dachsbacher 2015, "The
//! SGGX Microflake Distribution"): fibres, cloth, surfaces that are rendered as volumes.
//!
//! The flakes that are seen along unit direction `w` cover `sigma(w) = sqrt(w^T S w)`; of their normals `m` there are
//! `D(m) = 1 / (pi sqrt(det S) (m^T S^-1 m)^2)`, and light goes from `w` on to `v` with the density `D(h) / (4 sigma(w))` for
//! `h` halfway between `-w` and `v`. With `S = B B^T` the ellipsoid is a sphere whose normals `x` became `B x`. Areas on a plane
//! keep their proportions, so that the normals that are seen are those of the sphere, which are drawn by the cosine.
//!
//! How much is met does not change with the direction, as in Mitsuba 3: light that goes the other way is sent by another
//! density, see [`super::Phase::skew`].
use std::{
    f64::consts::PI,
    ops::{Add, Mul},
};

use durer_core::{
    glam::{DMat3, DVec3},
    math::{Frame, Normal3, Point2, Point3, Transform, Vector3},
    sampling::cosine_hemisphere,
};

use super::{super::grid::Grid, Turn, turned};

/// `S`, along the axes of world space: xx, yy, zz, xy, xz, yz.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread([f32; 6]);

impl Add for Spread {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Mul<f32> for Spread {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        Self(self.0.map(|v| v * factor))
    }
}

impl Spread {
    /// Flakes flatter than this are too sharp to be told from mirrors: the least `det S` for a mean of 1 on the diagonal.
    const FLATTEST: f64 = 1e-10;

    /// `B`, lower triangular (Cholesky); `None` if no ellipsoid has this `S`.
    fn root(self) -> Option<DMat3> {
        let [xx, yy, zz, xy, xz, yz] = self.0.map(f64::from);
        let size = (xx + yy + zz) / 3.0;
        let a = xx.sqrt();
        let (b, c) = (xy / a, xz / a);
        let d = (yy - b * b).sqrt();
        let e = (yz - b * c) / d;
        let f = (zz - c * c - e * e).sqrt();
        let root = DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(0.0, d, e), DVec3::new(0.0, 0.0, f));
        let flatness = (a * d * f / (size * size.sqrt())).powi(2);
        (root.is_finite() && flatness > Self::FLATTEST).then_some(root)
    }
}

/// Their phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Flakes {
    spread: Grid<Spread>,
    cube_from_render: Transform,
    /// Mean cosine of the deflection, over all directions, by the mean of the grid.
    mean_cos: f32,
}

fn wide(v: Vector3) -> DVec3 {
    DVec3::from(v.to_array().map(f64::from))
}

fn narrow(v: DVec3) -> Vector3 {
    Vector3::new(v.x as f32, v.y as f32, v.z as f32)
}

/// The direction that the light of unit direction `from` is drawn to.
fn mirrored(root: &DMat3, from: Vector3, u: Point2) -> Vector3 {
    let seen = narrow((root.transpose() * -wide(from)).normalize());
    let x = Frame::from_z(Normal3::from(seen)).to_world(cosine_hemisphere(u));
    let m = (*root * wide(x)).normalize();
    let w = wide(from);
    narrow((w - m * (2.0 * w.dot(m))).normalize())
}

impl Flakes {
    /// From six numbers for each place of a grid over the unit cube, x fastest, or for all places.
    ///
    /// # Errors
    /// What is wrong with them.
    pub(super) fn new(size: [usize; 3], values: &[f32]) -> Result<Self, String> {
        let places: Vec<Spread> = values.as_chunks::<6>().0.iter().map(|v| Spread(*v)).collect();
        if let Some(bad) = places.iter().position(|place| place.root().is_none()) {
            return Err(format!(
                "numbers {} to {} are no ellipsoid: expected xx, yy, zz, xy, xz, yz of a positive definite matrix",
                6 * bad,
                6 * bad + 5
            ));
        }
        let size = if places.len() == 1 { [1; 3] } else { size };
        let count = values.len();
        let mean = places.iter().fold(Spread::default(), |sum, v| sum + *v * (1.0 / places.len() as f32));
        let whole = count.is_multiple_of(6).then(|| Grid::new(size, places)).flatten();
        let [nx, ny, nz] = size;
        let spread =
            whole.ok_or(format!("{count} numbers, expected six for each of {nx} x {ny} x {nz} places"))?;
        let mean_cos = mean.root().map_or(0.0, |root| mean_cos(&root));
        Ok(Self { spread: spread.clamped(true), cube_from_render: Transform::IDENTITY, mean_cos })
    }
    pub(super) fn place(&mut self, cube_from_render: &Transform) {
        self.cube_from_render = *cube_from_render;
    }
    /// Whether they are the same everywhere.
    pub(super) fn is_even(&self) -> bool {
        self.spread.values().len() == 1
    }
    pub(super) fn mean_cos(&self) -> f32 {
        self.mean_cos
    }
    fn root(&self, p: Point3) -> DMat3 {
        let spread = match self.spread.values() {
            [one] => *one,
            _ => self.spread.at(self.cube_from_render.point(p).to_array()),
        };
        // What is mixed of ellipsoids is one; rounding cannot undo that.
        spread.root().unwrap_or(DMat3::IDENTITY)
    }
    /// Density of this turn, 1/sr.
    pub(super) fn density(&self, turn: &Turn) -> f32 {
        let root = self.root(turn.p);
        let way = wide(turn.to) - wide(turn.from);
        // Straight on light grazes flakes: any of those that stand along it.
        let h = way.try_normalize().unwrap_or_else(|| wide(turn.from).any_orthonormal_vector());
        let stretched = (root.inverse() * h).length_squared();
        let seen = (root.transpose() * wide(turn.from)).length();
        (1.0 / (4.0 * PI * root.determinant() * stretched * stretched * seen)) as f32
    }
    /// A unit direction after unit direction `from`, at a point of the unit square.
    pub(super) fn deflected(&self, (p, from): (Point3, Vector3), u: Point2) -> Vector3 {
        mirrored(&self.root(p), from, u)
    }
}

/// Over all directions from which light comes, at points of Roberts' sequence in four dimensions ("The Unreasonable
/// Effectiveness of Quasirandom Sequences", 2018).
fn mean_cos(root: &DMat3) -> f32 {
    const POINTS: u32 = 1 << 15;
    const STEPS: [f64; 4] =
        [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_038_009, 0.538_597_257_226_120_4];
    let mut sum = 0.0;
    for i in 0..POINTS {
        let [z, around, u, v] = STEPS.map(|step| (0.5 + step * f64::from(i)).fract() as f32);
        let from = turned(Vector3::new(0.0, 0.0, 1.0), 2.0 * z - 1.0, around);
        sum += f64::from(mirrored(root, from, Point2::new(u, v)).dot(from));
    }
    (sum / f64::from(POINTS)) as f32
}
