//! The tables of a measured material, out of a tensor file.
use std::f32::consts::PI;

use durer_core::{
    math::{
        Point2, Vector3,
        float::{cos, sin, sqr},
    },
    sampling::{Axes, Blend, Lattice, PiecewiseLinear2D, between, rises},
    spectrum::{Basis, Color, Spectrum, share_weights},
};
use durer_scene::{Tensor, TensorType, Tensors};

use super::Measured;

/// Cosines that the share of light reflected is known for.
const COSINES: usize = 16;
/// Directions of each, along an edge, that it is the mean of.
const DIRECTIONS: usize = 12;

/// What was measured.
#[derive(Clone, PartialEq)]
pub struct Measurement {
    description: String,
    /// Azimuth, then elevation of the direction seen from, in radians.
    axes: Axes,
    pub(super) is_isotropic: bool,
    /// 1, or of how many like parts the measurement holds one: 2 or 4.
    pub(super) parts: u32,
    /// What is stored has to be multiplied by densities of normals.
    is_divided: bool,
    ndf: Lattice,
    sigma: Lattice,
    pub(super) vndf: PiecewiseLinear2D,
    pub(super) luminance: PiecewiseLinear2D,
    /// Red, green and blue.
    rgb: Lattice,
    /// Wavelengths in nm that rise, and a layer for each.
    spectra: Option<(Vec<f32>, Lattice)>,
    /// Share of the light of a uniform sky that leaves, by the cosine.
    albedo: Vec<Color>,
    /// Width of GGX facets with as high a peak.
    pub(super) alpha: f32,
    /// Numbers that were no numbers, for which 0 is taken.
    damaged: usize,
}

impl std::fmt::Debug for Measurement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Measurement({:?}, {} directions)", self.description, self.axes.pairs())
    }
}

/// What a field must be: its name, type, and the sizes along its axes, of which `None` may be any.
struct Wanted<'a>(&'a str, TensorType, &'a [Option<usize>]);

fn field<'t>(tensors: &'t Tensors, Wanted(name, ty, shape): Wanted<'_>) -> Result<&'t Tensor, String> {
    let Some(tensor) = tensors.get(name) else {
        let names: Vec<&str> = tensors.fields().map(|(name, _)| name).collect();
        let has = if names.is_empty() { "nothing".to_owned() } else { durer_scene::listed(&names) };
        return Err(format!("it has no field \"{name}\", as measured materials do; it has: {has}"));
    };
    let is_like = tensor.shape.len() == shape.len()
        && tensor.shape.iter().zip(shape).all(|(n, wanted)| wanted.is_none_or(|w| w == *n) && *n > 0);
    if tensor.ty != ty || !is_like {
        let shown: Vec<String> =
            shape.iter().map(|n| n.map_or("any".to_owned(), |n| n.to_string())).collect();
        let (found, what) = (&tensor.shape, if ty == TensorType::U8 { "bytes" } else { "single floats" });
        let other = if tensor.ty == ty { "" } else { " of other numbers" };
        return Err(format!(
            "\"{name}\" is {found:?}{other}, expected {what} of the shape [{}]",
            shown.join(", ")
        ));
    }
    Ok(tensor)
}

/// The numbers of a field, which must be finite and not negative.
fn amounts(tensors: &Tensors, name: &str, tensor: &Tensor) -> Result<Vec<f32>, String> {
    let all: Vec<f32> = tensors.floats(tensor).collect();
    match all.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
        Some(i) => Err(format!("\"{name}\" holds {} at place {i}, expected numbers from 0 on", all[i])),
        None => Ok(all),
    }
}

