//! The bill as a table.
use std::{fmt::Write, time::Duration};

use durer::cost::{Factors, Method};

use super::{Bill, json::engine_word};
use crate::number::{count, counted, seconds, significant};

pub(super) fn bill(bill: &Bill<'_>) -> String {
    let mut text = String::new();
    head(&mut text, bill);
    table(&mut text, bill);
    alternatives(&mut text, bill);
    advice(&mut text, bill);
    text
}

fn head(text: &mut String, bill: &Bill<'_>) {
    let window = bill.prepared.window();
    let _ = writeln!(
        text,
        "{}: {} x {}, {} a pixel, {}, {} of which every ray {}",
        bill.scene,
        window.x1 - window.x0,
        window.y1 - window.y0,
        counted(bill.prepared.settings.samples.into(), "sample", "samples"),
        bill.prepared.integrator_name,
        counted(bill.predicted.primitives, "primitive", "primitives"),
        match engine_word(bill.prepared.scene.accel.engine()) {
            "none" => "is tested against all",
            _ => "meets those its boxes hold",
        },
    );
    let _ = match bill.predicted.method {
        Method::Parameters(tree) => writeln!(
            text,
            "predicted from parameters alone: all trees are full, {} at each hit{}, {} bounces, {} to lights",
            counted((tree.branches + tree.escapes).into(), "branch", "branches"),
            match tree.escapes {
                0 => String::new(),
                escapes => format!(" ({escapes} of them out of the scene)"),
            },
            tree.depth,
            counted(tree.shadow_rays.into(), "ray", "rays"),
        ),
        Method::Probe { pixels } => {
            writeln!(text, "predicted from {} of the picture", counted(pixels, "pixel", "pixels"))
        }
    };
}

fn table(text: &mut String, bill: &Bill<'_>) {
    let predicted = &bill.predicted.factors;
    let measured = bill.measured.as_ref().map(|m| &m.factors);
    let mut row = |sign: &str, name: &str, p: String, m: Option<String>, note: &str| {
        let m = m.unwrap_or_default();
        let line = format!("{sign} {name:<22} {p:>12} {m:>12}   {note}");
        let _ = writeln!(text, "{}", line.trim_end());
    };
    let head = measured.map(|_| "measured".to_owned());
    row(" ", "", "predicted".to_owned(), head, "");
    for (index, (name, value)) in predicted.counts().into_iter().enumerate() {
        let sign = if index == 0 { " " } else { "x" };
        let note = if name == "primitives" { "tests per ray" } else { "" };
        row(sign, name, factor(value), measured.map(|m| factor(m.counts()[index].1)), note);
    }
    let total = |f: &Factors| count(f.primitive_tests().round() as u64);
    let off = measured.map(|m| predicted.primitive_tests() / m.primitive_tests() - 1.0);
    let off = off.map(|off| match off {
        0.0 => "exact".to_owned(),
        off => format!("{:+.1} %", off * 100.0),
    });
    row("=", "primitive tests", total(predicted), measured.map(total), &off.unwrap_or_default());
    let cost = |f: &Factors| format!("{:.1} ns", f.intersection * 1e9);
    row("x", "intersection cost", cost(predicted), measured.map(cost), "counting included");
    let time = |f: &Factors| seconds(Duration::from_secs_f64(f.seconds()));
    row("=", "time of one thread", time(predicted), measured.map(time), "");
}

fn factor(value: f64) -> String {
    if value >= 1e4 { count(value as u64) } else { significant(value as f32, 4) }
}

fn alternatives(text: &mut String, bill: &Bill<'_>) {
    let _ =
        writeln!(text, "\n  other ways                     rays   prim. tests     box tests   one thread");
    for a in &bill.alternatives {
        let how = match a.sampling {
            Some(sampling) => format!("--accel {}, {}", engine_word(a.engine), sampling.word()),
            None => format!("--accel {}", engine_word(a.engine)),
        };
        let number = |v: f64| count(v.round() as u64);
        let _ = writeln!(
            text,
            "  {how:<22} {:>12}  {:>12}  {:>12} {:>12}",
            number(a.factors.rays()),
            number(a.factors.primitive_tests()),
            number(a.box_tests),
            seconds(Duration::from_secs_f64(a.factors.seconds())),
        );
    }
}

fn advice(text: &mut String, bill: &Bill<'_>) {
    let Some(first) = bill.advice.first() else {
        return;
    };
    let percent = |saves: f64| format!("{:.0} %", saves * 100.0);
    let _ = writeln!(
        text,
        "\n  cut first: {} (saves up to {})\n    {}",
        first.factor,
        percent(first.saves),
        first.how
    );
    let rest: Vec<String> =
        bill.advice.iter().skip(1).map(|a| format!("{} ({})", a.factor, percent(a.saves))).collect();
    if !rest.is_empty() {
        let _ = writeln!(text, "  then: {}", rest.join(", "));
    }
}
