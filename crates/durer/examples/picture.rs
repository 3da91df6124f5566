//! The library in a few lines: scene in, PNG out. `cargo run --release -p durer --example picture -- scene.glb out.png`
use std::path::Path;

use durer::{
    Options,
    film::{ToneMap, develop},
    image::write_png,
    prepare,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let scene = args.next().unwrap_or_else(|| "whitted".to_owned());
    let out = args.next().unwrap_or_else(|| "picture.png".to_owned());

    let mut imported = durer::open(&scene);
    let Some(prepared) = prepare(&mut imported, &Options::default()) else {
        for complaint in &imported.diagnostics {
            eprintln!("{:?}: {}", complaint.severity, complaint.message);
        }
        return Err(format!("{scene} cannot be rendered").into());
    };
    let film = prepared.job().render(Default::default(), &(), &Default::default()).film;
    let means: Vec<_> = film.pixels().iter().map(|pixel| pixel.mean()).collect();
    let picture = develop(film.width, film.height, &means, 0.0, ToneMap::None);
    write_png(Path::new(&out), picture.width, picture.height, &picture.rgb8)?;
    println!("{out}");
    Ok(())
}
