//! Renderers from the Python Package Index, each in a virtual environment below `target/bench`.
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use super::{
    super::embree::succeed,
    Options, Skipped,
    renderer::{How, Renderer},
};
use crate::root;

/// A package with the renderers that it brings.
struct Package {
    /// What is imported, and the environment's name.
    name: &'static str,
    /// What is installed.
    wanted: &'static str,
    script: &'static str,
    renderers: &'static [(&'static str, &'static [&'static str])],
}

const PACKAGES: [Package; 2] = [
    Package {
        name: "mitsuba",
        wanted: "mitsuba>=3.5,<4",
        script: "mitsuba_peer.py",
        renderers: &[
            ("mitsuba-llvm-multijitter", &["--variant", "llvm_ad_rgb", "--sampler", "multijitter"]),
            ("mitsuba-llvm-independent", &["--variant", "llvm_ad_rgb", "--sampler", "independent"]),
            ("mitsuba-scalar-independent", &["--variant", "scalar_rgb", "--sampler", "independent"]),
        ],
    },
    // From 4.3 on Cycles has metals with measured indices of refraction.
    Package { name: "bpy", wanted: "bpy>=4.3,<6", script: "cycles_peer.py", renderers: &[("cycles", &[])] },
];

/// The Python of an environment in which Mitsuba is, for other benchmarks too. If it cannot be had, why.
pub(in crate::bench) fn mitsuba_python(folder: &Path) -> Result<PathBuf, String> {
    let [mitsuba, _] = &PACKAGES;
    mitsuba.install(folder).map(|(python, _)| python)
}

/// All that were asked for and can be had, ours first, and what cannot.
pub(super) fn renderers(program: &Path, folder: &Path, options: &Options) -> (Vec<Renderer>, Vec<Skipped>) {
    let (mut found, mut skipped) = (Vec::new(), Vec::new());
    if options.wants_renderer("durer") {
        found.push(Renderer { name: "durer", how: How::Durer(program.to_owned()) });
    }
    let llvm = llvm();
    for package in &PACKAGES {
        let wanted = package.renderers.iter().filter(|(name, _)| options.wants_renderer(name));
        let wanted: Vec<_> = wanted.collect();
        if wanted.is_empty() {
            continue;
        }
        match package.install(folder) {
            Ok((python, script)) => found.extend(wanted.into_iter().map(|(name, words)| Renderer {
                name,
                how: How::Script {
                    python: python.clone(),
                    script: script.clone(),
                    words,
                    llvm: llvm.clone(),
                },
            })),
            Err(why) => skipped.push(Skipped::new(package.name, &why)),
        }
    }
    (found, skipped)
}

impl Package {
    /// The Python of its environment and its script; what is there already is kept. If it cannot be had, why.
    fn install(&self, folder: &Path) -> Result<(PathBuf, PathBuf), String> {
        let environment = folder.join(self.name);
        let python = environment.join("bin/python");
        let script = root().map_err(|e| e.to_string())?.join("benches/render").join(self.script);
        let import = || {
            let mut command = Command::new(&python);
            command.args(["-c", &format!("import numpy, {}", self.name)]);
            succeed(command, self.name)
        };
        if import().is_ok() {
            return Ok((python, script));
        }
        eprintln!("==> pip install {}", self.wanted);
        let mut command = Command::new("python3");
        command.args(["-m", "venv"]).arg(&environment);
        succeed(command, "python3 -m venv")?;
        let mut command = Command::new(&python);
        command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
        command.args(["--only-binary", ":all:", "numpy", self.wanted]);
        succeed(command, "pip")?;
        import()?;
        Ok((python, script))
    }
}

/// Mitsuba's `llvm` variants need LLVM as a shared library, of version 16 or newer for AVX-512. Rust's own is at hand; a path
/// in `DRJIT_LIBLLVM_PATH` goes before it, and without either Mitsuba looks where systems have it.
fn llvm() -> Option<PathBuf> {
    if let Some(path) = env::var_os("DRJIT_LIBLLVM_PATH") {
        return Some(path.into());
    }
    let output = Command::new("rustc").args(["--print", "sysroot"]).output().ok()?;
    let folder = Path::new(String::from_utf8_lossy(&output.stdout).trim()).join("lib");
    let files = fs::read_dir(folder).ok()?.flatten().map(|file| file.path());
    let mut libraries = files
        .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libLLVM.so")));
    libraries.next()
}
