//! `cargo xtask test`: everything that must hold before a change is taken.
use crate::{needs, page, steps::Steps};

/// Links to private items are fine: heads of files are written for readers of the source, too.
const RUSTDOC: &str = "-D warnings -A rustdoc::private_intra_doc_links";

/// How much is checked.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// Everything.
    Full,
    /// Formatting and tests.
    Quick,
}

/// The kernel's tests under AddressSanitizer, with few rays. In a folder of its own: everything is compiled anew, and
/// what others wrote is not worth optimising for it. Examples and documentation have their turn without it.
const SANITIZED: &[&str] = &[
    "test",
    "--config",
    "profile.dev.package.\"*\".opt-level=0",
    "--target",
    "x86_64-unknown-linux-gnu",
    "--target-dir",
    "target/asan",
    "-p",
    "durer-accel",
    "--lib",
    "--test",
    "suite",
    "--",
    // Safe code that reads no tree, and most of the time.
    "--skip=curves::",
    "--skip=points::",
    "--skip=grow::",
];
/// The sanitizer is not stable yet, hence the first.
const SANITIZER: &[(&str, &str)] =
    &[("RUSTC_BOOTSTRAP", "1"), ("RUSTFLAGS", "-Zsanitizer=address"), ("DURER_QUICK", "1")];

/// Runs the only code that may be unsafe where a read or write out of bounds is seen.
fn sanitize(steps: &mut Steps) -> anyhow::Result<()> {
    if cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        return steps.cargo(SANITIZED, SANITIZER);
    }
    println!("\n==> SKIPPED: the kernel's tests under AddressSanitizer run on x86-64 Linux only");
    Ok(())
}

/// Checks the tools, then runs the steps.
pub(crate) fn run(extent: Extent) -> anyhow::Result<()> {
    let full = extent == Extent::Full;
    needs::check(full)?;
    let mut steps = Steps::default();
    steps.cargo(&["fmt", "--all", "--check"], &[])?;
    // Before anything is compiled: the page becomes part of the program.
    let page = page::build_and_check(&mut steps)?;
    if full {
        steps.cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])?;
    }
    steps.cargo(&["test", "--workspace", "--no-fail-fast"], &[])?;
    if full {
        if page {
            page::try_in_browser(&mut steps)?;
        }
        sanitize(&mut steps)?;
        // Only libraries: the program and the façade would both be called `durer`.
        steps.cargo(&["doc", "--workspace", "--no-deps", "--lib"], &[("RUSTDOCFLAGS", RUSTDOC)])?;
        steps.cargo(&["build", "--release"], &[])?;
    }
    steps.print();
    println!("\nall steps passed");
    Ok(())
}
