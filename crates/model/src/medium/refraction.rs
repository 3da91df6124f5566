//! Indices of refraction as files give them: a number, a curve, Cauchy's coefficients, or a number and how much it disperses.
use durer_core::spectrum::{Curve, HELIUM_D};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use super::Medium;

/// What an index may be.
const RANGE: [f32; 2] = [0.1, 10.0];

impl Medium {
    /// The parameter `eta`.
    pub(crate) const ETA: ParamSpec = ParamSpec::new(
        "eta",
        ParamType::Index,
        ParamDefault::Float(1.5),
        "Index of refraction inside, relative to the outside; one that changes with wavelength splits light \
         into its colours where rays carry wavelengths.",
    )
    .range(RANGE[0], RANGE[1]);
    /// The parameter `cauchy`.
    pub(crate) const CAUCHY: ParamSpec = ParamSpec::new(
        "cauchy",
        ParamType::Floats,
        ParamDefault::Unset,
        "Instead of eta: A B C of the index A + B / λ² + C / λ⁴, λ in µm; C may be left out.",
    );
    /// The parameter `dispersion`.
    pub(crate) const DISPERSION: ParamSpec = ParamSpec::float(
        "dispersion",
        0.0,
        "How much eta changes with wavelength: 20 by Abbe's number, as glTF has it. Crown glass 0.3, flint 0.8.",
    )
    .range(0.0, f32::INFINITY);

    /// Reads these three: the index at 587.6 nm, and how it changes with wavelength if it does.
    pub fn refraction(args: &mut Args<'_>) -> (f32, Option<Curve>) {
        let (eta, curve) = args.refraction(Self::ETA.name);
        let dispersion = args.float(Self::DISPERSION.name);
        if args.is_set(Self::CAUCHY.name) {
            for other in [Self::ETA.name, Self::DISPERSION.name] {
                if args.is_set(other) {
                    let message =
                        format!("\"{other}\" and \"cauchy\" both say how light is bent: give one of them");
                    args.error(other, message);
                }
            }
            return cauchy(args);
        }
        if curve.is_some() && dispersion > 0.0 {
            args.error(
                Self::DISPERSION.name,
                "\"dispersion\" has no place beside a curve, which says how \"eta\" changes with wavelength",
            );
        }
        (eta, curve.or_else(|| Self::dispersing(eta, dispersion)))
    }

    /// How an index changes with wavelength that disperses so much; `None` if it does not.
    pub(crate) fn dispersing(eta: f32, dispersion: f32) -> Option<Curve> {
        let curve = (dispersion > 0.0).then(|| Curve::abbe(eta.into(), 20.0 / f64::from(dispersion)))?;
        (!curve.is_flat()).then_some(curve)
    }
}

fn cauchy(args: &mut Args<'_>) -> (f32, Option<Curve>) {
    let name = Medium::CAUCHY.name;
    let terms = match *args.floats(name) {
        [a, b] => [a, b, 0.0],
        [a, b, c] => [a, b, c],
        ref other => {
            let message = format!("\"cauchy\" has {} values, expected A B or A B C", other.len());
            args.error(name, message);
            return (1.0, None);
        }
    };
    let curve = Curve::cauchy(terms.map(f64::from));
    let [least, most] = curve.ends();
    let [low, high] = RANGE;
    // The other way round NaN would pass.
    if !(least >= low && most <= high) {
        let message = format!(
            "by \"cauchy\" the index is {least} to {most} where light is seen, expected {low} to {high}"
        );
        args.error(name, message);
    }
    (curve.at(HELIUM_D as f32), (!curve.is_flat()).then_some(curve))
}
