//! Whitted's adaptive antialiasing: what it costs, what it never loses, and how good it is.
use std::fmt::Write;

use durer::{
    Options, Prepared, Rendered, builtin,
    drive::{Adaptive, Antialias, SmallObjects},
    film::Tile,
};
use durer_tests::{bits, prepared, render, scene};

fn adaptive(how: Adaptive) -> Antialias {
    Antialias::Adaptive(how)
}

fn usual() -> Antialias {
    adaptive(Adaptive::default())
}

fn whitted(options: &Options) -> Prepared {
    prepared(builtin::find("whitted").expect("built in").import(), options)
}

fn small(options: Options) -> Options {
    Options { width: Some(80), antialias: usual(), ..options }
}

/// Black balls under a white sky, seen straight on in a picture of 80 x 50 pixels that are 0.1 wide at a distance of 10;
/// places and radius are in pixels.
fn balls(places: impl IntoIterator<Item = [f64; 2]>, radius: f64) -> String {
    let mut text = String::from(
        "Film \"rgb\" \"integer xresolution\" 80 \"integer yresolution\" 50\n\
         LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 28.0724869\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"classic\" \"rgb diffuse\" [0 0 0]\n",
    );
    for [x, y] in places {
        let (x, y) = (0.1 * (x - 40.0), -0.1 * (y - 25.0));
        let ball = format!("Translate {x:.9} {y:.9} 10\nShape \"sphere\" \"float radius\" {}", 0.1 * radius);
        let _ = writeln!(text, "AttributeBegin\n{ball}\nAttributeEnd");
    }
    text
}

/// A thousand pixels, no two of them neighbours, with a ball of 1/50 pixel radius somewhere in each.
fn scattered() -> Vec<[f64; 2]> {
    let mut state = 0x2545_F491_4F6C_DD1Du64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let pixels = (0..25).flat_map(|y| (0..40).map(move |x| [2.0 * f64::from(x), 2.0 * f64::from(y)]));
    pixels.map(|[x, y]| [x + random(), y + random()]).collect()
}

/// How many of [`scattered`] cannot be seen in the picture.
fn lost(how: Adaptive) -> usize {
    let places = scattered();
    let options = Options { antialias: adaptive(how), ..Options::default() };
    let rendered = render(&scene(&balls(places.iter().copied(), 0.02), &options));
    let pixels = rendered.film.pixels();
    let is_white = |x: i64, y: i64| {
        let inside = (0..80).contains(&x) && (0..50).contains(&y);
        !inside || pixels[(y * 80 + x) as usize].mean() == [1.0; 3]
    };
    // A ball may stick out of its pixel, or be met by a ray that neighbours share. Of four pixels one has a ball.
    let is_lost = |p: &&[f64; 2]| {
        let (x, y) = (p[0] as i64, p[1] as i64);
        let reach = |v: f64| {
            if v.fract() < 0.02 {
                -1..=0
            } else if v.fract() > 0.98 {
                0..=1
            } else {
                0..=0
            }
        };
        reach(p[0]).all(|dx| reach(p[1]).all(|dy| is_white(x + dx, y + dy)))
    };
    places.iter().filter(is_lost).count()
}

/// W4.
#[test]
fn a_picture_of_one_colour_costs_a_ray_per_corner() {
    let text = balls([[400.0, 400.0]], 1.0);
    let rendered = render(&scene(&text, &Options { antialias: usual(), ..Options::default() }));
    assert_eq!((rendered.rays, rendered.samples), (81 * 51, 81 * 51));
    let splits = rendered.splits.as_ref().expect("adaptive");
    assert_eq!((splits.corners, splits.by_level, splits.searches), (81 * 51, [0; 8], 0));
    assert!(rendered.film.pixels().iter().all(|p| p.mean() == [1.0; 3] && p.weight == 1.0));
}

/// W5. A lattice of 64 to the pixel has no gap for a ball of 1.28 of its spacings.
#[test]
fn a_ball_of_a_fiftieth_of_a_pixel_is_never_lost() {
    let how = Adaptive { depth: 6, ..Adaptive::default() };
    assert_eq!(lost(how), 0);
}

