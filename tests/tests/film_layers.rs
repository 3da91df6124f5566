//! What films keep beside colours: pbrt-v4's `gbuffer` against closed forms.
use durer::{
    Options, Prepared,
    film::{Layer, Tile},
    scene::Severity,
};
use durer_tests::{bits, exr, import, render, scene, small::BOX};

const EDGE: u32 = 8;
/// Half the side of the picture at distance 1.
const HALF: f64 = 0.577_350_269_189_625_8;
/// From the left, at 3 m: the camera's x is the world's z, its z is 3 less the world's x.
const CAMERA: &str = "LookAt 3 0 0  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60";
const STILL: &str = "Option \"bool disablepixeljitter\" true";

fn kept() -> Options {
    Options { layers: true, ..Options::default() }
}

/// A picture of `EDGE` by `EDGE` pixels on a film of these words.
fn picture(film: &str, options: &str, samples: u32, world: &str) -> Prepared {
    let text = format!(
        "{options}\n{CAMERA}\nFilm {film} \"integer xresolution\" {EDGE} \"integer yresolution\" {EDGE}\n{BOX}\n\
         Sampler \"sobol\" \"integer pixelsamples\" {samples}\nWorldBegin\nLightSource \"ambient\"\n{world}"
    );
    scene(&text, &kept())
}

/// Numbers of a pixel by the names of their layers.
struct Seen(Vec<Layer>);

impl Seen {
    fn of(prepared: &Prepared) -> Self {
        Self(render(prepared).film.layers())
    }
    fn at(&self, pixel: usize, name: &str) -> f64 {
        let layer = self.0.iter().find(|layer| layer.name == name).expect("a layer");
        layer.values[pixel].into()
    }
    fn three(&self, pixel: usize, name: &str) -> [f64; 3] {
        ["X", "Y", "Z"].map(|axis| self.at(pixel, &format!("{name}.{axis}")))
    }
}

/// In camera space, the direction of depth 1 through the middle of a pixel.
fn ahead(pixel: usize) -> [f64; 3] {
    let at = |i: usize| (2.0 * (i as f64 + 0.5) / f64::from(EDGE) - 1.0) * HALF;
    [at(pixel % EDGE as usize), -at(pixel / EDGE as usize), 1.0]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
fn near(a: [f64; 3], b: [f64; 3], within: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < within)
}
fn to_world([x, y, z]: [f64; 3]) -> [f64; 3] {
    [3.0 - z, y, x]
}

/// `p(u, v) = A + u E + v F` in the world.
const A: [f64; 3] = [-2.0, -4.0, -5.0];
const E: [f64; 3] = [1.0, 0.5, 9.0];
const F: [f64; 3] = [0.5, 9.0, -1.0];

#[test]
fn of_a_plane_places_normals_coordinates_and_slopes_are_those_of_the_formula() {
    let corner = |u: f64, v: f64| [0, 1, 2].map(|i| A[i] + u * E[i] + v * F[i]);
    let corners: String = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
        .map(|(u, v)| corner(u, v).map(|c| format!("{c} ")).concat())
        .concat();
    let wall = format!("Shape \"bilinearmesh\" \"point3 P\" [ {corners} ]");
    let seen = ["camera", "world"].map(|space| {
        Seen::of(&picture(&format!("\"gbuffer\" \"string coordinatesystem\" \"{space}\""), STILL, 1, &wall))
    });
    // E x F, turned to the eye, which lies towards +x.
    let n = [0, 1, 2].map(|i| E[(i + 1) % 3] * F[(i + 2) % 3] - E[(i + 2) % 3] * F[(i + 1) % 3]);
    let n = n.map(|c| c * n[0].signum() / dot(n, n).sqrt());
    // In camera space.
    let to_camera = |[x, y, z]: [f64; 3]| [z, y, -x];
    let (nc, qc) = (to_camera(n), to_camera([A[0] - 3.0, A[1], A[2]]));
    for pixel in 0..(EDGE * EDGE) as usize {
        let d = ahead(pixel);
        let z = dot(nc, qc) / dot(nc, d);
        let p = d.map(|c| c * z);
        assert!(near(seen[0].three(pixel, "P"), p, 1e-5), "{:?} {p:?}", seen[0].three(pixel, "P"));
        assert!(near(seen[1].three(pixel, "P"), to_world(p), 1e-5));
        for name in ["N", "Ns"] {
            assert!(near(seen[0].three(pixel, name), nc, 1e-6) && near(seen[1].three(pixel, name), n, 1e-6));
        }
        let (u, v) = (seen[0].at(pixel, "u"), seen[0].at(pixel, "v"));
        assert!(near(corner(u, v), to_world(p), 2e-5), "{u} {v}");
        // Of z = n q / n d by the picture's x and y, a pixel further; in the world of x = 3 - z, y, and z = z d_x.
        let step = 2.0 * HALF / f64::from(EDGE);
        let slope = |axis: usize| z * nc[axis].abs() / dot(nc, d).abs() * step;
        for (axis, name) in ["dzdx", "dzdy"].into_iter().enumerate() {
            let found = seen[0].at(pixel, name);
            assert!((found - slope(axis)).abs() < 1e-3 * z * step, "{name} {found} {}", slope(axis));
        }
        let along = z * step - nc[0] * z * step / dot(nc, d) * d[0];
        let found = seen[1].at(pixel, "dzdx");
        assert!((found - along.abs()).abs() < 1e-3 * z * step, "{found} {along}");
    }
}

