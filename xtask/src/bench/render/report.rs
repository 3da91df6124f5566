//! The figures as tables or as JSON (docs/benchmarks.md).
use serde_json::{Value, json};

use super::{Entry, Results, Skipped, THREADS, spheres};

/// Prints them on stdout.
pub(super) fn print(
    results: &[Results],
    spheres: Option<&spheres::Spheres>,
    skipped: &[Skipped],
    as_json: bool,
) -> anyhow::Result<()> {
    if as_json {
        let value = json!({
            "version": 2, "threads": THREADS,
            "scenes": results.iter().map(scene_value).collect::<Vec<_>>(),
            "povray_spheres": spheres.map(spheres::as_values),
            "skipped": skipped.iter().map(|s| json!({ "what": s.what, "why": s.why })).collect::<Vec<_>>(),
        });
        println!("{value:#}");
        return Ok(());
    }
    for results in results {
        println!("{}", table(results));
    }
    if let Some(spheres) = spheres {
        spheres::print(spheres);
    }
    for Skipped { what, why } in skipped {
        println!("skipped: {what}: {why}");
    }
    Ok(())
}

/// Rendered samples per processor second, in millions.
fn rate(results: &Results, entry: &Entry) -> f64 {
    let scene = results.scene;
    let samples = f64::from(scene.width) * f64::from(scene.height) * f64::from(results.samples);
    samples / entry.least() / 1e6
}

/// Ours by the best of the others that compute the same picture: below 1 we are ahead.
fn by_best_peer(results: &Results) -> Option<f64> {
    let (ours, peers) = results.entries.split_first()?;
    let seconds = |entry: &Entry| entry.seconds_to(results.scene.target);
    let agreeing = peers.iter().filter(|entry| entry.agreement.holds());
    let best = agreeing.map(seconds).min_by(f64::total_cmp)?;
    ours.renderer.is_ours().then(|| seconds(ours) / best)
}

fn scene_value(results: &Results) -> Value {
    let scene = results.scene;
    let entry = |entry: &Entry| {
        let pixels: Vec<_> = entry.mean.pixels.iter().collect();
        let channel = |c: usize| pixels.iter().map(|p| p[c]).sum::<f64>() / pixels.len() as f64;
        json!({
            "renderer": entry.renderer.name, "version": entry.version,
            "render_cpu_seconds": {
                "least": entry.least(), "median": entry.median(),
                "runs": entry.costs.iter().map(|cost| cost.render).collect::<Vec<_>>(),
            },
            "wall_seconds": entry.costs.iter().map(|cost| cost.wall).collect::<Vec<_>>(),
            "msamples_per_cpu_second": rate(results, entry),
            "relative_variance": entry.variance,
            "cpu_seconds_to_target": entry.seconds_to(scene.target),
            "peak_bytes": entry.peak_bytes(),
            "mean_rgb": [channel(0), channel(1), channel(2)],
            "agreement": {
                "bias": entry.agreement.bias, "standard_error": entry.agreement.error,
                "blocks": entry.agreement.blocks, "holds": entry.agreement.holds(),
            },
        })
    };
    json!({
        "scene": scene.name, "width": scene.width, "height": scene.height, "spp": results.samples,
        "depth": scene.depth, "target": scene.target, "counted_share": results.counted,
        "durer_by_best_peer": by_best_peer(results),
        "renderers": results.entries.iter().map(entry).collect::<Vec<_>>(),
    })
}

fn table(results: &Results) -> String {
    let scene = results.scene;
    let mut text = format!(
        "{}, {} x {}, {} samples per pixel, {} bounces, {THREADS} threads\n\n",
        scene.name, scene.width, scene.height, results.samples, scene.depth
    );
    let target = format!("s to {:.0e}", scene.target);
    text += &line(
        "",
        ["CPU s", "median", "Msamples/s", "variance", &target, "MB", "bias %", "blocks %"].map(str::to_owned),
    );
    for entry in &results.entries {
        let peak = entry.peak_bytes().map_or("-".to_owned(), |bytes| format!("{:.0}", bytes as f64 / 1e6));
        let cells = [
            format!("{:.2}", entry.least()),
            format!("{:.2}", entry.median()),
            format!("{:.3}", rate(results, entry)),
            format!("{:.2e}", entry.variance),
            format!("{:.2}", entry.seconds_to(scene.target)),
            peak,
            format!("{:+.2}", 100.0 * entry.agreement.bias),
            format!(
                "{:.2}{}",
                100.0 * entry.agreement.blocks,
                if entry.agreement.holds() { "" } else { " !" }
            ),
        ];
        text += &line(entry.renderer.name, cells);
    }
    match by_best_peer(results) {
        Some(ratio) => text += &format!("durer by the best peer with the same picture: {ratio:.2}\n"),
        None => text += "no peer rendered the same picture\n",
    }
    text
}

fn line(name: &str, cells: [String; 8]) -> String {
    let cells: String = cells.iter().map(|cell| format!(" {cell:>10}")).collect();
    format!("{name:<28}{cells}\n")
}
