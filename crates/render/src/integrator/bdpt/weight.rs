//! What each way to sample a path counts for.
//!
//! A path `x_0 .. x_{n-1}` from a light to the camera can be found in `n - 1` ways: `s` vertices by a walk from the light,
//! the others by one from the eye, joined by an edge. With the density `p_s` of each, a path that was found in one of them
//! counts by `p_s / sum p_i` (balance heuristic, Veach 1997, section 10.2). Ways that differ by one vertex share all other
//! densities, so that `p_{s+1} / p_s = L_s / E_s`, where `L_i` is the density with which a walk from the light comes to
//! `x_i`, `E_i` that of one from the eye (section 10.2.1). For `s = 1` the light is asked for by the vertex itself, with a
//! density of its own.

/// What is known of all ways to sample a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Densities {
    /// Of each vertex but the camera: by a walk from the light, and by one from the eye; and which edges there can be joined.
    /// The first is the light.
    walks: Vec<([f32; 2], Edges)>,
    /// Of the light's point where it is asked for by the next vertex.
    pub(super) asked: f32,
    /// Rays can meet the light.
    pub(super) is_met: bool,
    /// The camera can be joined to.
    pub(super) is_seen: bool,
}

/// Which edges of a vertex can be joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edges {
    /// Both.
    Both,
    /// Not the one towards the light: it is a walk below a surface.
    Onward,
    /// None: light is scattered in a sharp direction.
    Neither,
}

impl Edges {
    /// Those of a vertex where light is scattered in a sharp direction or not, and to which a walk below a surface leads from
    /// the next one towards the light or not.
    pub(super) fn of(is_sharp: bool, is_walked: bool) -> Self {
        match (is_sharp, is_walked) {
            (true, _) => Self::Neither,
            (false, true) => Self::Onward,
            (false, false) => Self::Both,
        }
    }
}

impl Densities {
    /// Those of a light, which is asked for with density `asked`, with room for so many vertices.
    pub(super) fn of_light(light: [f32; 2], asked: f32, is_met: bool, vertices: usize) -> Self {
        // PERF: asks for memory once (bench render).
        let mut walks = Vec::with_capacity(vertices + 1);
        walks.push((light, Edges::Both));
        Self { walks, asked, is_met, is_seen: false }
    }
    /// Adds the next vertex, towards the camera: densities from the light and from the eye, and which edges can be joined.
    pub(super) fn add(&mut self, from_light: f32, from_eye: f32, edges: Edges) {
        self.walks.push(([from_light, from_eye], edges));
    }
    /// Whether a path can be found with `s` vertices from the light.
    fn is_possible(&self, s: usize) -> bool {
        let n = self.walks.len();
        match s {
            0 => self.is_met,
            _ if s == n => self.is_seen && self.walks[s - 1].1 != Edges::Neither && n > 1,
            _ => self.walks[s - 1].1 != Edges::Neither && self.walks[s].1 == Edges::Both,
        }
    }

    /// The share of the path that was found with `s` vertices from the light.
    pub(super) fn share(&self, s: usize) -> f32 {
        let n = self.walks.len();
        let ratio = |i: usize| f64::from(self.walks[i].0[0]) / f64::from(self.walks[i].0[1]);
        let [begun, met] = self.walks[0].0.map(f64::from);
        let asked = f64::from(self.asked);
        // p_i by p_s. Upwards from the way that was taken each vertex was met from the eye, downwards from the light.
        let mut sum = 1.0;
        let mut add = |i: usize, p: f64| {
            if self.is_possible(i) {
                sum += p;
            }
        };
        // What the densities of walks from the light are to that of this way.
        let mut up = match s {
            0 => begun / met,
            1 => begun / asked,
            _ => 1.0,
        };
        if s == 0 {
            add(1, asked / met);
        }
        for i in s.max(1) + 1..=n {
            up *= ratio(i - 1);
            add(i, up);
        }
        let mut down = 1.0;
        for i in (2..s).rev() {
            down /= ratio(i);
            add(i, down);
        }
        if s > 1 {
            down /= ratio(1);
            add(1, down * asked / begun);
            add(0, down * met / begun);
        } else if s == 1 {
            add(0, met / asked);
        }
        // Rounding may lose the density of the way that was taken, of a lamp in its own plane for one. Such a path counts for
        // nothing, as next to nothing comes along it.
        if sum.is_nan() { 0.0 } else { (1.0 / sum) as f32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(i: u32) -> f32 {
        let h = i.wrapping_mul(0x9E37_79B9);
        ((h ^ (h >> 15)) % 1000) as f32 / 100.0 + 0.01
    }

    /// The density of each way, written out.
    fn explicit(d: &Densities) -> Vec<f64> {
        let n = d.walks.len();
        let of = |s: usize| {
            let light = (0..s).map(|i| match (i, s) {
                (0, 1) => f64::from(d.asked),
                _ => f64::from(d.walks[i].0[0]),
            });
            let eye = (s..n).map(|i| f64::from(d.walks[i].0[1]));
            light.product::<f64>() * eye.product::<f64>()
        };
        (0..=n).map(|s| if d.is_possible(s) { of(s) } else { 0.0 }).collect()
    }

    #[test]
    fn shares_are_those_of_the_densities_and_sum_to_one() {
        for case in 0..500 {
            let n = 1 + case % 7;
            let own = |i: usize, k: u32| number(case as u32 * 64 + i as u32 * 4 + k);
            let d = Densities {
                walks: (0..n)
                    .map(|i| {
                        let edges = match own(i, 2) {
                            x if i > 0 && case % 3 == 0 && x < 3.0 => Edges::Neither,
                            x if i > 0 && case % 2 == 0 && x > 8.0 => Edges::Onward,
                            _ => Edges::Both,
                        };
                        ([own(i, 0), own(i, 1)], edges)
                    })
                    .collect(),
                asked: own(40, 3),
                is_met: case % 5 != 0,
                is_seen: case % 4 != 0 && n > 1,
            };
            let explicit = explicit(&d);
            let all: f64 = explicit.iter().sum();
            let mut sum = 0.0;
            for (s, p) in explicit.iter().enumerate().filter(|(_, p)| **p > 0.0) {
                let share = f64::from(d.share(s));
                assert!((share - p / all).abs() < 1e-5, "{s} of {n}: {share}, expected {}", p / all);
                sum += share;
            }
            assert!(all == 0.0 || (sum - 1.0).abs() < 1e-5, "{sum}");
        }
    }

    #[test]
    fn a_density_that_is_lost_is_no_share() {
        let walks = [[1.0, 0.0], [0.0, 2.0]].map(|walks| (walks, Edges::Both)).to_vec();
        let d = Densities { walks, asked: 0.0, is_met: true, is_seen: true };
        assert_eq!(d.share(1), 0.0);
    }

    #[test]
    fn lights_that_send_no_particles_are_asked_or_met() {
        let d = Densities {
            walks: [[0.0, 2.0], [0.0, 1.0], [3.0, 1.0]].map(|walks| (walks, Edges::Both)).to_vec(),
            asked: 6.0,
            is_met: true,
            is_seen: true,
        };
        assert_eq!((d.share(0), d.share(1)), (0.25, 0.75));
    }
}
