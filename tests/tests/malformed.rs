//! Damaged files, given to the program itself: each ends with a picture, or with exit status 1 and a message that names
//! the file, within a time and an address space.
//!
//! The files are those of `assets/malformed`, collected from the tests and fuzzers of other projects. What the Khronos
//! validator says about its own is in `EXPECTED.tsv`; most of these faults a renderer may tolerate, see [`STRUCTURAL`].
use std::{
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use durer_tests::{
    program::{Allowance, Ran, each, files_below, program, run},
    shared,
};

/// Of each run: 10 s of wall time, 2 GiB of address space.
const ALLOWANCE: Allowance = Allowance { time: Duration::from_secs(10), memory: Some(2 << 30) };

/// Suffixes of scene files.
const SCENES: &[&str] = &["gltf", "glb", "pbrt", "obj", "ply", "stl"];

/// Codes of the Khronos validator, or beginnings of them, for files that make no sense to read on.
const STRUCTURAL: &[&str] = &[
    "INVALID_JSON",
    "GLB_",
    "BUFFER_VIEW_TOO_LONG",
    "ACCESSOR_TOO_LONG",
    "ACCESSOR_INDEX_OOB",
    "NODE_LOOP",
    "UNRESOLVED_REFERENCE",
];

/// What looks like the inside of the program, not like a message.
const INSIDE: &[&str] =
    &["panicked", "RUST_BACKTRACE", "overflowed its stack", "memory allocation of", "src/"];

/// The program, and folders for its runs.
struct Bench {
    program: PathBuf,
    place: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { program: program(), place: tempfile::tempdir().expect("a folder") }
    }

    /// Runs in a new folder.
    fn run(&self, words: &[&str], file: &Path) -> (Ran, tempfile::TempDir) {
        let folder = tempfile::tempdir_in(self.place.path()).expect("a folder");
        let words: Vec<OsString> = words
            .iter()
            .map(|&word| if word == "FILE" { file.as_os_str().to_owned() } else { word.into() })
            .collect();
        let ran = run(&self.program, &words, folder.path(), ALLOWANCE).expect("durer runs");
        (ran, folder)
    }
}

/// What is wrong with how a run ended: not by success, and not by a message that helps.
fn complaint(ran: &Ran, file: &Path) -> Option<String> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let said = &ran.stderr;
    let commands = |c: char| c.is_control() && c != '\n' && c != '\t';
    let wrong = match ran.code {
        _ if said.contains(commands) => "repeats control characters".to_owned(),
        None => format!("killed after {:.1?}", ran.wall),
        Some(0) if INSIDE.iter().any(|word| said.contains(word)) => "talks of its inside".to_owned(),
        Some(0) => return None,
        Some(1) if INSIDE.iter().any(|word| said.contains(word)) => "talks of its inside".to_owned(),
        Some(1) if !said.contains("error: ") => "fails without an error".to_owned(),
        Some(1) if !said.contains(&*name) => "does not name the file".to_owned(),
        Some(1) => return None,
        Some(code) => format!("exit status {code}"),
    };
    Some(format!("{}: {wrong}\n{}", file.display(), said.trim_end()))
}

/// The same for a run that draws: success leaves a picture, failure none.
fn complaint_of_render(ran: &Ran, file: &Path, picture: &Path) -> Option<String> {
    let drawn = fs::metadata(picture).is_ok_and(|data| data.len() > 0);
    match complaint(ran, file) {
        None if drawn != (ran.code == Some(0)) => {
            Some(format!("{}: exit status {:?}, picture: {drawn}\n{}", file.display(), ran.code, ran.stderr))
        }
        complaint => complaint,
    }
}

fn is_scene(path: &Path) -> bool {
    let suffix = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    SCENES.contains(&suffix.as_str())
}

fn insist(complaints: Vec<String>) {
    assert!(complaints.is_empty(), "{} complaints:\n{}", complaints.len(), complaints.join("\n\n"));
}

#[test]
fn damaged_scenes_end_with_a_picture_or_a_message() {
    let Some(shared) = shared("damaged_scenes_end_with_a_picture_or_a_message") else { return };
    let scenes: Vec<PathBuf> =
        files_below(&shared.join("assets/malformed")).into_iter().filter(|f| is_scene(f)).collect();
    assert!(scenes.len() > 180, "only {} scenes", scenes.len());
    let bench = Bench::new();
    insist(each(&scenes, |file| {
        let (told, _) = bench.run(&["info", "FILE"], file);
        let words = ["render", "FILE", "--width", "32", "--spp", "1", "-o", "picture.png"];
        let (drawn, folder) = bench.run(&words, file);
        let said = complaint_of_render(&drawn, file, &folder.path().join("picture.png"));
        complaint(&told, file).into_iter().chain(said).collect()
    }));
}

#[test]
fn valid_files_without_geometry_have_info_but_no_picture() {
    let Some(shared) = shared("valid_files_without_geometry_have_info_but_no_picture") else { return };
    let controls: Vec<PathBuf> = files_below(&shared.join("assets/malformed/gltf/khronos-valid-controls"))
        .into_iter()
        .filter(|file| is_scene(file))
        .collect();
    assert!(controls.len() > 35, "only {} files", controls.len());
    let bench = Bench::new();
    insist(each(&controls, |file| {
        let (told, _) = bench.run(&["info", "FILE", "--json"], file);
        if told.code != Some(0) {
            return vec![format!("{}: info exits with {:?}\n{}", file.display(), told.code, told.stderr)];
        }
        let facts: serde_json::Value = serde_json::from_str(&told.stdout).expect("JSON");
        if facts["counts"]["triangles"].as_u64().is_none_or(|n| n > 0) {
            return Vec::new();
        }
        let (drawn, _) = bench.run(&["render", "FILE", "--width", "32", "--spp", "1", "-o", "x.png"], file);
        let says = drawn.code == Some(1) && drawn.stderr.contains("nothing to draw");
        if says { Vec::new() } else { vec![format!("{}: render does not say so", file.display())] }
    }));
}

