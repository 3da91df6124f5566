//! Makes the table of `src/spectrum/upsample.rs`: smooth reflectances of colours.
use std::{env, fs, path::Path};

#[path = "../src/spectrum/cie.rs"]
mod cie;
mod fit;
#[path = "../src/spectrum/layers.rs"]
mod layers;
#[path = "../src/spectrum/observer.rs"]
#[expect(dead_code, reason = "the library reads its tables at any wavelength")]
mod observer;

fn main() {
    println!("cargo::rerun-if-changed=build");
    for file in ["cie", "layers", "observer"] {
        println!("cargo::rerun-if-changed=src/spectrum/{file}.rs");
    }
    let bytes: Vec<u8> = fit::table().iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let folder = env::var_os("OUT_DIR").expect("cargo names the folder");
    fs::write(Path::new(&folder).join("upsample.bin"), bytes).expect("the folder can be written");
}
