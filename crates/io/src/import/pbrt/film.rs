//! `Film` and `Sampler`: parameters, pbrt-v4's defaults and what of them durer follows.
use durer_scene::{
    Args, Crop, Diagnostics, FilmDesc, LayersDesc, Node, Param, ParamDefault, ParamSpec, ParamType, Params,
    Schema, Space, counted,
};

const fn int(name: &'static str, default: i32, most: f32, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Int, ParamDefault::Int(default), doc).range(1.0, most)
}

/// Parameters of every film; `gbuffer` and `spectral` add a few. In a spectral film rays carry wavelengths.
pub(super) const FILM: Schema = Schema {
    name: "rgb",
    aliases: &["gbuffer", "spectral"],
    doc: "The picture: its size and, for information, its file.",
    params: &[
        int("xresolution", 1280, 1e6, "pixels per row"),
        int("yresolution", 720, 1e6, "rows"),
        ParamSpec::new("filename", ParamType::File, ParamDefault::Text("pbrt.exr"), "shown by info"),
        ParamSpec::float("diagonal", 35.0, "film size, used by the realistic camera")
            .unit("mm")
            .above(0.0, 1e6),
        ParamSpec::new("savefp16", ParamType::Bool, ParamDefault::Bool(true), "no effect"),
        ParamSpec::new(
            "cropwindow",
            ParamType::Floats,
            ParamDefault::Unset,
            "x0 x1 y0 y1: the part rendered",
        )
        .range(0.0, 1.0),
        ParamSpec::new(
            "pixelbounds",
            ParamType::Ints,
            ParamDefault::Unset,
            "x0 x1 y0 y1: the same in pixels",
        )
        .unit("px")
        .range(0.0, 1e6),
        ParamSpec::new(
            "sensor",
            ParamType::Choice(&SENSORS),
            ParamDefault::Text("cie1931"),
            "only the default",
        ),
        ParamSpec::float("iso", 100.0, "multiplies the picture, 100 is 1").above(0.0, f32::INFINITY),
        ParamSpec::float("exposuretime", 1.0, "multiplies the picture, 1 is 1")
            .unit("s")
            .above(0.0, f32::INFINITY),
        ParamSpec::float(
            "whitebalance",
            0.0,
            "temperature of the daylight that is shown as white; 0 leaves colours",
        )
        .unit("K")
        .range(0.0, 40_000.0),
        ParamSpec::float("scale", 1.0, "multiplies the picture").above(0.0, f32::INFINITY),
        ParamSpec::new(
            "maxcomponentvalue",
            ParamType::Float,
            ParamDefault::Unset,
            "the most that X, Y or Z of a sample may be",
        )
        .above(0.0, f32::INFINITY),
        ParamSpec::new(
            "coordinatesystem",
            ParamType::Choice(&Space::WORDS),
            ParamDefault::Text(Space::WORDS[0]),
            "gbuffer: what places and normals are told in",
        ),
        int("nbuckets", 16, 10_000.0, "spectral: channels beside red, green and blue"),
        ParamSpec::float("lambdamin", VISIBLE[0], "spectral: where the first begins")
            .unit("nm")
            .range(VISIBLE[0], VISIBLE[1]),
        ParamSpec::float("lambdamax", VISIBLE[1], "spectral: where the last ends")
            .unit("nm")
            .range(VISIBLE[0], VISIBLE[1]),
    ],
};

/// What pbrt-v4 has measured curves of, after the observer that stands for all of them here.
const SENSORS: [&str; 18] = [
    "cie1931",
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d",
    "canon_eos_200d_mkii",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
];
/// The wavelengths that rays carry, in nm.
const VISIBLE: [f32; 2] = [360.0, 830.0];
/// The narrowest bucket in nm: channels are called after the middles, with three decimals.
const NARROWEST: f32 = 0.01;
/// What only films with layers heed, and which.
const OF_LAYERS: [(&str, &str); 4] = [
    ("coordinatesystem", "gbuffer"),
    ("nbuckets", "spectral"),
    ("lambdamin", "spectral"),
    ("lambdamax", "spectral"),
];
/// The coldest glow that can be balanced.
const COLDEST: f32 = 1000.0;

