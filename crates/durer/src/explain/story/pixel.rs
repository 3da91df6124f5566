//! The first paragraphs: the colour, its parts, and how the samples differ.
use crate::{Prepared, drive::Antialias};

use super::super::{
    Explanation, Part, Sample,
    explanation::Paragraph,
    survey,
    words::{color, counted, list, luminance, number, percent},
};

/// Parts below this share are not named.
const WORTH: f64 = 0.01;
/// Below this nothing is said of them together either.
const LEAST: f64 = 0.005;

/// What the pixel is, and of what it is made.
pub(super) fn summary(
    prepared: &Prepared,
    samples: &[Sample],
    detailed: &Sample,
    explanation: &Explanation,
) -> Paragraph {
    let Explanation { scene, integrator, pixel: [x, y], rgb, explained, samples: count, .. } = explanation;
    let value = color(*rgb);
    let mut sentences = Vec::new();
    let of = format!("Pixel {x},{y} of {scene} ({integrator})");
    let bad = explanation.spread.as_ref().map_or(0, |s| s.bad.len());
    match (samples.len(), explained.len()) {
        (1, _) if *count > 1 => {
            sentences.push(format!("Sample {} of {count} of {} is {value}.", detailed.number, lower(&of)));
        }
        (1, _) => sentences.push(format!("{of} is {value}, by its only sample.")),
        (_, told) if told == *count as usize => {
            let mean = match prepared.settings.antialias {
                Antialias::Supersample => format!("the mean of its {count} samples"),
                Antialias::Adaptive(_) => format!("made of {count} samples, each for its area"),
            };
            sentences.push(format!("{of} is {value}, {mean}."));
        }
        (_, told) => {
            sentences.push(format!("{of} is {value}; this tells of {told} of its {count} samples."));
        }
    }
    if let Some(wavelengths) = detailed.tree.basis.wavelengths() {
        let nm: Vec<String> = wavelengths.nm().map(|nm| format!("{nm:.1}")).to_vec();
        sentences.push(format!(
            "Rays of sample {} carry light of {} nm: where four numbers stand they are of these.",
            detailed.number,
            list(&nm)
        ));
    }
    if !detailed.is_finite() && bad == 0 {
        sentences.push("The film leaves such a sample out.".to_owned());
    }
    if matches!(prepared.integrator.facts().output, crate::Output::Radiance) && detailed.is_finite() {
        sentences.push(parts(explanation));
        sentences.extend(on_film(detailed));
    }
    Paragraph { about: "pixel", node: None, is_detail: false, sentences }
}

/// What camera and film make of what arrives, step by step; nothing where they leave it.
fn on_film(sample: &Sample) -> Option<String> {
    let eye = sample.tree.eye.as_ref()?;
    let (gain, film) = (eye.gain, eye.developing);
    let steps: Vec<String> = [
        (gain != 1.0).then(|| format!("times {} by lens and speed of the film", number(gain.into()))),
        (film.clamp != 1.0).then(|| format!("times {} as the film takes no more", number(film.clamp.into()))),
        film.balance.map(|_| "balanced for the white of the film".to_owned()),
    ]
    .into_iter()
    .flatten()
    .collect();
    (!steps.is_empty()).then(|| {
        format!(
            "Along the eye ray of sample {} arrives {}; {} that is {}.",
            sample.number,
            color(sample.arriving()),
            list(&steps),
            color(sample.rgb)
        )
    })
}

fn lower(of: &str) -> String {
    of.replacen("Pixel", "pixel", 1)
}

/// Of what the colour is made.
fn parts(explanation: &Explanation) -> String {
    if explanation.parts.iter().all(|p| luminance(p.rgb) == 0.0) {
        return "It is black: no light comes to it.".to_owned();
    }
    if let [only] = explanation.parts.as_slice() {
        return format!("All of it is {}.", only.words());
    }
    let (named, others): (Vec<&Part>, Vec<&Part>) = explanation.parts.iter().partition(|p| p.share >= WORTH);
    if let ([only], true) = (named.as_slice(), others.iter().map(|p| p.share).sum::<f64>() < LEAST) {
        return format!("Nearly all of it is {}.", only.words());
    }
    let mut items: Vec<String> =
        named.iter().map(|p| format!("{} {}", percent(p.share), describe(p))).collect();
    if !others.is_empty() {
        let rest: f64 = others.iter().map(|p| p.share).sum();
        if rest >= LEAST {
            items.push(format!("{} is other light", percent(rest)));
        }
    }
    format!("Of this light {}.", list(&items))
}

