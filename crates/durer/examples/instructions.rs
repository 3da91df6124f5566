//! Renders a built-in scene by the kernel's portable path on one thread, to have its instructions counted:
//! `valgrind --tool=callgrind --toggle-collect='*instructions*picture*' target/release/examples/instructions whitted`.
use durer::{
    Options, Prepared,
    accel::{BuildOptions, Isa},
    builtin,
    compile::{CompileOptions, compile},
    prepare,
};

/// What is counted. Prints something of the picture, so that it is needed.
#[inline(never)]
fn picture(prepared: &Prepared) {
    let rendered = prepared.job().render(Default::default(), &(), &Default::default());
    let sum: f32 = rendered.film.pixels().iter().map(|p| p.mean()[1]).sum();
    println!("{} rays, mean {}", rendered.rays, sum / rendered.film.pixels().len() as f32);
}

fn main() {
    let name = std::env::args().nth(1).unwrap_or_else(|| "whitted".to_owned());
    let Some(scene) = builtin::find(&name) else { return eprintln!("no scene {name}") };
    let mut imported = scene.import();
    let options = Options { width: Some(160), samples: Some(2), threads: Some(1), ..Options::default() };
    let Some(mut prepared) = prepare(&mut imported, &options) else { return eprintln!("not sound") };
    let size = (prepared.scene.view.width, prepared.scene.view.height);
    let portable = CompileOptions {
        accel: BuildOptions { isa: Some(Isa::Portable), ..BuildOptions::default() },
        ..CompileOptions::new(size.0, size.1)
    };
    let compiled = compile(&imported.desc, &imported.assets, &portable, &mut imported.diagnostics);
    let Some(mut compiled) = compiled else { return eprintln!("not sound") };
    // The picture is taken as the scene says.
    std::mem::swap(&mut compiled.view, &mut prepared.scene.view);
    prepared.scene = compiled;
    picture(&prepared);
}
