//! `cargo xtask test`: everything that must hold before a change is taken.
use crate::{needs, steps::Steps};

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

/// Checks the tools, then runs the steps.
pub(crate) fn run(extent: Extent) -> anyhow::Result<()> {
    let full = extent == Extent::Full;
    needs::check(full)?;
    let mut steps = Steps::default();
    steps.cargo(&["fmt", "--all", "--check"], &[])?;
    if full {
        steps.cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])?;
    }
    steps.cargo(&["test", "--workspace", "--no-fail-fast"], &[])?;
    if full {
        // Only libraries: the program and the façade would both be called `durer`.
        steps.cargo(&["doc", "--workspace", "--no-deps", "--lib"], &[("RUSTDOCFLAGS", RUSTDOC)])?;
        steps.cargo(&["build", "--release"], &[])?;
    }
    steps.print();
    println!("\nall steps passed");
    Ok(())
}
