//! Parameters as the page sees them: JSON for what files write, and back.
use durer::scene::{Data, Location, Param, ParamDefault, ParamSpec, ParamType, ValueType};
use serde::Serialize;
use serde_json::{Value, json};

/// A parameter in a form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Field {
    name: &'static str,
    r#type: &'static str,
    doc: &'static str,
    unit: &'static str,
    default: Value,
    value: Value,
    min: Option<f32>,
    max: Option<f32>,
    words: Option<&'static [&'static str]>,
    editable: bool,
}

impl Field {
    /// The field of a parameter, and what is written of it.
    pub(crate) fn of(spec: &ParamSpec, written: Option<&Param>) -> Self {
        let words = match spec.ty {
            ParamType::Choice(words) => Some(words),
            _ => None,
        };
        Self {
            name: spec.name,
            r#type: word(spec.ty),
            doc: spec.doc,
            unit: spec.unit,
            default: default(spec.default),
            value: written.map_or(Value::Null, value),
            min: Some(spec.range.0).filter(|v| v.is_finite()),
            max: Some(spec.range.1).filter(|v| v.is_finite()),
            words,
            editable: is_editable(spec.ty),
        }
    }

    /// The same with this value.
    pub(crate) fn with(self, value: Value) -> Self {
        Self { value, ..self }
    }
}

/// Whether a value can be typed in. A file of the scene's own choice is not changed from outside.
fn is_editable(ty: ParamType) -> bool {
    !ty.is_list() && ty != ParamType::File
}

fn word(ty: ParamType) -> &'static str {
    match ty {
        ParamType::Bool => "bool",
        ParamType::Int => "int",
        ParamType::Float => "float",
        ParamType::Point3 => "point3",
        ParamType::Vector3 => "vector3",
        ParamType::Ints => "ints",
        ParamType::Floats => "floats",
        ParamType::Point2s => "point2s",
        ParamType::Point3s => "point3s",
        ParamType::Vector3s => "vector3s",
        ParamType::Normals => "normals",
        ParamType::Text => "text",
        ParamType::Texts => "texts",
        ParamType::Choice(_) => "choice",
        ParamType::File => "file",
        ParamType::Index => "index",
        ParamType::Color => "color",
        ParamType::Colors => "colors",
        ParamType::ColorTexture => "color-texture",
        ParamType::FloatTexture => "float-texture",
    }
}

/// A number with no more digits than it has bits.
pub(crate) fn short(v: f32) -> Value {
    v.to_string().parse().map_or(Value::Null, |v: f64| v.into())
}

fn shorts(values: &[f32]) -> Value {
    values.iter().copied().map(short).collect()
}

fn default(default: ParamDefault) -> Value {
    match default {
        ParamDefault::Required | ParamDefault::Unset => Value::Null,
        ParamDefault::Bool(v) => v.into(),
        ParamDefault::Int(v) => v.into(),
        ParamDefault::Float(v) => short(v),
        ParamDefault::Triple(v) => shorts(&v),
        ParamDefault::Text(v) => v.into(),
    }
}

/// What is written, as JSON. Of long lists the beginning.
fn value(param: &Param) -> Value {
    const MOST: usize = 48;
    match (&param.data, param.ty) {
        (Data::Strings(v), ValueType::Texture) => json!({ "texture": v.first() }),
        (Data::Strings(v), ValueType::Spectrum) => json!({ "spectrum": v.first() }),
        (Data::Floats(v), ValueType::Spectrum) => json!({ "spectrum": shorts(&v[..v.len().min(MOST)]) }),
        (Data::Floats(v), ValueType::Blackbody) => json!({ "blackbody": v.first().copied().map(short) }),
        (Data::Floats(v), ValueType::Float) if v.len() == 1 => short(v[0]),
        (Data::Floats(v), _) => shorts(&v[..v.len().min(MOST)]),
        (Data::Ints(v), _) if v.len() == 1 => v[0].into(),
        (Data::Ints(v), _) => v[..v.len().min(MOST)].into(),
        (Data::Bools(v), _) => v.first().copied().into(),
        (Data::Strings(v), _) if v.len() == 1 => v[0].clone().into(),
        (Data::Strings(v), _) => v[..v.len().min(MOST)].into(),
    }
}

