//! Photons of one pass, found by place.
//!
//! A grid whose cells are as wide as the disc in which photons are gathered, so that a disc touches 8 of them; cells share
//! buckets by their hash. Photons of a bucket lie in the order in which they were sent: sums over them have the same bits
//! for any number of threads.
use std::f64::consts::PI;

use durer_core::{
    math::{Normal3, Point3, Vector3},
    spectrum::Spectrum,
};

/// Where a particle met a surface after its first bounce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photon {
    /// Where, in render space.
    pub p: Point3,
    /// Unit direction to where it came from.
    pub wi: Vector3,
    /// Unit geometric normal of the surface.
    pub n: Normal3,
    /// Power that arrives, as if it were the only one of its pass.
    pub power: Spectrum,
    /// Surfaces that it was scattered by.
    pub bounces: u32,
    /// Its leading wavelength stands for all.
    pub is_collapsed: bool,
}

/// The photons of a pass.
#[derive(Clone, Debug)]
pub struct Photons {
    radius: f32,
    /// `1 / (n pi r²)` for `n` particles sent.
    per_area: f32,
    /// Where each bucket begins, and the end of the last.
    starts: Vec<u32>,
    photons: Vec<Photon>,
}

impl Photons {
    /// Bytes that each takes, with its share of the grid; twice while it is sorted.
    pub const BYTES: u64 = 2 * (size_of::<Photon>() as u64 + 4);

    /// What `sent` particles left behind, in the order in which they were sent, to be gathered within `radius`.
    pub fn new(sent: u32, radius: f32, parts: &[Vec<Photon>]) -> Self {
        let count: usize = parts.iter().map(Vec::len).sum();
        let per_area = (1.0 / (f64::from(sent.max(1)) * PI * f64::from(radius).powi(2))) as f32;
        let mut new = Self { radius, per_area, starts: Vec::new(), photons: Vec::new() };
        let buckets = count.next_power_of_two();
        let all = || parts.iter().flatten();
        new.starts = vec![0; buckets + 1];
        let bucket_of = |photon: &Photon| bucket(cell(photon.p, radius), buckets);
        all().for_each(|photon| new.starts[bucket_of(photon) + 1] += 1);
        for i in 0..buckets {
            new.starts[i + 1] += new.starts[i];
        }
        let mut next = new.starts.clone();
        let Some(&first) = all().next() else { return new };
        new.photons = vec![first; count];
        for photon in all() {
            let place = &mut next[bucket_of(photon)];
            new.photons[*place as usize] = *photon;
            *place += 1;
        }
        new
    }

    /// Radius of the discs, in metres.
    pub fn radius(&self) -> f32 {
        self.radius
    }
    /// What a photon's power is multiplied with for its share of the irradiance in a disc, 1/m².
    pub fn per_area(&self) -> f32 {
        self.per_area
    }
    /// How many there are.
    pub fn len(&self) -> usize {
        self.photons.len()
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.photons.is_empty()
    }

    /// Those nearer to `p` than the radius, always in the same order.
    pub fn near(&self, p: Point3) -> impl Iterator<Item = &Photon> {
        let buckets = self.starts.len() - 1;
        let r = Vector3::new(self.radius, self.radius, self.radius);
        let (low, high) = (cell(p - r, self.radius), cell(p + r, self.radius));
        let mut touched = [usize::MAX; 8];
        let (mut count, mut last) = (0, 0);
        for corner in 0..8 {
            let at = std::array::from_fn(|axis| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] });
            let found = bucket(at, buckets);
            // Cells that share a bucket, or are the same.
            if !touched[..count].contains(&found) {
                touched[count] = found;
                count += 1;
            }
            last = count;
        }
        let squared = self.radius * self.radius;
        touched.into_iter().take(last).flat_map(move |bucket| {
            let [start, end] = [self.starts[bucket], self.starts[bucket + 1]].map(|i| i as usize);
            self.photons[start..end].iter().filter(move |photon| (photon.p - p).length_squared() < squared)
        })
    }
}

/// The cell of a point: two radii wide.
fn cell(p: Point3, radius: f32) -> [i32; 3] {
    // Beyond what integers hold cells are as wide as space: slow, and right.
    [p.x, p.y, p.z].map(|x| (f64::from(x) / (2.0 * f64::from(radius))).floor() as i32)
}

fn bucket(cell: [i32; 3], buckets: usize) -> usize {
    let [x, y, z] = cell.map(|i| u64::from(i as u32));
    let mixed = x.wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ y.wrapping_mul(0xC2B2_AE3D_27D4_EB4F)
        ^ z.wrapping_mul(0x1656_67B1_9E37_79F9);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 32) as usize & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn photon(p: Point3) -> Photon {
        let up = Vector3::new(0.0, 1.0, 0.0);
        let power = Spectrum::ONE;
        Photon { p, wi: up, n: Normal3::from(up), power, bounces: 1, is_collapsed: false }
    }

    /// Points as good as random in a cube of 2 m about the origin.
    fn cloud(count: u32) -> Vec<Photon> {
        let part = |i: u32, step: f64| ((f64::from(i) * step).fract() * 2.0 - 1.0) as f32;
        let at = |i| Point3::new(part(i, 0.819_172_5), part(i, 0.671_043_6), part(i, 0.549_700_4));
        (0..count).map(|i| photon(at(i))).collect()
    }

    #[test]
    fn each_photon_in_a_ball_is_found_once_and_no_other() {
        let all = cloud(4000);
        for radius in [0.02, 0.11, 0.5, 3.0] {
            let map = Photons::new(10, radius, &[all[..1000].to_vec(), all[1000..].to_vec()]);
            for asked in cloud(60).iter().map(|photon| photon.p) {
                let mut found: Vec<Photon> = map.near(asked).copied().collect();
                let inside = |photon: &&Photon| (photon.p - asked).length_squared() < radius * radius;
                let expected = all.iter().filter(inside).count();
                assert_eq!(found.len(), expected, "radius {radius}");
                found.sort_by(|a, b| a.p.x.total_cmp(&b.p.x));
                found.dedup();
                assert_eq!(found.len(), expected, "once each");
            }
        }
    }

    #[test]
    fn parts_do_not_matter_and_nothing_is_found_of_nothing() {
        let all = cloud(300);
        let whole = Photons::new(10, 0.3, std::slice::from_ref(&all));
        let parts = Photons::new(10, 0.3, &[all[..7].to_vec(), Vec::new(), all[7..].to_vec()]);
        let near = |map: &Photons| map.near(all[0].p).copied().collect::<Vec<_>>();
        assert_eq!(near(&whole), near(&parts));
        assert!(Photons::new(10, 0.3, &[]).near(all[0].p).next().is_none());
        // Far away, where floats are coarser than the radius.
        let far = photon(Point3::new(3e9, -2e9, 1e9));
        assert_eq!(Photons::new(1, 0.1, &[vec![far]]).near(far.p).count(), 1);
    }
}