/// Samplers of pbrt-v4 that take `pixelsamples`.
const SAMPLERS: [&str; 6] = ["halton", "independent", "paddedsobol", "sobol", "zsobol", "pmj02bn"];

const SAMPLES: ParamSpec = int("pixelsamples", 16, 1e9, "samples per pixel");
const SEED: ParamSpec =
    ParamSpec::new("seed", ParamType::Int, ParamDefault::Int(0), "changes every random number");

/// Parameters of the samplers that take `pixelsamples`.
pub(super) const SAMPLER: Schema = Schema {
    name: "sampler",
    aliases: &[],
    doc: "How many samples per pixel, and how they become random numbers.",
    params: &[
        SAMPLES,
        SEED,
        ParamSpec::new(
            "randomization",
            ParamType::Choice(&["none", "permutedigits", "fastowen", "owen"]),
            ParamDefault::Text("fastowen"),
            "no effect",
        ),
    ],
};

/// Parameters of the stratified sampler.
pub(super) const STRATIFIED: Schema = Schema {
    name: "stratified",
    aliases: &[],
    doc: "xsamples times ysamples samples per pixel.",
    params: &[
        int("xsamples", 4, 3e4, "samples in x"),
        int("ysamples", 4, 3e4, "samples in y"),
        SEED,
        ParamSpec::new(
            "jitter",
            ParamType::Bool,
            ParamDefault::Bool(true),
            "anywhere in each cell, not its middle",
        ),
    ],
};

/// Reads `Film`.
pub(super) fn film(node: &Node, film: &mut FilmDesc, diagnostics: &mut Diagnostics) {
    let known = FILM.name == node.kind || FILM.aliases.contains(&node.kind.as_str());
    if node.kind == "image" {
        let hint = "this is pbrt-v3's word; pbrt-v4 writes \"rgb\"";
        diagnostics.error(node.at.clone(), "unknown film \"image\"").hint(hint);
    } else if !known {
        diagnostics.unknown(
            node.at.clone(),
            "film",
            &node.kind,
            FILM.aliases.iter().copied().chain([FILM.name]),
        );
    }
    let mut args = Args::check(node, FILM, &[], diagnostics);
    film.spectral = node.kind == "spectral";
    film.width = u32::try_from(args.int("xresolution")).ok();
    film.height = u32::try_from(args.int("yresolution")).ok();
    let numbers = [
        ("diagonal", &mut film.diagonal_mm),
        ("iso", &mut film.iso),
        ("exposuretime", &mut film.exposure_seconds),
    ];
    for (name, into) in numbers {
        *into = args.is_set(name).then(|| args.float(name));
    }
    let scale = args.float("scale");
    if scale != 1.0 {
        film.exposure_seconds = Some(film.exposure_seconds.unwrap_or(1.0) * scale);
    }
    film.max_component_value = args.optional_float("maxcomponentvalue");
    film.white_balance = white_balance(&mut args);
    film.filename = args.is_set("filename").then(|| args.text("filename").to_owned());
    film.crop = crop(&mut args);
    film.layers = layers(&mut args, &node.kind);
}

/// What a film of this kind keeps beside colours.
fn layers(args: &mut Args<'_>, kind: &str) -> Option<LayersDesc> {
    for (name, of) in OF_LAYERS {
        if args.is_set(name) && kind != of {
            args.warning(name, format!("\"{name}\" has no effect: it is for film \"{of}\""));
        }
    }
    match kind {
        "gbuffer" => Some(LayersDesc::Surfaces(match args.text("coordinatesystem") {
            "world" => Space::World,
            _ => Space::Camera,
        })),
        "spectral" => {
            let count = u32::try_from(args.int("nbuckets")).ok()?;
            let range = [args.float("lambdamin"), args.float("lambdamax")];
            if args.is_sound() && range[1] - range[0] < NARROWEST * count as f32 {
                let least = format!("expected a bucket to have {NARROWEST} nm or more");
                let [low, high] = range;
                args.error("lambdamax", format!("{count} buckets lie from {low} to {high} nm, {least}"));
            }
            Some(LayersDesc::Buckets { count, range })
        }
        _ => None,
    }
}

