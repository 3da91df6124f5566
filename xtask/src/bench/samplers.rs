//! `cargo xtask bench samplers`: the noise that each kind of sampler leaves (docs/samplers.md). Figures only: nothing is
//! asserted.
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::Value;

use super::built;
use crate::root;

/// Where the chart is.
const CHART: &str = "docs/samplers.svg";

/// What was asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Options {
    json: bool,
    quick: bool,
    chart: bool,
}

impl Options {
    /// From the words after `bench samplers`.
    pub(crate) fn parse(words: &[&str]) -> anyhow::Result<Self> {
        let mut options = Self::default();
        for word in words {
            match *word {
                "--json" => options.json = true,
                "--quick" => options.quick = true,
                "--chart" => options.chart = true,
                other => bail!("unknown option \"{other}\"; see `cargo xtask help`"),
            }
        }
        Ok(options)
    }
}

/// Builds, measures, reports.
pub(crate) fn run(options: Options) -> anyhow::Result<()> {
    let mut command = Command::new(built::program("samplers")?);
    if options.quick {
        command.arg("--quick");
    }
    if options.chart {
        command.args(["--chart", CHART]);
    }
    let output = command.current_dir(root()?).stderr(std::process::Stdio::inherit()).output()?;
    if !output.status.success() {
        bail!("the benchmark failed");
    }
    let figures: Value = serde_json::from_slice(&output.stdout).context("figures of samplers")?;
    if options.json {
        println!("{figures:#}");
    } else {
        print!("{}", tables(&figures)?);
    }
    Ok(())
}

/// Relative variances, then how many times less than of independent samples that is; after a stroke the same of blurred
/// pictures.
fn tables(figures: &Value) -> anyhow::Result<String> {
    let mut text = String::new();
    for (scene, kinds) in figures.as_object().context("no scenes")? {
        text += &format!("{scene}\n");
        let kinds = kinds.as_array().context("no samplers")?;
        let numbers = |kind: &Value, key: &str| -> Vec<f64> {
            kind[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
        };
        for kind in kinds {
            let mut line = format!("  {:12}", kind["sampler"].as_str().unwrap_or_default());
            for key in ["relative_variance", "blurred"] {
                for (noise, random) in numbers(kind, key).iter().zip(numbers(&kinds[0], key)) {
                    let gain = if *noise > 0.0 { random / noise } else { 1.0 };
                    line += &format!(" {noise:8.1e} {gain:5.2}");
                }
                line += " |";
            }
            text += line.trim_end_matches(" |");
            text.push('\n');
        }
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn options_are_read() {
        let options = Options::parse(&["--json", "--chart"]).expect("good options");
        assert!(options.json && options.chart && !options.quick);
        assert!(Options::parse(&["--fast"]).is_err());
    }

    #[test]
    fn tables_hold_gains() {
        let kind = |word: &str, v: f64| json!({ "sampler": word, "relative_variance": [v], "blurred": [v] });
        let text =
            tables(&json!({ "box": [kind("independent", 0.5), kind("sobol", 0.125)] })).expect("figures");
        assert!(text.contains("1.2e-1  4.00") || text.contains("1.3e-1  4.00"), "{text}");
    }
}