#[test]
fn files_whose_structure_is_broken_are_refused() {
    let Some(shared) = shared("files_whose_structure_is_broken_are_refused") else { return };
    let folder = shared.join("assets/malformed/gltf");
    let table = fs::read_to_string(folder.join("khronos/EXPECTED.tsv")).expect("EXPECTED.tsv");
    let is_structural = |codes: &str| codes.split(',').any(|c| STRUCTURAL.iter().any(|s| c.starts_with(s)));
    let rows = table.lines().skip(1).filter_map(|line| line.split_once('\t'));
    let mut files: Vec<PathBuf> = rows
        .filter(|(_, codes)| is_structural(codes))
        .map(|(file, _)| folder.join("khronos").join(file))
        .collect();
    assert!(files.len() > 25, "only {} files", files.len());
    files.extend(
        ["IndexOutOfRange", "AllIndicesOutOfRange"]
            .map(|name| folder.join("assimp/IndexOutOfRange").join(format!("{name}.gltf"))),
    );
    let bench = Bench::new();
    insist(each(&files, |file| {
        let (told, _) = bench.run(&["info", "FILE"], file);
        let accepted = told.code == Some(0);
        let said = accepted.then(|| format!("{}: accepted", file.display()));
        said.into_iter().chain(complaint(&told, file)).collect()
    }));
}

fn is_png(file: &Path) -> bool {
    file.extension().is_some_and(|suffix| suffix == "png")
}

/// Pictures that an environment may be, and whether they are sound.
fn pictures(shared: &Path) -> Vec<(PathBuf, bool)> {
    let assets = shared.join("assets");
    let good = ["images/exr", "images/png/pngsuite", "images/jpg", "images/hdr"];
    let bad = ["malformed/exr", "malformed/images"];
    // What small kinds of PNG there are is for the tests of images; some of them are enough here.
    let every = if std::env::var_os("DURER_SLOW").is_some() { 1 } else { 6 };
    let of = |folders: &[&str], sound: bool| {
        let files: Vec<PathBuf> = folders.iter().flat_map(|f| files_below(&assets.join(f))).collect();
        files.into_iter().map(move |file| (file, sound))
    };
    let sound = of(&good, true).enumerate().filter(|(i, (file, _))| i % every == 0 || !is_png(file));
    sound.map(|(_, picture)| picture).chain(of(&bad, false)).collect()
}

#[test]
fn pictures_become_environments_or_are_refused() {
    let Some(shared) = shared("pictures_become_environments_or_are_refused") else { return };
    let bench = Bench::new();
    let (help, _) = bench.run(&["render", "--help"], Path::new(""));
    if !help.stdout.contains("--env") {
        eprintln!("SKIPPED: pictures_become_environments_or_are_refused: `durer render` has no --env");
        return;
    }
    let pictures = pictures(&shared);
    assert!(pictures.len() > 150, "only {} pictures", pictures.len());
    insist(each(&pictures, |(file, sound)| {
        let words = ["render", "--env", "FILE", "--width", "32", "--spp", "1", "-o", "picture.png"];
        let (ran, folder) = bench.run(&words, file);
        let wrong = complaint_of_render(&ran, file, &folder.path().join("picture.png"));
        // Rare kinds of OpenEXR may be refused; the rest of the sound ones may not.
        let exr = file.extension().is_some_and(|suffix| suffix == "exr");
        let refused = *sound && !exr && ran.code == Some(1);
        let refused = refused.then(|| format!("{}: refused\n{}", file.display(), ran.stderr));
        wrong.into_iter().chain(refused).collect()
    }));
}

#[test]
fn bad_endings_are_seen() {
    let file = Path::new("a/b.gltf");
    let ran = |code, stderr: &str| Ran {
        code,
        stdout: String::new(),
        stderr: stderr.to_owned(),
        wall: Duration::from_secs(1),
    };
    assert_eq!(complaint(&ran(Some(0), ""), file), None);
    assert_eq!(complaint(&ran(Some(1), "error: b.gltf: it is empty"), file), None);
    for (code, stderr) in [
        (None, ""),
        (Some(1), ""),
        (Some(1), "error: it is empty"),
        (Some(2), "error: b.gltf: it is empty"),
        (Some(1), "error: b.gltf\nthread 'main' panicked at x"),
        (Some(0), "thread '<unnamed>' panicked at x"),
        (Some(1), "error: b.gltf: unknown word \u{1b}[2J"),
    ] {
        assert!(complaint(&ran(code, stderr), file).is_some(), "{code:?} {stderr}");
    }
    assert!(complaint_of_render(&ran(Some(0), ""), file, Path::new("nowhere.png")).is_some());
}

#[test]
fn a_run_that_takes_too_long_or_too_much_is_ended() {
    let place = tempfile::tempdir().expect("a folder");
    let shell = |script: &str, allowance| {
        let words = ["-c", script].map(OsString::from);
        run(Path::new("sh"), &words, place.path(), allowance).expect("a shell")
    };
    let short = Allowance { time: Duration::from_millis(200), memory: None };
    assert_eq!(shell("exec sleep 5", short).code, None);
    assert_eq!(shell("echo out; echo err >&2; exit 3", ALLOWANCE).code, Some(3));
    if cfg!(target_os = "linux") {
        let limit = shell("ulimit -v", ALLOWANCE).stdout;
        assert_eq!(limit.trim(), (2u64 * 1024 * 1024).to_string());
    }
}
