//! The facts to read.
use std::{fmt::Write, time::Duration};

use durer::{Imported, scene::Severity};

use super::{Info, Named};
use crate::{
    number::{bytes, count, seconds},
    report::{self, Looks},
};

/// How many names are listed before the rest is counted.
const MOST_NAMES: usize = 12;

pub(super) fn table(info: &Info<'_>, imported: &Imported) -> String {
    let mut text = String::new();
    let mut row = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12} {value}");
    };
    row("scene", info.scene.to_owned());
    row("format", info.format.unwrap_or("unknown").to_owned());
    let c = &info.counts;
    row("shapes", format!("{} ({} moving), {} meshes", c.shapes, c.moving_shapes, c.meshes));
    let of = |n: Option<u64>| n.map_or_else(|| "?".to_owned(), count);
    row(
        "kernel",
        format!("{} triangles, {} instances, {} nodes", of(c.triangles), of(c.instances), of(c.nodes)),
    );
    if let Some(b) = &info.bounds {
        row("bounds", format!("{} to {}", place(b.min), place(b.max)));
    }
    row("textures", c.textures.to_string());
    row("cameras", names(&info.cameras));
    row("lights", names(&info.lights));
    row("materials", names(&info.materials));
    row("film", film(info));
    row("integrator", info.integrator.unwrap_or("not said").to_owned());
    if let Some(m) = &info.memory {
        let (hierarchy, meshes, film) = (bytes(m.hierarchy), bytes(m.meshes), bytes(m.film));
        row("memory", format!("about {hierarchy} hierarchy, {meshes} meshes, {film} film"));
    }
    let [load, build] = [info.seconds.load, info.seconds.build].map(|s| seconds(Duration::from_secs_f64(s)));
    row("time", format!("load {load}, build {build}"));
    match info.doctor.as_slice() {
        [] => row("doctor", "nothing odd found".to_owned()),
        findings => findings.iter().for_each(|f| row("doctor", f.clone())),
    }
    let complaints = report::render(imported, Severity::Note, Looks::PLAIN);
    if complaints.is_empty() { text } else { format!("{text}\n{complaints}") }
}

fn place(p: [f64; 3]) -> String {
    p.map(|v| crate::number::significant(v as f32, 5)).join(" ")
}

fn names(list: &[Named<'_>]) -> String {
    let one = |n: &Named<'_>| {
        if n.name.is_empty() { n.kind.to_owned() } else { format!("{} ({})", n.name, n.kind) }
    };
    let mut text = list.iter().take(MOST_NAMES).map(one).collect::<Vec<_>>().join(", ");
    if list.len() > MOST_NAMES {
        let _ = write!(text, ", and {} more", list.len() - MOST_NAMES);
    }
    if list.is_empty() { "none".to_owned() } else { format!("{}: {text}", list.len()) }
}

fn film(info: &Info<'_>) -> String {
    let f = &info.film;
    let of = |n: Option<u32>| n.map_or_else(|| "?".to_owned(), |n| n.to_string());
    let filename = f.filename.map(|n| format!(", to be written to {n}")).unwrap_or_default();
    match (f.width, f.height, f.spp) {
        (None, None, None) => format!("not said{filename}"),
        (w, h, spp) => format!("{} x {}, {} samples per pixel{filename}", of(w), of(h), of(spp)),
    }
}