/// The daylight that is shown as white, in kelvin; `None` where colours are left as they are.
fn white_balance(args: &mut Args<'_>) -> Option<f32> {
    let kelvin = args.float("whitebalance");
    if kelvin > 0.0 && kelvin < COLDEST {
        args.error(
            "whitebalance",
            format!("\"whitebalance\" is {kelvin}, expected 0 or {COLDEST} K and more"),
        );
    }
    let sensor = args.text("sensor");
    if args.is_sound() && sensor != SENSORS[0] {
        args.warning(
            "sensor",
            format!(
                "the measured curves of the sensor \"{sensor}\" are not part of durer: colours are those of \"cie1931\", which \
                 pbrt-v4 fits them to, with the same speed and white balance"
            ),
        );
    }
    (kelvin > 0.0).then_some(kelvin)
}

/// The part of the picture that `cropwindow` or `pixelbounds` asks for; `None` for all of it.
fn crop(args: &mut Args<'_>) -> Option<Crop> {
    let given = ["cropwindow", "pixelbounds"].map(|name| args.is_set(name));
    let name = match given {
        [false, false] => return None,
        [true, false] => "cropwindow",
        [false, true] => "pixelbounds",
        [true, true] => {
            args.error(
                "pixelbounds",
                "both \"cropwindow\" and \"pixelbounds\" are given: each says which part",
            );
            return None;
        }
    };
    let size =
        [args.int("xresolution"), args.int("yresolution")].map(|edge| u32::try_from(edge).unwrap_or(0));
    let crop = match (args.floats("cropwindow"), args.ints("pixelbounds")) {
        (&[x0, x1, y0, y1], _) => Crop::Window([x0.min(x1), x0.max(x1), y0.min(y1), y0.max(y1)]),
        (_, &[x0, x1, y0, y1]) => Crop::Pixels([x0, x1, y0, y1].map(|edge| u32::try_from(edge).unwrap_or(0))),
        (floats, ints) => {
            let found = counted(floats.len() + ints.len(), "value");
            args.error(name, format!("\"{name}\" has {found}, expected 4: x0 x1 y0 y1"));
            return None;
        }
    };
    if !args.is_sound() {
        return None;
    }
    let [x0, x1, y0, y1] = crop.pixels(size, size);
    if x0 >= x1.min(size[0]) || y0 >= y1.min(size[1]) {
        args.error(name, format!("no pixel of the picture lies in x {x0} to {x1} and y {y0} to {y1}"));
    }
    ([x0, x1, y0, y1] != [0, size[0], 0, size[1]]).then_some(crop)
}

/// Reads `Sampler`.
pub(super) fn sampler(node: &Node, film: &mut FilmDesc, diagnostics: &mut Diagnostics) {
    if node.kind == STRATIFIED.name {
        let args = Args::check(node, STRATIFIED, &[], diagnostics);
        film.samples = u32::try_from(args.int("xsamples").saturating_mul(args.int("ysamples"))).ok();
        film.seed = seed(&args).or(film.seed);
        return;
    }
    if !SAMPLERS.contains(&node.kind.as_str()) {
        diagnostics.unknown(
            node.at.clone(),
            "sampler",
            &node.kind,
            SAMPLERS.into_iter().chain([STRATIFIED.name]),
        );
        // Its number of samples is worth having even so; what else it takes is unknown.
        let mut samples = Params::new();
        node.params.iter().filter(|p| p.name == SAMPLES.name).for_each(|p: &Param| samples.push(p.clone()));
        return sampler(
            &Node { kind: "sobol".to_owned(), params: samples, at: node.at.clone() },
            film,
            diagnostics,
        );
    }
    // Messages call the sampler by its own name.
    let name = SAMPLERS.into_iter().find(|s| *s == node.kind).unwrap_or(SAMPLER.name);
    let args = Args::check(node, Schema { name, ..SAMPLER }, &[], diagnostics);
    film.samples = u32::try_from(args.int(SAMPLES.name)).ok();
    film.seed = seed(&args).or(film.seed);
}

/// The seed of a sampler, if it gives one; negative ones are as good as others.
fn seed(args: &Args<'_>) -> Option<u64> {
    args.is_set(SEED.name).then(|| args.int(SEED.name) as u32 as u64)
}
