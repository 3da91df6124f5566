//! Volumes: values on a grid of a `.vol` file, or one value.
//!
//! `VOL`, version 3 (u8), then little-endian: 1 for f32 (i32), numbers of values along x, y and z, of channels (i32 each), the
//! corners of a box (six f32), and the values, channels first, then x, y and z.
use durer_core::glam::{DAffine3, DVec3};
use durer_scene::Assets;

use super::{
    object::{Object, Value},
    world::World,
};

/// Most values of a grid.
const MOST: usize = 1 << 28;

/// Colours, or other numbers, on a grid that fills the unit cube of its own space.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid<const N: usize = 3> {
    pub(super) size: [usize; 3],
    /// One for each place, x fastest.
    pub(super) values: Vec<[f32; N]>,
    pub(super) place: DAffine3,
}

impl<const N: usize> Grid<N> {
    /// The value at a point of the unit cube, clamped at its sides.
    pub(super) fn at(&self, p: DVec3) -> [f32; N] {
        let mut first = [0usize; 3];
        let mut share = [0.0; 3];
        for ((first, share), (p, n)) in
            first.iter_mut().zip(&mut share).zip(p.to_array().into_iter().zip(self.size))
        {
            let place = (p * n as f64 - 0.5).clamp(0.0, n as f64 - 1.0);
            (*first, *share) = (place as usize, place.fract());
        }
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        let mut sum = [0.0f64; N];
        for corner in 0..8usize {
            let (mut weight, mut index) = (1.0, 0);
            let axes = first.iter().zip(share).zip(self.size.iter().zip(strides));
            for (axis, ((first, share), (n, stride))) in axes.enumerate() {
                let up = corner >> axis & 1;
                weight *= if up == 1 { share } else { 1.0 - share };
                index += (first + up).min(n - 1) * stride;
            }
            let value = self.values.get(index).copied().unwrap_or([0.0; N]);
            sum.iter_mut().zip(value).for_each(|(sum, v)| *sum += weight * f64::from(v));
        }
        sum.map(|v| v as f32)
    }
    /// Its values at the middles of a grid of this size in a box.
    pub(super) fn onto(&self, size: [usize; 3], place: DAffine3) -> Vec<[f32; N]> {
        if size == self.size && place == self.place {
            return self.values.clone();
        }
        let own_from_there = self.place.inverse() * place;
        let [nx, ny, nz] = size;
        let middle = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        let point =
            |i: usize| DVec3::new(middle(i % nx, nx), middle(i / nx % ny, ny), middle(i / (nx * ny), nz));
        (0..nx * ny * nz).map(|i| self.at(own_from_there.transform_point3(point(i)))).collect()
    }
}

/// The grid of colours that `object` is, none below 0.
pub(super) fn colors(world: &mut World<'_>, object: &Object) -> Option<Grid> {
    let grid: Grid = match object.plugin.as_str() {
        "constvolume" => {
            world.check(object, &["value", "to_world"], &[]);
            let values = vec![even(world, object, "value")?];
            Grid { size: [1; 3], values, place: object.transform("to_world", world.said) }
        }
        _ => grid_of(world, object)?,
    };
    if grid.values.iter().flatten().any(|v| *v < 0.0) {
        world.said.error(object.at, "a value of this volume is negative");
        return None;
    }
    Some(grid)
}

/// The grid of so many channels that `object` is; of one channel all are the same.
pub(super) fn grid_of<const N: usize>(world: &mut World<'_>, object: &Object) -> Option<Grid<N>> {
    let place = object.transform("to_world", world.said);
    match object.plugin.as_str() {
        "constvolume" if N == 1 => {
            world.check(object, &["value", "to_world"], &[]);
            let value = object.number_or("value", 1.0, world.said) as f32;
            Some(Grid { size: [1; 3], values: vec![[value; N]], place })
        }
        "gridvolume" => {
            world.check(
                object,
                &["filename", "to_world", "use_grid_bbox", "raw"],
                &["filter_type", "wrap_mode", "accel"],
            );
            let (grid, [low, high]) = file(world, object)?;
            let fits = object.truth("use_grid_bbox", false, world.said);
            let (low, high) = if fits { (low, high) } else { (DVec3::ZERO, DVec3::ONE) };
            let fitted = DAffine3::from_translation(low) * DAffine3::from_scale(high - low);
            Some(Grid { place: place * fitted, ..grid })
        }
        other => {
            world.said.unknown(object.at, "volume", other, ["constvolume", "gridvolume"]);
            None
        }
    }
}

