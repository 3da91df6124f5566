//! Indices of refraction over wavelengths, by formula: glasses, water, some minerals.
//!
//! Sellmeier's equation `n² = 1 + sum of B λ² / (λ² - C)`, λ in µm. Glasses: Schott's catalogue; water at 20 °C: Daimon and
//! Masumura 2007; fused silica: Malitson 1965; sapphire (ordinary ray): Malitson and Dodge 1972; diamond: Peter 1923.
use super::{Curve, HELIUM_D};

/// Name, and pairs of `B` and `C` (µm²).
type Sellmeier = (&'static str, &'static [(f64, f64)]);

/// Of water the index against a vacuum is known; that of air, which all others are measured in.
const AIR: f64 = 1.000_27;

const BK7: &[(f64, f64)] =
    &[(1.039_612_12, 0.006_000_698_67), (0.231_792_344, 0.020_017_914_4), (1.010_469_45, 103.560_653)];
const SF5: &[(f64, f64)] =
    &[(1.524_818_89, 0.011_254_756), (0.187_085_527, 0.058_899_539_2), (1.427_290_15, 129.141_675)];
const SF10: &[(f64, f64)] =
    &[(1.621_539_02, 0.012_224_145_7), (0.256_287_842, 0.059_573_677_5), (1.644_475_52, 147.468_793)];
const SF11: &[(f64, f64)] =
    &[(1.737_596_95, 0.013_188_707), (0.313_747_346, 0.062_306_814_2), (1.898_781_01, 155.236_29)];

const KNOWN: &[Sellmeier] = &[
    ("glass-BK7", BK7),
    (
        "glass-BAF10",
        &[(1.585_149_5, 0.009_266_812_82), (0.143_559_385, 0.042_448_980_5), (1.085_212_69, 105.613_573)],
    ),
    (
        "glass-FK51A",
        &[(0.971_247_817, 0.004_723_019_95), (0.216_901_417, 0.015_357_561_2), (0.904_651_666, 168.681_33)],
    ),
    (
        "glass-LASF9",
        &[(2.000_295_47, 0.012_142_601_7), (0.298_926_886, 0.053_873_623_6), (1.806_918_43, 156.530_829)],
    ),
    // As pbrt-v4 has it, F5, F10 and F11 are other words for SF5, SF10 and SF11.
    ("glass-F5", SF5),
    ("glass-F10", SF10),
    ("glass-F11", SF11),
    ("glass-SF5", SF5),
    ("glass-SF10", SF10),
    ("glass-SF11", SF11),
    (
        "water",
        &[
            (0.568_402_756_5, 0.005_101_829_712),
            (0.172_617_739_1, 0.018_211_539_36),
            (0.020_861_895_78, 0.026_207_222_93),
            (0.113_074_868_8, 10.697_927_21),
        ],
    ),
    (
        "fused-silica",
        &[(0.696_166_3, 0.004_679_148_26), (0.407_942_6, 0.013_512_063_1), (0.897_479_4, 97.934_002_5)],
    ),
    (
        "sapphire",
        &[(1.431_349_3, 0.005_279_926_1), (0.650_547_13, 0.014_238_264_7), (5.341_402_1, 325.017_834)],
    ),
    ("diamond", &[(0.330_6, 0.030_625), (4.335_6, 0.011_236)]),
];

/// The index at a wavelength in nm, against air, of what is called `name`; `None` if no formula is known for it.
pub fn index(name: &str, nm: f64) -> Option<f64> {
    let (_, terms) = KNOWN.iter().find(|known| known.0 == name)?;
    let square = nm * nm * 1e-6;
    let n = (1.0 + terms.iter().map(|(b, c)| b * square / (square - c)).sum::<f64>()).sqrt();
    Some(if name == "water" { n / AIR } else { n })
}

/// Fraunhofer's lines F and C, between which dispersion is measured, in nm.
const LINES: [f64; 2] = [486.13, 656.27];

impl Curve {
    /// An index by Cauchy's equation `A + B / λ² + C / λ⁴`, λ in µm.
    pub fn cauchy([a, b, c]: [f64; 3]) -> Self {
        Self::of(|nm| {
            let square = nm * nm * 1e-6;
            a + b / square + c / (square * square)
        })
    }
    /// An index that is `n_d` at helium's yellow line and disperses as much as Abbe's number `v` says, with Cauchy's first
    /// two terms (KHR_materials_dispersion). No longer wavelength makes it less than 1 if it is not so there.
    pub fn abbe(n_d: f64, v: f64) -> Self {
        let term = |nm: f64| 1.0 / (nm * nm);
        let rise = (n_d - 1.0) / (v * (term(LINES[0]) - term(LINES[1])));
        let least = if n_d < 1.0 { 0.1 } else { 1.0 };
        Self::of(|nm| (n_d + rise * (term(nm) - term(HELIUM_D))).max(least))
    }
}

