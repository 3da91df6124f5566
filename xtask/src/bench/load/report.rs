//! The figures as a table of Markdown.
use std::fmt::Write;

use serde_json::Value;

/// One line for each scene, and what was skipped.
pub(super) fn as_table(figures: &Value) -> String {
    let mut text = "| scene | MB | triangles | reading, MB/s with 1 and 2 threads | of a thread's time | ready: cpu s, wall s | \
                    Mitsuba | pbrt-v4 |\n|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for row in figures["rows"].as_array().into_iter().flatten() {
        let megabytes = row["bytes"].as_f64().unwrap_or(f64::NAN) / 1e6;
        let rate =
            |pointer: &str| row.pointer(pointer).and_then(Value::as_f64).map_or(f64::NAN, |s| megabytes / s);
        let pair = |pointer: &str| {
            let of = |clock: &str| row.pointer(&format!("{pointer}/{clock}")).and_then(Value::as_f64);
            of("cpu")
                .zip(of("wall"))
                .map_or_else(|| "–".to_owned(), |(cpu, wall)| format!("{cpu:.2}, {wall:.2}"))
        };
        let _ = writeln!(
            text,
            "| {} | {megabytes:.1} | {} | {:.0}, {:.0} | {:.0} | {} | {} | {} |",
            row["scene"].as_str().unwrap_or_default(),
            row["triangles"],
            rate("/durer-1/read/wall"),
            rate("/durer-2/read/wall"),
            rate("/durer-2/read/cpu"),
            pair("/durer-2/ready"),
            pair("/mitsuba"),
            pair("/pbrt"),
        );
    }
    for reason in figures["skipped"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        let _ = writeln!(text, "SKIPPED: {reason}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_line_holds_rates_and_times() {
        let clocks = |cpu: f64, wall: f64| json!({ "cpu": cpu, "wall": wall });
        let figures = json!({
            "rows": [{ "scene": "OBJ", "bytes": 40_000_000, "triangles": 12,
                "durer-1": { "read": clocks(0.2, 0.2), "ready": clocks(1.0, 1.0) },
                "durer-2": { "read": clocks(0.25, 0.1), "ready": clocks(1.0, 0.5) },
                "mitsuba": clocks(3.0, 2.0) }],
            "skipped": ["pbrt-v4: not there"],
        });
        let text = as_table(&figures);
        assert!(
            text.contains("| OBJ | 40.0 | 12 | 200, 400 | 160 | 1.00, 0.50 | 3.00, 2.00 | – |"),
            "{text}"
        );
        assert!(text.ends_with("SKIPPED: pbrt-v4: not there\n"));
    }
}
