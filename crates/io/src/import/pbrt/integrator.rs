//! Integrators of pbrt-v4 that durer has not, but another one that tends to the same picture.
use durer_scene::{
    Args, Data, Diagnostics, Location, Node, Param, ParamDefault, ParamSpec, ParamType, Params, Schema,
    ValueType,
};

/// Where a path ends; the same in all of them.
const DEPTH: ParamSpec =
    ParamSpec::new("maxdepth", ParamType::Int, ParamDefault::Int(5), "surfaces that a path meets")
        .range(0.0, 1e9);
const fn choice(name: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Bool, ParamDefault::Bool(true), "no effect but noise")
}
const fn number(name: &'static str, ty: ParamType) -> ParamSpec {
    ParamSpec::new(name, ty, ParamDefault::Unset, "no effect but noise")
}

/// What is asked for, ours, and where the pictures of the two differ, if they do.
struct Like {
    schema: Schema,
    ours: &'static str,
    but: &'static str,
}

const LIKE: [Like; 4] = [
    Like {
        schema: Schema {
            name: "simplepath",
            aliases: &[],
            doc: "paths without weights of several ways",
            params: &[DEPTH, choice("samplelights"), choice("samplebsdf")],
        },
        ours: "path",
        but: "",
    },
    Like {
        schema: Schema {
            name: "randomwalk",
            aliases: &[],
            doc: "paths that meet lights by luck",
            params: &[DEPTH],
        },
        ours: "path",
        but: "; lights without extent, which pbrt's never meets, shine",
    },
    Like {
        schema: Schema { name: "simplevolpath", aliases: &[], doc: "paths in media", params: &[DEPTH] },
        ours: "volpath",
        but: "; surfaces, at which pbrt's stops, scatter light",
    },
    Like {
        schema: Schema {
            name: "mlt",
            aliases: &[],
            doc: "mutations of paths from both ends",
            params: &[
                DEPTH,
                number("bootstrapsamples", ParamType::Int),
                number("chains", ParamType::Int),
                number("mutationsperpixel", ParamType::Int),
                number("largestepprobability", ParamType::Float),
                number("sigma", ParamType::Float),
                ParamSpec::new("regularize", ParamType::Bool, ParamDefault::Bool(false), "as of bdpt"),
            ],
        },
        ours: "bdpt",
        but: ", without mutations: the sampler says how many samples are taken",
    },
];

/// The integrator of ours that tends to the same picture as this one, which a note tells; itself if it is not among these.
pub(super) fn mapped(node: Node, diagnostics: &mut Diagnostics) -> Node {
    let Some(like) = LIKE.iter().find(|like| like.schema.name == node.kind) else { return node };
    let args = Args::check(&node, like.schema, &[], diagnostics);
    let depth = args.int(DEPTH.name);
    let of = node.params.get(DEPTH.name).map_or(Location::None, |p| p.at.clone());
    let mut params = Params::new();
    params.push(Param {
        name: DEPTH.name.to_owned(),
        ty: ValueType::Integer,
        data: Data::Ints(vec![depth]),
        at: of,
    });
    if let Some(regularize) = node.params.get("regularize") {
        params.push(regularize.clone());
    }
    let message = format!(
        "integrator \"{}\" is drawn by \"{}\", which tends to the same picture{}",
        node.kind, like.ours, like.but
    );
    match like.but {
        "" => diagnostics.note(node.at.clone(), message),
        _ => diagnostics.warning(node.at.clone(), message),
    };
    Node { kind: like.ours.to_owned(), params, ..node }
}
