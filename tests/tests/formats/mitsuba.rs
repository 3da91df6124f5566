//! Plugins of Mitsuba, each with what it needs.
use super::trial::{Bench, Outcome, remark};

/// Shapes.
const SHAPES: &[&str] = &[
    r#"<shape type="obj"><string name="filename" value="triangle.obj"/></shape>"#,
    r#"<shape type="ply"><string name="filename" value="triangle.ply"/></shape>"#,
    r#"<shape type="sphere"><point name="center" value="0, 1, 0"/><float name="radius" value="2"/></shape>"#,
    r#"<shape type="rectangle"/>"#,
    r#"<shape type="cube"/>"#,
    r#"<shape type="disk"/>"#,
    r#"<shape type="cylinder"/>"#,
    r#"<shape type="merge"><shape type="sphere"/></shape>"#,
    r#"<shape type="bsplinecurve"><string name="filename" value="strands.txt"/></shape>"#,
    r#"<shape type="linearcurve"><string name="filename" value="strands.txt"/></shape>"#,
    r#"<shape type="sdfgrid"/>"#,
    r#"<shape type="sdfgrid"><string name="filename" value="distances.vol"/></shape>"#,
];

/// What stands in a sphere.
const INSIDE: &[&str] = &[
    r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.1, 0.2, 0.3"/></bsdf>"#,
    r#"<bsdf type="diffuse"><spectrum name="reflectance" value="400:0.1, 700:0.5"/></bsdf>"#,
    r#"<bsdf type="diffuse"><spectrum name="reflectance" filename="curve.spd"/></bsdf>"#,
    r#"<bsdf type="roughdiffuse"/>"#,
    r#"<bsdf type="dielectric"><string name="int_ior" value="water"/></bsdf>"#,
    r#"<bsdf type="thindielectric"/>"#,
    r#"<bsdf type="roughdielectric"><string name="distribution" value="ggx"/></bsdf>"#,
    r#"<bsdf type="roughdielectric"/>"#,
    r#"<bsdf type="conductor"/>"#,
    r#"<bsdf type="conductor"><string name="material" value="Au"/></bsdf>"#,
    r#"<bsdf type="roughconductor"><string name="material" value="Cr"/></bsdf>"#,
    r#"<bsdf type="plastic"/>"#,
    r#"<bsdf type="plastic"><rgb name="specular_reflectance" value="0.5"/></bsdf>"#,
    r#"<bsdf type="roughplastic"/>"#,
    r#"<bsdf type="roughplastic"><rgb name="specular_reflectance" value="0.5"/><boolean name="nonlinear" value="true"/></bsdf>"#,
    r#"<bsdf type="thindielectric"><rgb name="specular_transmittance" value="0.5"/></bsdf>"#,
    r#"<bsdf type="pplastic"/>"#,
    r#"<bsdf type="phong"/>"#,
    r#"<bsdf type="principled"/>"#,
    r#"<bsdf type="principledthin"/>"#,
    r#"<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>"#,
    r#"<bsdf type="mask"><bsdf type="diffuse"/></bsdf>"#,
    r#"<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="diffuse"/><bsdf type="null"/></bsdf>"#,
    r#"<bsdf type="normalmap"><texture name="normalmap" type="bitmap"><string name="filename" value="pixel.png"/></texture><bsdf type="diffuse"/></bsdf>"#,
    r#"<bsdf type="bumpmap"><texture type="bitmap"><string name="filename" value="pixel.png"/></texture><bsdf type="diffuse"/></bsdf>"#,
    r#"<bsdf type="null"/>"#,
    r#"<bsdf type="hair"/>"#,
    r#"<bsdf type="hair"><rgb name="sigma_a" value="0.2, 0.25, 0.7"/><float name="scale" value="2"/></bsdf>"#,
    r#"<bsdf type="measured"><string name="filename" value="paint.bsdf"/></bsdf>"#,
    r#"<bsdf type="polarizer"/>"#,
    r#"<bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="pixel.png"/><string name="wrap_mode" value="clamp"/></texture></bsdf>"#,
    r#"<bsdf type="diffuse"><texture name="reflectance" type="checkerboard"/></bsdf>"#,
    r#"<bsdf type="diffuse"><texture name="reflectance" type="mesh_attribute"><string name="name" value="vertex_color"/></texture></bsdf>"#,
    r#"<bsdf type="diffuse"><texture name="reflectance" type="volume"/></bsdf>"#,
    r#"<bsdf type="diffuse"><texture name="reflectance" type="volume"><volume name="volume" type="gridvolume"><string name="filename" value="grid.vol"/></volume></texture></bsdf>"#,
    r#"<emitter type="area"><rgb name="radiance" value="3"/></emitter>"#,
    r#"<emitter type="area"><spectrum name="radiance" type="blackbody"><float name="temperature" value="3000"/></spectrum></emitter>"#,
    r#"<emitter type="directionalarea"/>"#,
];

