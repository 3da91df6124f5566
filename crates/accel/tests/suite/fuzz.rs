//! Random scenes, random rays: every set of instructions, every preset and brute force find the same hits, bit for bit,
//! and they are those of an oracle in f64.
mod leaks;
mod oracle;
mod rays;
mod scenes;
mod sieve;

use durer_accel::{Accel, Hit, Precision, Preset, TraversalProbe};
use durer_core::math::Ray;

use crate::corpus::{Random, Shapes, ray_count};
use oracle::{Meeting, meetings};
use scenes::Scene;
use sieve::{Asked, Holes};

/// A test, unless told otherwise.
const RAYS: usize = 12_000;
const RAYS_PER_SCENE: usize = 500;

/// What a run of rays has shown.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    rays: usize,
    hits: usize,
    /// Rays that the oracle says must hit.
    sure: usize,
    /// Rays for which rounding decides nothing.
    clear: usize,
    /// Answers of `Precision::Fast`, and those that name another primitive than `Precision::Robust`.
    fast: usize,
    fast_differs: usize,
}

type Bits = (u32, u32, [u32; 6]);

fn bits(hit: Option<Hit>) -> Option<Bits> {
    hit.map(|h| (h.instance, h.prim, [h.t, h.u, h.v, h.n_g.x, h.n_g.y, h.n_g.z].map(f32::to_bits)))
}

/// Whether the hit is one of the meetings, in place, weights and side.
fn is_real(hit: &Hit, all: &[Meeting]) -> bool {
    all.iter().filter(|m| (m.instance, m.prim) == (hit.instance, hit.prim)).any(|m| {
        let t = f64::from(hit.t);
        let lies = m.low <= t && t <= m.high;
        let weighs = m.weights.is_none_or(|([u, v], [du, dv])| {
            (f64::from(hit.u) - u).abs() <= du && (f64::from(hit.v) - v).abs() <= dv
        });
        lies && weighs && m.normal.is_none_or(|n| n.dot(hit.n_g.to_f64()) > 0.0)
    })
}

/// Whether all meetings in range are sure and the first is apart from the others: rounding decides nothing.
fn is_clear(all: &[Meeting], ray: &Ray, asked: &Asked) -> bool {
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let mut inside: Vec<_> = all.iter().filter(|m| m.high >= t_min && m.low <= t_max).collect();
    inside.sort_by(|a, b| a.low.total_cmp(&b.low));
    let is_first = inside.windows(2).take(1).all(|m| m[0].high < m[1].low);
    asked.holes != Holes::Pattern && is_first && inside.iter().all(|m| m.sure)
}

/// The farthest that the nearest hit may be.
fn limit(all: &[Meeting], asked: &Asked) -> f64 {
    let sure = all.iter().filter(|m| m.sure && asked.holes != Holes::Pattern);
    sure.map(|m| m.high).fold(f64::INFINITY, f64::min)
}

struct Bench {
    brute: Accel,
    /// Every preset for every set of instructions.
    trees: Vec<Accel>,
    /// `Precision::Fast`.
    fast: Vec<Accel>,
    shapes: Shapes,
}

impl Bench {
    fn new(scene: &Scene) -> Self {
        Self {
            brute: scene.brute(),
            trees: scene.trees(&[Preset::Fast, Preset::Balanced, Preset::High], Precision::Robust),
            fast: scene.trees(&[Preset::Balanced], Precision::Fast),
            shapes: scene.shapes(),
        }
    }

