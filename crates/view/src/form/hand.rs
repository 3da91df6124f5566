//! Forms of what is no node of the description: how the picture is shown, its size, its moment.
use durer::{
    film::ToneMap,
    sampling::SamplerKind,
    scene::{ParamDefault, ParamSpec, ParamType},
    spectrum::Carried,
};
use serde_json::Value;

use super::{
    Field, FormId,
    edit::{Complaint, Effort},
    param::{read, short},
};
use crate::settings::{Look, Settings};

/// Largest edge of a picture, in pixels.
const LARGEST_EDGE: u32 = 8192;
/// Most pixels of a picture: its sums take half a GiB.
const MOST_PIXELS: u64 = 1 << 25;

const LOOK: &[ParamSpec] = &[
    ParamSpec::float("exposure", 0.0, "Brightens the picture by so many stops.")
        .unit("EV")
        .range(-30.0, 30.0),
    ParamSpec::new(
        "tonemap",
        ParamType::Choice(&ToneMap::WORDS),
        ParamDefault::Unset,
        "How light becomes colours. If left out: none for cast, whitted and distributed, else agx.",
    ),
];

const FILM: &[ParamSpec] = &[
    ParamSpec::new("width", ParamType::Int, ParamDefault::Unset, "Pixels per row.")
        .range(1.0, LARGEST_EDGE as f32),
    ParamSpec::new("height", ParamType::Int, ParamDefault::Unset, "Rows.").range(1.0, LARGEST_EDGE as f32),
    ParamSpec::new(
        "samples",
        ParamType::Int,
        ParamDefault::Unset,
        "Samples per pixel at which rendering ends.",
    )
    .range(1.0, 65536.0),
    ParamSpec::new("seed", ParamType::Int, ParamDefault::Unset, "Changes every random number.")
        .range(0.0, 1e6),
    ParamSpec::new(
        "spectral",
        ParamType::Bool,
        ParamDefault::Unset,
        "Rays carry four wavelengths instead of red, green and blue.",
    ),
];

const MOMENT: &[ParamSpec] =
    &[ParamSpec::float("time", 0.0, "The moment of the picture.").unit("s").range(-1e6, 1e6)];

fn specs(id: FormId) -> &'static [ParamSpec] {
    match id {
        FormId::Look => LOOK,
        FormId::Film => FILM,
        FormId::Moment => MOMENT,
        _ => &[],
    }
}

/// The parameter of a form.
pub(super) fn spec(id: FormId, name: &str) -> Option<&'static ParamSpec> {
    specs(id).iter().find(|spec| spec.name == name)
}

/// Names of the form's parameters.
pub(super) fn names(id: FormId) -> impl Iterator<Item = &'static str> {
    specs(id).iter().map(|spec| spec.name)
}

/// All fields with their values.
pub(super) fn fields(id: FormId, settings: &Settings) -> Vec<Field> {
    let Settings { options, look, .. } = settings;
    let field = |spec: &ParamSpec| {
        let value = match spec.name {
            "exposure" => short(look.exposure),
            "tonemap" => look.tonemap.map_or(Value::Null, |t| t.word().into()),
            "width" => options.width.into(),
            "height" => options.height.into(),
            "samples" => options.samples.or(settings.desc.film.samples).into(),
            "seed" => options.seed.or(settings.desc.film.seed).unwrap_or(0).into(),
            "spectral" => match options.carried {
                Some(carried) => (carried == Carried::Wavelengths).into(),
                None => settings.desc.film.spectral.into(),
            },
            "time" => short(options.time),
            _ => Value::Null,
        };
        Field::of(spec, None).with(value)
    };
    specs(id).iter().map(field).collect()
}

/// Whether such a form's settings are not as they were opened.
pub(super) fn differs(id: FormId, settings: &Settings, opened: &Settings) -> bool {
    match id {
        FormId::Sampler => sampler(settings) != sampler(opened),
        _ => fields(id, settings) != fields(id, opened),
    }
}

/// The sampler in use.
pub(super) fn sampler(settings: &Settings) -> SamplerKind {
    settings.options.sampler.unwrap_or_default()
}

/// Sets a parameter; `null` sets what was opened.
pub(super) fn set(
    id: FormId,
    (settings, opened): (&mut Settings, &Settings),
    spec: &ParamSpec,
    value: &Value,
) -> Result<Effort, Complaint> {
    let complain = |message: String| Complaint::of(id, Some(spec.name), message);
    let number = match value {
        Value::Null => None,
        value => {
            let param = read(spec, value).map_err(complain)?;
            Complaint::range(id, spec, &param)?;
            value.as_f64()
        }
    };
    let Settings { options, look, .. } = settings;
    let whole = |was: Option<u32>| number.map_or(was, |v| Some(v as u32));
    match spec.name {
        "exposure" => look.exposure = number.map_or(opened.look.exposure, |v| v as f32),
        "tonemap" => {
            *look = Look { tonemap: value.as_str().and_then(ToneMap::from_word), ..*look };
        }
        "samples" => options.samples = whole(opened.options.samples),
        "seed" => options.seed = number.map_or(opened.options.seed, |v| Some(v as u64)),
        "spectral" => {
            let wanted = value.as_bool().map(|on| if on { Carried::Wavelengths } else { Carried::Rgb });
            options.carried = wanted.or(opened.options.carried);
            return Ok(Effort::Again);
        }
        "time" => options.time = number.map_or(opened.options.time, |v| v as f32),
        name => {
            let mut size = [options.width, options.height];
            let (edge, was) = match name {
                "width" => (0, opened.options.width),
                _ => (1, opened.options.height),
            };
            size[edge] = whole(was);
            let pixels = size.map(|edge| u64::from(edge.unwrap_or(1)));
            if pixels[0] * pixels[1] > MOST_PIXELS {
                return Err(complain(format!(
                    "a picture of {} x {} pixels is too large",
                    pixels[0], pixels[1]
                )));
            }
            [options.width, options.height] = size;
        }
    }
    Ok(match id {
        FormId::Look => Effort::Develop,
        FormId::Moment => Effort::Again,
        _ => Effort::Retake,
    })
}

/// As it was opened.
pub(super) fn reset(id: FormId, settings: &mut Settings, opened: &Settings) -> Effort {
    match id {
        FormId::Look => {
            settings.look = opened.look;
            Effort::Develop
        }
        FormId::Moment => {
            settings.options.time = opened.options.time;
            Effort::Again
        }
        FormId::Sampler => {
            settings.options.sampler = opened.options.sampler;
            Effort::Retake
        }
        _ => {
            let [options, was] = [&mut settings.options, &mut opened.options.clone()];
            (options.width, options.height) = (was.width, was.height);
            (options.samples, options.seed) = (was.samples, was.seed);
            let same = options.carried == was.carried;
            options.carried = was.carried;
            if same { Effort::Retake } else { Effort::Again }
        }
    }
}