#[test]
fn of_a_ball_normals_point_from_its_middle_and_misses_are_nothing() {
    let ball = "Material \"diffuse\" \"rgb reflectance\" [ 0.2 0.4 0.8 ] Shape \"sphere\" \"float radius\" 1";
    let seen = Seen::of(&picture("\"gbuffer\" \"string coordinatesystem\" \"world\"", STILL, 1, ball));
    let mut met = 0;
    for pixel in 0..(EDGE * EDGE) as usize {
        let d = ahead(pixel);
        // |t d - (0, 0, 3)| = 1.
        let (dd, root) = (dot(d, d), 9.0 - 8.0 * dot(d, d));
        let albedo = ["R", "G", "B"].map(|c| seen.at(pixel, &format!("Albedo.{c}")));
        if root < 0.0 {
            assert!(seen.0.iter().all(|layer| layer.values[pixel] == 0.0), "{pixel}");
            continue;
        }
        met += 1;
        let t = (3.0 - root.sqrt()) / dd;
        let p = to_world(d.map(|c| c * t));
        assert!(near(seen.three(pixel, "P"), p, 1e-5) && near(seen.three(pixel, "N"), p, 1e-5), "{p:?}");
        assert!(near(seen.three(pixel, "Ns"), p, 1e-5) && near(albedo, [0.2, 0.4, 0.8], 1e-6));
    }
    assert_eq!(met, 16);
}

/// Half of the samples of a pixel are 2, the others 0.
#[test]
fn variances_are_those_of_a_known_noise() {
    let world = "Shape \"sphere\" \"float radius\" 1";
    let noise = "Integrator \"function\" \"string function\" \"step\"";
    let seen = Seen::of(&picture("\"gbuffer\"", noise, 64, world));
    let middle = (EDGE / 2 * EDGE + EDGE / 2) as usize;
    for name in ["Variance.R", "Variance.G", "Variance.B", "RelativeVariance.G"] {
        assert!((seen.at(middle, name) - 64.0 / 63.0).abs() < 1e-6, "{name} {}", seen.at(middle, name));
        assert_eq!(seen.at(0, name), 0.0, "nothing is met there");
    }
    let brighter = Seen::of(&picture("\"gbuffer\" \"float iso\" 300", noise, 64, world));
    assert!((brighter.at(middle, "Variance.G") - 9.0 * 64.0 / 63.0).abs() < 1e-5);
    assert!((brighter.at(middle, "RelativeVariance.G") - 3.0 * 64.0 / 63.0).abs() < 1e-5);
}

#[test]
fn all_integrators_see_the_same_surfaces() {
    let world = "Material \"dielectric\" Shape \"sphere\" \"float radius\" 1 \
                 Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.3 0.1 ] \
                 Shape \"plane\" \"point3 point\" [ 0 -1 0 ] LightSource \"point\" \"point3 from\" [ 2 3 1 ]";
    let of = |integrator: &str| {
        let options = format!("Integrator \"{integrator}\"");
        let mut layers = Seen::of(&picture("\"gbuffer\"", &options, 4, world)).0;
        layers.truncate(16);
        layers.into_iter().map(|l| l.values.into_iter().map(f32::to_bits).collect()).collect::<Vec<Vec<_>>>()
    };
    let expected = of("path");
    for integrator in ["volpath", "whitted", "bdpt", "light", "sppm", "ambientocclusion", "direct"] {
        assert_eq!(of(integrator), expected, "{integrator}");
    }
}

