//! `cargo xtask page`: the HTML pages, from TypeScript to the files that the program carries, and their tests.
use std::{
    fs,
    path::PathBuf,
    process::{Command, Stdio},
};

use anyhow::{Context, bail};

use crate::{root, steps::Steps, target_folder};

/// Oldest Node that the tools of the page run on.
const OLDEST: (u32, u32) = (18, 19);

/// npm, as the system calls it.
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// Where Chromium may be; `DURER_CHROMIUM` names another place.
const CHROMIUM: &[&str] = &["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/// The pages that are built, and what the crate that carries them calls them.
const PAGES: [(&str, &str); 2] = [("index.html", "durer.html"), ("view.html", "view.html")];

/// Builds the page, or says what is missing.
pub(crate) fn run() -> anyhow::Result<()> {
    if let Some(complaint) = missing() {
        bail!("the page cannot be built: {complaint}");
    }
    let mut steps = Steps::default();
    build(&mut steps)
}

/// Builds and checks the page if Node is there. True if it was.
pub(crate) fn build_and_check(steps: &mut Steps) -> anyhow::Result<bool> {
    if let Some(complaint) = missing() {
        println!("\n==> SKIPPED: the HTML page is neither built nor tested: {complaint}");
        return Ok(false);
    }
    build(steps)?;
    steps.program(&[NPM, "run", "check"], "page", &[])?;
    steps.program(&[NPM, "test"], "page", &[])?;
    Ok(true)
}

/// Opens pages in Chromium if it is there: those of the fixtures, and those that the program writes.
pub(crate) fn try_in_browser(steps: &mut Steps) -> anyhow::Result<()> {
    if !has_chromium() {
        println!("\n==> SKIPPED: the HTML page's tests in a browser: no Chromium (apt-get install chromium)");
        return Ok(());
    }
    steps.cargo(&["build", "--package", "durer-cli"], &[])?;
    let program = target_folder()?.join("debug").join(format!("durer{}", std::env::consts::EXE_SUFFIX));
    let program = program.to_str().context("the target folder's name is no UTF-8")?;
    steps.program(&[NPM, "run", "test:browser"], "page", &[("DURER_BIN", program)])
}

/// Whether Chromium is where the page's tests look for it.
pub(crate) fn has_chromium() -> bool {
    let named = std::env::var_os("DURER_CHROMIUM").map(PathBuf::from);
    named.into_iter().chain(CHROMIUM.iter().map(PathBuf::from)).any(|place| place.is_file())
}

/// What is missing for building the page, with its cure.
pub(crate) fn missing() -> Option<String> {
    let version = said(&["node", "--version"]);
    let enough = version.as_deref().and_then(parse).is_some_and(|version| version >= OLDEST);
    let (major, minor) = OLDEST;
    if !enough {
        let found = version.map_or("no Node".to_owned(), |v| format!("Node {}", v.trim()));
        return Some(format!("{found}, but {major}.{minor} or newer is needed (https://nodejs.org)"));
    }
    said(&[NPM, "--version"]).is_none().then(|| "no npm (it comes with Node)".to_owned())
}

/// What a program prints, if it can be run.
fn said(words: &[&str]) -> Option<String> {
    let (program, rest) = words.split_first()?;
    let output = Command::new(program).args(rest).stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Major and minor of "v20.19.2".
fn parse(version: &str) -> Option<(u32, u32)> {
    let mut parts = version.trim().trim_start_matches('v').split('.').map(str::parse);
    Some((parts.next()?.ok()?, parts.next()?.ok()?))
}

fn build(steps: &mut Steps) -> anyhow::Result<()> {
    let folder = root()?.join("page");
    // Packages are installed anew only if the list of them changed.
    let lock = fs::read(folder.join("package-lock.json")).context("page/package-lock.json")?;
    let stamp = folder.join("node_modules").join(".durer-lock");
    if fs::read(&stamp).ok().as_deref() != Some(lock.as_slice()) {
        steps.program(&[NPM, "ci"], "page", &[])?;
        fs::write(&stamp, &lock).with_context(|| stamp.display().to_string())?;
    }
    steps.program(&[NPM, "run", "build"], "page", &[])?;
    for (name, carried) in PAGES {
        let from = folder.join("dist").join(name);
        let built = fs::read(&from).with_context(|| from.display().to_string())?;
        let target = root()?.join("crates").join("page").join("dist").join(carried);
        // The same file again would have everything compiled that depends on it.
        if fs::read(&target).ok().as_deref() != Some(built.as_slice()) {
            fs::write(&target, &built).with_context(|| target.display().to_string())?;
        }
        println!("    {} kB in {}", built.len() / 1000, target.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn versions_are_compared_as_numbers() {
        assert_eq!(parse("v20.9.1\n"), Some((20, 9)));
        assert!(parse("v20.9.1") > Some((18, 19)) && parse("v18.9.0") < Some((18, 19)));
        assert_eq!(parse("none"), None);
    }
}
