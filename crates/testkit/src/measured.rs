//! Tensor files of materials whose reflection is known, in the parameterisation of Dupuy and Jakob 2018: what a goniophotometer
//! would have found, written down as the RGL database does.
use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// A surface of which all is known.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// Density of facets by normal; their areas, projected, add up to 1.
    pub normals: &'a dyn Fn(DVec3) -> f64,
    /// Value without the cosine, seen from, lit from, at a wavelength in nm or in channel 0, 1 or 2.
    pub value: &'a dyn Fn(DVec3, DVec3, f64) -> f64,
}

/// Where it is measured.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Azimuths that it is seen from; one if it looks the same from all.
    pub azimuths: Vec<f64>,
    /// How many elevations it is seen from.
    pub elevations: usize,
    /// Normals along elevation and azimuth.
    pub normals: [usize; 2],
    /// Colours along an edge, for each direction seen from.
    pub colours: usize,
    /// Wavelengths in nm; none for red, green and blue.
    pub wavelengths: Vec<f64>,
}

/// An array.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Numbers along each axis.
    pub shape: Vec<usize>,
    /// The numbers.
    pub numbers: Numbers,
}

/// Numbers of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Bytes.
    Bytes(Vec<u8>),
    /// Single precision.
    Floats(Vec<f32>),
}

impl Field {
    fn floats(name: &'static str, shape: &[usize], values: impl IntoIterator<Item = f64>) -> Self {
        let numbers = Numbers::Floats(values.into_iter().map(|v| v as f32).collect());
        Self { name, shape: shape.to_vec(), numbers }
    }
    fn bytes(name: &'static str, bytes: &[u8]) -> Self {
        Self { name, shape: vec![bytes.len()], numbers: Numbers::Bytes(bytes.to_vec()) }
    }
    /// Its numbers as bytes.
    pub fn packed(&self) -> Vec<u8> {
        match &self.numbers {
            Numbers::Bytes(bytes) => bytes.clone(),
            Numbers::Floats(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        }
    }
}

/// GGX facets of two widths, along x and y, with height-correlated shadowing (Heitz 2014, equations 71, 72 and 99).
#[derive(Clone, Copy, Debug)]
pub struct Brushed(pub f64, pub f64);

impl Brushed {
    /// Density of normals.
    pub fn normals(self, m: DVec3) -> f64 {
        let q = (m.x / self.0).powi(2) + (m.y / self.1).powi(2) + m.z * m.z;
        1.0 / (PI * self.0 * self.1 * q * q)
    }
    fn lambda(self, w: DVec3) -> f64 {
        let slopes = (self.0 * w.x).powi(2) + (self.1 * w.y).powi(2);
        ((1.0 + slopes / (w.z * w.z)).sqrt() - 1.0) / 2.0
    }
    /// Value without the cosine, of facets that reflect all light.
    pub fn value(self, wo: DVec3, wi: DVec3) -> f64 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let shadowing = 1.0 / (1.0 + self.lambda(wo) + self.lambda(wi));
        self.normals((wo + wi).normalize()) * shadowing / (4.0 * wo.z * wi.z)
    }
}

