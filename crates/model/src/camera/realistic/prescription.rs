//! Lens files of pbrt: a row for each surface, from the scene to the film, with four numbers, radius of curvature, way to the
//! next surface, index of refraction behind, diameter; in millimetres. Radius 0 is the aperture stop, index 0 air; `#` begins
//! a comment. A radius above 0 bulges towards the scene. The last way, to the film, is replaced by focusing.
use super::glass::Interface;

/// Most surfaces: no lens that was built has half as many.
const MOST: usize = 1000;
/// No material for lenses refracts more.
const LARGEST_INDEX: f64 = 5.0;

/// The surfaces of a lens file, in metres; what is wrong with it otherwise.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Interface>, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut surfaces: Vec<Interface> = Vec::new();
    let mut stop = None;
    for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let line = line.split('#').next().unwrap_or("");
        let words: Vec<&str> = line.split([' ', '\t', ',', '\r']).filter(|word| !word.is_empty()).collect();
        if words.is_empty() {
            continue;
        }
        let said = |what: String| format!("line {number}: {what}");
        let surface = row(&words).map_err(said)?;
        if surface.is_stop() {
            if let Some(first) = stop {
                return Err(said(format!("a second aperture stop (radius 0); line {first} has one")));
            }
            stop = Some(number);
        }
        surfaces.push(surface);
        if surfaces.len() > MOST {
            return Err(said(format!("more than {MOST} surfaces")));
        }
    }
    if surfaces.iter().all(Interface::is_stop) {
        let expected = "expected rows of radius, thickness, index and diameter (mm)";
        return Err(format!("it has no refracting surface, {expected}"));
    }
    if surfaces.last().is_some_and(|s| s.index != 1.0) {
        return Err("glass reaches from its last surface to the film, expected index 1 or 0 there".to_owned());
    }
    Ok(surfaces)
}

fn row(words: &[&str]) -> Result<Interface, String> {
    let [radius, thickness, index, diameter] = words else {
        let found = if words.len() == 1 { "1 number".to_owned() } else { format!("{} numbers", words.len()) };
        return Err(format!("{found}, expected 4: radius, thickness, index and diameter (mm)"));
    };
    let number = |word: &str| {
        let shown: String = word.chars().take(40).collect();
        match word.parse::<f64>() {
            Ok(value) if value.abs() < 1e9 => Ok(value),
            Ok(value) if value.is_finite() => Err(format!("{shown} is out of range, expected less than 1e9")),
            _ => Err(format!("expected a number, found {shown}")),
        }
    };
    let (radius, thickness, index, diameter) =
        (number(radius)?, number(thickness)?, number(index)?, number(diameter)?);
    if thickness < 0.0 {
        return Err(format!("the way to the next surface is {thickness} mm, expected 0 or more"));
    }
    if index != 0.0 && !(1.0..=LARGEST_INDEX).contains(&index) {
        return Err(format!(
            "the index of refraction is {index}, expected 1 to {LARGEST_INDEX}, or 0 for air"
        ));
    }
    if diameter <= 0.0 {
        return Err(format!("the diameter is {diameter} mm, expected more than 0"));
    }
    let metres = |mm: f64| mm * 1e-3;
    Ok(Interface {
        curvature: if radius == 0.0 { 0.0 } else { 1.0 / metres(radius) },
        thickness: metres(thickness),
        index: if index == 0.0 { 1.0 } else { index },
        radius: metres(diameter) * 0.5,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_comments_and_air_are_read() {
        let text = "\u{feff}# a singlet\r\n25 5\t1.5 20 # front\r\n\r\n-1e3, 2, 0, 20\n0 3 0 8\n";
        let found = read(text.as_bytes()).expect("a lens");
        assert_eq!(found.len(), 3);
        let [front, back, stop] = [0, 1, 2].map(|i| found[i]);
        assert!((front.curvature - 40.0).abs() < 1e-12 && front.index == 1.5 && front.radius == 0.01);
        assert!((back.curvature + 1.0).abs() < 1e-12 && back.index == 1.0 && back.thickness == 0.002);
        assert!(stop.is_stop() && stop.radius == 0.004);
    }

    #[test]
    fn what_is_no_lens_is_told_line_by_line() {
        for (text, expected) in [
            ("1 2 3", "line 1: 3 numbers, expected 4: radius, thickness, index and diameter (mm)"),
            ("# x\n25", "line 2: 1 number, expected 4: radius, thickness, index and diameter (mm)"),
            ("25 5 1.5 big", "line 1: expected a number, found big"),
            ("25 5 1.5 nan", "line 1: expected a number, found nan"),
            ("-2e12 5 1.5 9", "line 1: -2e12 is out of range, expected less than 1e9"),
            ("25 -5 1.5 9", "line 1: the way to the next surface is -5 mm, expected 0 or more"),
            ("25 5 0.9 9", "line 1: the index of refraction is 0.9, expected 1 to 5, or 0 for air"),
            ("25 5 1.5 0", "line 1: the diameter is 0 mm, expected more than 0"),
            ("25 5 1.5 9\n0 1 0 5\n0 1 0 5", "line 3: a second aperture stop (radius 0); line 2 has one"),
            ("25 5 1.5 9", "glass reaches from its last surface to the film, expected index 1 or 0 there"),
            ("", "it has no refracting surface, expected rows of radius, thickness, index and diameter (mm)"),
            (
                "0 1 0 5",
                "it has no refracting surface, expected rows of radius, thickness, index and diameter (mm)",
            ),
        ] {
            assert_eq!(read(text.as_bytes()).err().as_deref(), Some(expected), "{text}");
        }
        assert!(read(&b"25 5 1.5 9\n".repeat(MOST + 1)).is_err());
        assert!(read(&[0xff, 0xfe, 0]).is_err());
    }
}
