//! The bill as JSON; `durer cost --help` documents it.
use durer::{
    accel::Engine,
    cost::{Factors, Method},
};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct Bill<'a> {
    version: u32,
    scene: &'a str,
    integrator: &'a str,
    width: u32,
    height: u32,
    samples: u32,
    accel: &'static str,
    primitives: u64,
    predicted: Sum,
    measured: Option<Sum>,
    alternatives: Vec<Alternative>,
    cut_first: Vec<Advice>,
}

#[derive(Serialize)]
struct Sum {
    #[serde(skip_serializing_if = "Option::is_none")]
    method: Option<&'static str>,
    primitive_tests: serde_json::Number,
    box_tests: serde_json::Number,
    rays: serde_json::Number,
    seconds: f64,
    factors: Terms,
}

#[derive(Serialize)]
struct Terms {
    height: f64,
    width: f64,
    primitives: f64,
    intersection_ns: f64,
    tree: f64,
    shadow: f64,
    supersamples: f64,
    gloss: f64,
    temporal: f64,
    focal: f64,
}

#[derive(Serialize)]
struct Alternative {
    accel: &'static str,
    sampling: Option<&'static str>,
    rays: serde_json::Number,
    primitive_tests: serde_json::Number,
    box_tests: serde_json::Number,
    seconds: f64,
}

#[derive(Serialize)]
struct Advice {
    factor: &'static str,
    saves: f64,
    how: &'static str,
}

/// The word of an engine, as `--accel` has it.
pub(super) fn engine_word(engine: Engine) -> &'static str {
    match engine {
        Engine::Bvh => "bvh",
        Engine::BruteForce => "none",
    }
}

/// The nearest whole number.
fn whole(value: f64) -> serde_json::Number {
    (value.round() as u64).into()
}

impl<'a> Bill<'a> {
    pub(super) fn new(bill: &super::Bill<'a>) -> Self {
        let super::Bill { scene, prepared, predicted, measured, alternatives, advice } = bill;
        let window = prepared.window();
        Self {
            version: 1,
            scene,
            integrator: &prepared.integrator_name,
            width: window.x1 - window.x0,
            height: window.y1 - window.y0,
            samples: prepared.settings.samples,
            accel: engine_word(prepared.scene.accel.engine()),
            primitives: predicted.primitives,
            predicted: Sum {
                method: Some(match predicted.method {
                    Method::Parameters(_) => "parameters",
                    Method::Probe { .. } => "probe",
                }),
                primitive_tests: whole(predicted.factors.primitive_tests()),
                box_tests: whole(predicted.box_tests),
                rays: whole(predicted.factors.rays()),
                seconds: predicted.factors.seconds(),
                factors: Terms::new(&predicted.factors),
            },
            measured: measured.as_ref().map(|m| Sum {
                method: None,
                primitive_tests: m.primitive_tests.into(),
                box_tests: m.box_tests.into(),
                rays: m.rays.into(),
                seconds: m.factors.seconds(),
                factors: Terms::new(&m.factors),
            }),
            alternatives: alternatives
                .iter()
                .map(|a| Alternative {
                    accel: engine_word(a.engine),
                    sampling: a.sampling.map(|s| s.word()),
                    rays: whole(a.factors.rays()),
                    primitive_tests: whole(a.factors.primitive_tests()),
                    box_tests: whole(a.box_tests),
                    seconds: a.factors.seconds(),
                })
                .collect(),
            cut_first: advice
                .iter()
                .map(|a| Advice { factor: a.factor, saves: a.saves, how: a.how })
                .collect(),
        }
    }
}

impl Terms {
    fn new(f: &Factors) -> Self {
        Self {
            height: f.height,
            width: f.width,
            primitives: f.primitives,
            intersection_ns: f.intersection * 1e9,
            tree: f.tree,
            shadow: f.shadow,
            supersamples: f.supersamples,
            gloss: f.gloss,
            temporal: f.temporal,
            focal: f.focal,
        }
    }
}
