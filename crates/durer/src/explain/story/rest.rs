//! The last paragraphs: where all light comes from, what was cut off, what is wrong.
use crate::{
    Prepared,
    probe::{StopReason, TreeNode},
};

use super::super::{
    Explanation, Law, Sample,
    explanation::Paragraph,
    survey,
    words::{color, counted, list, luminance, number, percent},
};

/// Where light comes from, however it came.
pub(super) fn sources(explanation: &Explanation) -> Option<Paragraph> {
    if explanation.sources.len() < 2 {
        return None;
    }
    let items: Vec<String> = explanation
        .sources
        .iter()
        .map(|p| format!("{} {} {}", percent(p.share), p.words(), color(p.rgb)))
        .collect();
    Some(Paragraph {
        about: "sources",
        node: None,
        is_detail: true,
        sentences: vec![format!("By where it comes from, over all bounces, the light is {}.", list(&items))],
    })
}

/// Rays that were given up, and what they could have brought.
pub(super) fn cut(prepared: &Prepared, samples: &[Sample], explanation: &Explanation) -> Option<Paragraph> {
    let nodes: Vec<&TreeNode> =
        samples.iter().flat_map(|s| &s.tree.nodes).filter(|n| survey::is_cut(n)).collect();
    if nodes.is_empty() {
        return None;
    }
    let of = |reason: StopReason| nodes.iter().filter(|n| n.stop == Some(reason)).count();
    let mut why = Vec::new();
    let rule = |name: &str| prepared.rules.get(name).map(ToString::to_string).unwrap_or_default();
    match of(StopReason::DepthLimit) {
        0 => {}
        n => why.push(format!("{n} at the depth limit of {}", bounces(&rule("max_depth")))),
    }
    match of(StopReason::ContributionBelowCutoff) {
        0 => {}
        n => why.push(format!(
            "{n} as their share was not above {}",
            threshold(&nodes, rule("min_contribution"))
        )),
    }
    match of(StopReason::Cancelled) {
        0 => {}
        n => why.push(format!("{n} as the record was full")),
    }
    let count = match nodes.len() {
        1 => "1 ray was".to_owned(),
        n => format!("{n} rays were"),
    };
    let why = match why.as_slice() {
        [only] => only.split_once(' ').map_or(only.clone(), |(_, reason)| format!(" {reason}")),
        many => format!(": {}", list(many)),
    };
    let sentences = vec![format!("{count} given up{why}."), bound(prepared, samples, explanation)];
    Some(Paragraph { about: "cut", node: None, is_detail: false, sentences })
}

/// What rays that were given up could have brought.
fn bound(prepared: &Prepared, samples: &[Sample], explanation: &Explanation) -> String {
    let sum: f64 = samples.iter().map(|s| luminance(survey::cut_share(&s.tree))).sum();
    let mean = sum / samples.len().max(1) as f64;
    let share = percent(mean);
    let had = format!("They would have had {share} of the {}", of_what(samples));
    let (Some(missing), Ok(most)) = (explanation.missing, prepared.brightest()) else {
        let why = explanation.no_bound.as_deref().unwrap_or_default();
        let seen = survey::brightest(samples);
        let guess = match seen > 0.0 {
            true => format!(
                " If nothing is brighter than the {} that was seen, it is a luminance of {} at most.",
                number(seen),
                number(mean * seen)
            ),
            false => String::new(),
        };
        return format!("{had}; what they could have added has no bound: {why}.{guess}");
    };
    let whole = luminance(explanation.rgb);
    let share = match whole > 0.0 {
        true => format!(", {} of the {}", percent(luminance(missing) / whole), of_what(samples)),
        false => String::new(),
    };
    format!(
        "{had}; as nothing in the scene is brighter than {}, they could have added {} at most{share}.",
        number(most.into()),
        color(missing)
    )
}

fn of_what(samples: &[Sample]) -> &'static str {
    if samples.len() > 1 { "pixel" } else { "sample" }
}

fn bounces(n: &str) -> String {
    if n == "1" { "1 bounce".to_owned() } else { format!("{n} bounces") }
}

/// The share at which rays are given up, as the rays say if the rules do not.
fn threshold(nodes: &[&TreeNode], rule: String) -> String {
    let told = nodes.iter().filter(|n| n.stop == Some(StopReason::ContributionBelowCutoff));
    let told = told.filter_map(|n| n.limit).map(|l| number(l.threshold.into())).next();
    told.unwrap_or(rule)
}

/// What is wrong; for those who want to know more also that nothing is.
pub(super) fn findings(samples: &[Sample], explanation: &Explanation) -> Option<Paragraph> {
    let rays: usize = samples.iter().map(|s| s.tree.nodes.len()).sum();
    if explanation.findings.is_empty() {
        let text = format!(
            "{} of {} were checked against {} laws of ray tracing, and none breaks any.",
            counted(rays, "ray"),
            counted(samples.len(), "sample"),
            Law::ALL.len()
        );
        return Some(Paragraph { about: "findings", node: None, is_detail: true, sentences: vec![text] });
    }
    let mut sentences = vec!["Something is wrong here.".to_owned()];
    for found in &explanation.findings {
        let more = match (found.finding.rays, found.samples) {
            (1, 1) => String::new(),
            (rays, 1) => format!(" ({} of this sample)", counted(rays, "ray")),
            (_, samples) => format!(" (in {samples} samples)"),
        };
        let text = &found.finding.text;
        let mut letters = text.chars();
        let first: String = letters.next().map(|c| c.to_uppercase().collect()).unwrap_or_default();
        sentences.push(format!("{first}{}{more}.", letters.as_str()));
    }
    Some(Paragraph { about: "findings", node: None, is_detail: false, sentences })
}
