//! The figures as a table or as JSON.
use serde_json::{Value, json};

use super::{Comparison, HEIGHT, Mode, Run, Spheres, THREADS, WIDTH};

/// Prints the tables on stdout.
pub(in super::super) fn print(spheres: &Spheres) {
    let Spheres { comparisons, rmse } = spheres;
    for Comparison { mode, ours, theirs } in comparisons {
        println!("{}", as_table(title(*mode), ours, theirs));
    }
    for (name, rmse) in ["durer", "povray"].iter().zip(rmse) {
        println!("{name}, antialiased: RMSE {rmse:.5} to its own converged picture");
    }
}

fn title(mode: Mode) -> &'static str {
    match mode {
        Mode::Plain => "one sample per pixel",
        Mode::Antialiased => "durer --antialias adaptive, povray +A0.3",
        Mode::Converged => "converged",
    }
}

/// As JSON.
pub(in super::super) fn as_values(spheres: &Spheres) -> Value {
    let Spheres { comparisons, rmse } = spheres;
    let mut all = json!({
        "version": 1, "scene": "povray_spheres", "width": WIDTH, "height": HEIGHT, "spp": 1, "threads": THREADS,
        "rmse": { "durer": rmse.first(), "povray": rmse.get(1) },
    });
    for Comparison { mode, ours, theirs } in comparisons {
        let value = as_value(ours, theirs);
        // One sample per pixel was the only mode once.
        match (*mode, &mut all, value) {
            (Mode::Plain, Value::Object(all), Value::Object(value)) => all.extend(value),
            (_, all, value) => all["antialiased"] = value,
        }
    }
    all
}

fn as_table(title: &str, ours: &[Run], theirs: &[Run]) -> String {
    let mut text = format!("povray_spheres, {WIDTH} x {HEIGHT}, {title}, {THREADS} threads\n\n");
    let heads = ["wall s", "user s", "trace s", "rays", "shadow tests"];
    text.push_str(&line("", &heads.map(str::to_owned)));
    for (name, runs) in [("durer", ours), ("povray", theirs)] {
        if runs.is_empty() {
            continue;
        }
        for (number, run) in runs.iter().enumerate() {
            text.push_str(&row(&format!("{name}, run {}", number + 1), run));
        }
        text.push_str(&row(&format!("{name}, median"), &Run::median(runs)));
    }
    if !theirs.is_empty() {
        let cells =
            ratios(ours, theirs).map(|(_, ratio)| ratio.map_or("-".to_owned(), |r| format!("{r:.3}")));
        text.push_str(&line("durer / povray", &cells));
    }
    text
}

fn row(name: &str, run: &Run) -> String {
    let time = |seconds: f64| format!("{seconds:.3}");
    let user = run.user.map_or("-".to_owned(), time);
    line(name, &[time(run.wall), user, time(run.trace), run.rays.to_string(), run.shadow_tests.to_string()])
}

fn line(name: &str, cells: &[String; 5]) -> String {
    let cells: String = cells.iter().map(|cell| format!(" {cell:>12}")).collect();
    format!("{name:<16}{cells}\n")
}

/// Medians of durer by those of POV-Ray: a time below 1 means that durer is faster.
fn ratios(ours: &[Run], theirs: &[Run]) -> [(&'static str, Option<f64>); 5] {
    let (a, b) = (Run::median(ours), Run::median(theirs));
    [
        ("wall", Some(a.wall / b.wall)),
        ("user", a.user.zip(b.user).map(|(a, b)| a / b)),
        ("trace", Some(a.trace / b.trace)),
        ("rays", Some(a.rays as f64 / b.rays as f64)),
        ("shadow_tests", Some(a.shadow_tests as f64 / b.shadow_tests as f64)),
    ]
}

fn as_value(ours: &[Run], theirs: &[Run]) -> Value {
    let one = |run: &Run| {
        json!({
            "wall": run.wall, "user": run.user, "trace": run.trace,
            "rays": run.rays, "shadow_tests": run.shadow_tests,
        })
    };
    let program = |runs: &[Run]| match runs {
        [] => Value::Null,
        _ => json!({ "runs": runs.iter().map(one).collect::<Vec<_>>(), "median": one(&Run::median(runs)) }),
    };
    let ratios = match theirs {
        [] => Value::Null,
        _ => ratios(ours, theirs).into_iter().map(|(name, ratio)| (name.to_owned(), json!(ratio))).collect(),
    };
    json!({
        "durer": program(ours), "povray": program(theirs), "durer_by_povray": ratios,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUN: Run = Run { wall: 0.5, user: Some(0.8), trace: 0.4, rays: 100, shadow_tests: 60 };

    #[test]
    fn ratios_are_ours_by_theirs() {
        let slower = Run { wall: 1.0, user: None, trace: 0.8, rays: 200, ..RUN };
        let value = as_value(&[RUN], &[slower]);
        assert_eq!(value["durer_by_povray"]["wall"], 0.5);
        assert_eq!(value["durer_by_povray"]["user"], Value::Null);
        assert_eq!(value["durer_by_povray"]["shadow_tests"], 1.0);
        assert!(
            as_table("plain", &[RUN], &[slower])
                .lines()
                .last()
                .is_some_and(|line| line.starts_with("durer / povray"))
        );
    }

    #[test]
    fn the_plain_comparison_is_where_it_was() {
        let of = |mode| Comparison { mode, ours: vec![RUN], theirs: Vec::new() };
        let value =
            as_values(&Spheres { comparisons: [of(Mode::Plain), of(Mode::Antialiased)], rmse: vec![0.25] });
        assert_eq!(value["durer"]["median"]["rays"], 100);
        assert_eq!(value["antialiased"]["durer"]["median"]["rays"], 100);
        assert_eq!((&value["rmse"]["durer"], &value["rmse"]["povray"]), (&json!(0.25), &Value::Null));
    }

    #[test]
    fn without_povray_durer_stands_alone() {
        assert_eq!(as_value(&[RUN], &[])["povray"], Value::Null);
        assert!(!as_table("plain", &[RUN], &[]).contains("povray,"));
    }
}
