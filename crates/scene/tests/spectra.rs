//! Spectra where colours and numbers are asked for.
use std::sync::Arc;

use durer_scene::{
    Args, AssetError, Assets, ColorInput, Data, Diagnostics, Image, Mesh, Missing, Node, ParamDefault,
    ParamSpec, ParamType, Params, Schema, ValueType,
};

const SCHEMA: Schema = Schema {
    name: "thing",
    aliases: &[],
    doc: "A thing with a share, a light and an index.",
    params: &[
        ParamSpec::color_texture("share", [0.5; 3], "A share of light."),
        ParamSpec::color("light", [1.0; 3], "Light.").unit("W/sr").range(0.0, f32::INFINITY),
        ParamSpec::new("eta", ParamType::Index, ParamDefault::Float(1.5), "An index.").range(0.1, 10.0),
    ],
};

/// A folder that holds two spectra.
struct Files;

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        match path {
            "spds/flat.spd" => Ok(Arc::from(b"# nm share\r\n300 0.25\r\n900 0.25\r\n".as_slice())),
            "bad.spd" => Ok(Arc::from(b"300 0.25\n290 1".as_slice())),
            _ => Err(AssetError::Missing { path: path.to_owned() }),
        }
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
}

/// What `ask` finds in one parameter, and the complaints with their hints.
fn ask<T>(name: &str, ty: ValueType, data: Data, ask: impl Fn(&mut Args<'_>) -> T) -> (T, String) {
    let node = Node::new("thing", Params::new().with(name, ty, data));
    let mut said = Diagnostics::default();
    let mut args = Args::check(&node, SCHEMA, &[], &mut said).with_assets(&Files, Missing::Refuse);
    let found = ask(&mut args);
    let said = said.iter().map(|d| format!("{} {}", d.message, d.hint.as_deref().unwrap_or_default()));
    (found, said.collect())
}

fn color(name: &str, ty: ValueType, data: Data) -> ([f32; 3], String) {
    ask(name, ty, data, |args| args.color(name).rgb)
}

fn word(word: &str) -> Data {
    Data::Strings(vec![word.to_owned()])
}

fn near(found: [f32; 3], expected: [f32; 3]) {
    assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-3), "{found:?} {expected:?}");
}

#[test]
fn shares_are_seen_under_daylight() {
    let (found, said) = color("share", ValueType::Spectrum, word("spds/flat.spd"));
    near(found, [0.25; 3]);
    assert_eq!(said, "");
    let red = Data::Floats(vec![400.0, 0.0, 590.0, 0.0, 610.0, 0.9, 780.0, 0.9]);
    let ([r, g, b], _) = color("share", ValueType::Spectrum, red);
    assert!(r > 0.7 && g < 0.1 && b < 0.05, "{r} {g} {b}");
}

#[test]
fn lights_have_luminance_one_whatever_their_numbers() {
    let flat = |v: f32| Data::Floats(vec![360.0, v, 830.0, v]);
    for v in [0.01, 1.0, 500.0] {
        let ([r, g, b], _) = color("light", ValueType::Spectrum, flat(v));
        // Equal energy is x = y = 1/3; in Rec. 709: rows of the matrix summed.
        assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 1e-3);
        assert!(
            (r - 1.2048).abs() < 0.02 && (g - 0.9483).abs() < 0.02 && (b - 0.9087).abs() < 0.02,
            "{r} {g} {b}"
        );
    }
    let (found, said) = color("light", ValueType::Spectrum, word("stdillum-D65"));
    near(found, [1.0; 3]);
    assert_eq!(said, "");
    let ([r, _, b], _) = color("light", ValueType::Blackbody, Data::Floats(vec![2000.0]));
    assert!(r > 5.0 * b);
}

#[test]
fn indices_are_those_of_yellow_light() {
    let index = |ty, data| ask("eta", ty, data, |args| args.index("eta"));
    assert_eq!(index(ValueType::Float, Data::Floats(vec![1.33])), (1.33, String::new()));
    assert_eq!(index(ValueType::Spectrum, word("glass-BK7")), (1.5168, String::new()));
    let (found, _) = index(ValueType::Spectrum, Data::Floats(vec![500.0, 1.6, 600.0, 1.5]));
    assert!((found - 1.5124).abs() < 1e-6);
    let (_, said) = index(ValueType::Spectrum, Data::Floats(vec![500.0, 16.0, 600.0, 16.0]));
    assert!(said.contains("\"eta\" is 16 at 587.6 nm, expected 0.1 to 10"), "{said}");
    assert_eq!(ask("light", ValueType::Rgb, Data::Floats(vec![1.0; 3]), |args| args.index("eta")).0, 1.5);
}

#[test]
fn bad_spectra_are_told() {
    let said = |data| color("share", ValueType::Spectrum, data).1;
    assert!(said(word("glass-BK8")).contains("did you mean \"glass-BK7\"?"));
    assert!(said(word("gone.spd")).contains("there is no spectrum \"gone.spd\""));
    assert!(
        said(word("bad.spd"))
            .contains("bad.spd: the wavelengths of a spectrum must rise, but 290 nm follows 300 nm")
    );
    assert!(said(Data::Floats(vec![500.0, 1.0, 500.0, 1.0])).contains("must rise"));
    assert!(said(Data::Floats(vec![500.0])).contains("expected"));
}

#[test]
fn measured_spectra_keep_their_curves() {
    let red = || Data::Floats(vec![400.0, 0.0, 590.0, 0.0, 610.0, 0.9, 780.0, 0.9]);
    let (found, _) = ask("share", ValueType::Spectrum, red(), |args| args.color_input("share"));
    let ColorInput::Curve(color, curve) = found else { panic!("no curve: {found:?}") };
    assert!((curve.at(600.0) - 0.45).abs() < 1e-6 && curve.at(500.0) == 0.0 && color.rgb[0] > 0.7);
    // Of lights, colours stand for the curve where textures are multiplied.
    let (found, _) = ask("light", ValueType::Spectrum, red(), |args| args.color_input("light"));
    assert!(matches!(found, ColorInput::Constant(_)), "{found:?}");

    let index = |ty, data| ask("eta", ty, data, |args| args.refraction("eta"));
    let ((usual, curve), _) = index(ValueType::Spectrum, word("glass-SF11"));
    let curve = curve.expect("a curve");
    // Schott's catalogue: n_F and n_C.
    assert!((usual - 1.7847).abs() < 1e-4, "{usual}");
    assert!((curve.at(486.13) - 1.806_45).abs() < 1e-4 && (curve.at(656.27) - 1.775_99).abs() < 1e-4);
    let flat = Data::Floats(vec![400.0, 1.5, 700.0, 1.5]);
    assert_eq!(index(ValueType::Spectrum, flat), ((1.5, None), String::new()));
    let (_, said) = index(ValueType::Spectrum, Data::Floats(vec![400.0, 16.0, 587.6, 1.5]));
    assert!(said.contains("\"eta\" is 16 at some wavelengths, expected 0.1 to 10"), "{said}");
}
