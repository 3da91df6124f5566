//! The same million triangles in every format, with numbers as long as programs write them.
use std::{
    fs::File,
    io::{BufWriter, Result, Write},
    path::Path,
};

/// Squares along an edge.
const SQUARES: u32 = 708;

/// Waves over a square: points with six decimals, and triangles.
struct Hills {
    points: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Hills {
    fn new() -> Self {
        let point = |x: u32, y: u32| {
            let [u, v] = [x, y].map(|n| n as f32 / SQUARES as f32 * 10.0 - 5.0);
            [u, v, 0.3 * (u * 2.1).sin() * (v * 1.7).cos() + 0.05 * (u * 17.0 + v * 11.0).sin()]
        };
        let points = (0..=SQUARES).flat_map(|y| (0..=SQUARES).map(move |x| point(x, y))).collect();
        let corners = (0..SQUARES).flat_map(|y| (0..SQUARES).map(move |x| y * (SQUARES + 1) + x));
        let triangles = corners.flat_map(|a| {
            let above = a + SQUARES + 1;
            [[a, a + 1, above + 1], [a, above + 1, above]]
        });
        Self { points, triangles: triangles.collect() }
    }

    fn obj(&self, to: &mut impl Write) -> Result<()> {
        for [x, y, z] in &self.points {
            writeln!(to, "v {x:.6} {y:.6} {z:.6}")?;
        }
        for [a, b, c] in &self.triangles {
            writeln!(to, "f {} {} {}", a + 1, b + 1, c + 1)?;
        }
        Ok(())
    }

    fn ply_head(&self, to: &mut impl Write, format: &str) -> Result<()> {
        let (points, triangles) = (self.points.len(), self.triangles.len());
        write!(to, "ply\nformat {format} 1.0\nelement vertex {points}\n")?;
        write!(to, "property float x\nproperty float y\nproperty float z\nelement face {triangles}\n")?;
        write!(to, "property list uchar int vertex_indices\nend_header\n")
    }

    fn ply_text(&self, to: &mut impl Write) -> Result<()> {
        self.ply_head(to, "ascii")?;
        for [x, y, z] in &self.points {
            writeln!(to, "{x:.6} {y:.6} {z:.6}")?;
        }
        for [a, b, c] in &self.triangles {
            writeln!(to, "3 {a} {b} {c}")?;
        }
        Ok(())
    }

    fn ply(&self, to: &mut impl Write) -> Result<()> {
        self.ply_head(to, "binary_little_endian")?;
        for value in self.points.iter().flatten() {
            to.write_all(&value.to_le_bytes())?;
        }
        for triangle in &self.triangles {
            to.write_all(&[3])?;
            to.write_all(&triangle.map(u32::to_le_bytes).concat())?;
        }
        Ok(())
    }

    fn stl(&self, to: &mut impl Write) -> Result<()> {
        writeln!(to, "solid hills")?;
        for triangle in &self.triangles {
            writeln!(to, "  facet normal 0 0 1\n    outer loop")?;
            for [x, y, z] in triangle.map(|i| self.points[i as usize]) {
                writeln!(to, "      vertex {x:.6} {y:.6} {z:.6}")?;
            }
            writeln!(to, "    endloop\n  endfacet")?;
        }
        writeln!(to, "endsolid hills")
    }

    fn pbrt(&self, to: &mut impl Write) -> Result<()> {
        pbrt_head(to)?;
        writeln!(to, "Shape \"trianglemesh\" \"point3 P\" [")?;
        for [x, y, z] in &self.points {
            writeln!(to, "{x:.6} {y:.6} {z:.6}")?;
        }
        writeln!(to, "] \"integer indices\" [")?;
        for [a, b, c] in &self.triangles {
            writeln!(to, "{a} {b} {c}")?;
        }
        writeln!(to, "]")
    }
}

fn pbrt_head(to: &mut impl Write) -> Result<()> {
    writeln!(to, "LookAt 0 -9 6  0 0 0  0 0 1\nCamera \"perspective\"\nWorldBegin")?;
    writeln!(to, "LightSource \"infinite\" \"rgb L\" [1 1 1]")
}

/// A scene of Mitsuba with a mesh in a file.
fn mitsuba(to: &mut impl Write, kind: &str, file: &str) -> Result<()> {
    writeln!(to, "<scene version=\"3.0.0\">\n  <integrator type=\"path\"/>\n  <emitter type=\"constant\"/>")?;
    writeln!(to, "  <sensor type=\"perspective\"><float name=\"fov\" value=\"60\"/>")?;
    writeln!(
        to,
        "    <film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film>"
    )?;
    writeln!(
        to,
        "  </sensor>\n  <shape type=\"{kind}\"><string name=\"filename\" value=\"{file}\"/></shape>\n</scene>"
    )
}

/// Writes them into a folder.
pub(crate) fn write(folder: &Path) -> Result<()> {
    let hills = Hills::new();
    let file = |name: &str| File::create(folder.join(name)).map(BufWriter::new);
    hills.obj(&mut file("hills.obj")?)?;
    hills.ply_text(&mut file("hills-text.ply")?)?;
    hills.ply(&mut file("hills.ply")?)?;
    hills.stl(&mut file("hills.stl")?)?;
    hills.pbrt(&mut file("hills.pbrt")?)?;
    let mut of_file = file("hills-ply.pbrt")?;
    pbrt_head(&mut of_file)?;
    writeln!(of_file, "Shape \"plymesh\" \"string filename\" \"hills.ply\"")?;
    mitsuba(&mut file("hills-obj.xml")?, "obj", "hills.obj")?;
    mitsuba(&mut file("hills-text.xml")?, "ply", "hills-text.ply")?;
    mitsuba(&mut file("hills-ply.xml")?, "ply", "hills.ply")
}
