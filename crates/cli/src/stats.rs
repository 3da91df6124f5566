//! What a render did, as a line, a table or JSON.
use std::{fmt::Write, time::Duration};

use clap::ValueEnum;
use durer::{
    Id, ImbalanceTotals, Prepared, Rendered,
    probe::{Counters, RayKind, StopReason},
};
use serde::Serialize;
use serde_json::{Map, Value};

use crate::number::{bytes, count, counted, seconds};

/// How statistics are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StatsForm {
    /// A table on stderr.
    Text,
    /// An object on stdout.
    Json,
}

/// Wall time per phase.
#[derive(Clone, Copy, Default)]
pub(crate) struct Seconds {
    pub(crate) load: Duration,
    pub(crate) build: Duration,
    pub(crate) render: Duration,
    pub(crate) write: Duration,
}

/// What statistics are made of.
pub(crate) struct Facts<'a> {
    pub(crate) scene: &'a str,
    pub(crate) prepared: &'a Prepared,
    pub(crate) rendered: &'a Rendered,
    pub(crate) seconds: Seconds,
    pub(crate) outputs: &'a [String],
}

/// The statistics. Field names are the keys of the JSON form: a contract.
#[derive(Serialize)]
pub(crate) struct Stats<'a> {
    version: u32,
    durer: &'static str,
    scene: &'a str,
    integrator: &'a str,
    width: u32,
    height: u32,
    spp: u32,
    seed: u64,
    threads: usize,
    outputs: &'a [String],
    interrupted: bool,
    samples: u64,
    /// Null unless antialiasing is adaptive.
    adaptive: Option<Adaptive>,
    bad_samples: u64,
    first_bad: Option<Bad>,
    imbalances: Imbalances<'a>,
    seconds: Phases,
    rays: Rays,
    /// Why rays ended, by reason.
    stops: Map<String, Value>,
    tests: Tests,
    max_depth: u32,
    build: Build,
}

#[derive(Serialize)]
struct Adaptive {
    /// Rays through corners of pixels.
    corners: u64,
    /// Squares split, by how often they had been split before.
    splits: Vec<u64>,
    /// Rays traced to their first hit in search of small objects; not among the rays counted elsewhere.
    searches: u64,
}

#[derive(Serialize)]
struct Bad {
    pixel: [u32; 2],
    sample: u32,
}

/// Rays that left transparent bodies which they were not in.
#[derive(Serialize)]
struct Imbalances<'a> {
    objects: Vec<Imbalanced<'a>>,
    elsewhere: u64,
    too_deep: u64,
}

#[derive(Serialize)]
struct Imbalanced<'a> {
    object: &'a str,
    rays: u64,
}

#[derive(Serialize)]
struct Phases {
    load: f64,
    build: f64,
    render: f64,
    write: f64,
}

#[derive(Serialize)]
struct Rays {
    all: u64,
    per_second: f64,
    by_kind: Map<String, Value>,
}

#[derive(Serialize)]
struct Tests {
    boxes: u64,
    primitives: u64,
    boxes_per_ray: f64,
    primitives_per_ray: f64,
}

#[derive(Serialize)]
struct Build {
    triangles: u64,
    shapes: u64,
    instances: u64,
    nodes: u64,
    bytes: u64,
    max_depth: u32,
}

impl<'a> Stats<'a> {
    /// Counts that were not gathered are zero or missing.
    pub(crate) fn new(facts: &Facts<'a>) -> Self {
        let Facts { scene, prepared, rendered, seconds, outputs } = *facts;
        let counters = rendered.counters.clone().unwrap_or_default();
        let (settings, view) = (&prepared.settings, &prepared.scene.view);
        let Seconds { load, build, render, write } = seconds;
        let built = prepared.scene.accel.stats();
        Self {
            version: 1,
            durer: env!("CARGO_PKG_VERSION"),
            scene,
            integrator: &prepared.integrator_name,
            width: view.width,
            height: view.height,
            spp: settings.samples,
            seed: settings.seed,
            threads: settings.threads,
            outputs,
            interrupted: rendered.cancelled,
            samples: rendered.samples,
            adaptive: rendered.splits.as_ref().map(|s| Adaptive {
                corners: s.corners,
                splits: s.by_level.to_vec(),
                searches: s.searches,
            }),
            bad_samples: rendered.bad_samples,
            first_bad: rendered.first_bad.map(|b| Bad { pixel: b.pixel, sample: b.sample }),
            imbalances: Imbalances::new(facts),
            seconds: Phases {
                load: load.as_secs_f64(),
                build: build.as_secs_f64(),
                render: render.as_secs_f64(),
                write: write.as_secs_f64(),
            },
            rays: Rays {
                all: rendered.rays,
                per_second: rendered.rays as f64 / render.as_secs_f64().max(1e-9),
                by_kind: RayKind::ALL
                    .map(|k| (k.word().to_owned(), counters.rays(k).into()))
                    .into_iter()
                    .collect(),
            },
            stops: StopReason::ALL
                .map(|r| (r.word().to_owned(), counters.stops(r).into()))
                .into_iter()
                .collect(),
            tests: Tests::new(&counters),
            max_depth: counters.max_depth,
            build: Build {
                triangles: built.triangles,
                shapes: built.user_primitives,
                instances: built.instances,
                nodes: built.nodes,
                bytes: built.bytes,
                max_depth: built.max_depth,
            },
        }
    }

