//! Metals as curves over wavelengths, and as what colours need of them.
//!
//! Index of refraction `eta` and extinction `k` as in Palik 1985, "Handbook of Optical Constants of Solids" (silver,
//! aluminium, gold, copper).
use super::{Color, Sampled, named::waves, sampled::share_of};

/// Wavelengths of the tables, nm.
#[rustfmt::skip]
const NM: [f32; 39] = [
    359.374, 364.659, 370.102, 375.71, 381.49, 387.451, 393.601, 399.949, 406.505, 413.281, 420.285,
    427.532, 435.032, 442.801, 450.852, 459.201, 467.865, 476.862, 486.212, 495.937, 506.058, 516.601,
    527.592, 539.062, 551.041, 563.564, 576.671, 590.401, 604.801, 619.921, 635.816, 652.548, 670.185,
    688.801, 708.481, 729.319, 751.419, 774.901, 799.898,
];

/// Name of a metal, its `eta` and its `k`.
type Metal = (&'static str, [f32; NM.len()], [f32; NM.len()]);

#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = "6.28 is an extinction here")]
const METALS: &[Metal] = &[
    ("metal-Ag", [
        0.194813, 0.186, 0.192063, 0.2, 0.198063, 0.192, 0.182, 0.173, 0.172625, 0.173, 0.166688, 0.16,
        0.1585, 0.157, 0.151063, 0.144, 0.137313, 0.132, 0.13025, 0.13, 0.129938, 0.13, 0.130063, 0.129,
        0.124375, 0.12, 0.119313, 0.121, 0.1255, 0.131, 0.136125, 0.14, 0.140063, 0.14, 0.144313, 0.148,
        0.145875, 0.143, 0.142563,
    ], [
        1.53375, 1.61, 1.64187, 1.67, 1.735, 1.81, 1.87875, 1.95, 2.02937, 2.11, 2.18625, 2.26, 2.32938,
        2.4, 2.47875, 2.56, 2.64, 2.72, 2.79813, 2.88, 2.97375, 3.07, 3.15937, 3.25, 3.34813, 3.45,
        3.55375, 3.66, 3.76625, 3.88, 4.01063, 4.15, 4.29312, 4.44, 4.58625, 4.74, 4.90813, 5.09, 5.28875,
    ]),
    ("metal-Al", [
        0.39575, 0.407, 0.419125, 0.432, 0.445688, 0.46, 0.474688, 0.49, 0.506188, 0.523, 0.540063, 0.558,
        0.577313, 0.598, 0.620313, 0.644, 0.668625, 0.695, 0.72375, 0.755, 0.789, 0.826, 0.867, 0.912,
        0.963, 1.02, 1.08, 1.15, 1.22, 1.3, 1.39, 1.49, 1.6, 1.74, 1.91, 2.14, 2.41, 2.63, 2.8,
    ], [
        4.365, 4.43, 4.49375, 4.56, 4.63375, 4.71, 4.78437, 4.86, 4.93813, 5.02, 5.10875, 5.2, 5.29, 5.38,
        5.48, 5.58, 5.69, 5.8, 5.915, 6.03, 6.15, 6.28, 6.42, 6.55, 6.7, 6.85, 7.0, 7.15, 7.31, 7.48, 7.65,
        7.82, 8.01, 8.21, 8.39, 8.57, 8.62, 8.6, 8.45,
    ]),
    ("metal-Au", [
        1.72762, 1.716, 1.70588, 1.696, 1.68475, 1.674, 1.666, 1.658, 1.64725, 1.636, 1.628, 1.616,
        1.59625, 1.562, 1.50212, 1.426, 1.34587, 1.242, 1.08675, 0.916, 0.7545, 0.608, 0.49175, 0.402,
        0.3455, 0.306, 0.267625, 0.236, 0.212375, 0.194, 0.17775, 0.166, 0.161, 0.16, 0.160875, 0.164,
        0.1695, 0.176, 0.181375,
    ], [
        1.85238, 1.862, 1.883, 1.906, 1.9225, 1.936, 1.94775, 1.956, 1.95938, 1.958, 1.95138, 1.94, 1.9245,
        1.904, 1.87587, 1.846, 1.81462, 1.796, 1.79737, 1.84, 1.9565, 2.12, 2.32625, 2.54, 2.73062, 2.88,
        2.94062, 2.97, 3.015, 3.06, 3.07, 3.15, 3.44581, 3.8, 4.08769, 4.357, 4.61019, 4.86, 5.12581,
    ]),
    ("metal-Cu", [
        1.28156, 1.27, 1.24906, 1.225, 1.2, 1.18, 1.17437, 1.175, 1.1775, 1.18, 1.17813, 1.175, 1.17281,
        1.17, 1.16531, 1.16, 1.15531, 1.15, 1.14281, 1.135, 1.13156, 1.12, 1.09244, 1.04, 0.950375, 0.826,
        0.645875, 0.468, 0.35125, 0.272, 0.230813, 0.214, 0.20925, 0.213, 0.21625, 0.223, 0.2365, 0.25,
        0.254188,
    ], [
        1.93169, 1.95, 1.97244, 2.015, 2.12156, 2.21, 2.17719, 2.13, 2.16006, 2.21, 2.24994, 2.289, 2.326,
        2.362, 2.39763, 2.433, 2.46919, 2.504, 2.53587, 2.564, 2.58962, 2.605, 2.59556, 2.583, 2.5765,
        2.599, 2.67806, 2.809, 3.01075, 3.24, 3.45819, 3.67, 3.86313, 4.05, 4.23956, 4.43, 4.61956, 4.817,
        5.03413,
    ]),
];

/// The curve called `name`, such as `metal-Au-k`, where it is known at more than the few wavelengths of
/// [`super::named()`]; of the others, straight lines between those.
pub fn curve(name: &str) -> Option<Sampled> {
    let of = |(metal, eta, k): &Metal| match name.strip_prefix(metal)? {
        "-eta" => Some(*eta),
        "-k" => Some(*k),
        _ => None,
    };
    let Some(values) = METALS.iter().find_map(of) else { return Sampled::new(&waves(name)?).ok() };
    let pairs: Vec<f32> = NM.iter().zip(values).flat_map(|(nm, v)| [*nm, v]).collect();
    Sampled::new(&pairs).ok()
}

/// Most that a metal is taken to reflect, so that its extinction stays finite.
const MOST: f32 = 0.9999;

/// Index and extinction of the three colours of a metal with these curves: `eta` is the mean of its curve as a share of
/// D65's light would be averaged, and `k` such that reflectance at normal incidence, seen from something of the index
/// `outside`, is that of the curves, integrated to linear Rec. 709. Both are divided by `outside`.
/// Where Rec. 709 does not hold the colour (gold's red would be 1.02) its components are brought into `[0, 1]`.
pub fn conductor(eta: &Sampled, k: &Sampled, outside: f32) -> (Color, Color) {
    let at = |curve: &Sampled, nm: f64| f64::from(curve.nearest(nm)) / f64::from(outside);
    let reflectance = share_of(|nm| normal(at(eta, nm), at(k, nm)));
    let mean = share_of(|nm| at(eta, nm));
    let lanes: [(f32, f32); 3] = std::array::from_fn(|i| lane(mean.rgb[i], reflectance.rgb[i]));
    (Color { rgb: lanes.map(|l| l.0) }, Color { rgb: lanes.map(|l| l.1) })
}

/// Reflectance at normal incidence of `eta + i k`.
fn normal(eta: f64, k: f64) -> f64 {
    ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k)
}