fn describe(part: &Part) -> String {
    let words = part.words();
    match part.kind {
        super::super::PartKind::Reflection
        | super::super::PartKind::Refraction
        | super::super::PartKind::Gloss
        | super::super::PartKind::Translucency => format!("comes by {words}"),
        _ => format!("is {words}"),
    }
}

/// How the samples differ; nothing where they are alike.
pub(super) fn samples(
    prepared: &Prepared,
    samples: &[Sample],
    explanation: &Explanation,
) -> Option<Paragraph> {
    let spread = explanation.spread.as_ref()?;
    let mut sentences = Vec::new();
    let count = samples.len();
    let seen = survey::objects(prepared, samples);
    if seen.len() > 1 {
        let items: Vec<String> = seen
            .iter()
            .take(4)
            .map(|(name, n)| match name {
                Some(name) => format!("{n} \"{name}\""),
                None => format!("{n} nothing but the sky"),
            })
            .collect();
        sentences.push(format!("Of {count} samples {} see {}.", seen_total(&seen), list(&items)));
    }
    for light in survey::lights(prepared, samples) {
        sentences.extend(visibility(&light, count));
    }
    let mean = luminance(explanation.rgb);
    let finite: Vec<_> = samples.iter().filter(|s| s.is_finite()).collect();
    if mean > 0.0 && finite.len() > 1 && spread.deviation > 0.02 * mean {
        let (sample, brightest) = spread.brightest;
        let (least, times) = (spread.darkest.1 / mean, brightest / mean);
        sentences.push(format!(
            "The samples are {} to {} times as bright as the pixel, with a deviation of {}; the brightest is sample \
             {sample}{}.",
            number(least),
            number(times),
            percent(spread.deviation / mean),
            if times > 10.0 { ": a firefly" } else { "" }
        ));
    }
    if !spread.bad.is_empty() {
        let numbers: Vec<String> = spread.bad.iter().take(5).map(u32::to_string).collect();
        sentences.push(format!(
            "{} infinite or not a number and left out by the film: {}.",
            if spread.bad.len() == 1 {
                "1 sample is".to_owned()
            } else {
                format!("{} samples are", spread.bad.len())
            },
            list(&numbers)
        ));
    }
    (!sentences.is_empty()).then_some(Paragraph { about: "samples", node: None, is_detail: false, sentences })
}

fn seen_total(seen: &[(Option<String>, usize)]) -> &'static str {
    if seen.len() > 4 { "most" } else { "all" }
}

/// How many samples a light reaches, if not all or none are the same.
fn visibility(seen: &survey::Seen, samples: usize) -> Option<String> {
    if seen.asked < 2
        || seen.lit == seen.asked
        || seen.blockers.is_empty()
        || (seen.lit == 0 && seen.blockers.len() == 1)
    {
        return None;
    }
    let blockers: Vec<String> = seen.blockers.iter().take(3).map(|(name, _)| format!("\"{name}\"")).collect();
    let (light, lit, asked) = (&seen.light, seen.lit, seen.asked);
    let whom = match asked == samples {
        true => counted(asked, "sample"),
        false => format!("the {} that ask it", counted(asked, "sample")),
    };
    Some(match lit {
        0 => format!("Light \"{light}\" reaches none of {whom}: {} in its way.", stand(&blockers)),
        _ => format!(
            "Light \"{light}\" reaches {lit} of {whom} ({}): its half-shadow, as {} in the way of the others.",
            percent(lit as f64 / asked as f64),
            stand(&blockers)
        ),
    })
}

fn stand(names: &[String]) -> String {
    format!("{} {}", list(names), if names.len() == 1 { "stands" } else { "stand" })
}