/// The direction at a point of the unit square.
fn direction(u: f64, v: f64) -> DVec3 {
    let (theta, phi) = (u * u * PI / 2.0, (2.0 * v - 1.0) * PI);
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// Solid angle by area of the unit square there.
fn stretch(u: f64) -> f64 {
    2.0 * PI * PI * u * (u * u * PI / 2.0).sin()
}

fn seen_from(phi: f64, theta: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// `count` numbers from 0 to 1.
fn steps(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |i| i as f64 / (count - 1) as f64)
}

/// The integral of straight lines between values up to `x`, in steps.
fn upto(values: &[f64], x: f64) -> f64 {
    let whole = (x as usize).min(values.len() - 2);
    let sum: f64 = values[..=whole].windows(2).map(|w| 0.5 * (w[0] + w[1])).sum();
    let t = x - whole as f64;
    sum + t * (values[whole] + 0.5 * t * (values[whole + 1] - values[whole]))
}

/// Where the integral up to there is the share `u` of all, in steps; by halving.
fn reached(values: &[f64], u: f64) -> f64 {
    let all = (values.len() - 1) as f64;
    let wanted = u * upto(values, all);
    let (mut low, mut high) = (0.0, all);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if upto(values, middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The point of the unit square that `(u, v)` is drawn to through a bilinear table.
fn drawn(table: &[f64], width: usize, (u, v): (f64, f64)) -> (f64, f64) {
    let rows: Vec<&[f64]> = table.chunks_exact(width).collect();
    let last = (width - 1) as f64;
    let totals: Vec<f64> = rows.iter().map(|row| upto(row, last)).collect();
    let y = reached(&totals, v);
    let below = (y as usize).min(rows.len() - 2);
    let t = y - below as f64;
    let between: Vec<f64> =
        rows[below].iter().zip(rows[below + 1]).map(|(a, b)| a * (1.0 - t) + b * t).collect();
    (reached(&between, u) / last, y / (rows.len() - 1) as f64)
}

/// The projected area of the facets that are seen.
fn sigma(known: Known<'_>, wo: DVec3) -> f64 {
    const STEPS: [usize; 2] = [160, 96];
    let middle = |i: usize, steps: usize| (i as f64 + 0.5) / steps as f64;
    let mut sum = 0.0;
    for i in 0..STEPS[0] {
        let u = middle(i, STEPS[0]);
        for j in 0..STEPS[1] {
            let m = direction(u, middle(j, STEPS[1]));
            sum += (known.normals)(m) * m.dot(wo).max(0.0) * stretch(u);
        }
    }
    sum / (STEPS[0] * STEPS[1]) as f64
}

/// The fields of the file of a known surface.
pub fn fields(known: Known<'_>, grid: &Grid) -> Vec<Field> {
    let [width, height] = grid.normals;
    let colours = grid.colours;
    let elevations: Vec<f64> = steps(grid.elevations).map(|t| t * 1.54).collect();
    let wavelengths = match grid.wavelengths.is_empty() {
        true => vec![0.0, 1.0, 2.0],
        false => grid.wavelengths.clone(),
    };
    // What looks the same from everywhere is measured by azimuths from that of the eye.
    let around = if grid.azimuths.len() > 1 { 33 } else { 2 };
    let ndf = steps(height).flat_map(|v| steps(width).map(move |u| (known.normals)(direction(u, v))));
    let sigmas = steps(around).flat_map(|v| steps(65).map(move |u| sigma(known, direction(u, v))));
    let (mut vndf, mut luminance, mut spectra) = (Vec::new(), Vec::new(), Vec::new());
    for phi in &grid.azimuths {
        for theta in &elevations {
            let wo = seen_from(*phi, *theta);
            let visible = |u: f64, v: f64| {
                let m = direction(u, v);
                (known.normals)(m) * m.dot(wo).max(0.0) * stretch(u)
            };
            let table: Vec<f64> = steps(height)
                .flat_map(|v| steps(width).map(move |u| (u, v)))
                .map(|(u, v)| visible(u, v))
                .collect();
            let area = sigma(known, wo);
            let normals: Vec<DVec3> = steps(colours)
                .flat_map(|v| steps(colours).map(move |u| (u, v)))
                .map(|place| drawn(&table, width, place))
                .map(|(u, v)| direction(u, v))
                .collect();
            let mut sums = vec![0.0; normals.len()];
            for nm in &wavelengths {
                for (m, sum) in normals.iter().zip(&mut sums) {
                    let wi = 2.0 * m.dot(wo) * *m - wo;
                    let value = match wi.z > 0.0 {
                        true => (known.value)(wo, wi, *nm) * wi.z * 4.0 * area / (known.normals)(*m),
                        false => 0.0,
                    };
                    spectra.push(value);
                    *sum += value;
                }
            }
            vndf.extend(table);
            luminance.extend(sums);
        }
    }
    let (phis, thetas) = (grid.azimuths.len(), elevations.len());
    let mut all = vec![
        Field::bytes("description", b"made of a formula"),
        Field::bytes("jacobian", &[1]),
        Field::floats("theta_i", &[thetas], elevations),
        Field::floats("phi_i", &[phis], grid.azimuths.iter().copied()),
        Field::floats("ndf", &[height, width], ndf),
        Field::floats("sigma", &[around, 65], sigmas),
        Field::floats("vndf", &[phis, thetas, height, width], vndf),
        Field::floats("luminance", &[phis, thetas, colours, colours], luminance),
    ];
    let shape = [phis, thetas, wavelengths.len(), colours, colours];
    if grid.wavelengths.is_empty() {
        all.push(Field::floats("rgb", &shape, spectra));
    } else {
        all.push(Field::floats("spectra", &shape, spectra));
        all.push(Field::floats("wavelengths", &[wavelengths.len()], wavelengths));
    }
    all
}

/// A small file: grey and matte, of red, green and blue, seen from one azimuth.
pub fn paint() -> Vec<u8> {
    let known = Known { normals: &|_| 1.0 / PI, value: &|_, _, _| 0.5 / PI };
    file(&fields(known, &Grid { azimuths: vec![0.0], ..SMALL }))
}

/// The same by wavelengths, seen from a turn of azimuths: for what reads files, not for pictures.
pub fn brushed_paint() -> Vec<u8> {
    let known = Known { normals: &|m| Brushed(0.6, 0.4).normals(m), value: &|_, _, nm| nm / 1000.0 / PI };
    let wavelengths = vec![400.0, 500.0, 700.0];
    file(&fields(known, &Grid { azimuths: azimuths(5, 1.0), wavelengths, ..SMALL }))
}

const SMALL: Grid =
    Grid { azimuths: Vec::new(), elevations: 3, normals: [5, 5], colours: 4, wavelengths: Vec::new() };

/// `count` azimuths over one of so many parts of a turn.
pub fn azimuths(count: usize, parts: f64) -> Vec<f64> {
    steps(count).map(|t| -PI + t * TAU / parts).collect()
}

/// The file of some fields.
pub fn file(fields: &[Field]) -> Vec<u8> {
    let mut head = [&b"tensor_file\0\x01\0"[..], &(fields.len() as u32).to_le_bytes()].concat();
    let told = |field: &Field| 2 + field.name.len() + 2 + 1 + 8 + 8 * field.shape.len();
    let mut at = head.len() + fields.iter().map(told).sum::<usize>();
    let mut data = Vec::new();
    for field in fields {
        let ty = if matches!(field.numbers, Numbers::Bytes(_)) { 1 } else { 10 };
        head.extend((field.name.len() as u16).to_le_bytes());
        head.extend(field.name.as_bytes());
        head.extend((field.shape.len() as u16).to_le_bytes());
        head.push(ty);
        head.extend((at as u64).to_le_bytes());
        field.shape.iter().for_each(|n| head.extend((*n as u64).to_le_bytes()));
        let packed = field.packed();
        at += packed.len();
        data.extend(packed);
    }
    head.extend(data);
    head
}
