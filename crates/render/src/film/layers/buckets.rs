//! Light by its wavelength: the mean of what arrives in each of equally wide parts of a range.
//!
//! Wavelengths are not drawn evenly. One of density `p` stands for `1/p` nm, and a bucket's mean is `sum L/p` by `sum 1/p`:
//! light that is the same at all wavelengths has no noise. pbrt-v4 draws evenly and divides by the number of samples.
use durer_core::spectrum::AtWavelength;

/// Parts of a range of wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buckets {
    /// How many.
    pub count: u32,
    /// The ends of the range in nm, the smaller one first.
    pub range: [f32; 2],
}

impl Buckets {
    pub(super) fn sums(&self) -> usize {
        2 * self.count as usize
    }

    fn width(&self) -> f64 {
        f64::from(self.range[1] - self.range[0]) / f64::from(self.count)
    }

    /// The bucket of a wavelength; `None` outside the range.
    fn of(&self, nm: f32) -> Option<usize> {
        let [low, high] = self.range;
        let at = (f64::from(nm - low) / self.width()).floor();
        ((low..=high).contains(&nm)).then(|| (at as usize).min(self.count as usize - 1))
    }

    /// Adds a sample to the sums of a pixel.
    pub fn add(&self, sums: &mut [f64], values: &[AtWavelength; 4], weight: f32) {
        for at in values {
            if let Some(bucket) = self.of(at.nm) {
                let width = f64::from(weight) * f64::from(at.width);
                sums[2 * bucket] += width * f64::from(at.value);
                sums[2 * bucket + 1] += width;
            }
        }
    }

    /// What a splat adds to buckets, each wavelength to its own; nothing outside the range.
    pub fn lanes(&self, values: &[AtWavelength; 4]) -> [(usize, f32); 4] {
        values.map(|at| {
            let share = f64::from(at.width) / (values.len() as f64 * self.width());
            self.of(at.nm).map_or((0, 0.0), |bucket| (bucket, (f64::from(at.value) * share) as f32))
        })
    }

    /// The mean of a bucket; 0 where no sample has such a wavelength.
    pub(super) fn mean(sums: &[f64], bucket: usize) -> f32 {
        let (sum, weight) = (sums[2 * bucket], sums[2 * bucket + 1]);
        if weight > 0.0 { (sum / weight) as f32 } else { 0.0 }
    }

    /// Names of the channels as Fichet, Pacanowski and Wilkie (2021, "An OpenEXR Layout for Spectral Images") have them:
    /// the middle of the bucket, with a comma, as a point separates layers.
    pub(super) fn names(&self) -> Vec<String> {
        let name = |bucket| {
            let nm = f64::from(self.range[0]) + (f64::from(bucket) + 0.5) * self.width();
            format!("S0.{}nm", format!("{nm:.3}").replace('.', ","))
        };
        (0..self.count).map(name).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THREE: Buckets = Buckets { count: 3, range: [400.0, 700.0] };

    #[test]
    fn wavelengths_fall_into_their_buckets() {
        let of = [399.9, 400.0, 499.9, 500.0, 650.0, 700.0, 700.1].map(|nm| THREE.of(nm));
        assert_eq!(of, [None, Some(0), Some(0), Some(1), Some(2), Some(2), None]);
        assert_eq!(THREE.names(), ["S0.450,000nm", "S0.550,000nm", "S0.650,000nm"]);
    }

    #[test]
    fn a_buckets_mean_is_by_what_wavelengths_stand_for() {
        let mut sums = [0.0; 6];
        let at = |nm, value, width| AtWavelength { nm, value, width };
        let values = [at(410.0, 2.0, 1.0), at(490.0, 5.0, 2.0), at(600.0, 7.0, 9.0), at(800.0, 1e9, 1.0)];
        THREE.add(&mut sums, &values, 0.5);
        THREE.add(&mut sums, &values, 1.5);
        assert_eq!([0, 1, 2].map(|bucket| Buckets::mean(&sums, bucket)), [4.0, 0.0, 7.0]);
        let lanes = THREE.lanes(&values);
        assert_eq!(lanes, [(0, 2.0 / 400.0), (0, 10.0 / 400.0), (2, 63.0 / 400.0), (0, 0.0)]);
    }
}
