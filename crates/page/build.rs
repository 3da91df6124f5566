//! Looks for the built pages, `dist/durer.html` and `dist/view.html`, which `cargo xtask page` puts there. Without them
//! everything is built but the pages.
use std::path::Path;

fn main() {
    // The folder, which is always there: a file that is missing would run this at every build.
    println!("cargo::rerun-if-changed=dist");
    for (file, cfg) in [("dist/durer.html", "page_built"), ("dist/view.html", "live_built")] {
        println!("cargo::rustc-check-cfg=cfg({cfg})");
        if Path::new(file).is_file() {
            println!("cargo::rerun-if-changed={file}");
            println!("cargo::rustc-cfg={cfg}");
        } else {
            println!(
                "cargo::warning={file} is not built, durer will do without that page: run `cargo xtask page` (needs Node)"
            );
        }
    }
}
