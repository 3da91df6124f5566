//! The facts to read.
use std::{
    collections::{BTreeSet, HashMap},
    fmt::Write,
    time::Duration,
};

use durer::{
    Imported,
    scene::{SceneDesc, Severity, ShapeSource},
};

use super::{
    camera::CameraFacts,
    facts::{AnimationFacts, Complaints, Counts, Info, Named, Phases, WorldBounds},
    memory::Memory,
    texture::TextureFacts,
};
use crate::{
    number::{bytes, count, counted, seconds, significant},
    report::{self, Looks},
};

/// How much is listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// The first of many.
    Brief,
    /// Everything, and what the kernel holds.
    Full,
}

impl Detail {
    /// How many names stand in a row.
    fn names(self) -> usize {
        if self == Self::Full { usize::MAX } else { 12 }
    }
    /// How many things have a line each.
    fn lines(self) -> usize {
        if self == Self::Full { usize::MAX } else { 20 }
    }
}

pub(super) fn table(info: &Info<'_>, imported: &Imported, detail: Detail) -> String {
    let mut text = String::new();
    let mut row = |name: &str, lines: Vec<String>| {
        for (index, line) in lines.into_iter().enumerate() {
            let _ = writeln!(text, "{:<12} {line}", if index == 0 { name } else { "" });
        }
    };
    row("scene", vec![info.scene.to_owned()]);
    row("format", vec![info.format.unwrap_or("unknown").to_owned()]);
    row("shapes", vec![shapes(&info.counts, &imported.desc)]);
    row("triangles", triangles(&info.counts));
    row("bounds", info.bounds.iter().map(|b| bounds(b, largest(info))).collect());
    row("textures", textures(&info.textures, detail));
    row("cameras", cameras(info, detail));
    row("lights", vec![names(&info.lights, detail)]);
    row("materials", vec![names(&info.materials, detail)]);
    row("animations", animations(info, detail));
    row("variants", variants(info, detail));
    row("picture", picture(info));
    row("integrator", integrator(info));
    row("memory", info.memory.as_ref().map(memory).unwrap_or_default());
    if detail == Detail::Full {
        row("hierarchy", vec![hierarchy(info)]);
    }
    row("time", vec![time(&info.seconds)]);
    row("diagnostics", vec![diagnostics(&info.complaints)]);
    let complaints = report::render(info.scene, imported, Severity::Note, Looks::PLAIN);
    if complaints.is_empty() { text } else { format!("{text}\n{complaints}") }
}

/// Name or index, and when.
fn animations(info: &Info<'_>, detail: Detail) -> Vec<String> {
    let line = |(index, animation): (usize, &AnimationFacts<'_>)| {
        let AnimationFacts { name, start, end } = animation;
        let name = if name.is_empty() { format!("{index}") } else { (*name).to_owned() };
        format!("{name}, from {start} s to {end} s")
    };
    cut(info.animations.iter().enumerate().map(line).collect(), detail)
}

fn variants(info: &Info<'_>, detail: Detail) -> Vec<String> {
    let line = |(index, name): (usize, &String)| match name.as_str() {
        "" => index.to_string(),
        name => name.to_owned(),
    };
    cut(info.variants.iter().enumerate().map(line).collect(), detail)
}

/// As many lines as are asked for, and how many more there are.
fn cut(mut lines: Vec<String>, detail: Detail) -> Vec<String> {
    let more = lines.len().saturating_sub(detail.lines());
    lines.truncate(detail.lines());
    if more > 0 {
        lines.push(format!("and {} more", count(more as u64)));
    }
    lines
}

fn shapes(c: &Counts, desc: &SceneDesc) -> String {
    let other = c.other_shapes.unwrap_or(0);
    let placed = (c.shapes as u64).saturating_sub(other);
    let different = c.meshes_different.unwrap_or(placed);
    let mut kinds = Vec::new();
    if placed > different {
        kinds.push(format!("{} placements of {}", count(placed), counted(different, "mesh", "meshes")));
    } else if placed > 0 {
        kinds.push(counted(placed, "mesh", "meshes"));
    }
    if other > 0 {
        kinds.push(format!("{} without mesh{}", counted(other, "shape", "shapes"), words(desc, other)));
    }
    let moving = match (c.shapes, c.moving_shapes as u64) {
        (_, 0) => "",
        (1, _) => ", moving",
        (_, 1) => "; 1 of these moves",
        (_, n) => &format!("; {} of these move", count(n)),
    };
    if kinds.is_empty() { "none".to_owned() } else { kinds.join(", ") + moving }
}

/// The kinds of the shapes that are no meshes, if the file has no others by kind.
fn words(desc: &SceneDesc, other: u64) -> String {
    let kinds: Vec<&str> = desc
        .shapes
        .iter()
        .filter_map(|shape| match &shape.source {
            ShapeSource::Node(node) => Some(node.kind.as_str()),
            ShapeSource::Mesh(_) => None,
        })
        .collect();
    let distinct: BTreeSet<&str> = kinds.iter().copied().collect();
    match kinds.len() as u64 == other {
        true => format!(" ({})", distinct.into_iter().collect::<Vec<_>>().join(", ")),
        false => String::new(),
    }
}