/// The parameter that a value of the page stands for.
///
/// # Errors
/// What was expected. Ranges and names are checked elsewhere, as those of a file are.
pub(crate) fn read(spec: &ParamSpec, value: &Value) -> Result<Param, String> {
    let wrong = |expected: &str| Err(format!("\"{}\" is {value}, expected {expected}", spec.name));
    let number = |v: &Value| v.as_f64().map(|v| v as f32).filter(|v| v.is_finite());
    let numbers = |v: &Value| v.as_array().and_then(|v| v.iter().map(number).collect::<Option<Vec<f32>>>());
    let triple = |v: &Value| numbers(v).filter(|v| v.len() == 3);
    let of = |key: &str| value.as_object().filter(|o| o.len() == 1).and_then(|o| o.get(key));
    let named = |key: &str| of(key).and_then(Value::as_str).map(|v| Data::Strings(vec![v.to_owned()]));
    let spectrum = || named("spectrum").or_else(|| of("spectrum").and_then(numbers).map(Data::Floats));
    let blackbody = || of("blackbody").and_then(number).map(|v| Data::Floats(vec![v]));
    let floats = |v: Option<Vec<f32>>| v.map(Data::Floats);
    let one = || number(value).map(|v| Data::Floats(vec![v]));
    let text = || value.as_str().map(|v| Data::Strings(vec![v.to_owned()]));
    let color = || {
        let rgb = floats(triple(value)).map(|data| (ValueType::Rgb, data));
        rgb.or_else(|| spectrum().map(|data| (ValueType::Spectrum, data)))
            .or_else(|| blackbody().map(|data| (ValueType::Blackbody, data)))
    };
    let texture = || named("texture").map(|data| (ValueType::Texture, data));
    let typed = |ty: ValueType| move |data: Data| (ty, data);
    let (found, expected) = match spec.ty {
        ParamType::Bool => {
            (value.as_bool().map(|v| (ValueType::Bool, Data::Bools(vec![v]))), "true or false")
        }
        ParamType::Int => {
            let whole = value.as_i64().and_then(|v| i32::try_from(v).ok());
            (whole.map(|v| (ValueType::Integer, Data::Ints(vec![v]))), "a whole number")
        }
        ParamType::Float => (one().map(typed(ValueType::Float)), "a number"),
        ParamType::Point3 => (floats(triple(value)).map(typed(ValueType::Point3)), "three numbers"),
        ParamType::Vector3 => (floats(triple(value)).map(typed(ValueType::Vector3)), "three numbers"),
        ParamType::Text | ParamType::Choice(_) => (text().map(typed(ValueType::String)), "a text"),
        ParamType::Index => (
            one().map(typed(ValueType::Float)).or_else(|| spectrum().map(typed(ValueType::Spectrum))),
            "a number or a spectrum",
        ),
        ParamType::Color => (color(), "a colour: three numbers, a spectrum, a blackbody"),
        ParamType::ColorTexture => {
            (color().or_else(texture), "a colour: three numbers, a spectrum, a blackbody, a texture")
        }
        ParamType::FloatTexture => {
            (one().map(typed(ValueType::Float)).or_else(texture), "a number or a texture")
        }
        ParamType::File => {
            return Err(format!("\"{}\" names a file: only the scene file says which", spec.name));
        }
        _ => return Err(format!("\"{}\" is a list: only the scene file says what is in it", spec.name)),
    };
    match found {
        Some((ty, data)) => Ok(Param { name: spec.name.to_owned(), ty, data, at: Location::None }),
        None => wrong(expected),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::{integrator::INTEGRATORS, model::material::MATERIALS, scene::Schema};

    fn schemas() -> impl Iterator<Item = &'static Schema> {
        INTEGRATORS.iter().map(|e| &e.schema).chain(MATERIALS.iter().map(|e| &e.schema))
    }

    #[test]
    fn every_default_can_be_typed_in_and_reads_back() {
        let mut tried = 0;
        for schema in schemas() {
            for spec in schema.params.iter().filter(|spec| is_editable(spec.ty)) {
                let Value::Null = default(spec.default) else {
                    let read = read(spec, &default(spec.default)).expect(spec.name);
                    assert_eq!(value(&read), default(spec.default), "{} {}", schema.name, spec.name);
                    assert!(spec.ty.accepts().contains(&read.ty), "{} {}", schema.name, spec.name);
                    tried += 1;
                    continue;
                };
            }
        }
        assert!(tried > 30, "{tried}");
    }

    #[test]
    fn ways_to_say_a_colour() {
        let spec = ParamSpec::color_texture("reflectance", [0.5; 3], "");
        let ways = [
            json!([0.5, 0.25, 1]),
            json!({ "texture": "wood" }),
            json!({ "spectrum": "metal-Cu-k" }),
            json!({ "spectrum": [400, 1, 700, 0.5] }),
            json!({ "blackbody": 6500 }),
        ];
        for way in ways {
            let param = read(&spec, &way).expect("a colour");
            assert_eq!(serde_json::to_value(value(&param)).ok(), serde_json::from_str(&as_floats(&way)).ok());
        }
        for wrong in
            [json!(1), json!([1, 2]), json!({ "texture": 3 }), json!({ "a": 1 }), json!("red"), json!(null)]
        {
            assert!(read(&spec, &wrong).is_err(), "{wrong}");
        }
    }

    /// Numbers come back as floats.
    fn as_floats(value: &Value) -> String {
        match value {
            Value::Number(v) => format!("{:?}", v.as_f64().unwrap_or_default()),
            Value::Array(v) => format!("[{}]", v.iter().map(as_floats).collect::<Vec<_>>().join(",")),
            Value::Object(v) => {
                let pairs: Vec<String> = v.iter().map(|(k, v)| format!("\"{k}\":{}", as_floats(v))).collect();
                format!("{{{}}}", pairs.join(","))
            }
            other => other.to_string(),
        }
    }

    #[test]
    fn files_and_lists_are_the_scenes_own() {
        let file = ParamSpec::new("filename", ParamType::File, ParamDefault::Required, "");
        assert!(read(&file, &json!("../secret.png")).is_err());
        let list = ParamSpec::new("P", ParamType::Point3s, ParamDefault::Required, "");
        assert!(read(&list, &json!([1, 2, 3])).is_err());
    }
}