/// W5: a share of 1 - (pi r^2 - 8 overlaps) of the cells of a lattice of 32 to the pixel is further than 0.64 spacings
/// from all corners: 1.9 %.
#[test]
fn one_split_less_loses_a_few() {
    let lost = lost(Adaptive { depth: 5, ..Adaptive::default() });
    assert!((8..=32).contains(&lost), "{lost} of 1000");
}

/// W5: a corner meets one with probability pi / 2500.
#[test]
fn without_looking_for_them_small_balls_are_lost() {
    let how = Adaptive { depth: 6, small_objects: SmallObjects::Ignored, ..Adaptive::default() };
    assert!(lost(how) >= 990, "{} of 1000", lost(how));
}

#[test]
fn what_hides_behind_something_is_not_looked_for() {
    let places = scattered();
    let text = balls(places, 0.02);
    let wall = "Translate 0 0 5\nShape \"disk\" \"float radius\" 100\n";
    let options = Options { antialias: usual(), ..Options::default() };
    let rendered = render(&scene(&format!("{text}{wall}"), &options));
    let splits = rendered.splits.expect("adaptive");
    assert_eq!(splits.by_level, [0; 8]);
    assert!(splits.searches > 0, "the balls were not seen to be near");
}

/// Rows as high as half a pixel, a black one and a white one in each: all corners are of one colour.
#[test]
fn a_pattern_as_fine_as_the_corners_is_seen() {
    let rows = "AttributeBegin\nTranslate -500 0.0125 -500\nScale 1000 0.05 1000\n\
                Texture \"rows\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\nAttributeEnd\n\
                Material \"classic\" \"rgb diffuse\" [0 0 0] \"texture ambient\" \"rows\"\n\
                Translate 0 0 10\nShape \"disk\" \"float radius\" 100\n";
    let options = Options { antialias: usual(), ..Options::default() };
    let rendered = render(&scene(&format!("Integrator \"whitted\"\n{}{rows}", balls([], 1.0)), &options));
    let pixels = rendered.film.pixels();
    let wrong = pixels.iter().map(|p| (p.mean()[0] - 0.5).powi(2)).sum::<f32>() / pixels.len() as f32;
    assert!(wrong.sqrt() < 0.08, "wrong by {}", wrong.sqrt());
}

#[test]
fn large_things_do_not_split_what_is_around_them() {
    let of = |small_objects| {
        let how = Adaptive { small_objects, ..Adaptive::default() };
        let options = Options { antialias: adaptive(how), ..Options::default() };
        render(&scene(&balls([[30.0, 20.0], [50.3, 31.7]], 7.0), &options))
    };
    let (found, ignored) = (of(SmallObjects::Found), of(SmallObjects::Ignored));
    assert_eq!(found.splits, ignored.splits);
    assert!(bits(&found) == bits(&ignored));
}

#[test]
fn small_meshes_are_found_as_one_and_large_ones_are_met_anyway() {
    let mesh = |scale: f64| {
        let shape = "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \
                     \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]";
        let text = balls([], 1.0);
        let how = Adaptive { depth: 6, ..Adaptive::default() };
        let options = Options { antialias: adaptive(how), ..Options::default() };
        render(&scene(&format!("{text}Translate 0.03 0.04 10\nScale {scale} {scale} 1\n{shape}"), &options))
    };
    let is_dark = |rendered: &Rendered| rendered.film.pixels().iter().any(|p| p.mean()[0] < 1.0);
    let tiny = mesh(0.002);
    assert!(is_dark(&tiny) && tiny.splits.as_ref().is_some_and(|s| s.by_level[0] == 1), "{:?}", tiny.splits);
    let large = mesh(1.0);
    assert!(is_dark(&large) && large.splits.is_some_and(|s| s.searches == 0));
}

