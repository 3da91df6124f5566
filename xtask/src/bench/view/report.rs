//! The figures as tables.
use std::fmt::Write;

use serde_json::Value;

use super::Figures;

/// All tables, those without rows left out.
pub(super) fn as_tables(figures: &Figures) -> String {
    let mut text = String::new();
    for recording in &figures.recordings {
        recorded(&mut text, recording);
    }
    for live in &figures.live {
        watched(&mut text, live);
    }
    for command in &figures.commands {
        let (scene, output) = (word(command, "/scene"), word(command, "/output"));
        line(&mut text, &format!("durer trace {scene} {output}: {}", seconds(command, "/median")));
    }
    for page in &figures.pages {
        let kilobytes = page["bytes"].as_f64().map_or(f64::NAN, |bytes| bytes / 1000.0);
        line(&mut text, &format!("page {}: {kilobytes:.0} kB", word(page, "/page")));
    }
    for page in &figures.browser {
        let fps = page["fps"].as_f64().unwrap_or(f64::NAN);
        let (name, rays, shown) = (word(page, "/page"), &page["rays"], &page["shown"]);
        let (opened, drawn) = (seconds(page, "/opened"), word(page, "/renderer"));
        let (step, worst) = (seconds(page, "/step/median"), seconds(page, "/step/worst"));
        line(&mut text, &format!("in Chromium {name}: {rays} rays, {shown} shown, opened in {opened}"));
        line(
            &mut text,
            &format!("  {fps:.1} frames per second, a step of the selection {step}, worst {worst}; {drawn}"),
        );
    }
    if figures.browser.iter().any(|page| word(page, "/renderer").contains("SwiftShader")) {
        line(&mut text, "SwiftShader draws on the processor: a graphics card is many times faster.");
    }
    for reason in &figures.skipped {
        line(&mut text, &format!("SKIPPED: {reason}"));
    }
    text
}

fn watched(text: &mut String, of: &Value) {
    let (scene, integrator) = (word(of, "/scene"), word(of, "/integrator"));
    let (loaded, first) = (seconds(of, "/loaded"), seconds(of, "/first_picture"));
    line(text, &format!("durer view {scene}, {integrator}: {} triangles", of["triangles"]));
    line(text, &format!("  loaded in {loaded}, first picture {first} after the page was opened"));
    let (median, worst) = (seconds(of, "/orbit/median"), seconds(of, "/orbit/worst"));
    let per_second = of["orbit"]["per_second"].as_f64().unwrap_or(f64::NAN);
    let edge = of["orbit"]["pixels_per_sample_edge"].as_f64().unwrap_or(f64::NAN);
    line(
        text,
        &format!(
            "  orbiting: {per_second:.0} pictures per second, of a sample in {edge:.0} x {edge:.0} pixels; \
             from a move to its picture median {median}, worst {worst}"
        ),
    );
    for (key, name) in [("one_sample", "rays of one sample"), ("all_samples", "of all samples")] {
        let [median, worst] = ["median", "worst"].map(|what| seconds(of, &format!("/trace/{key}/{what}")));
        let rays = &of["trace"][key]["rays"];
        line(text, &format!("  {name}: median {median}, worst {worst}; {rays} rays"));
    }
}

fn recorded(text: &mut String, of: &Value) {
    let (scene, integrator) = (word(of, "/scene"), word(of, "/integrator"));
    let (triangles, pixels, samples) = (&of["triangles"], &of["pixels"], &of["samples"]);
    line(text, &format!("{scene}, {integrator}: {triangles} triangles, {pixels} pixels, {samples} samples"));
    for (key, name) in [
        ("one_sample", "tree of one sample"),
        ("all_samples", "trees of all samples"),
        ("document", "document of all samples"),
    ] {
        let (median, worst) = (seconds(of, &format!("/{key}/median")), seconds(of, &format!("/{key}/worst")));
        let (nodes, most) = (&of[key]["nodes_median"], &of[key]["nodes_most"]);
        line(
            text,
            &format!("  {name:<24} median {median:>10}, worst {worst:>10}; nodes {nodes}, most {most}"),
        );
    }
}

fn word<'a>(value: &'a Value, pointer: &str) -> &'a str {
    value.pointer(pointer).and_then(Value::as_str).unwrap_or("-")
}

/// A time with a unit that suits it.
fn seconds(value: &Value, pointer: &str) -> String {
    match value.pointer(pointer).and_then(Value::as_f64) {
        None => "-".to_owned(),
        Some(time) if time < 1e-3 => format!("{:.1} µs", time * 1e6),
        Some(time) if time < 1.0 => format!("{:.1} ms", time * 1e3),
        Some(time) => format!("{time:.2} s"),
    }
}

fn line(text: &mut String, content: &str) {
    // Writing into a string cannot fail.
    let _ = writeln!(text, "{content}");
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn times_have_units_that_suit() {
        let value = json!({ "a": 0.000_025, "b": 0.25, "c": 2.0 });
        let shown = ["/a", "/b", "/c", "/d"].map(|key| seconds(&value, key));
        assert_eq!(shown, ["25.0 µs", "250.0 ms", "2.00 s", "-"]);
    }

    #[test]
    fn what_was_skipped_is_told() {
        let mut figures = Figures::default();
        figures.pages.push(json!({ "page": "one", "bytes": 1_500_000 }));
        figures.skipped.push("why".to_owned());
        assert_eq!(as_tables(&figures), "page one: 1500 kB\nSKIPPED: why\n");
    }
}
