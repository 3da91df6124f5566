//! `Option`: what holds for the whole scene.
use durer_scene::{Args, Data, Node, Param, ParamDefault, ParamSpec, ParamType, Params, Schema, Severity};

use super::{input::Reported, lexer::Token, parser::Parser};

const fn flag(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Bool, ParamDefault::Bool(false), doc)
}
const fn path(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::File, ParamDefault::Unset, doc)
}

const OPTION: Schema = Schema {
    name: "Option",
    aliases: &[],
    doc: "What holds for the whole scene.",
    params: &[
        flag(
            "disablepixeljitter",
            "all samples of a pixel take its middle, that of the lens and of the exposure",
        ),
        flag("disabletexturefiltering", "textures are looked at in points"),
        flag("disablewavelengthjitter", "all samples carry the same wavelengths"),
        ParamSpec::float("displacementedgescale", 1.0, "factor on the edge length of displaced shapes")
            .above(0.0, f32::INFINITY),
        flag("forcediffuse", "every surface scatters evenly what it scatters"),
        path("msereferenceimage", "no effect"),
        path("msereferenceout", "no effect"),
        flag("pixelstats", "no effect"),
        ParamSpec::new(
            "rendercoordsys",
            ParamType::Choice(&["camera", "cameraworld", "world"]),
            ParamDefault::Text("cameraworld"),
            "no effect",
        ),
        ParamSpec::new("seed", ParamType::Int, ParamDefault::Int(0), "changes every random number"),
        flag("wavefront", "no effect"),
    ],
};

/// What durer says of options that change nothing, where they ask for something.
const REMARKS: [(&str, Severity, &str, &str); 5] = [
    (
        "rendercoordsys",
        Severity::Note,
        "\"rendercoordsys\" changes nothing: placements are composed in double precision, and rendered around the camera",
        "",
    ),
    (
        "wavefront",
        Severity::Note,
        "\"wavefront\" changes nothing: it says how pbrt-v4 computes, not what",
        "",
    ),
    (
        "pixelstats",
        Severity::Warning,
        "\"pixelstats\" writes no files",
        "\"durer view\" shows the rays and the noise of each pixel, the integrator \"cast\" with \"cost\" what its first hit takes",
    ),
    (
        "msereferenceimage",
        Severity::Warning,
        "\"msereferenceimage\" is not compared with while the picture is rendered",
        "render to .exr with 1, 4, 16, ... samples (--samples) and compare the files",
    ),
    ("msereferenceout", Severity::Warning, "\"msereferenceout\" is not written", ""),
];

impl Parser<'_> {
    /// `Option`
    pub(super) fn option(&mut self, head: Token) -> Result<(), Reported> {
        let given = self.input.params()?;
        let at = self.input.lexer.span(head);
        if given.is_empty() {
            self.input.error(at, "Option needs one parameter such as \"integer seed\" 1");
            return Err(Reported);
        }
        let mut params = Params::new();
        for param in given {
            // As pbrt-v4 reads them: "disablePixelJitter" is one of them.
            let name = param.name.replace(['_', '-'], "").to_ascii_lowercase();
            match OPTION.params.iter().any(|spec| spec.name == name) {
                true => params.push(Param { name, ..param }),
                false => {
                    let known = OPTION.params.iter().map(|spec| spec.name);
                    self.input.diagnostics.unknown(param.at, "option", &param.name, known);
                }
            }
        }
        let node = Node { kind: OPTION.name.to_owned(), params, at: at.into() };
        let args = Args::check(&node, OPTION, &[], self.input.diagnostics);
        if !args.is_sound() {
            return Ok(());
        }
        let desc = &mut *self.world.desc;
        let options = &mut desc.options;
        let flags = [
            ("disablepixeljitter", &mut options.disable_pixel_jitter),
            ("disabletexturefiltering", &mut options.disable_texture_filtering),
            ("disablewavelengthjitter", &mut options.disable_wavelength_jitter),
            ("forcediffuse", &mut options.force_diffuse),
        ];
        for (name, into) in flags {
            if args.is_set(name) {
                *into = args.bool(name);
            }
        }
        if args.is_set("displacementedgescale") {
            options.displacement_edge_scale = Some(args.float("displacementedgescale"));
        }
        if args.is_set("seed") {
            desc.film.seed = Some(u64::from(args.int("seed") as u32));
        }
        for (name, severity, message, hint) in REMARKS {
            let Some(param) = node.params.get(name) else { continue };
            if param.data == Data::Bools(vec![false]) || !self.first_time(name) {
                continue;
            }
            let said = match severity {
                Severity::Note => self.input.diagnostics.note(param.at.clone(), message),
                _ => self.input.diagnostics.warning(param.at.clone(), message),
            };
            if !hint.is_empty() {
                said.hint(hint);
            }
        }
        Ok(())
    }
}