/// Abbe's number of an index that changes so and is `n_d` at helium's yellow line: `(n_d - 1) / (n_F - n_C)`.
pub fn abbe_number(n_d: f64, curve: &Curve) -> f64 {
    let [f, c] = LINES.map(|nm| f64::from(curve.at(nm as f32)));
    (n_d - 1.0) / (f - c)
}

/// Its index over wavelengths.
pub(super) fn index_curve(name: &str) -> Option<Curve> {
    index(name, 500.0)?;
    Some(Curve::of(|nm| index(name, nm).unwrap_or(1.0)))
}

/// Names of those that pbrt-v4 does not know.
pub(super) fn index_names() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().map(|known| known.0).filter(|name| !name.starts_with("glass-"))
}

#[cfg(test)]
mod tests {
    use super::{
        super::{HELIUM_D, named, named::waves},
        *,
    };

    #[test]
    fn formulas_agree_with_the_table_of_names() {
        let glasses = KNOWN.iter().filter(|known| known.0.starts_with("glass-"));
        assert!(glasses.clone().count() == 10);
        for (name, _) in glasses {
            let table = waves(name).expect("a name");
            for pair in table.chunks(2) {
                let got = index(name, pair[0].into()).expect("a formula");
                assert!((got - f64::from(pair[1])).abs() < 2.5e-4, "{name} at {} nm: {got}", pair[0]);
            }
        }
    }

    #[test]
    fn few_numbers_say_how_glass_disperses() {
        // Schott's catalogue: BK7 has n_d = 1.5168 and V = 64.17, SF11 1.78472 and 25.68.
        for (name, n_d, v) in [("glass-BK7", 1.516_8, 64.17), ("glass-SF11", 1.784_72, 25.68)] {
            let measured = index_curve(name).expect("a curve");
            assert!((abbe_number(n_d, &measured) / v - 1.0).abs() < 2e-3, "{name}");
            let made = Curve::abbe(n_d, v);
            assert!((abbe_number(n_d, &made) / v - 1.0).abs() < 1e-3, "{name}");
            for nm in [450.0, 486.13, 587.6, 656.27, 700.0] {
                let (found, expected) = (made.at(nm), measured.at(nm));
                assert!(
                    (found - expected).abs() < 0.1 * (measured.at(450.0) - expected).abs().max(0.02),
                    "{name} {nm}"
                );
            }
        }
        // BK7 by Cauchy's equation, as textbooks have it.
        let bk7 = Curve::cauchy([1.5046, 0.0042, 0.0]);
        let measured = index_curve("glass-BK7").expect("a curve");
        assert!([450.0, 550.0, 650.0].into_iter().all(|nm| (bk7.at(nm) - measured.at(nm)).abs() < 1e-3));
        assert!((Curve::cauchy([1.5, 0.0, 0.01]).at(500.0) - 1.66).abs() < 1e-5);
        let ends = Curve::abbe(1.33, 0.5).ends();
        assert!(ends[0] == 1.0 && ends[1] > 2.0, "{ends:?}");
    }

    #[test]
    fn minerals_and_water_have_the_indices_of_handbooks() {
        // Fraunhofer's lines F, d and C.
        for (name, f, d, c) in [
            ("water", 1.3371, 1.3330, 1.3312),
            ("fused-silica", 1.4631, 1.4585, 1.4564),
            ("sapphire", 1.7756, 1.7682, 1.7649),
            ("diamond", 2.4354, 2.4176, 2.4099),
        ] {
            for (nm, expected) in [(486.13, f), (HELIUM_D, d), (656.27, c)] {
                let got = index(name, nm).expect("a formula");
                assert!((got - expected).abs() < 3e-4, "{name} at {nm} nm: {got}");
            }
            assert!(named(name).is_some_and(|n| (f64::from(n.number) - d).abs() < 3e-4), "{name}");
            assert!((f64::from(index_curve(name).expect("a curve").at(486.13)) - f).abs() < 3e-4);
        }
        assert!(index("glass-Unobtainium", 500.0).is_none() && index_names().count() == 4);
    }
}
