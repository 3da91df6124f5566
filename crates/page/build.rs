//! Looks for the built page, `dist/durer.html`, which `cargo xtask page` puts there. Without it everything is built
//! but the page.
use std::path::Path;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(page_built)");
    // The folder, which is always there: a file that is missing would run this at every build.
    println!("cargo::rerun-if-changed=dist");
    if Path::new("dist/durer.html").is_file() {
        println!("cargo::rerun-if-changed=dist/durer.html");
        println!("cargo::rustc-cfg=page_built");
    } else {
        println!(
            "cargo::warning=the HTML page is not built, durer will write none: run `cargo xtask page` (needs Node)"
        );
    }
}
