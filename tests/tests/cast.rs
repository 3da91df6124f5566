//! What ray casting shows, against geometry known in closed form.
use durer::{Options, Show};
use durer_tests::{render, scene};

const BALL: &str = "Film \"rgb\" \"integer xresolution\" 201 \"integer yresolution\" 201\n\
    LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n\
    WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [.2 .4 .6]\nShape \"sphere\"\n";

fn cast(text: &str, show: Show) -> durer::Rendered {
    let options =
        Options { integrator: Some("cast".into()), show: Some(show), samples: Some(1), ..Options::default() };
    render(&scene(text, &options))
}

#[test]
fn the_silhouette_of_a_sphere_has_the_solid_angle_g1() {
    let film = cast(BALL, Show::Depth).film;
    // Solid angle of the pixels that hit: each covers cos^3 / f^2 of a unit focal plane.
    let pixel = 2.0 * (30.0f64).to_radians().tan() / 201.0;
    let mut solid = 0.0;
    let mut widest: f64 = 0.0;
    for (i, p) in film.pixels().iter().enumerate() {
        if p.weight > 0.0 {
            let (x, y) = ((i % 201) as f64 - 100.0, (i / 201) as f64 - 100.0);
            let r2 = (x * x + y * y) * pixel * pixel;
            solid += pixel * pixel / (1.0 + r2).powf(1.5);
            widest = widest.max(r2.sqrt());
        }
    }
    assert!((solid - 0.359_341).abs() < 0.002, "{solid}");
    assert!((widest - 0.353_553).abs() < pixel, "{widest}");
}

#[test]
fn depth_is_along_the_axis_and_length_along_the_ray_g7() {
    let wall = "Film \"rgb\" \"integer xresolution\" 31 \"integer yresolution\" 21\n\
        Camera \"perspective\" \"float fov\" 90\nWorldBegin\n\
        Shape \"plane\" \"point3 point\" [0 0 4] \"vector3 normal\" [0 0 -1]\n";
    for (i, p) in cast(wall, Show::Depth).film.pixels().iter().enumerate() {
        let [depth, length, _] = p.mean();
        assert!((depth - 4.0).abs() < 1e-5, "{depth}");
        let (x, y) = (((i % 31) as f64 - 15.0) / 10.5, ((i / 31) as f64 - 10.0) / 10.5);
        let cos = 1.0 / (1.0 + x * x + y * y).sqrt();
        assert!((f64::from(length) * cos - 4.0).abs() < 1e-5, "{length} {cos}");
    }
}

#[test]
fn normals_albedo_and_ids_are_those_of_the_sphere() {
    let middle = 100 * 201 + 100;
    let normal = cast(BALL, Show::Normal).film.pixels()[middle].mean();
    assert!((normal[2] + 1.0).abs() < 1e-6, "{normal:?}");
    let albedo = cast(BALL, Show::Albedo).film.pixels();
    assert_eq!(albedo[middle].mean(), [0.2, 0.4, 0.6]);
    assert_eq!(albedo[0].mean(), [0.0; 3]);
    assert_eq!(cast(BALL, Show::Id).film.pixels()[middle].mean()[0], 1.0);
}

#[test]
fn local_shading_is_lamberts_cosine_without_shadows() {
    let lit = BALL.replace(
        "WorldBegin\n",
        "WorldBegin\nLightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0]\n\
         Shape \"disk\" \"float height\" -2.5 \"float radius\" 0.0001\n",
    );
    let shading = cast(&lit, Show::Shading).film.pixels();
    let normals = cast(BALL, Show::Normal).film.pixels();
    for (i, (s, n)) in shading.iter().zip(&normals).enumerate().filter(|(_, (_, n))| n.weight > 0.0) {
        if i == 100 * 201 + 100 {
            continue;
        }
        let expected = 0.4 / std::f32::consts::PI * (-n.mean()[2]).max(0.0);
        assert!((s.mean()[1] - expected).abs() < 1e-5, "pixel {i}: {} != {expected}", s.mean()[1]);
    }
}

#[test]
fn cost_is_every_primitive_without_a_hierarchy_and_less_with_one() {
    let mut balls = BALL.to_owned();
    for i in 0..9 {
        balls += &format!("AttributeBegin Translate {i} 2 4 Shape \"sphere\" AttributeEnd\n");
    }
    let cost = |engine| {
        let options = Options {
            integrator: Some("cast".into()),
            show: Some(Show::Cost),
            width: Some(40),
            engine,
            ..Options::default()
        };
        let rendered = render(&scene(&balls, &options));
        rendered.film.pixels().iter().map(durer::film::Pixel::mean).collect::<Vec<_>>()
    };
    let all = cost(durer::accel::Engine::BruteForce);
    assert!(all.iter().all(|c| *c == [10.0, 0.0, 0.0]), "also where nothing is hit");
    let some = cost(durer::accel::Engine::Bvh);
    assert!(some.iter().all(|c| c[0] < 10.0 && c[1] >= 1.0));
    assert!(some.iter().any(|c| c[0] >= 1.0) && some.iter().any(|c| c[0] == 0.0));
}