impl Measurement {
    /// From a file of the database of Dupuy and Jakob, or of its shape.
    ///
    /// # Errors
    /// What is missing in the file, or wrong with it.
    pub fn new(tensors: &Tensors) -> Result<Self, String> {
        use TensorType::{F32, U8};
        let get = |name: &str, ty, shape: &[Option<usize>]| field(tensors, Wanted(name, ty, shape));
        let list = |name: &str| {
            let tensor = get(name, F32, &[None])?;
            Ok::<Vec<f32>, String>(tensors.floats(tensor).collect())
        };
        let (phi, theta) = (list("phi_i")?, list("theta_i")?);
        let (phis, thetas) = (Some(phi.len()), Some(theta.len()));
        let description = tensors.bytes(get("description", U8, &[None])?);
        let jacobian = tensors.bytes(get("jacobian", U8, &[Some(1)])?);
        let is_isotropic = phi.len() <= 2;
        let parts = if is_isotropic { 1 } else { parts(&phi)? };
        let axes =
            Axes::new([phi, theta]).ok_or("\"phi_i\" or \"theta_i\" holds numbers that do not rise")?;

        let flat = |name: &str| {
            let tensor = get(name, F32, &[None, None])?;
            let size = [tensor.shape[1], tensor.shape[0]];
            Lattice::new(size, 1, amounts(tensors, name, tensor)?)
                .ok_or_else(|| format!("\"{name}\" is empty"))
        };
        let warp = |name: &str, tensor: &Tensor| {
            let size = [tensor.shape[3], tensor.shape[2]];
            PiecewiseLinear2D::new(size, amounts(tensors, name, tensor)?).map_err(|number| {
                let [phi, theta] = axes.pair(number);
                let seen = format!("azimuth {:.1} and elevation {:.1} degrees", phi.to_degrees(), theta.to_degrees());
                format!("\"{name}\", seen from {seen}, is no density: of less than 2 by 2 numbers, or 0 everywhere")
            })
        };
        let vndf = warp("vndf", get("vndf", F32, &[phis, thetas, None, None])?)?;
        let of_luminance = get("luminance", F32, &[phis, thetas, None, None])?;
        let luminance = warp("luminance", of_luminance)?;
        let (height, width) = (of_luminance.shape[2], of_luminance.shape[3]);
        let colors = |name: &str, layers: usize| {
            let tensor = get(name, F32, &[phis, thetas, Some(layers), Some(height), Some(width)])?;
            let all = tensors.floats(tensor);
            let mut damaged = 0;
            let values: Vec<f32> = all
                .map(|v| {
                    if v.is_finite() {
                        v
                    } else {
                        damaged += 1;
                        0.0
                    }
                })
                .collect();
            Ok::<_, String>((values, damaged))
        };
        let lattice = |layers: usize, values: Vec<f32>| {
            Lattice::new([width, height], layers, values).ok_or("its colours are empty")
        };
        let (rgb, spectra, damaged) = match tensors.get("wavelengths") {
            Some(_) => {
                let nm = list("wavelengths")?;
                if !rises(&nm) {
                    return Err("\"wavelengths\" holds numbers that do not rise".to_owned());
                }
                let (values, damaged) = colors("spectra", nm.len())?;
                let rgb = lattice(3, as_rgb(&values, &share_weights(&nm), width * height))?;
                let spectra = lattice(nm.len(), values)?;
                (rgb, Some((nm, spectra)), damaged)
            }
            None => {
                let (values, damaged) = colors("rgb", 3)?;
                (lattice(3, values)?, None, damaged)
            }
        };
        let mut all = Self {
            description: String::from_utf8_lossy(description).trim_end_matches('\0').to_owned(),
            axes,
            is_isotropic,
            parts,
            is_divided: jacobian != [0],
            ndf: flat("ndf")?,
            sigma: flat("sigma")?,
            vndf,
            luminance,
            rgb,
            spectra,
            albedo: vec![Color::BLACK; COSINES],
            alpha: 1.0,
            damaged,
        };
        all.albedo = (0..COSINES).map(|i| all.reflected(i as f32 / (COSINES - 1) as f32)).collect();
        all.alpha = all.width();
        Ok(all)
    }

    /// Heap memory of the tables, in bytes.
    pub fn bytes(&self) -> u64 {
        let lattices =
            [Some(&self.ndf), Some(&self.sigma), Some(&self.rgb), self.spectra.as_ref().map(|(_, l)| l)];
        let flat: u64 = lattices.into_iter().flatten().map(Lattice::bytes).sum();
        flat + self.vndf.bytes() + self.luminance.bytes()
    }
    /// Numbers among the colours that are none; 0 is taken for them.
    pub fn damaged(&self) -> usize {
        self.damaged
    }
    /// The tables around a direction that it is seen from, and how much of the facets is seen from there.
    pub(super) fn seen(&self, phi: f32, theta: f32) -> (Blend, f32) {
        let at = self.sigma.place(unit(phi, theta));
        (self.axes.blend([phi, theta]), self.sigma.at(&Blend::ONE, 0, &at))
    }
    /// What is stored at `u`, a share of light under the normal at `m`, as value times cosine; all in unit squares.
    pub(super) fn value(
        &self,
        basis: &Basis,
        (blend, sigma): &(Blend, f32),
        [u, m]: [Point2; 2],
    ) -> Spectrum {
        let by_normal = || {
            let density = self.ndf.at(&Blend::ONE, 0, &self.ndf.place(m));
            if *sigma > 0.0 { density / (4.0 * sigma) } else { 0.0 }
        };
        let factor = if self.is_divided { by_normal() } else { 1.0 };
        let color = match (&self.spectra, basis) {
            (Some((nm, layers)), Basis::Spectral(wavelengths)) => {
                let place = layers.place(u);
                wavelengths.map(Spectrum::BLACK, |at, _| {
                    let (low, t) = between(nm, at);
                    let high = (low + 1).min(nm.len() - 1);
                    let value = layers.at(blend, low, &place) * (1.0 - t);
                    let value = if t > 0.0 { value + layers.at(blend, high, &place) * t } else { value };
                    value.max(0.0)
                })
            }
            _ => {
                let place = self.rgb.place(u);
                let rgb = std::array::from_fn(|c| self.rgb.at(blend, c, &place).max(0.0));
                basis.unbounded(Color { rgb })
            }
        };
        color * factor
    }

