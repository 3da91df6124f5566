//! Cameras against closed forms.
use durer_core::math::{Point2, Point3, Ray, Vector3};
use durer_core::sampling::{Sampler, SamplerKind};
use durer_model::camera::{CAMERAS, Camera};
use durer_scene::{Args, Data, Diagnostics, Node, Params, ValueType};

fn build(kind: &str, params: Params, width: u32, height: u32) -> Result<(Box<dyn Camera>, String), String> {
    let node = Node::new(kind, params);
    let entry = CAMERAS.iter().find(|e| e.answers_to(kind)).expect("a registered word");
    let mut diagnostics = Diagnostics::default();
    let camera = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut diagnostics));
    let said = diagnostics.iter().map(|d| d.message.as_str()).collect::<Vec<_>>().join("; ");
    let Some(mut camera) = camera else {
        return Err(said);
    };
    camera.fit(width, height);
    Ok((camera, said))
}

fn camera(kind: &str, params: Params, width: u32, height: u32) -> Box<dyn Camera> {
    build(kind, params, width, height).expect("sound parameters").0
}

fn through(camera: &dyn Camera, x: f32, y: f32) -> Ray {
    camera.ray(Point2::new(x, y), 0.25, &Sampler::new(SamplerKind::Sobol, 0, [0, 0], 0, 1))
}

/// Slopes x / z and y / z of a ray.
fn slopes(ray: &Ray) -> [f64; 2] {
    [f64::from(ray.d.x) / f64::from(ray.d.z), f64::from(ray.d.y) / f64::from(ray.d.z)]
}

fn four(v: [f32; 4]) -> (ValueType, Data) {
    (ValueType::Float, Data::Floats(v.to_vec()))
}

#[test]
fn the_centre_looks_along_z_whatever_the_shape_of_the_picture() {
    for (w, h) in [(1, 1), (640, 480), (480, 640), (1920, 1)] {
        for kind in ["perspective", "orthographic"] {
            let ray = through(camera(kind, Params::new(), w, h).as_ref(), 0.5, 0.5);
            assert_eq!(
                (ray.o, ray.d, ray.time),
                (Point3::ZERO, Vector3::new(0.0, 0.0, 1.0), 0.25),
                "{kind} {w} {h}"
            );
        }
    }
}

#[test]
fn corners_are_where_the_closed_form_says() {
    let t = 20f64.to_radians().tan();
    for (axis, w, h, x, y) in [
        ("shorter", 300, 200, 1.5 * t, t),
        ("shorter", 200, 300, t, 1.5 * t),
        ("x", 300, 200, t, t / 1.5),
        ("x", 200, 300, t, 1.5 * t),
        ("y", 300, 200, 1.5 * t, t),
        ("y", 200, 300, t / 1.5, t),
    ] {
        let camera = camera("perspective", Params::new().float("fov", 40.0).string("fovaxis", axis), w, h);
        for (film_x, film_y, right, up) in
            [(0.0, 0.0, -1.0, 1.0), (1.0, 0.0, 1.0, 1.0), (0.0, 1.0, -1.0, -1.0)]
        {
            let ray = through(camera.as_ref(), film_x, film_y);
            let [sx, sy] = slopes(&ray);
            assert!((sx - right * x).abs() < 1e-6 && (sy - up * y).abs() < 1e-6, "{axis} {w}x{h}: {sx} {sy}");
        }
    }
}

#[test]
fn directions_have_unit_length_and_depth_is_length_times_cosine() {
    // G7: a wall at depth 7 is met at t = 7 / cos a.
    let camera = camera("perspective", Params::new().float("fov", 100.0), 160, 90);
    for i in 0..=20 {
        for j in 0..=20 {
            let ray = through(camera.as_ref(), i as f32 / 20.0, j as f32 / 20.0);
            let [sx, sy] = slopes(&ray);
            let cosine = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
            assert!((ray.d.length() - 1.0).abs() < 1e-6);
            let t = 7.0 / f64::from(ray.d.z);
            assert!((t * cosine - 7.0).abs() < 1e-5, "{t} {cosine}");
        }
    }
}

#[test]
fn windows_and_aspect_ratios_replace_the_defaults() {
    let (ty, data) = four([0.0, 0.5, -1.0, 0.0]);
    let cut = camera("perspective", Params::new().with("screenwindow", ty, data.clone()), 100, 100);
    let near = |ray: &Ray, x: f64, y: f64| {
        let [sx, sy] = slopes(ray);
        (sx - x).abs() < 1e-6 && (sy - y).abs() < 1e-6
    };
    assert!(
        near(&through(cut.as_ref(), 0.0, 0.0), 0.0, 0.0) && near(&through(cut.as_ref(), 1.0, 1.0), 0.5, -1.0)
    );
    let wide = camera("perspective", Params::new().float("frameaspectratio", 2.0), 100, 100);
    assert!(near(&through(wide.as_ref(), 1.0, 0.0), 2.0, 1.0));
    let parallel = camera("orthographic", Params::new().with("screenwindow", ty, data), 100, 100);
    assert_eq!(through(parallel.as_ref(), 1.0, 1.0).o, Point3::new(0.5, -1.0, 0.0));
    let parallel = camera("orthographic", Params::new(), 200, 100);
    assert_eq!(through(parallel.as_ref(), 0.0, 0.0).o, Point3::new(-2.0, 1.0, 0.0));
}

#[test]
fn what_makes_no_picture_is_refused_and_a_lens_is_warned_about() {
    let (ty, data) = four([1.0, 1.0, 0.0, 1.0]);
    for params in [
        Params::new().float("fov", 0.0),
        Params::new().float("fov", 180.0),
        Params::new().float("fov", 200.0),
        Params::new().float("frameaspectratio", 0.0),
        Params::new().with("screenwindow", ty, data),
        Params::new().with("screenwindow", ValueType::Float, Data::Floats(vec![1.0; 3])),
    ] {
        assert!(build("perspective", params.clone(), 8, 8).is_err(), "{params:?}");
    }
    let lens = Params::new().float("lensradius", 0.1).float("focaldistance", 3.0);
    let (_, said) = build("perspective", lens, 8, 8).expect("a camera");
    assert!(said.contains("depth of field is not supported yet"), "{said}");
}
