//! The commands of the README and of the gallery work: each `sh` block is run, small, in an empty folder.
//!
//! `cargo run --release -- X` becomes `durer X` of the build under test. Pictures are made small unless the command says
//! how large; servers are ended once they told their address. Files that stand for a user's own are written beside it:
//! `room.glb`, `room.pbrt`, `statue.ply.gz` and `sky.hdr`. Commands that would take too long or run this test again are
//! listed in `NOT_RUN`.
use std::{
    fs,
    io::{BufRead, BufReader, Write},
    process::{Command, Stdio},
};

use durer_tests::program::{program, root};
use serde_json::json;

/// Commands that are not run here, and why.
const NOT_RUN: &[(&str, &str)] = &[
    ("cargo xtask test", "runs this test"),
    ("cargo xtask bench render", "takes long, and its times mean nothing beside other tests"),
    ("cargo xtask bench kernel --quick", "as above, and it fetches Embree"),
    ("cargo xtask assets", "takes a minute, and rewrites a page of the repository"),
];

/// How the README starts the program.
const PREFIX: &str = "cargo run --release -- ";

/// A command of the README.
#[derive(Debug, Default, PartialEq)]
struct Shown {
    command: String,
    /// What it prints, if a `text` block follows.
    prints: Option<String>,
}

/// Commands of the `sh` blocks of a text, without comments; lines that end in `\` are joined.
fn commands(text: &str) -> Vec<Shown> {
    let mut commands: Vec<Shown> = Vec::new();
    let mut fence = None;
    let mut begun = String::new();
    for line in text.lines() {
        match (line.strip_prefix("```"), fence) {
            (Some("text"), None) => {
                fence = Some("text");
                if let Some(last) = commands.last_mut() {
                    last.prints.get_or_insert_default();
                }
            }
            (Some(language), None) => fence = Some(language),
            (Some(_), Some(_)) => fence = None,
            (None, Some("sh")) => {
                let code = line.split(" #").next().unwrap_or("").trim();
                match code.strip_suffix('\\') {
                    Some(part) => begun.push_str(part),
                    None if code.is_empty() || code.starts_with('#') => {}
                    None => {
                        let command = std::mem::take(&mut begun) + code;
                        commands.push(Shown { command, prints: None });
                    }
                }
            }
            (None, Some("text")) => {
                if let Some(prints) = commands.last_mut().and_then(|last| last.prints.as_mut()) {
                    prints.push_str(line);
                    prints.push('\n');
                }
            }
            _ => {}
        }
    }
    commands
}

/// A text without its numbers, which may change in their last digits.
fn without_numbers(text: &str) -> String {
    text.chars().filter(|c| !c.is_ascii_digit() && !"+-.".contains(*c)).collect()
}

/// The words after the program's name, with the size of the picture made small.
fn small(command: &str) -> Option<Vec<String>> {
    let mut words = shlex::split(command.strip_prefix(PREFIX)?)?;
    let says = |option: &str| words.iter().any(|word| word == option);
    let width = words.iter().skip_while(|word| *word != "--width").nth(1).and_then(|w| w.parse().ok());
    let is_small =
        width.is_some_and(|width: u32| width <= 320) || says("--height") || says("--scale") || says("--crop");
    if (says("render") || says("cost") || says("draw")) && !is_small {
        words.extend(["--scale", "0.1"].map(str::to_owned));
    }
    Some(words)
}

/// A binary glTF file with one triangle of a metre.
fn glb() -> Vec<u8> {
    let positions: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let binary: Vec<u8> = positions.iter().flat_map(|v| v.to_le_bytes()).collect();
    let document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0],
        }],
        "bufferViews": [{ "buffer": 0, "byteLength": binary.len() }],
        "buffers": [{ "byteLength": binary.len() }],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut file = Vec::new();
    let word = |file: &mut Vec<u8>, v: usize| file.extend((v as u32).to_le_bytes());
    file.extend(b"glTF");
    word(&mut file, 2);
    word(&mut file, length);
    word(&mut file, text.len());
    file.extend(b"JSON");
    file.extend(text);
    word(&mut file, binary.len());
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}

/// One triangle.
const STATUE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// The same as gzip.
fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packer.write_all(bytes).expect("memory");
    packer.finish().expect("memory")
}

/// Two grey pixels all around.
const SKY: &[u8] = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";

