//! Bidirectional path tracing: a walk from the eye, a particle's from a light, and every edge between the two.
//!
//! `L = sum over s, t of w_{s,t} C_{s,t}` (Veach and Guibas 1994; Veach 1997, chapter 10; Lafortune and Willems 1993): with
//! `s` vertices from the light and `t` from the eye, the camera among them. `s = 0`: the eye's walk meets the light; `s = 1`:
//! a vertex asks for a light as paths do; `t = 1`: a particle is seen by the camera, in a pixel that need not be that of
//! the sample. Each counts by what the others could have found as well (`weight.rs`).
//!
//! Light that sharp surfaces both bring to a diffuse one and show it by is found by none of these but from lights with
//! extent, by luck: a lamp in glass seen in a mirror.
mod eye;
mod glow;
mod joint;
mod weight;

use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Integrator, LIGHT_SAMPLER, PATH_DEPTH, Particles, ROULETTE_DEPTH, Start, Transport,
    below::Descent,
    vertices::Stamina,
    walk::{Rules, Walk},
};
use crate::{
    Contribution, LightSampler, PathRay, SampleCx,
    probe::{Probe, RayKind, TreeNode},
};
use eye::EyeWalk;

/// Which ways to find a path count, and how much.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ways {
    /// All, by their shares.
    All,
    /// This one alone, with vertices from light and eye, by its share.
    Shared([usize; 2]),
    /// This one alone, as if there were no other.
    Alone([usize; 2]),
}

/// The bidirectional path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bidirectional {
    rules: Rules,
    light_sampler: LightSampler,
    roulette_depth: u32,
    ways: Ways,
}

impl Kind for Bidirectional {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "bdpt",
        aliases: &[],
        doc: "Bidirectional path tracing: walks from the eye and from a light, joined in every way, through fog and smoke as \
              well. Finds caustics and light around corners that paths look for in vain.",
        params: &[
            PATH_DEPTH,
            LIGHT_SAMPLER,
            ROULETTE_DEPTH,
            ParamSpec::new(
                "strategy",
                ParamType::Text,
                ParamDefault::Unset,
                "Only paths of so many vertices from the light and from the eye, the camera among them: \"s,t\". For those who \
                 want to see what each way finds.",
            ),
            ParamSpec::new(
                "weighted",
                ParamType::Bool,
                ParamDefault::Bool(true),
                "What one strategy finds counts by its share among all; else as if it were the only one.",
            ),
            OF_PBRT[0],
            OF_PBRT[1],
            OF_PBRT[2],
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let rules = Rules { max_depth: args.int("maxdepth") as u32, ..Rules::PATH };
        let light_sampler = LightSampler::from_word(args.text("lightsampler"))?;
        let roulette_depth = args.int("roulettedepth") as u32;
        let ways = ways(args)?;
        for ParamSpec { name, .. } in OF_PBRT {
            if args.bool(name) {
                args.warning(
                    name,
                    format!("\"{name}\" has no effect; \"strategy\" shows what one strategy finds"),
                );
            }
        }
        Some(Box::new(Self { rules, light_sampler, roulette_depth, ways }))
    }
}

/// Parameters that pbrt-v4 takes.
const OF_PBRT: [ParamSpec; 3] = {
    const fn of(name: &'static str) -> ParamSpec {
        ParamSpec::new(
            name,
            ParamType::Bool,
            ParamDefault::Bool(false),
            "Taken as pbrt-v4 takes it; without effect.",
        )
    }
    [of("regularize"), of("visualizestrategies"), of("visualizeweights")]
};

/// The parameters `strategy` and `weighted`.
fn ways(args: &mut Args<'_>) -> Option<Ways> {
    if !args.is_set("strategy") {
        if args.is_set("weighted") && !args.bool("weighted") {
            args.error(
                "weighted",
                "\"weighted\" false needs a \"strategy\": all together count by their shares",
            );
            return None;
        }
        return Some(Ways::All);
    }
    let text = args.text("strategy").to_owned();
    let numbers: Vec<usize> = text.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [s, t] if t > 0 && s + t >= 2 && (s, t) != (1, 1) => {
            Some(if args.bool("weighted") { Ways::Shared([s, t]) } else { Ways::Alone([s, t]) })
        }
        _ => {
            let message = format!(
                "\"strategy\" is \"{text}\", expected \"s,t\": vertices from the light (0 or more) and from the eye (1 or \
                 more), 2 or more in all and not \"1,1\""
            );
            args.error("strategy", message);
            None
        }
    }
}

impl Ways {
    /// What a path that was found with `s` and `t` vertices counts for, if its share is asked for.
    fn weight(self, s: usize, t: usize, share: impl FnOnce() -> f32) -> f32 {
        match self {
            Self::All => share(),
            Self::Shared(own) if own == [s, t] => share(),
            Self::Alone(own) if own == [s, t] => 1.0,
            Self::Shared(_) | Self::Alone(_) => 0.0,
        }
    }
}

impl Transport for Bidirectional {
    fn depth_limit(&self) -> Option<u32> {
        Some(self.rules.max_depth)
    }
    fn walks(&self) -> bool {
        true
    }
    fn particles(&self) -> Particles {
        Particles::Some
    }
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let (Start::Eye(ray) | Start::Again(TreeNode { path: ray, .. })) = start;
        let ray = PathRay { media: cx.scene.start, ..*ray };
        let mut walk = Walk::in_media(&self.rules, cx, probe, Descent::Adjoint);
        let stamina = Stamina { vertices: self.rules.max_depth, sure: self.roulette_depth };
        let id = walk.probe.ray(parent, &ray, RayKind::Eye);
        let particle = walk.particle(&ray, stamina, id);
        let (origin, vertices) = (ray.ray.o, stamina.room());
        let mut eye = EyeWalk { own: self, walk, particle: particle.as_ref(), origin, vertices };
        eye.splat(id, out);
        eye.trace(ray, id, out);
        out.rays = eye.walk.rays;
        out.imbalances = eye.walk.imbalances;
    }
}
