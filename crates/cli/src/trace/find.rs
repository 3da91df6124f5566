//! `--find`: all samples of the picture for the worst of them.
use std::sync::atomic::Ordering;

use durer::{
    Prepared,
    drive::Antialias,
    tree::{Find, Found},
};

use super::{Args, check_many};
use crate::{
    exit::{WrongUsage, tell},
    interrupt::Interrupt,
    progress::Bar,
};

/// The worst sample, and whether the search was given up before its end; says what it is. `None`, with a word about it, if
/// there is no such sample.
pub(super) fn search(
    args: &Args,
    find: Find,
    prepared: &Prepared,
    interrupt: &Interrupt,
) -> anyhow::Result<Option<(Found, bool)>> {
    let window = prepared.window();
    if window.area() == 0 {
        return Err(WrongUsage("--crop lies outside the picture: there is nothing to find".to_owned()).into());
    }
    // How many samples an adaptive picture takes is known afterwards only.
    let samples = match prepared.settings.antialias {
        Antialias::Supersample => u64::from(prepared.settings.samples),
        Antialias::Adaptive(_) => 4,
    };
    if prepared.settings.antialias == Antialias::Supersample {
        check_many("--find takes", prepared.settings.samples)?;
    }
    let bar = Bar::new(window.area() * samples, args.talk.quiet);
    let cancel = interrupt.rendering();
    let found = find.search(prepared, &bar, cancel);
    bar.finish();
    let interrupted = cancel.load(Ordering::Relaxed);
    let Some(found) = found else {
        let so_far = if interrupted { " so far" } else { "" };
        tell(&match find {
            Find::Nan => format!("no sample{so_far} is infinite or NaN"),
            _ => format!("nothing was found{so_far}: no sample has a value"),
        });
        return Ok(None);
    };
    if !args.talk.quiet {
        let [x, y] = found.pixel;
        let replay = args.sample_options.replay(found.pixel, found.sample);
        let (word, sample, why) = (find.word(), found.sample, &found.why);
        tell(&format!("{word}: pixel {x},{y}, sample {sample}: {why}\n  durer trace {replay}"));
    }
    Ok(Some((found, interrupted)))
}