fn triangles(c: &Counts) -> Vec<String> {
    let (Some(placed), Some(stored), Some(vertices)) =
        (c.triangles_placed, c.triangles_described, c.vertices)
    else {
        return Vec::new();
    };
    let vertices = counted(vertices, "vertex", "vertices");
    match (placed, stored) {
        (0, 0) => Vec::new(),
        (placed, stored) if placed == stored => vec![format!("{}, with {vertices}", count(placed))],
        (placed, stored) => {
            vec![format!("{} as placed; {} as stored, with {vertices}", count(placed), count(stored))]
        }
    }
}

fn bounds(b: &WorldBounds, largest: f64) -> String {
    let size: [f64; 3] = std::array::from_fn(|i| b.max[i] - b.min[i]);
    let size = size.map(|v| significant(v as f32, 4)).join(" x ");
    format!("from {} to {}, size {size} (metres)", place(b.min, largest), place(b.max, largest))
}

/// An image or texture a line, with how many textures are the same but for their names.
fn textures(list: &[TextureFacts<'_>], detail: Detail) -> Vec<String> {
    let mut folded = Folded::default();
    for texture in list {
        let line = match (texture.image, texture.width.zip(texture.height)) {
            (Some(image), Some((w, h))) => format!("{image}, {w} x {h} pixels"),
            (Some(image), None) => format!("{image}, not read"),
            (None, _) => format!("{} ({})", texture.name, texture.kind),
        };
        folded.add(line);
    }
    let images = list.iter().filter_map(|t| t.image).collect::<BTreeSet<_>>().len();
    let images =
        if images > 0 { format!(", {}", counted(images as u64, "image", "images")) } else { String::new() };
    let lines = folded.list.into_iter().map(|(line, times)| match times {
        1 => line,
        n => format!("{line}, in {n} textures"),
    });
    headed(format!("{}{images}", list.len()), lines.collect(), detail)
}

fn cameras(info: &Info<'_>, detail: Detail) -> Vec<String> {
    if let ([], Some((position, ahead))) = (info.cameras.as_slice(), info.view) {
        let (at, along) = (place(position, largest(info)), direction(ahead));
        return vec![format!("none; an automatic one frames everything, at {at}, looking along {along}")];
    }
    let lines =
        info.cameras.iter().enumerate().map(|(index, camera)| one_camera(index, camera, largest(info)));
    headed(info.cameras.len().to_string(), lines.collect(), detail)
}

fn one_camera(index: usize, camera: &CameraFacts<'_>, largest: f64) -> String {
    let mut line = format!("{index}  ");
    if !camera.name.is_empty() {
        let _ = write!(line, "{}, ", camera.name);
    }
    let (at, along) = (place(camera.position, largest), direction(camera.direction));
    let _ = write!(line, "{}, at {at}, looking along {along}", camera.kind);
    if let (Some(fov), Some(axis)) = (camera.fov, camera.fov_axis) {
        let axis = match axis {
            "x" => "horizontal",
            "y" => "vertical",
            _ => "of the shorter side",
        };
        let _ = write!(line, ", fov {} deg ({axis})", significant(fov, 4));
    }
    match (camera.used, index) {
        (false, _) => {}
        (true, 0) => line.push_str("  <- default"),
        (true, _) => line.push_str("  <- chosen"),
    }
    line
}

/// A number of things above a line for each.
fn headed(head: String, lines: Vec<String>, detail: Detail) -> Vec<String> {
    if lines.is_empty() {
        return vec!["none".to_owned()];
    }
    let more = lines.len().saturating_sub(detail.lines());
    let mut rows = vec![head];
    rows.extend(lines.into_iter().take(detail.lines()));
    if more > 0 {
        rows.push(format!("... and {more} more (-v lists all)"));
    }
    rows
}

/// Words in the order they came first, each with how often it came.
#[derive(Default)]
struct Folded {
    list: Vec<(String, usize)>,
    known: HashMap<String, usize>,
}

impl Folded {
    fn add(&mut self, word: String) {
        match self.known.get(&word) {
            Some(&at) => self.list[at].1 += 1,
            None => {
                self.known.insert(word.clone(), self.list.len());
                self.list.push((word, 1));
            }
        }
    }
}

/// Names in a row, those without one by their kinds with how many there are.
fn names(list: &[Named<'_>], detail: Detail) -> String {
    let mut folded = Folded::default();
    for n in list {
        match n.name.is_empty() {
            true => folded.add(n.kind.to_owned()),
            false => folded.list.push((format!("{} ({})", n.name, n.kind), 1)),
        }
    }
    let folded = folded.list;
    let more = folded.len().saturating_sub(detail.names());
    let words = folded.into_iter().take(detail.names()).map(|(word, times)| match times {
        1 => word,
        n => format!("{n} x {word}"),
    });
    let mut text = words.collect::<Vec<_>>().join(", ");
    if more > 0 {
        let _ = write!(text, ", ... and {more} more (-v lists all)");
    }
    if list.is_empty() { "none".to_owned() } else { format!("{}: {text}", list.len()) }
}

fn picture(info: &Info<'_>) -> Vec<String> {
    let Some(used) = &info.render else { return Vec::new() };
    let f = &info.film;
    let origin = |said: bool| if said { "" } else { " by default" };
    let size = format!("{} x {} pixels{}", used.width, used.height, origin(f.width.or(f.height).is_some()));
    let spp = counted(used.spp.into(), "sample per pixel", "samples per pixel");
    let filename = f.filename.map(|name| format!("; the file calls it {name}")).unwrap_or_default();
    vec![format!("{size}, {spp}{}{filename}", origin(f.spp.is_some()))]
}

fn integrator(info: &Info<'_>) -> Vec<String> {
    let Some(used) = &info.render else { return Vec::new() };
    vec![match info.integrator {
        None => format!("{} by default", used.integrator),
        Some(asked) if asked == used.integrator => asked.to_owned(),
        Some(asked) => format!("{}; the file asks for {asked}", used.integrator),
    }]
}

fn memory(m: &Memory) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = |n: u64, what: &str, remark: String| {
        if n > 0 {
            lines.push(format!("{:<23} {:>10}{remark}", what, bytes(n)));
        }
    };
    line(m.meshes + m.meshes_placed, "scene geometry", String::new());
    line(m.textures, "textures", String::new());
    line(m.measured, "measured materials", String::new());
    let [kept, building] = [m.hierarchy_expected, m.hierarchy_building].map(bytes);
    let estimated = format!("  (estimated: {kept}, while it is built: {building})");
    line(m.hierarchy, "acceleration structure", estimated);
    line(m.film, "picture", "  (once rendering begins)".to_owned());
    line(m.peak.unwrap_or(0), "peak of the process", "  (until now, without the picture)".to_owned());
    lines
}

fn hierarchy(info: &Info<'_>) -> String {
    let c = &info.counts;
    let of = |n: Option<u64>, one, many| counted(n.unwrap_or(0), one, many);
    format!(
        "{}, {}, {}, walked with {}",
        of(c.triangles, "triangle", "triangles"),
        of(c.instances, "instance", "instances"),
        of(c.nodes, "node", "nodes"),
        info.isa.unwrap_or("nothing")
    )
}

fn time(s: &Phases) -> String {
    let shown = |s: f64| seconds(Duration::from_secs_f64(s));
    let parts =
        [("textures", s.textures), ("geometry", s.geometry), ("acceleration structure", s.acceleration)];
    // What takes no time is not worth a word.
    let parts = parts.iter().filter_map(|(name, s)| Some((name, s.filter(|s| *s >= 5e-5)?)));
    let parts = parts.map(|(name, s)| format!("{name} {}", shown(s)));
    let parts = parts.collect::<Vec<_>>().join(", ");
    let parts = if parts.is_empty() { parts } else { format!(" ({parts})") };
    format!("load {}, build {}{parts}, total {}", shown(s.load), shown(s.build), shown(s.total))
}

fn diagnostics(c: &Complaints) -> String {
    let parts =
        [(c.errors, "error", "errors"), (c.warnings, "warning", "warnings"), (c.notes, "note", "notes")];
    let parts = parts.into_iter().filter(|(n, ..)| *n > 0);
    let parts: Vec<String> = parts.map(|(n, one, many)| counted(n as u64, one, many)).collect();
    if parts.is_empty() { "none: nothing odd was found".to_owned() } else { parts.join(", ") }
}

/// A point of a scene whose coordinates are so large at most: what is finer is rounding.
fn place(p: [f64; 3], largest: f64) -> String {
    let step = 10f64.powi(largest.max(f64::MIN_POSITIVE).log10().floor() as i32 - 5);
    // Adding 0 makes a positive zero of a negative one.
    p.map(|v| significant(((v / step).round() * step + 0.0) as f32, 6)).join(" ")
}

/// A unit vector.
fn direction(d: [f64; 3]) -> String {
    d.map(|v| significant(((v * 1e4).round() / 1e4 + 0.0) as f32, 3)).join(" ")
}

/// The largest coordinate of anything.
fn largest(info: &Info<'_>) -> f64 {
    let corners = info.bounds.iter().flat_map(|b| [b.min, b.max]);
    let cameras = info.cameras.iter().map(|c| c.position).chain(info.view.map(|(at, _)| at));
    corners.chain(cameras).flatten().fold(0.0, |most, v| most.max(v.abs()))
}