/// The same in a scene whose integrator sees media.
const MEDIA: &[&str] = &[
    r#"<medium name="interior" type="homogeneous"><phase type="hg"><float name="g" value="0.5"/></phase></medium>"#,
    r#"<medium name="interior" type="heterogeneous"><volume name="sigma_t" type="constvolume"><float name="value" value="2"/></volume></medium>"#,
    r#"<medium name="interior" type="heterogeneous"><volume name="sigma_t" type="gridvolume"><string name="filename" value="grid.vol"/></volume><volume name="albedo" type="gridvolume"><string name="filename" value="grid.vol"/></volume></medium>"#,
    r#"<medium name="interior" type="homogeneous"><phase type="rayleigh"/></medium>"#,
    r#"<medium name="interior" type="homogeneous"><phase type="tabphase"><string name="values" value="1, 0.5, 2"/></phase></medium>"#,
    r#"<medium name="interior" type="homogeneous"><phase type="sggx"><volume name="S" type="constvolume"><string name="value" value="1, 1, 0.1, 0, 0, 0"/></volume></phase></medium>"#,
    r#"<medium name="interior" type="homogeneous"><phase type="sggx"><volume name="S" type="gridvolume"><string name="filename" value="flakes.vol"/></volume></phase></medium>"#,
    r#"<medium name="interior" type="homogeneous"><phase type="blendphase"><float name="weight" value="0.3"/><phase name="a" type="hg"/><phase name="b" type="rayleigh"/></phase></medium>"#,
    r#"<medium name="interior" type="heterogeneous"><volume name="sigma_t" type="gridvolume"><string name="filename" value="grid.vol"/></volume><phase type="blendphase"><volume name="weight" type="gridvolume"><string name="filename" value="grid.vol"/></volume><phase name="a" type="isotropic"/><phase name="b" type="hg"/></phase></medium>"#,
];

