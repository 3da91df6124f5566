//! Formats of lines: OBJ with MTL, PLY, STL.
use super::trial::{Bench, Outcome, remark};

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";

/// Statements of OBJ, with what they need after them.
const STATEMENTS: &[&str] = &[
    "f 1 2 3",
    "f 1/1 2/1 3/1",
    "f 1//1 2//1 3//1",
    "f -3 -2 -1",
    "v 0 0 0 1 0 0",
    "v 0 0 0 1",
    "vt 0 0 0",
    "vp 0 0",
    "g group",
    "o object",
    "s 1",
    "s off",
    "mtllib library.mtl",
    "usemtl red",
    "l 1 2",
    "p 1",
    "cstype bezier",
    "deg 3",
    "curv 0 1 1 2 3",
    "surf 0 1 0 1 1 2 3",
    "parm u 0 1",
    "trim 0 1 1",
    "hole 0 1 1",
    "scrv 0 1 1",
    "sp 1",
    "end",
    "con 1 2 3 4",
    "mg 1 0.1",
    "bevel on",
    "c_interp on",
    "d_interp on",
    "lod 1",
    "maplib maps",
    "usemap map",
    "shadow_obj file",
    "trace_obj file",
    "ctech cparm 1",
    "stech cparma 1 1",
    "call file.obj",
    "csh command",
];

/// Statements of MTL.
const MATERIALS: &[&str] = &[
    "Ka 1 1 1",
    "Kd 1 0 0",
    "Kd spectral file.rfl 1",
    "Kd xyz 1 1 1",
    "Ks 1 1 1",
    "Ke 1 1 1",
    "Tf 0.5 0.5 0.5",
    "Ns 32",
    "Ni 1.5",
    "d 0.5",
    "d -halo 0.5",
    "Tr 0.5",
    "sharpness 60",
    "illum 0",
    "illum 1",
    "illum 2",
    "illum 3",
    "illum 4",
    "illum 5",
    "illum 6",
    "illum 7",
    "illum 8",
    "illum 9",
    "illum 10",
    "map_Ka pixel.png",
    "map_Kd pixel.png",
    "map_Kd -s 2 2 2 pixel.png",
    "map_Kd -o 1 1 1 pixel.png",
    "map_Kd -clamp on pixel.png",
    "map_Kd -mm 0 1 pixel.png",
    "map_Kd -blendu off pixel.png",
    "map_Kd -imfchan r pixel.png",
    "map_Ks pixel.png",
    "map_Ke pixel.png",
    "map_Ns pixel.png",
    "map_d pixel.png",
    "map_aat on",
    "map_Bump pixel.png",
    "bump -bm 0.5 pixel.png",
    "disp pixel.png",
    "decal pixel.png",
    "norm pixel.png",
    "refl -type sphere pixel.png",
    "Pr 0.5",
    "Pm 0.5",
    "Ps 0.5",
    "Pc 0.5",
    "Pcr 0.5",
    "aniso 0.5",
    "anisor 0.5",
    "map_Pr pixel.png",
    "map_Pm pixel.png",
    "map_Ps pixel.png",
];

/// Properties of PLY vertices and faces.
const PROPERTIES: &[&str] = &[
    "vertex: float nx ny nz",
    "vertex: float u v",
    "vertex: float s t",
    "vertex: uchar red green blue",
    "vertex: uchar red green blue alpha",
    "vertex: float quality",
    "face: int face_indices",
    "face: uchar red",
    "edge",
];

pub fn write(out: &mut String) {
    let bench = Bench::new();
    out.push_str("\n## Wavefront OBJ and MTL\n\n");
    let face = "f 1 2 3\n";
    list(out, "Statements of OBJ", STATEMENTS, |statement| {
        let before = if *statement == "usemtl red" { "mtllib library.mtl\n" } else { "" };
        bench.try_file("x.obj", format!("{OBJ}{before}{statement}\n{face}"))
    });
    list(out, "Statements of MTL", MATERIALS, |statement| {
        std::fs::write(bench.path("own.mtl"), format!("newmtl m\n{statement}\n")).expect("written");
        bench.try_file("x.obj", format!("mtllib own.mtl\n{OBJ}usemtl m\nf 1/1 2/1 3/1\n"))
    });
    out.push_str("\n## PLY\n\n");
    list(
        out,
        "Beside positions and faces, as text, binary of both orders, or packed with gzip",
        PROPERTIES,
        |what| bench.try_file("x.ply", ply(what)),
    );
    out.push_str("\n## STL\n\nRead: text; binary, with colours left out; packed with gzip.\n");
}

/// A triangle with more properties.
fn ply(what: &str) -> String {
    let (element, rest) = what.split_once(": ").unwrap_or((what, ""));
    let (ty, names) = rest.split_once(' ').unwrap_or(("", ""));
    let of = |e: &str| if e == element { names.split(' ').collect() } else { Vec::new() };
    let (vertex, face): (Vec<&str>, Vec<&str>) = (of("vertex"), of("face"));
    let declared = |names: &[&str]| names.iter().map(|n| format!("property {ty} {n}\n")).collect::<String>();
    let edge =
        if element == "edge" { "element edge 1\nproperty int vertex1\nproperty int vertex2\n" } else { "" };
    let more = |n: usize| " 1".repeat(n);
    let (v, f) = (more(vertex.len()), more(face.len()));
    format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{}element face 1\n\
         property list uchar int vertex_indices\n{}{edge}end_header\n0 0 0{v}\n1 0 0{v}\n0 1 0{v}\n3 0 1 2{f}\n{}",
        declared(&vertex),
        declared(&face),
        if edge.is_empty() { "" } else { "0 1\n" }
    )
}

fn list(out: &mut String, title: &str, features: &[&str], try_it: impl Fn(&&str) -> Outcome) {
    let outcomes: Vec<Outcome> = features.iter().map(try_it).collect();
    let read = features.iter().zip(&outcomes).filter(|(_, o)| **o == Outcome::Read);
    let read: Vec<String> = read.map(|(f, _)| format!("`{f}`")).collect();
    out.push_str(&format!("{title}. Read: {}.\n\n", read.join(", ")));
    features.iter().zip(&outcomes).filter_map(|(f, o)| remark(f, o)).for_each(|line| out.push_str(&line));
    out.push('\n');
}
