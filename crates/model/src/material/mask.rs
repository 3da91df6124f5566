//! A material with parts that are not there: leaves, lace, fences. What pbrt's parameter `alpha` of shapes becomes.
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Interface, MATERIALS, Material, mix::Mix};

/// The word `mask`.
#[derive(Debug)]
pub struct Mask;

impl Kind for Mask {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "mask",
        aliases: &[],
        doc: "Another material where it is there; elsewhere rays pass as if nothing were. It also dims the light of a shape.",
        params: &[
            ParamSpec::new(
                "material",
                ParamType::Text,
                ParamDefault::Required,
                "Name of a material that is described before this one.",
            ),
            ParamSpec::float_texture("alpha", 1.0, "Share of the surface that is there.").range(0.0, 1.0),
            ParamSpec::new(
                "alphamode",
                ParamType::Choice(&["blend", "mask"]),
                ParamDefault::Text("blend"),
                "Whether what is there in part lets the rest of light pass, or all is there or nothing.",
            ),
            ParamSpec::float("alphacutoff", 0.5, "With mask: holes are where alpha is below this.")
                .range(0.0, 1e6),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let cutoff = (args.text("alphamode") == "mask").then(|| args.float("alphacutoff"));
        let word = args.text("material");
        let material = args.build_named("material", word, MATERIALS);
        let alpha = args.float_input("alpha");
        Some(Box::new(Mix::new([Box::new(Interface), material?], alpha, cutoff)))
    }
}
