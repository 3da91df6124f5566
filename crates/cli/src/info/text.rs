//! The facts to read.
use std::{fmt::Write, time::Duration};

use durer::{Imported, scene::Severity};

use super::{
    facts::{Counts, Info, Named, Phases},
    memory::Memory,
    texture::TextureFacts,
};
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
    shapes(&info.counts, &mut row);
    if let Some(b) = &info.bounds {
        row("bounds", format!("{} to {}", place(b.min), place(b.max)));
    }
    row("textures", textures(&info.textures));
    row("cameras", names(&info.cameras));
    row("lights", names(&info.lights));
    row("materials", names(&info.materials));
    row("film", film(info));
    row("integrator", info.integrator.unwrap_or("not said").to_owned());
    if let Some(m) = &info.memory {
        row("memory", memory(m));
    }
    row("time", time(&info.seconds));
    let c = &info.complaints;
    row("complaints", format!("{} errors, {} warnings, {} notes", c.errors, c.warnings, c.notes));
    match info.doctor.as_slice() {
        [] => row("doctor", "nothing odd found".to_owned()),
        findings => findings.iter().for_each(|f| row("doctor", f.clone())),
    }
    let complaints = report::render(info.scene, imported, Severity::Note, Looks::PLAIN);
    if complaints.is_empty() { text } else { format!("{text}\n{complaints}") }
}

fn shapes(c: &Counts, row: &mut impl FnMut(&str, String)) {
    let of = |n: Option<u64>| n.map_or_else(|| "?".to_owned(), count);
    let meshes = format!("{} meshes", c.meshes);
    row(
        "shapes",
        format!("{} ({} moving, {} no meshes), {meshes}", c.shapes, c.moving_shapes, of(c.other_shapes)),
    );
    let [placed, described] = [c.triangles_placed, c.triangles_described].map(of);
    row("triangles", format!("{placed}, of these {described} different; {} vertices", of(c.vertices)));
    let [triangles, instances, nodes] = [c.triangles, c.instances, c.nodes].map(of);
    row("kernel", format!("{triangles} triangles, {instances} instances, {nodes} nodes"));
}

fn memory(m: &Memory) -> String {
    let [hierarchy, expected] = [m.hierarchy, m.hierarchy_expected].map(bytes);
    let [meshes, placed, textures, film] = [m.meshes, m.meshes_placed, m.textures, m.film].map(bytes);
    let peak = m.peak.map(|peak| format!("; {} at most so far", bytes(peak))).unwrap_or_default();
    format!(
        "hierarchy {hierarchy} (expected {expected}), meshes {meshes} and {placed} placed, textures {textures}, \
         film {film}{peak}"
    )
}

fn time(s: &Phases) -> String {
    let shown = |s: f64| seconds(Duration::from_secs_f64(s));
    let parts = [("textures", s.textures), ("geometry", s.geometry), ("acceleration", s.acceleration)];
    let parts = parts.iter().filter_map(|(name, s)| s.map(|s| format!("{name} {}", shown(s))));
    let parts = parts.collect::<Vec<_>>().join(", ");
    format!("load {}, build {} ({parts}), total {}", shown(s.load), shown(s.build), shown(s.total))
}

fn textures(list: &[TextureFacts<'_>]) -> String {
    listed(list, |t| {
        let size = t.width.zip(t.height).map(|(w, h)| format!(" {w} x {h}"));
        let image = t.image.filter(|image| *image != t.name).map(|image| format!(" {image}"));
        format!("{} ({}{}{})", t.name, t.kind, image.unwrap_or_default(), size.unwrap_or_default())
    })
}

fn place(p: [f64; 3]) -> String {
    p.map(|v| crate::number::significant(v as f32, 5)).join(" ")
}

fn names(list: &[Named<'_>]) -> String {
    listed(list, |n| if n.name.is_empty() { n.kind.to_owned() } else { format!("{} ({})", n.name, n.kind) })
}

/// How many there are, and the first of them.
fn listed<T>(list: &[T], one: impl Fn(&T) -> String) -> String {
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
