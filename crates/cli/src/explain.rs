//! `durer explain`: why a pixel has its colour.

use durer::{
    explain::{explain, explain_one},
    tree::Subject,
};

use crate::{
    exit::{Exit, emit, emit_json, harmless},
    load::load,
    options::{SampleOptions, TalkOptions},
    report,
    trace::{check_many, check_pixel, check_sample},
    value::{pixel, whole},
};

/// Letters of a line.
const LINE: usize = 100;

const EXAMPLES: &str = "\
Examples:
  durer explain --pixel 640,360
  durer explain room.glb --pixel 320,240 -v                all surfaces and sources
  durer explain snell --pixel 100,400                      total internal reflection
  durer explain penumbra --integrator distributed --pixel 480,300
  durer explain room.glb --pixel 10,20 --sample 7          one sample, not the mean
  durer explain room.glb --pixel 10,20 --json | jq .findings

Give the options of the render whose pixel you mean. The first paragraph names the
parts of the colour by what the first surface does with light; then the ray that
brings most is followed, with the numbers in the formulas: Lambert kd / pi E cos a,
the highlight, Snell n1 sin a = n2 sin b, Fresnel R and T, Beer and Lambert
exp(-sigma d). What was cut off is named with a bound on what it could have added.

Every ray is checked against the laws of ray tracing, computed anew from the scene:
shadow rays lead to their light, normals are those of the shapes, refraction follows
Snell and Fresnel for the bodies on both sides, mirrored rays are mirrored, no body is
left that was not entered, no light comes from nothing, and the sum is the pixel. What
breaks a law is said at the end.

All samples of the pixel are told of, at most 256, evenly chosen. The keys of the JSON
are described in docs/explain.md; within a version keys may be added, none renamed.";

/// Says why a pixel has its colour.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample_options: SampleOptions,
    /// Which pixel; 0,0 is the upper left one.
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    #[arg(help_heading = "Explanation")]
    pixel: [u32; 2],
    /// One of its samples, from 0, instead of all of them.
    #[arg(long, value_name = "K", value_parser = whole(0u32..=u32::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Explanation")]
    sample: Option<u32>,
    /// As JSON on stdout.
    #[arg(long, help_heading = "Explanation")]
    json: bool,
    #[command(flatten)]
    talk: TalkOptions,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let name = &args.sample_options.scene.scene;
    // What is left to do for one pixel is not worth more threads.
    let options = durer::Options { threads: Some(1), ..args.sample_options.wishes() };
    let loaded = load(name, &options);
    report::print(name, &loaded.imported, &args.talk);
    let Some(prepared) = &loaded.prepared else {
        return Ok(loaded.failure);
    };
    check_pixel(prepared, args.pixel)?;
    let subject = Subject { name, prepared };
    let count = prepared.job().sample_count(args.pixel);
    let explanation = match args.sample {
        Some(sample) => {
            check_sample(prepared, count, sample)?;
            explain_one(&subject, args.pixel, sample)
        }
        None => {
            check_many("the mean is made of", count)?;
            explain(&subject, args.pixel, &subject.samples(args.pixel), None)
        }
    };
    if args.json {
        emit_json(&explanation)?;
    } else {
        emit(&harmless(&wrapped(&explanation.text(args.talk.verbose))))?;
    }
    Ok(Exit::Done)
}

/// Text in lines of [`LINE`] letters at most, where words allow.
fn wrapped(text: &str) -> String {
    let mut out = String::new();
    for paragraph in text.lines() {
        let mut length = 0;
        for word in paragraph.split(' ') {
            let own = word.chars().count();
            if length > 0 && length + 1 + own > LINE {
                out.push('\n');
                length = 0;
            } else if length > 0 {
                out.push(' ');
                length += 1;
            }
            out += word;
            length += own;
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::wrapped;

    #[test]
    fn lines_are_not_too_long_and_nothing_is_lost() {
        let text = format!("{}\n\n{}", "some words ".repeat(40).trim_end(), "x".repeat(300));
        let lines = wrapped(&text);
        assert!(lines.lines().all(|l| l.chars().count() <= 100 || !l.contains(' ')));
        let words = |t: &str| t.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&lines), words(&text));
        assert!(lines.contains("\n\n"));
    }
}