/// Index and extinction that reflect the share `r`, with this index if there is an extinction for it.
fn lane(eta: f32, r: f32) -> (f32, f32) {
    let r = r.clamp(0.0, MOST);
    let k2 = (r * (eta + 1.0) * (eta + 1.0) - (eta - 1.0) * (eta - 1.0)) / (1.0 - r);
    if eta > 0.0 && k2 >= 0.0 {
        return (eta, k2.sqrt());
    }
    ((1.0 + r.sqrt()) / (1.0 - r.sqrt()), 0.0)
}

/// Index and extinction of something that reflects this share of light at normal incidence: index 1 (pbrt-v4).
pub fn conductor_of(reflectance: Color) -> (Color, Color) {
    (Color::WHITE, reflectance.map(extinction))
}

/// Extinction of something of index 1 that reflects the share `r` of light at normal incidence.
pub fn extinction(r: f32) -> f32 {
    let r = r.clamp(0.0, MOST);
    2.0 * (r / (1.0 - r)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reflected((eta, k): (Color, Color)) -> [f64; 3] {
        std::array::from_fn(|i| normal(eta.rgb[i].into(), k.rgb[i].into()))
    }

    fn curves(metal: &str) -> [Sampled; 2] {
        ["eta", "k"].map(|what| curve(&format!("metal-{metal}-{what}")).expect("a metal"))
    }

    #[test]
    fn metals_reflect_what_their_curves_do() {
        for metal in ["Ag", "Al", "Au", "Cu", "CuZn", "TiO2"] {
            let [eta, k] = curves(metal);
            // Integrated by the public way: a curve of reflectances, read as a colour.
            let at = |nm: f32| normal(eta.nearest(nm.into()).into(), k.nearest(nm.into()).into()) as f32;
            let pairs: Vec<f32> = (360..=830).flat_map(|nm| [nm as f32, at(nm as f32)]).collect();
            let expected = Sampled::new(&pairs).expect("a spectrum").share();
            let got = reflected(conductor(&eta, &k, 1.0));
            for (got, expected) in got.iter().zip(expected.rgb) {
                // Gold reflects more red than Rec. 709 can say without exceeding 1.
                let expected = f64::from(expected.min(MOST));
                assert!((got - expected).abs() < 1e-4, "{metal}: {got:?} {expected:?}");
            }
        }
    }

    #[test]
    fn gold_is_yellow_copper_red_and_silver_white() {
        let colour = |metal: &str| {
            let [eta, k] = curves(metal);
            reflected(conductor(&eta, &k, 1.0))
        };
        let ([r, g, b], [cr, cg, cb]) = (colour("Au"), colour("Cu"));
        assert!(r > 0.95 && (0.65..0.85).contains(&g) && b < 0.5, "{r} {g} {b}");
        assert!(cr > 0.9 && cg < 0.7 && cb < cg, "{cr} {cg} {cb}");
        let [silver, aluminium] = [colour("Ag"), colour("Al")];
        assert!(silver.iter().all(|v| *v > 0.9), "{silver:?}");
        assert!(aluminium.iter().all(|v| (0.88..0.93).contains(v)), "{aluminium:?}");
        assert!(curve("metal-Unobtainium-k").is_none() && curve("metal-Au-x").is_none());
    }

    #[test]
    fn i9_and_colours_come_out() {
        assert!((normal(0.2, 3.0) - 0.923_372).abs() < 1e-6);
        let grey = reflected(conductor_of(Color::new(0.0, 0.5, 1.0)));
        assert!(
            grey[0] == 0.0 && (grey[1] - 0.5).abs() < 1e-6 && (grey[2] - 0.9999).abs() < 1e-4,
            "{grey:?}"
        );
    }
}
