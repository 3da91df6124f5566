//! `docs/formats.md` says feature by feature what is read, changed and refused, and is made by trying each of them: it
//! cannot be out of date. `DURER_BLESS=1` writes it anew.
mod gltf;
mod lines;
mod mitsuba;
mod pbrt;
mod trial;

use std::path::Path;

fn page() -> String {
    let mut out = String::from(
        "# Formats, feature by feature\n\n\
         Made by `DURER_BLESS=1 cargo test -p durer-tests --test formats`, which tries each feature on a small scene and \
         writes down what durer said; do not edit. *Read* means that nothing was said. What is read in another way comes \
         with the warning that durer gives, what is refused with the error: neither is ever swallowed.\n\n\
         More about each: [pbrt](pbrt-language.md), [glTF](gltf.md), [Mitsuba](mitsuba.md), [OBJ, PLY, STL](meshes.md), \
         [kinds and parameters](reference.md).\n",
    );
    pbrt::write(&mut out);
    gltf::write(&mut out);
    mitsuba::write(&mut out);
    lines::write(&mut out);
    out
}

#[test]
fn the_page_of_formats_is_what_the_readers_do() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/formats.md");
    let page = page();
    if std::env::var_os("DURER_BLESS").is_some() {
        std::fs::write(&path, &page).expect("docs/ can be written");
    }
    let found = std::fs::read_to_string(&path).expect("docs/formats.md");
    let differs = found.lines().zip(page.lines()).find(|(a, b)| a != b);
    assert!(
        found == page,
        "docs/formats.md differs from what the readers do: run DURER_BLESS=1 cargo test -p durer-tests --test formats\n{differs:#?}"
    );
}

#[test]
fn the_page_tells_what_is_read_from_what_is_not() {
    let page = page();
    let row = |start: &str| page.lines().find(|l| l.starts_with(start)).unwrap_or_else(|| panic!("{start}"));
    assert!(row("| `sphere` ").contains("`radius`"));
    assert!(page.contains("\n- `Integrator \"mlt\"`: "), "what is not read is told");
    assert!(!page.contains("| `mlt` "), "and is not among what is read");
}