#[test]
fn splits_are_bounded_by_the_limit() {
    for depth in [0, 2, 5] {
        let how = Adaptive { depth, threshold: 0.0, ..Adaptive::default() };
        let prepared = whitted(&Options { width: Some(12), antialias: adaptive(how), ..Options::default() });
        let rendered = render(&prepared);
        let splits = rendered.splits.expect("adaptive");
        let pixels = u64::from(rendered.film.width * rendered.film.height);
        for (level, &count) in (0..).zip(&splits.by_level) {
            let most = if level < depth { pixels << (2 * level) } else { 0 };
            assert!(count <= most && (count > 0 || most == 0), "level {level}: {count} of {most}");
        }
        // Five at each split, and one in each part that is left.
        let all: u64 = splits.by_level.iter().sum();
        let most = splits.corners + 5 * all + pixels + 3 * all;
        assert!(rendered.samples <= most, "{} samples, at most {most}", rendered.samples);
    }
}

#[test]
fn pixels_stand_for_their_whole_area() {
    let rendered = render(&whitted(&small(Options::default())));
    assert!(rendered.film.pixels().iter().all(|p| p.weight == 1.0));
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let of = |threads| render(&whitted(&small(Options { threads: Some(threads), ..Options::default() })));
    let one = of(1);
    for threads in [2, 7] {
        let other = of(threads);
        assert!(bits(&one) == bits(&other), "{threads} threads");
        assert_eq!((one.rays, &one.splits), (other.rays, &other.splits));
    }
}

#[test]
fn a_crop_is_a_part_of_the_whole_picture() {
    let crop = Tile { x0: 21, y0: 11, x1: 61, y1: 40 };
    for text in [balls(scattered(), 0.3), balls([[30.2, 20.7]], 12.0)] {
        let of = |crop| render(&scene(&text, &Options { crop, antialias: usual(), ..Options::default() }));
        let (whole, part) = (of(None), of(Some(crop)));
        let (whole_bits, part_bits) = (bits(&whole), bits(&part));
        for (i, (w, p)) in (0u32..).zip(whole_bits.iter().zip(&part_bits)) {
            let (x, y) = (i % 80, i / 80);
            let inside = (crop.x0..crop.x1).contains(&x) && (crop.y0..crop.y1).contains(&y);
            assert_eq!(*p, if inside { *w } else { [0; 3] }, "{x},{y}");
        }
    }
}

#[test]
fn recorded_samples_are_those_of_the_picture() {
    let prepared = whitted(&Options { width: Some(40), ..small(Options::default()) });
    let rendered = render(&prepared);
    let (pixels, job) = (rendered.film.pixels(), prepared.job());
    let mut split = 0;
    for (i, pixel) in (0u32..).zip(&pixels) {
        let at = [i % 40, i / 40];
        let count = job.sample_count(at);
        let values: Vec<[f32; 3]> = (0..count).map(|k| job.record(at, k).1).collect();
        if count == 4 {
            let mean = |c: usize| 0.25 * ((values[0][c] + values[1][c]) + (values[2][c] + values[3][c]));
            assert_eq!([0, 1, 2].map(|c| mean(c).to_bits()), pixel.mean().map(f32::to_bits), "{at:?}");
        } else if count == 9 {
            // Above, left, centre, right, below.
            let parts = [[0, 4, 5, 6], [4, 1, 6, 7], [5, 6, 2, 8], [6, 7, 8, 3]];
            let mut sum = [0.0f32; 3];
            for [a, b, c, d] in parts.map(|part| part.map(|k: usize| values[k])) {
                (0..3).for_each(|i| sum[i] += 0.25 * (0.25 * ((a[i] + b[i]) + (c[i] + d[i]))));
            }
            assert_eq!(sum.map(f32::to_bits), pixel.mean().map(f32::to_bits), "{at:?}");
            split += 1;
        }
        assert!(job.record(at, count).0.nodes.is_empty(), "there is no such sample");
    }
    assert!(split > 5, "{split} pixels were split once");
}