/// The grid in the file of an object, and the corners of its box.
pub(super) fn file<const N: usize>(world: &mut World<'_>, object: &Object) -> Option<(Grid<N>, [DVec3; 2])> {
    let path = world.path(object, "filename")?;
    let at = object.get("filename").map_or(object.at, |p| p.at);
    let read = world.assets.bytes(&path).map_err(|error| error.to_string());
    let parsed = read.and_then(|bytes| parsed(&bytes).map_err(|why| format!("{path}: {why}")));
    super::value::told(parsed, at, world.said)
}

/// A colour that is the same everywhere; of a curve, what it does to daylight.
pub(super) fn even(world: &mut World<'_>, object: &Object, name: &str) -> Option<[f32; 3]> {
    let prop = object.get(name)?;
    match &prop.value {
        Value::Color(rgb) => Some(*rgb),
        Value::Number(v) => Some([*v as f32; 3]),
        Value::Even(v) => Some([*v; 3]),
        Value::Curve(curve) => durer_core::spectrum::Sampled::new(curve).ok().map(|s| s.share().rgb),
        other => {
            world.said.error(prop.at, format!("\"{name}\" is {}, expected a colour", other.word()));
            None
        }
    }
}

/// The grid in a file, and the corners of its box.
fn parsed<const N: usize>(bytes: &[u8]) -> Result<(Grid<N>, [DVec3; 2]), String> {
    let short = || "the file ends too early".to_owned();
    if !bytes.starts_with(b"VOL\x03") {
        return Err("this is no volume of Mitsuba (.vol, version 3)".to_owned());
    }
    let word = |i: usize| -> Option<[u8; 4]> { bytes.get(4 + 4 * i..8 + 4 * i)?.try_into().ok() };
    let whole = |i| word(i).map(i32::from_le_bytes).ok_or_else(short);
    let float = |i| word(i).map(|b| f64::from(f32::from_le_bytes(b))).ok_or_else(short);
    let kind = whole(0)?;
    if kind != 1 {
        return Err(format!("values of type {kind} are not read, only f32 (1)"));
    }
    let mut size = [0usize; 3];
    for (i, n) in size.iter_mut().enumerate() {
        *n = usize::try_from(whole(1 + i)?)
            .ok()
            .filter(|n| (1..=1 << 16).contains(n))
            .ok_or("a size that is none")?;
    }
    let channels = match whole(4)? {
        1 => 1,
        n if usize::try_from(n) == Ok(N) => N,
        other if N == 1 => return Err(format!("{other} channels, expected 1")),
        other => return Err(format!("{other} channels, expected {N}, or 1 for all")),
    };
    let count = size.iter().product::<usize>();
    if count > MOST {
        return Err(format!("{count} values are too many"));
    }
    let low = DVec3::new(float(5)?, float(6)?, float(7)?);
    let high = DVec3::new(float(8)?, float(9)?, float(10)?);
    let data = bytes.get(48..48 + 4 * count * channels).ok_or_else(short)?;
    let floats: Vec<f32> = data.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    if floats.iter().any(|v| !v.is_finite()) || !low.is_finite() || !high.is_finite() {
        return Err("a value is infinite or no number".to_owned());
    }
    let values = match channels {
        1 => floats.iter().map(|v| [*v; N]).collect(),
        _ => floats.as_chunks::<N>().0.to_vec(),
    };
    Ok((Grid { size, values, place: DAffine3::IDENTITY }, [low, high]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that fails may panic")]
mod tests {
    use super::*;

    fn file(channels: i32, values: &[f32]) -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        [1, 2, 1, 1, channels].iter().for_each(|n: &i32| bytes.extend(n.to_le_bytes()));
        [0.0f32, 0.0, 0.0, 4.0, 1.0, 1.0].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        bytes
    }

    #[test]
    fn values_stand_in_the_middles_of_cells_and_go_on_to_the_sides() {
        let (grid, [_, high]) = parsed::<3>(&file(1, &[1.0, 3.0])).unwrap();
        assert_eq!((grid.size, high.x), ([2, 1, 1], 4.0));
        let x = |x: f64| grid.at(DVec3::new(x, 0.9, 0.1))[0];
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(x), [1.0, 1.0, 2.0, 3.0, 3.0]);
    }

    #[test]
    fn damaged_volumes_are_told() {
        let wrong = |bytes: &[u8]| parsed::<3>(bytes).unwrap_err();
        assert!(wrong(b"VOL\x02").contains("version 3"));
        assert_eq!(wrong(&file(3, &[1.0; 5])), "the file ends too early");
        assert!(wrong(&file(2, &[1.0; 4])).contains("2 channels, expected 3"));
        assert!(wrong(&file(1, &[1.0, f32::NAN])).contains("no number"));
        let whole = file(1, &[1.0, 3.0]);
        (0..whole.len()).for_each(|cut| drop(parsed::<3>(whole.get(..cut).unwrap()).unwrap_err()));
    }
}