    fn check(&self, name: &str, scene: &Scene, (ray, asked): (&Ray, &Asked), tally: &mut Tally) {
        let put = |accel: &Accel| asked.put(accel, &self.shapes, ray);
        let (hit, any) = put(&self.brute);
        assert_eq!(any, hit.is_some(), "{name}: {ray:?} {asked:?} {hit:?}");
        for tree in &self.trees {
            let (got, got_any) = put(tree);
            let isa = tree.isa();
            assert_eq!(bits(got), bits(hit), "{name}, {isa:?}: {ray:?} {asked:?} {got:?} {hit:?}");
            assert_eq!(got_any, any, "{name}, {isa:?}: {ray:?} {asked:?} {hit:?}");
        }
        let all = meetings(scene, ray, asked);
        let most = limit(&all, asked);
        let t = hit.map_or(f64::INFINITY, |h| h.t.into());
        assert!(
            t <= most,
            "{name}: missed {ray:?} {asked:?} {hit:?} {:?} {:?}",
            near(&all, most),
            scene.placed
        );
        assert!(
            hit.is_none_or(|h| is_real(&h, &all) && ray.contains(h.t)),
            "{name}: invented {ray:?} {asked:?} {hit:?} {all:?}"
        );
        tally.rays += 1;
        tally.hits += usize::from(hit.is_some());
        tally.sure += usize::from(most < f64::INFINITY);
        let clear = is_clear(&all, ray, asked);
        tally.clear += usize::from(clear);
        for tree in &self.fast {
            let (got, got_any) = put(tree);
            let isa = tree.isa();
            assert_eq!(got_any, got.is_some(), "{name}, {isa:?}: {ray:?} {asked:?} {got:?}");
            let place = |h: Hit| (h.instance, h.prim);
            let same = got.map(place) == hit.map(place);
            assert!(same || !clear, "{name}, {isa:?}: {ray:?} {asked:?} {got:?} {hit:?}");
            let t = got.map_or(f64::INFINITY, |h| h.t.into());
            assert!(t <= most, "{name}, {isa:?}: missed {ray:?} {asked:?} {got:?} {:?}", near(&all, most));
            let is_real = got.is_none_or(|h| is_real(&h, &all) && ray.contains(h.t));
            assert!(is_real, "{name}, {isa:?}: invented {ray:?} {asked:?} {got:?} {all:?}");
            tally.fast += 1;
            tally.fast_differs += usize::from(!same);
        }
    }
}

/// The meeting that should have been found.
fn near(all: &[Meeting], most: f64) -> Vec<&Meeting> {
    all.iter().filter(|m| m.sure && m.high == most).collect()
}

fn fuzz(name: &str, seed: u64, make: fn(&mut Random) -> Scene) {
    let mut random = Random(seed);
    let mut tally = Tally::default();
    for _ in 0..ray_count(RAYS).div_ceil(RAYS_PER_SCENE) {
        let scene = make(&mut random);
        let bench = Bench::new(&scene);
        for _ in 0..RAYS_PER_SCENE {
            let (ray, asked) = (rays::ray(&mut random, &scene), Asked::random(&mut random));
            bench.check(name, &scene, (&ray, &asked), &mut tally);
        }
    }
    println!("{name}: {tally:?}");
    // The test means nothing if rays rarely hit, or if the oracle is rarely sure.
    assert!(tally.hits * 10 > tally.rays && tally.sure * 50 > tally.rays, "{name}: {tally:?}");
    assert!(tally.clear * 4 > tally.rays, "{name}: {tally:?}");
    // Rays through vertices and along edges are a third of all, and many begin on a surface.
    assert!(tally.fast_differs * 3 < tally.fast, "{name}: {tally:?}");
}

macro_rules! fuzzed {
    ($($name:ident: $seed:literal),* $(,)?) => {$(
        #[test]
        fn $name() {
            fuzz(stringify!($name), $seed, scenes::$name);
        }
    )*};
}
fuzzed! {
    soup: 1, aligned: 2, stacks: 3, slivers: 4, repeated: 5, flat: 6, scaled: 7, far: 8, mixed: 9, grid: 10,
    crossing: 11,
}

/// Remembers the primitives a ray was tested against.
#[derive(Default)]
struct Tested(Vec<u32>);

impl TraversalProbe for Tested {
    type Id = ();
    fn primitive(&mut self, _: (), _: u32, prim: u32) {
        self.0.push(prim);
    }
}

#[test]
fn the_highest_preset_holds_triangles_in_pieces_and_the_others_do_not() {
    let mut random = Random(12);
    let scene = scenes::crossing(&mut random);
    for (preset, cuts) in [(Preset::Fast, false), (Preset::Balanced, false), (Preset::High, true)] {
        let mut twice = 0;
        for tree in scene.trees(&[preset], Precision::Robust) {
            for _ in 0..200 {
                let mut tested = Tested::default();
                tree.query(&rays::ray(&mut random, &scene)).probe(&mut tested, ()).closest();
                let all = tested.0.len();
                tested.0.sort_unstable();
                tested.0.dedup();
                twice += all - tested.0.len();
            }
        }
        assert_eq!(twice > 0, cuts, "{preset:?}: {twice}");
    }
}