#[test]
fn layers_change_no_colour_and_threads_change_no_layer() {
    let world = "Material \"diffuse\" Shape \"sphere\" \"float radius\" 1";
    // Of six tiles, the last of which are cut.
    let mut prepared = picture("\"gbuffer\"", "", 70, world);
    (prepared.scene.view.width, prepared.scene.view.height) = (70, 40);
    prepared.settings.crop = Some(Tile { x0: 0, y0: 3, x1: 70, y1: 40 });
    let one = render(&prepared);
    prepared.settings.threads = 3;
    assert_eq!(render(&prepared).film.layers(), one.film.layers());
    prepared.scene.view.layers = None;
    let plain = render(&prepared);
    assert_eq!(bits(&plain), bits(&one));
    assert!(plain.film.layers().is_empty());
}

#[test]
fn wavelengths_see_the_same_surfaces_and_about_the_same_albedo() {
    let world =
        "Material \"diffuse\" \"rgb reflectance\" [ 0.2 0.4 0.8 ] Shape \"sphere\" \"float radius\" 2";
    let mut prepared = picture("\"gbuffer\"", STILL, 1024, world);
    let colors = Seen::of(&prepared);
    prepared.settings.carried = durer::spectrum::Carried::Wavelengths;
    let spectral = Seen::of(&prepared);
    let middle = (EDGE / 2 * EDGE + EDGE / 2) as usize;
    assert_eq!(spectral.three(middle, "P"), colors.three(middle, "P"));
    for (name, expected) in [("Albedo.R", 0.2), ("Albedo.G", 0.4), ("Albedo.B", 0.8)] {
        assert!((spectral.at(middle, name) - expected).abs() < 0.02, "{name} {}", spectral.at(middle, name));
    }
}

#[test]
fn a_file_holds_all_layers_under_the_names_of_pbrt() {
    let prepared = picture("\"gbuffer\"", "", 2, "Shape \"sphere\"");
    let rendered = render(&prepared);
    let layers = rendered.film.layers();
    let p = layers.iter().find(|layer| layer.name == "P.Z").expect("places").values.clone();
    let (_, read) = exr(&prepared, &rendered);
    let names: Vec<&str> = read.iter().map(|channel| channel.name.as_str()).collect();
    let expected = "Albedo.B Albedo.G Albedo.R B G N.X N.Y N.Z Ns.X Ns.Y Ns.Z P.X P.Y P.Z R RelativeVariance.B \
                    RelativeVariance.G RelativeVariance.R Variance.B Variance.G Variance.R dzdx dzdy u v";
    assert_eq!(names.join(" "), expected);
    assert_eq!(read.iter().find(|c| c.name == "P.Z").map(|c| &c.values), Some(&p));
}

#[test]
fn films_that_do_not_fit_in_memory_are_refused() {
    let refused = |film: &str| {
        let text = format!("Film {film}\nWorldBegin\nShape \"sphere\"");
        let mut imported = import(&text);
        assert!(durer::prepare(&mut imported, &kept()).is_none(), "{film}");
        let said = imported.diagnostics.iter().filter(|d| d.severity == Severity::Error);
        said.map(|d| d.message.clone()).collect::<String>()
    };
    let huge = "\"spectral\" \"integer nbuckets\" 1000";
    assert_eq!(
        refused(&format!("{huge} \"integer xresolution\" 2000 \"integer yresolution\" 1000")),
        "what the film keeps beside colours takes 60 GiB for 2000 x 1000 pixels: 32000 bytes for each"
    );
    assert!(
        refused("\"spectral\" \"integer nbuckets\" 1000000")
            .contains("\"nbuckets\" is 1000000, expected 1 to 10000")
    );
    assert!(
        refused("\"spectral\" \"float lambdamin\" 500 \"float lambdamax\" 400")
            .contains("16 buckets lie from")
    );
}
