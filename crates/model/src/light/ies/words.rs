//! The text of an IES file (ANSI/IES LM-63, all editions): lines of keywords up to `TILT=`, numbers after it.
use super::profile::Profile;

/// Most angles in one direction: more than any goniophotometer has.
const MOST: usize = 100_000;

/// The profile that a file describes; the reason if it is none, or of a type that is not read.
pub(super) fn read(bytes: &[u8]) -> Result<Profile, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.lines();
    let tilt = lines
        .find_map(|line| line.trim().strip_prefix("TILT=").map(|rest| rest.trim().to_owned()))
        .ok_or("it has no line TILT=, so it is no IES file")?;
    let rest: Vec<&str> = lines.collect();
    let rest = rest.join("\n");
    let mut numbers =
        Numbers { words: Box::new(rest.split([' ', '\t', '\r', '\n', ',']).filter(|w| !w.is_empty())) };
    match tilt.as_str() {
        "NONE" => {}
        "INCLUDE" => {
            numbers.one("the lamp's position")?;
            let pairs = numbers.count("tilt angles")?;
            numbers.list(2 * pairs, "tilt angles and factors")?;
        }
        other => {
            return Err(format!(
                "it keeps its tilt in the file {other}, which is not read; only NONE and INCLUDE are"
            ));
        }
    }
    numbers.one("the number of lamps")?;
    numbers.one("the lumens of a lamp")?;
    let multiplier = numbers.one("the multiplier")?;
    let down = numbers.count("vertical angles")?;
    let around = numbers.count("horizontal angles")?;
    match numbers.one("the photometric type")? {
        1.0 => {}
        2.0 => return Err("it is of photometric type B; only type C is read".to_owned()),
        3.0 => return Err("it is of photometric type A; only type C is read".to_owned()),
        other => return Err(format!("its photometric type is {other}, expected 1 (C)")),
    }
    numbers.list(4, "units, width, length and height")?;
    let ballast = numbers.one("the ballast factor")?;
    let future = numbers.one("the ballast-lamp factor")?;
    numbers.one("the watts")?;
    let down = numbers.list(down, "vertical angles")?;
    let around = numbers.list(around, "horizontal angles")?;
    let factor = multiplier * ballast * future;
    let values = numbers.list(down.len() * around.len(), "intensities")?;
    Profile::new(&down, &around, values.into_iter().map(|v| (v * factor) as f32).collect())
}

/// The numbers that are left.
struct Numbers<'t> {
    words: Box<dyn Iterator<Item = &'t str> + 't>,
}

impl Numbers<'_> {
    fn one(&mut self, what: &str) -> Result<f64, String> {
        let word = self.words.next().ok_or_else(|| format!("it ends before {what}"))?;
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| format!("found \"{word}\" for {what}, expected a number"))
    }
    fn count(&mut self, what: &str) -> Result<usize, String> {
        let number = self.one(what)?;
        let is_count = number >= 1.0 && number <= MOST as f64 && number.fract() == 0.0;
        is_count.then_some(number as usize).ok_or_else(|| format!("it has {number} {what}"))
    }
    fn list(&mut self, count: usize, what: &str) -> Result<Vec<f64>, String> {
        // Not allocated before it is there.
        (0..count).map(|_| self.one(what)).collect()
    }
}
