//! One run of POV-Ray, and what it says about it.
use std::{
    path::Path,
    process::{Command, Stdio},
};

use anyhow::Context;

use super::{HEIGHT, Mode, Run, THREADS, WIDTH};
use crate::measure::measure;

pub(super) fn is_installed() -> bool {
    let mut command = Command::new("povray");
    command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// The file's name.
pub(super) const PICTURE: &str = "povray.png";

/// Leaves [`PICTURE`] in the folder.
pub(super) fn render(scene: &Path, folder: &Path, mode: Mode) -> anyhow::Result<Run> {
    let mut command = Command::new("povray");
    command.arg(format!("+I{}", scene.display())).current_dir(folder);
    command.args([format!("+W{WIDTH}"), format!("+H{HEIGHT}"), format!("+WT{THREADS}")]);
    // No window, no progress.
    command.args(["-D", "-V", &format!("+O{PICTURE}")]);
    command.args(match mode {
        Mode::Plain => ["-A"].as_slice(),
        // What the manual recommends: 3 x 3 more samples where neighbours differ by 0.3.
        Mode::Antialiased => &["+A0.3"],
        // 9 x 9 where they differ at all.
        Mode::Converged => &["+A0.0", "+AM1", "+R9", "-J"],
    });
    let measured = measure(&mut command)?;
    let said =
        Said::read(&String::from_utf8_lossy(&measured.output.stderr)).context("POV-Ray's statistics")?;
    let Said { trace, rays, shadow_tests } = said;
    Ok(Run { wall: measured.wall, user: measured.user, trace, rays, shadow_tests })
}

/// POV-Ray 3.7's own figures.
#[derive(Debug, PartialEq)]
struct Said {
    trace: f64,
    rays: u64,
    shadow_tests: u64,
}

impl Said {
    fn read(log: &str) -> Option<Self> {
        let after = |label: &str| log.split(['\r', '\n']).find_map(|line| line.trim().strip_prefix(label));
        let number = |label: &str| after(label)?.split_whitespace().next()?.parse().ok();
        // "0 hours  0 minutes  0 seconds (0.608 seconds)"
        let (_, trace) = after("Trace Time:")?.rsplit_once('(')?;
        Some(Self {
            trace: trace.split_whitespace().next()?.parse().ok()?,
            rays: number("Rays:")?,
            shadow_tests: number("Shadow Ray Tests:")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closing_statistics_are_read() {
        let log = "Rendered 10 of 20 pixels\rRender Statistics\n\
            Rays:            2500774   Saved:            166482   Max Level: 10/10\n\
            Shadow Ray Tests:           1710657   Succeeded:                422263\n\
            Render Time:\n  Photon Time:      No photons\n\
            \x20 Trace Time:       0 hours  0 minutes  0 seconds (0.608 seconds)\n\
            \x20             using 2 thread(s) with 1.041 CPU-seconds total\n";
        assert_eq!(Said::read(log), Some(Said { trace: 0.608, rays: 2500774, shadow_tests: 1710657 }));
        assert_eq!(Said::read("Parse Error: no such file"), None);
    }
}
