//! Filters: numbers in a form that packs well, brought back to what accessors read.

/// Unit vectors on an octahedron, with the largest value as the third number, to normalised integers of 8 or 16 bits.
pub(super) fn octahedral(bytes: &mut [u8], stride: usize) {
    if stride == 4 {
        for [x, y, z, _] in bytes.as_chunks_mut::<4>().0 {
            let vector = unfolded([*x, *y, *z].map(|v| f32::from(v as i8)), 127.0);
            [*x, *y, *z] = vector.map(|v| (v as i8) as u8);
        }
        return;
    }
    for row in bytes.as_chunks_mut::<8>().0 {
        let [a, b, c, d, e, f, _, _] = *row;
        let numbers = [[a, b], [c, d], [e, f]].map(|v| f32::from(i16::from_le_bytes(v)));
        let vector = unfolded(numbers, 32767.0).map(|v| (v as i16).to_le_bytes());
        row.iter_mut().zip(vector.as_flattened()).for_each(|(to, from)| *to = *from);
    }
}

/// The vector of length `most` at x, y of the octahedron of the size `one`.
fn unfolded([x, y, one]: [f32; 3], most: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    let back = z.min(0.0);
    let fold = |v: f32| if v >= 0.0 { v + back } else { v - back };
    let (x, y) = (fold(x), fold(y));
    let scale = most / (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|v| (v * scale).round())
}

/// Quaternions of which the largest number is left out, to normalised integers of 16 bits.
pub(super) fn quaternion(bytes: &mut [u8]) {
    for row in bytes.as_chunks_mut::<8>().0 {
        let [a, b, c, d, e, f, g, h] = *row;
        let code = i16::from_le_bytes([g, h]);
        let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(code | 3);
        let [x, y, z] = [[a, b], [c, d], [e, f]].map(|v| f32::from(i16::from_le_bytes(v)) * scale);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let mut all = [w, x, y, z];
        all.rotate_right((code & 3) as usize);
        let numbers = all.map(|v| ((v * 32767.0).round() as i16).to_le_bytes());
        row.iter_mut().zip(numbers.as_flattened()).for_each(|(to, from)| *to = *from);
    }
}

/// Whole numbers of 24 bits times powers of 2, to floats.
pub(super) fn exponential(bytes: &mut [u8]) {
    for row in bytes.as_chunks_mut::<4>().0 {
        let packed = i32::from_le_bytes(*row);
        let (exponent, whole) = (packed >> 24, (packed << 8) >> 8);
        *row = ((f64::from(whole) * 2f64.powi(exponent)) as f32).to_le_bytes();
    }
}

/// Luma and two differences of colours (YCoCg), to normalised red, green and blue of 8 or 16 bits. The highest bit of alpha
/// says how many bits all of them have; alpha itself has one less.
pub(super) fn color(bytes: &mut [u8], stride: usize) {
    if stride == 4 {
        for [y, co, cg, a] in bytes.as_chunks_mut::<4>().0 {
            let rgba =
                mixed([i32::from(*y), i32::from(*co as i8), i32::from(*cg as i8), i32::from(*a)], 255.0);
            [*y, *co, *cg, *a] = rgba.map(|v| v as u8);
        }
        return;
    }
    for row in bytes.as_chunks_mut::<8>().0 {
        let [a, b, c, d, e, f, g, h] = *row;
        let [y, co, cg, alpha] = [[a, b], [c, d], [e, f], [g, h]].map(i16::from_le_bytes);
        let unsigned = |v: i16| i32::from(v as u16);
        let rgba = mixed([unsigned(y), co.into(), cg.into(), unsigned(alpha)], 65535.0);
        let numbers = rgba.map(|v| (v as u16).to_le_bytes());
        row.iter_mut().zip(numbers.as_flattened()).for_each(|(to, from)| *to = *from);
    }
}