#[test]
fn a_cancelled_picture_keeps_its_first_wave() {
    struct CancelAfter<'a>(&'a std::sync::atomic::AtomicBool, std::sync::atomic::AtomicU64, u64);
    impl durer::Progress for CancelAfter<'_> {
        fn advance(&self, steps: u64, _: u64) {
            use std::sync::atomic::Ordering::SeqCst;
            if self.1.fetch_add(steps, SeqCst) + steps >= self.2 {
                self.0.store(true, SeqCst);
            }
        }
    }
    let prepared = whitted(&small(Options { threads: Some(1), ..Options::default() }));
    let job = prepared.job();
    let corners = 81 * 46;
    let stopped_at = |steps| {
        let cancel = false.into();
        let rendered = job.render(Default::default(), &CancelAfter(&cancel, 0.into(), steps), &cancel);
        assert!(rendered.cancelled);
        rendered.film.pixels().iter().filter(|p| p.weight > 0.0).count()
    };
    assert_eq!(stopped_at(corners), 80 * 45, "all pixels show their corners");
    let some = stopped_at(corners / 3);
    assert!(some > 500 && some < 80 * 45, "{some} pixels have a corner");
    assert_eq!(job.steps(), corners + 80 * 45);
}

/// Sums over the parts of the full-size picture that are looked at.
#[derive(Default)]
struct Tally {
    squares: f64,
    samples: u64,
    rays: u64,
}

impl Tally {
    /// Adds a part, and its squared differences from the reference.
    fn add(&mut self, part: &Rendered, reference: &Rendered, crop: Tile) {
        (self.samples, self.rays) = (self.samples + part.samples, self.rays + part.rays);
        let (a, b) = (part.film.pixels(), reference.film.pixels());
        for at in (crop.y0..crop.y1).flat_map(|y| (crop.x0..crop.x1).map(move |x| (y * 1280 + x) as usize)) {
            let pairs = a[at].mean().into_iter().zip(b[at].mean());
            self.squares += pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
        }
    }
    fn rmse(&self) -> f64 {
        self.squares.sqrt()
    }
}

/// W6, on the scene `whitted` at its full size, of which 100 parts of 16 x 9 pixels are looked at, one somewhere in
/// each of 10 x 10 equal rectangles. The reference has 4096 samples where DURER_SLOW is set, else 64: a quarter of the error of
/// 16, for both sides alike.
#[test]
fn adaptive_pictures_are_as_good_as_sixteen_samples_for_a_quarter_of_their_rays() {
    let samples = if std::env::var_os("DURER_SLOW").is_some() { 4096 } else { 64 };
    let (mut adaptive, mut uniform, mut corners) = (Tally::default(), Tally::default(), Tally::default());
    let whole = whitted(&Options::default());
    for part in 0u32..100 {
        let (x, y) = (part % 10 * 8 + part * 5 / 3 % 8, part / 10 * 8 + part * 3 % 8);
        let (x0, y0) = (x * 16, y * 9);
        let crop = Tile { x0, y0, x1: x0 + 16, y1: y0 + 9 };
        let of = |samples, seed, antialias| {
            let settings = durer::Settings { crop: Some(crop), samples, seed, antialias, ..whole.settings };
            durer::Job { settings, ..whole.job() }.render(Default::default(), &(), &Default::default())
        };
        let reference = of(samples, 99, Antialias::Supersample);
        adaptive.add(&of(1, 0, usual()), &reference, crop);
        let unsplit = Antialias::Adaptive(Adaptive { depth: 0, ..Adaptive::default() });
        corners.add(&of(1, 0, unsplit), &reference, crop);
        uniform.add(&of(16, 0, Antialias::Supersample), &reference, crop);
    }
    // Of a part the corners around it are traced as well, of the whole picture there is a corner per pixel.
    let around = 1.0 - 14400.0 / corners.samples as f64;
    let share =
        |all: u64, corners: u64, uniform: u64| (all as f64 - around * corners as f64) / uniform as f64;
    let eye = share(adaptive.samples, corners.samples, uniform.samples);
    let all = share(adaptive.rays, corners.rays, uniform.rays);
    eprintln!("error {:.3}, eye rays {eye:.3}, all rays {all:.3}", adaptive.rmse() / uniform.rmse());
    assert!(adaptive.rmse() <= uniform.rmse(), "error {} and {}", adaptive.rmse(), uniform.rmse());
    assert!(eye < 0.25 && all < 0.25, "eye rays {eye}, all rays {all}");
}