    /// One line.
    pub(crate) fn summary(&self) -> String {
        let Phases { load, build, render, .. } = self.seconds;
        let [load, build, render] = [load, build, render].map(|s| seconds(Duration::from_secs_f64(s)));
        let samples = match self.adaptive {
            None => format!("{} spp", self.spp),
            Some(_) => format!("{} samples, adaptive", count(self.samples)),
        };
        let state = if self.interrupted { " (interrupted)" } else { "" };
        format!(
            "{}: {} x {}, {samples}, {}{state}; load {load}, build {build}, render {render}; {} rays, {:.2} Mrays/s",
            self.scene,
            self.width,
            self.height,
            self.integrator,
            count(self.rays.all),
            self.rays.per_second / 1e6,
        )
    }

    /// A table.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{}\n", self.summary());
        let mut row = |name: &str, value: String| {
            let _ = writeln!(text, "  {name:<34} {value:>12}");
        };
        row("samples", count(self.samples));
        if let Some(adaptive) = &self.adaptive {
            row("samples at corners of pixels", count(adaptive.corners));
            for (level, &splits) in adaptive.splits.iter().enumerate().filter(|(_, splits)| **splits > 0) {
                row(&format!("splits, level {level}"), count(splits));
            }
            row("searches for small objects", count(adaptive.searches));
        }
        row("bad samples", count(self.bad_samples));
        for found in &self.imbalances.objects {
            row(&format!("left unentered, {}", found.object), count(found.rays));
        }
        for (kind, n) in &self.rays.by_kind {
            row(&format!("rays, {kind}"), count(n.as_u64().unwrap_or(0)));
        }
        for (reason, n) in &self.stops {
            row(&format!("stops, {reason}"), count(n.as_u64().unwrap_or(0)));
        }
        row("deepest ray", counted(self.max_depth.into(), "bounce", "bounces"));
        row("box tests per ray", format!("{:.2}", self.tests.boxes_per_ray));
        row("primitive tests per ray", format!("{:.2}", self.tests.primitives_per_ray));
        row("triangles", count(self.build.triangles));
        row("shapes that are no mesh", count(self.build.shapes));
        row("instances", count(self.build.instances));
        row("nodes", count(self.build.nodes));
        row("depth of the hierarchy", self.build.max_depth.to_string());
        row("memory of the hierarchy", bytes(self.build.bytes));
        let Phases { load, build, render, write } = self.seconds;
        for (phase, s) in [("load", load), ("build", build), ("render", render), ("write", write)] {
            row(&format!("time, {phase}"), seconds(Duration::from_secs_f64(s)));
        }
        text
    }
}

impl<'a> Imbalances<'a> {
    fn new(facts: &Facts<'a>) -> Self {
        let ImbalanceTotals { objects, elsewhere, too_deep } = &facts.rendered.imbalances;
        let name = |number: u32| facts.prepared.scene.object(Id::new(number)).name.as_str();
        let objects = objects.iter().map(|(object, rays)| Imbalanced { object: name(*object), rays: *rays });
        Self { objects: objects.collect(), elsewhere: *elsewhere, too_deep: *too_deep }
    }
}

impl Tests {
    fn new(counters: &Counters) -> Self {
        let rays = counters.all_rays().max(1) as f64;
        Self {
            boxes: counters.node_tests,
            primitives: counters.primitive_tests,
            boxes_per_ray: counters.node_tests as f64 / rays,
            primitives_per_ray: counters.primitive_tests as f64 / rays,
        }
    }
}
