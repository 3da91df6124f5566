//! Area lights with pictures: what samples bring is what the picture has at their point, and the power is what was asked.
use std::{f64::consts::PI, sync::Arc};

use durer_core::{
    glam::DAffine3,
    math::{Normal3, Point2, Point3, Ray, Vector3},
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::{
    light::{AREA_LIGHTS, Area, Light, LightCx, Orientation, Track},
    shape::{Disk, Geometry, Patch, Sphere, mesh_surface},
};
use durer_scene::{
    Args, AssetError, Assets, Data, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params, ValueType,
};
use durer_testkit::random::Random;

const CX: LightCx = LightCx { basis: Basis::Rgb, time: 0.0 };

/// One picture, whatever the name.
struct Only(Arc<Image>);

impl Assets for Only {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, _path: &str) -> Result<Arc<Image>, AssetError> {
        Ok(Arc::clone(&self.0))
    }
}

/// Bright in the upper left corner, dark in the lower right one.
fn picture() -> Image {
    let data = (0..64).map(|i| (7 - i % 8 + 7 - i / 8) as f32 * 0.5).flat_map(|v| [v; 3]).collect();
    Image { width: 8, height: 8, channels: 3, data: ImageData::F32(data) }
}

fn emission(params: Params, said: &mut Diagnostics) -> Option<durer_model::light::Emission> {
    let node = Node::new("diffuse", params.string("filename", "glow.exr"));
    let assets = Only(Arc::new(picture()));
    let mut args = Args::check(&node, AREA_LIGHTS[0].schema, &[], said).with_assets(&assets, Missing::Refuse);
    (AREA_LIGHTS[0].build)(&mut args)
}

fn area(params: Params, geometry: &Geometry, place: DAffine3) -> Area {
    let emission = emission(params, &mut Diagnostics::default()).expect("sound");
    Area::new(&emission, geometry, Track::still(place), Orientation::AsMade).expect("it shines")
}

/// The unit square, in as many triangles as `n` times `n` cells have.
fn square(n: u32) -> Geometry {
    let at = |i: u32| i as f32 / n as f32;
    let grid = || (0..=n).flat_map(|y| (0..=n).map(move |x| (at(x), at(y))));
    let cell = |i: u32| {
        let a = i / n * (n + 1) + i % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Geometry::Mesh(Arc::new(Mesh {
        positions: grid().map(|(x, y)| Point3::new(x, y, 0.0)).collect(),
        uvs: grid().map(|(x, y)| Point2::new(x, y)).collect(),
        indices: (0..n * n).flat_map(cell).collect(),
        ..Mesh::default()
    }))
}

/// What a ray sees of a light where it is.
fn seen(light: &Area, geometry: &Geometry, o: Point3, d: Vector3) -> Option<f32> {
    let surface = match geometry {
        Geometry::Shapes(parts) => {
            let ray = Ray::new(o, d);
            let hit = parts.iter().filter_map(|s| s.intersect(&ray).map(|hit| (s, hit)));
            let (shape, hit) = hit.min_by(|a, b| a.1.t.total_cmp(&b.1.t))?;
            shape.surface(&ray, &hit)
        }
        Geometry::Mesh(mesh) => {
            let t = -o.z / d.z;
            let (x, y) = (o.x + d.x * t, o.y + d.y * t);
            let n = ((mesh.indices.len() / 2) as f32).sqrt();
            let (i, j) = (((x * n) as u32).min(n as u32 - 1), ((y * n) as u32).min(n as u32 - 1));
            let (u, v) = (x * n - i as f32, y * n - j as f32);
            let prim = 2 * (j * n as u32 + i) + u32::from(v > u);
            let notes = if v > u { [u, v - u] } else { [u - v, v] };
            mesh_surface(mesh, prim, notes, 0.0)
        }
        Geometry::Strands(_) => return None,
    };
    Some(light.emitted(Basis::Rgb, &surface, -d).mean())
}

#[test]
fn samples_bring_what_rays_see() {
    let corners = [[0.0, 0.0, 0.2], [1.0, 0.0, 0.0], [0.0, 1.2, 0.3], [1.0, 1.0, 0.0]].map(Point3::from);
    let forms = [
        square(1),
        square(5),
        Geometry::shape(Sphere::new(0.7)),
        Geometry::shape(Disk::new(0.0, 1.0, 0.2, 300.0)),
        Geometry::shape(Patch::new(corners)),
    ];
    let both =
        || Params::new().with("twosided", ValueType::Bool, Data::Bools(vec![true])).float("scale", 2.0);
    for geometry in &forms {
        let light = area(both(), geometry, DAffine3::IDENTITY);
        let mut found = 0;
        let mut random = Random::new(7);
        for i in 0..2000 {
            let from = Point3::from_f64(random.direction() * 4.0);
            let sampler = Sampler::new(SamplerKind::Independent, 2, [0, 0], i, 2000);
            let Some(s) = light.sample(&CX, from, &sampler) else { continue };
            let Some(expected) = seen(&light, geometry, from, s.wi) else { continue };
            let got = s.weight.mean() * s.pdf.expect("extended");
            found += u32::from((got - expected).abs() < 2e-3 * expected + 5e-3);
        }
        // Rays may miss what is seen edge on, and meet another sheet of a patch first.
        assert!(found > 1900, "{found} {geometry:?}");
    }
}

#[test]
fn power_is_that_of_the_whole_picture() {
    for geometry in [square(1), square(4), Geometry::shape(Disk::new(0.0, 1.0, 0.0, 360.0))] {
        let light =
            area(Params::new().float("power", 12.0).float("scale", 0.5), &geometry, DAffine3::IDENTITY);
        assert!((light.power(1.0) - 6.0).abs() < 1e-3);
        // The flux through a far sphere, from the irradiance there.
        let mut random = Random::new(3);
        let mut flux = 0.0;
        for i in 0..20_000 {
            let d = random.direction();
            let sampler = Sampler::new(SamplerKind::Independent, 5, [0, 0], i, 20_000);
            let s = light.sample(&CX, Point3::from_f64(d * 200.0), &sampler);
            flux += s.map_or(0.0, |s| f64::from(s.weight.mean())) * 4.0 * PI * 200.0f64.powi(2) / 20_000.0;
        }
        assert!((flux / 6.0 - 1.0).abs() < 0.03, "{flux}");
    }
}

#[test]
fn the_first_row_of_the_picture_is_where_v_is_one() {
    let light = area(Params::new(), &square(1), DAffine3::IDENTITY);
    let at = |x: f32, y: f32| {
        let Geometry::Mesh(mesh) = square(1) else { return 0.0 };
        let surface = mesh_surface(&mesh, 0, [x - y, y], 0.0);
        light.emitted(Basis::Rgb, &surface, Vector3::new(0.0, 0.0, 1.0)).mean()
    };
    // Pixels (0, 7), (7, 7) and (7, 0) lie at the lower corners and the upper right one.
    assert!(
        (at(0.0, 0.0) - 3.5).abs() < 1e-5 && at(1.0, 0.0).abs() < 1e-5 && (at(1.0, 1.0) - 3.5).abs() < 1e-5
    );
    assert!(light.bounds().expect("a place").normals.axis == Normal3::new(0.0, 0.0, 1.0).into());
}

#[test]
fn a_light_has_a_colour_or_a_picture() {
    let mut said = Diagnostics::default();
    assert!(emission(Params::new().rgb("L", [1.0; 3]), &mut said).is_none() && said.has_errors());
}