/// Red, green, blue and alpha of which `most` is 1.
fn mixed([y, co, cg, alpha]: [i32; 4], most: f32) -> [f32; 4] {
    // All bits up to the highest one.
    let one = alpha.checked_ilog2().map_or(0, |bit| (2 << bit) - 1);
    let alpha = ((alpha << 1) & one) | (alpha & 1);
    let scale = if one > 0 { most / one as f32 } else { 0.0 };
    [y + co - cg, y + cg, y - co - cg, alpha].map(|v| (v as f32 * scale).round().clamp(0.0, most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_octahedron_become_unit_vectors() {
        // (0, 0) is the upper tip; (64, 63) lies on the edge; (127, 127) is folded to the lower tip.
        let mut rows = [[0u8, 0, 127, 9], [64, 63, 127, 9], [127, 127, 127, 9], [0x81, 0, 127, 9]];
        let bytes = rows.as_flattened_mut();
        octahedral(bytes, 4);
        let numbers: Vec<i8> = bytes.iter().map(|b| *b as i8).collect();
        assert_eq!(numbers, [0, 0, 127, 9, 91, 89, 0, 9, 0, 0, -127, 9, -127, 0, 0, 9]);
        let mut wide: Vec<u8> = [0i16, 0, 2047, 5].iter().flat_map(|v| v.to_le_bytes()).collect();
        octahedral(&mut wide, 8);
        assert_eq!(wide, [0i16, 0, 32767, 5].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
    }

    #[test]
    fn the_largest_number_of_a_quaternion_comes_back() {
        // 12 bits a number; the largest is the one of the lowest two bits of the last.
        for largest in 0..4i16 {
            let (one, code) = (2047i16 & !3, (2047i16 & !3) | largest);
            let mut row: Vec<u8> = [one / 2, 0, 0, code].iter().flat_map(|v| v.to_le_bytes()).collect();
            quaternion(&mut row);
            let numbers: Vec<f64> =
                row.as_chunks::<2>().0.iter().map(|b| f64::from(i16::from_le_bytes(*b)) / 32767.0).collect();
            let x = f64::from(one / 2) / 2047.0 * 0.5f64.sqrt();
            let expected: [f64; 4] = std::array::from_fn(|i| match i as i16 - largest {
                0 => (1.0 - x * x).sqrt(),
                1 | -3 => x,
                _ => 0.0,
            });
            assert!(
                numbers.iter().zip(expected).all(|(a, b)| (a - b).abs() < 4e-5),
                "{numbers:?} {expected:?}"
            );
        }
    }

    #[test]
    fn colours_come_back() {
        // Packed by meshoptimizer with 8 and 12 bits: (1, 1/2, 1/4, 1) and (0, 3/4, 1, 1/2).
        let mut bytes = [144u8, 95, 241, 255, 159, 129, 31, 192];
        color(&mut bytes, 4);
        assert_eq!(bytes, [254, 129, 64, 255, 1, 190, 255, 128]);
        let wide = [2304u16, 1535, 65281, 4095, 2559, 63489, 511, 3072];
        let mut wide: Vec<u8> = wide.iter().flat_map(|v| v.to_le_bytes()).collect();
        color(&mut wide, 8);
        let found: Vec<f64> =
            wide.as_chunks::<2>().0.iter().map(|b| f64::from(u16::from_le_bytes(*b)) / 65535.0).collect();
        let expected = [1.0, 0.5, 0.25, 1.0, 0.0, 0.75, 1.0, 0.5];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{found:?}");
        let mut nothing = [0u8; 4];
        color(&mut nothing, 4);
        assert_eq!(nothing, [0; 4]);
    }

    #[test]
    fn exponents_scale_whole_numbers() {
        let packed =
            |exponent: i8, whole: i32| ((i32::from(exponent) << 24) | (whole & 0xff_ffff)).to_le_bytes();
        let mut bytes = [packed(-3, 5), packed(2, -7), packed(0, 0)].concat();
        exponential(&mut bytes);
        assert_eq!(bytes, [0.625f32, -28.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
    }
}