/// What stands in the scene.
const OUTSIDE: &[&str] = &[
    r#"<emitter type="point"><point name="position" value="0, 3, 0"/></emitter>"#,
    r#"<emitter type="spot"/>"#,
    r#"<emitter type="spot"><texture name="texture" type="bitmap"><string name="filename" value="pixel.png"/></texture></emitter>"#,
    r#"<emitter type="directional"><vector name="direction" value="0, -1, 0"/></emitter>"#,
    r#"<emitter type="constant"/>"#,
    r#"<emitter type="envmap"><string name="filename" value="pixel.png"/></emitter>"#,
    r#"<emitter type="projector"><texture name="irradiance" type="bitmap"><string name="filename" value="pixel.png"/></texture></emitter>"#,
    r#"<emitter type="sunsky"/>"#,
    r#"<sensor type="perspective"/>"#,
    r#"<sensor type="thinlens"><float name="aperture_radius" value="0.1"/></sensor>"#,
    r#"<sensor type="orthographic"/>"#,
    r#"<sensor type="radiancemeter"><point name="origin" value="0, 0, 5"/><vector name="direction" value="0, 0, -1"/></sensor>"#,
    r#"<sensor type="irradiancemeter"/>"#,
    r#"<sensor type="distant"/>"#,
    r#"<sensor type="batch"/>"#,
    r#"<sensor type="perspective"><film type="hdrfilm"><integer name="crop_width" value="4"/></film></sensor>"#,
    r#"<sensor type="perspective"><film type="hdrfilm"><rfilter type="lanczos"/></film></sensor>"#,
    r#"<sensor type="perspective"><sampler type="multijitter"/></sensor>"#,
    r#"<integrator type="path"><integer name="max_depth" value="4"/></integrator>"#,
    r#"<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>"#,
    r#"<integrator type="direct"/>"#,
    r#"<integrator type="volpath"/>"#,
    r#"<integrator type="ptracer"/>"#,
    r#"<integrator type="depth"/>"#,
    r#"<integrator type="moment"><integrator type="path"/></integrator>"#,
    r#"<integrator type="volpath"><boolean name="hide_emitters" value="true"/></integrator>"#,
    r#"<integrator type="pssmlt"/>"#,
    r#"<integrator type="mlt"><boolean name="bidirectional_mutation" value="true"/></integrator>"#,
    r#"<integrator type="ppm"><float name="initial_radius" value="0.1"/></integrator>"#,
    r#"<default name="a" value="1"/>"#,
    r#"<path value="."/>"#,
    r#"<include filename="missing.xml"/>"#,
];

pub(crate) fn write(out: &mut String) {
    let bench = Bench::new();
    std::fs::write(bench.path("triangle.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    std::fs::write(bench.path("strands.txt"), "0 0 0 0.1\n1 0 0 0.2\n1 1 0 0.1\n0 1 0 0\n").expect("written");
    let header = [1u32, 1, 1, 1, 1].map(u32::to_le_bytes).concat();
    let values = [0.0f32, 0.0, 0.0, 1.0, 1.0, 1.0, 0.5].map(f32::to_le_bytes).concat();
    std::fs::write(bench.path("grid.vol"), [b"VOL\x03".as_slice(), &header, &values].concat())
        .expect("written");
    let volume = |name: &str, header: [u32; 5], values: &[f32]| {
        let header = header.map(u32::to_le_bytes).concat();
        let corners = [0.0f32, 0.0, 0.0, 1.0, 1.0, 1.0].map(f32::to_le_bytes).concat();
        let values: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        std::fs::write(bench.path(name), [b"VOL\x03".as_slice(), &header, &corners, &values].concat())
            .expect("written");
    };
    volume("distances.vol", [1, 2, 2, 2, 1], &[-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0]);
    volume("flakes.vol", [1, 1, 1, 1, 6], &[1.0, 1.0, 0.1, 0.0, 0.0, 0.0]);
    let scene = |inside: &str| format!("<scene version=\"3.0.0\">{inside}</scene>");
    let shapes = SHAPES.iter().map(|s| (*s, scene(s)));
    let inside = INSIDE.iter().map(|s| (*s, scene(&format!("<shape type=\"sphere\">{s}</shape>"))));
    let volpath = "<integrator type=\"volpath\"/>";
    let media = MEDIA.iter().map(|s| (*s, scene(&format!("<shape type=\"sphere\">{s}</shape>{volpath}"))));
    let outside = OUTSIDE.iter().map(|s| (*s, scene(&format!("<shape type=\"sphere\"/>{s}"))));
    let (mut read, mut told) = (Vec::new(), String::new());
    for (feature, text) in shapes.chain(inside).chain(media).chain(outside) {
        let outcome = bench.try_file("scene.xml", text);
        match outcome {
            Outcome::Read => read.push(format!("- `{feature}`\n")),
            _ => told.extend(remark(feature, &outcome)),
        }
    }
    out.push_str("\n## Mitsuba\n\nScenes of Mitsuba 3, and of 0.x, whose names are changed as Mitsuba 3 changes them; `.serialized` \
                  meshes of versions 3 and 4. Read:\n\n");
    read.iter().for_each(|line| out.push_str(line));
    out.push_str("\nRead in another way, or refused:\n\n");
    out.push_str(&told);
}
