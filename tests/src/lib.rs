//! Shared fixtures of the cross-crate tests.
#![allow(clippy::expect_used, clippy::panic, reason = "a fixture that cannot be made is a failed test")]

pub mod look;
pub mod program;
pub mod small;

use std::path::{Path, PathBuf};

use durer::{
    Distribution, Imported, Options, Prepared, Rendered, Show,
    film::ToneMap,
    image::{NamedChannel, PictureFormat, read_exr_channels},
    import::pbrt,
    integrator::Sampling,
    picture::{Look, Picture},
    prepare,
    scene::Limits,
};

/// A scene in our text language, imported.
pub fn import(text: &str) -> Imported {
    let mut imported = Imported::new(PathBuf::new(), Default::default());
    imported.desc.name = "test".to_owned();
    pbrt::read_text("test.pbrt", text, &mut imported);
    imported
}

/// Something that renders.
///
/// # Panics
/// If the scene has an error.
pub fn prepared(mut imported: Imported, options: &Options) -> Prepared {
    prepare(&mut imported, options).unwrap_or_else(|| panic!("{:#?}", imported.diagnostics))
}

/// A scene in our text language, ready to render.
pub fn scene(text: &str, options: &Options) -> Prepared {
    prepared(import(text), options)
}

/// The whole picture.
pub fn render(prepared: &Prepared) -> Rendered {
    prepared.job().render(Default::default(), &(), &Default::default())
}

/// The bits of every pixel's mean.
pub fn bits(rendered: &Rendered) -> Vec<[u32; 3]> {
    rendered.film.pixels().iter().map(|p| p.mean().map(f32::to_bits)).collect()
}

/// The EXR file of a picture, as bytes and read again.
///
/// # Panics
/// If it cannot be written or read.
pub fn exr(prepared: &Prepared, rendered: &Rendered) -> (Vec<u8>, Vec<NamedChannel>) {
    let picture = Picture {
        scene: "test",
        prepared,
        pixels: rendered.film.pixels(),
        layers: rendered.film.layers(),
        render: Default::default(),
        interrupted: false,
    };
    let look = Look { exposure: 0.0, tonemap: ToneMap::None };
    let bytes = picture.encode(PictureFormat::Exr, look).expect("a file");
    let (_, _, read) = read_exr_channels(&bytes, "test.exr", Limits::default()).expect("channels");
    (bytes, read)
}

/// The folder of real files that tests look at, if it is there: `DURER_SHARED`, else `../shared`. Says loudly that the
/// test is skipped if it is not.
pub fn shared(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("DURER_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: {test}: no folder {}; set DURER_SHARED", folder.display());
    None
}

/// Files of others under the folder `assets` of [`shared`] with few triangles: textures, instances, motion, holes, glass,
/// clear coats, lights of every kind.
pub const FILES: &[&str] = &[
    "gltf/BoxInterleaved.glb",
    "gltf/SimpleInstancing.glb",
    "gltf/TextureCoordinateTest.glb",
    "gltf/EmissiveStrengthTest.glb",
    "gltf/AttenuationTest.glb",
    "gltf/TransmissionTest.glb",
    "gltf/TransmissionRoughnessTest.glb",
    "gltf/NegativeScaleTest.glb",
    "gltf/NormalTangentMirrorTest.glb",
    "gltf/ClearCoatTest.glb",
    "gltf/dispersion-test.glb",
    "gltf/AlphaBlendModeTest.glb",
    "pbrt/cornell-box-variants/smallpt.pbrt",
    "pbrt/cornell-box-variants/cornell-box-specular.pbrt",
    "pbrt/veach-mis/scene-v4.pbrt",
    "obj/suzanne.obj",
    "stl/teapot.stl",
    "gltf/TextureSettingsTest.glb",
    "gltf/VertexColorTest.glb",
    "gltf/OrientationTest.glb",
];

/// Whitted's integrator, Cook's in both ways to combine samples, ray casting, the paths, and particles, for small pictures.
pub fn settings() -> [Options; 11] {
    let of = |integrator: &str, distribution: Distribution| Options {
        integrator: Some(integrator.to_owned()),
        width: Some(64),
        samples: Some(4),
        max_depth: Some(6),
        distribution,
        ..Options::default()
    };
    let distributed = |sampling, rays| Distribution {
        shadow_rays: Some(rays),
        gloss_rays: Some(rays),
        sampling: Some(sampling),
        ..Distribution::default()
    };
    let none = Distribution::default();
    [
        of("whitted", none),
        of("distributed", distributed(Sampling::Shared, 4)),
        Options { max_depth: Some(3), ..of("distributed", distributed(Sampling::Nested, 2)) },
        Options { show: Some(Show::Shading), max_depth: None, ..of("cast", none) },
        of("path", none),
        of("volpath", none),
        of("direct", none),
        of("light", none),
        of("bdpt", none),
        of("sppm", none),
        Options { max_depth: None, ..of("ambientocclusion", none) },
    ]
}