/// Files that a command promises: those after `-o`, and those whose paths `render` printed.
fn promised(words: &[String], stdout: &str) -> Vec<String> {
    let named =
        words.windows(2).filter(|pair| pair[0] == "-o" || pair[0] == "--output").map(|pair| pair[1].clone());
    let mut files: Vec<String> = named.collect();
    let is_listing =
        words.iter().any(|w| w == "render") && !words.iter().any(|w| w.starts_with("--stats=json"));
    if is_listing {
        assert!(!stdout.trim().is_empty(), "render names no file");
        files.extend(stdout.lines().map(str::to_owned));
    }
    files
}

/// Starts a server, which tells its address first, and ends it.
fn serves(command: &mut Command) {
    let mut server = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("durer runs");
    let mut address = String::new();
    BufReader::new(server.stdout.take().expect("a pipe")).read_line(&mut address).expect("text");
    server.kill().and_then(|()| server.wait()).expect("an end");
    assert!(address.starts_with("http://127.0.0.1:") && address.contains("token="), "{command:?}: {address}");
}

#[test]
fn every_command_does_what_it_says() {
    let pages =
        ["README.md", "docs/gallery.md"].map(|page| fs::read_to_string(root().join(page)).expect("a page"));
    let commands: Vec<Shown> = pages.iter().flat_map(|page| commands(page)).collect();
    assert!(commands.iter().any(|c| c.command.starts_with(PREFIX)), "the README shows no command");
    for (command, _) in NOT_RUN {
        assert!(commands.iter().any(|c| c.command == *command), "the README no longer shows `{command}`");
    }
    let program = program();
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("room.glb"), glb()).expect("a file");
    fs::copy(root().join("crates/durer/scenes/whitted.pbrt"), folder.path().join("room.pbrt"))
        .expect("a file");
    fs::write(folder.path().join("statue.ply.gz"), packed(STATUE.as_bytes())).expect("a file");
    fs::write(folder.path().join("sky.hdr"), SKY).expect("a file");
    for Shown { command, prints } in &commands {
        if NOT_RUN.iter().any(|(not_run, _)| command == not_run) {
            continue;
        }
        let words = small(command).unwrap_or_else(|| panic!("`{command}` is not known to this test"));
        let mut started = Command::new(&program);
        started.args(&words).current_dir(folder.path());
        if words.iter().any(|word| word == "view") {
            serves(&mut started);
            continue;
        }
        let output = started.output().expect("durer runs");
        let (stdout, stderr) =
            (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        if !output.status.success() && stderr.contains("cargo xtask page") {
            eprintln!("SKIPPED: `{command}`: the page is not built");
            continue;
        }
        assert!(output.status.success(), "`{command}` fails:\n{stderr}");
        if let Some(prints) = prints {
            assert_eq!(
                without_numbers(&stdout),
                without_numbers(prints),
                "`{command}` prints something else"
            );
        }
        for file in promised(&words, &stdout) {
            let length = fs::metadata(folder.path().join(&file)).map_or(0, |data| data.len());
            assert!(length > 0, "`{command}` leaves no {file}");
        }
    }
}

#[test]
fn links_lead_to_files() {
    let mut dead = Vec::new();
    for page in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/gallery.md"] {
        let text = fs::read_to_string(root().join(page)).expect("a page");
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
        let files = targets.filter(|target| !target.is_empty() && !target.contains("://"));
        let folder = root().join(page).parent().expect("a folder").to_path_buf();
        dead.extend(files.filter(|file| !folder.join(file).exists()).map(|file| format!("{page}: {file}")));
    }
    assert!(dead.is_empty(), "links that lead nowhere:\n{}", dead.join("\n"));
}

#[test]
fn commands_are_found_and_made_small() {
    let text = "```rust\nnot this\n```\n```sh\n# nor this\ncargo run --release -- render a.glb \\\n  -o b.png  # this\n\
        cargo xtask test\n```\n```text\nall passed\n```\n";
    let shown = commands(text);
    assert_eq!(shown[0].command, "cargo run --release -- render a.glb -o b.png");
    assert_eq!(shown[0].prints, None);
    let test = Shown { command: "cargo xtask test".to_owned(), prints: Some("all passed\n".to_owned()) };
    assert_eq!(shown[1..], [test]);
    let words = small("cargo run --release -- render a.glb").expect("a command of durer");
    assert_eq!(words, ["render", "a.glb", "--scale", "0.1"]);
    let sized = small("cargo run --release -- render --width 20").expect("a command of durer");
    assert_eq!(sized, ["render", "--width", "20"]);
    assert_eq!(small("rm -r scenes"), None);
}