    /// Share of the light of a uniform sky that leaves towards a cosine.
    pub(super) fn albedo(&self, cos: f32) -> Color {
        let x = cos.clamp(0.0, 1.0) * (COSINES - 1) as f32;
        let low = (x as usize).min(COSINES - 2);
        self.albedo[low] * (1.0 - (x - low as f32)) + self.albedo[low + 1] * (x - low as f32)
    }
    /// The same, measured.
    fn reflected(&self, cos: f32) -> Color {
        let lobe = Measured::new(self, Basis::Rgb, Vector3::new(1.0, 0.0, 0.0));
        // Straight along the surface nothing is seen.
        let cos = cos.max(0.02);
        let sin = (1.0 - sqr(cos)).sqrt();
        let azimuths: &[f32] = if self.is_isotropic { &[0.0] } else { &[0.4, 1.97, 3.54, 5.11] };
        let mut sum = Color::BLACK;
        for phi in azimuths {
            let wo = Vector3::new(sin * self::cos(*phi), sin * self::sin(*phi), cos);
            for i in 0..DIRECTIONS * DIRECTIONS {
                let at = |i: usize| (i as f32 + 0.5) / DIRECTIONS as f32;
                if let Some(drawn) = lobe.draw(wo, Point2::new(at(i % DIRECTIONS), at(i / DIRECTIONS))) {
                    sum = sum + Color { rgb: Basis::Rgb.to_rgb(drawn.branch.weight) };
                }
            }
        }
        sum * (1.0 / (azimuths.len() * DIRECTIONS * DIRECTIONS) as f32)
    }
    /// Width of the GGX facets of which as many look straight up.
    fn width(&self) -> f32 {
        const STEPS: [usize; 2] = [128, 16];
        let at = |u: f32, v: f32| self.ndf.at(&Blend::ONE, 0, &self.ndf.place(Point2::new(u, v)));
        let middle = |i: usize, steps: usize| (i as f32 + 0.5) / steps as f32;
        let (mut peak, mut all) = (0.0, 0.0);
        for j in 0..STEPS[1] {
            let v = middle(j, STEPS[1]);
            peak += at(0.0, v) / STEPS[1] as f32;
            for i in 0..STEPS[0] {
                let u = middle(i, STEPS[0]);
                let theta = sqr(u) * PI / 2.0;
                all += at(u, v) * cos(theta) * sin(theta) * 2.0 * sqr(PI) * u / (STEPS[0] * STEPS[1]) as f32;
            }
        }
        if peak > 0.0 && all > 0.0 { (all / (PI * peak)).sqrt().clamp(0.01, 1.0) } else { 1.0 }
    }
}

/// A direction in the unit square: more room for what is near the normal.
pub(super) fn unit(phi: f32, theta: f32) -> Point2 {
    let turns = (phi + PI) / (2.0 * PI);
    Point2::new((theta * 2.0 / PI).max(0.0).sqrt(), turns - turns.floor())
}

/// Of how many like parts of a turn these azimuths are one.
fn parts(phi: &[f32]) -> Result<u32, String> {
    let (first, last) = (phi[0], phi[phi.len() - 1]);
    let parts = (2.0 * PI / (last - first)).round();
    let begins = (first + PI).abs() < 0.5;
    match [1, 2, 4].into_iter().find(|n| *n as f32 == parts).filter(|_| begins) {
        Some(parts) => Ok(parts),
        None => Err(format!(
            "\"phi_i\" goes from {first} to {last}, expected a turn, half of it or a quarter from {} on",
            -PI
        )),
    }
}

/// Red, green and blue of layers of wavelengths that add this to them; `table` numbers of each.
fn as_rgb(values: &[f32], weights: &[[f32; 3]], table: usize) -> Vec<f32> {
    let mut all = Vec::with_capacity(values.len() / weights.len().max(1) * 3);
    for layers in values.chunks_exact((table * weights.len()).max(1)) {
        for c in 0..3 {
            let sum = |i: usize| {
                let sum = weights.iter().enumerate().map(|(layer, w)| w[c] * layers[layer * table + i]);
                sum.sum::<f32>()
            };
            all.extend((0..table).map(sum));
        }
    }
    all
}
