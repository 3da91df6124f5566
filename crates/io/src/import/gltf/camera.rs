//! Cameras and punctual lights, and the placement both share: rotation and position of their node without its scale.
use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Motion,
};
use durer_scene::{CameraDesc, Data, FilmDesc, LightDesc, Node, Params, ValueType};

use super::element::{Checked, Element};

/// The placement `world` without scale, shear and mirroring: what a camera or light inherits from its node.
pub(super) fn rigid(world: &DAffine3) -> DAffine3 {
    let m = world.matrix3;
    let z = m.z_axis.try_normalize().unwrap_or(DVec3::Z);
    let y = (m.y_axis - z * z.dot(m.y_axis)).try_normalize().unwrap_or_else(|| z.any_orthonormal_vector());
    DAffine3 { matrix3: DMat3::from_cols(y.cross(z), y, z), translation: world.translation }
}

/// A motion with something done to each of its keys.
pub(super) fn carried(motion: &Motion, make: impl Fn(&DAffine3) -> DAffine3) -> Motion {
    let keys = motion.keys().iter().map(|(time, m)| (*time, make(m))).collect();
    Motion::keyed(keys).unwrap_or_else(|_| Motion::still(make(&motion.at(0.0))))
}

/// The camera `element`, carried by a node at `world`. glTF cameras look along -z, ours along +z, with the same x and
/// y: the placement mirrors z.
pub(super) fn camera(element: &Element<'_>, name: &str, world: &Motion) -> Checked<CameraDesc> {
    let kind = element.required("type")?;
    let node = match kind.text()? {
        "perspective" => perspective(&element.required("perspective")?)?,
        "orthographic" => orthographic(&element.required("orthographic")?)?,
        other => {
            return Err(kind.fault(format!("expected perspective or orthographic, found \"{other}\"")));
        }
    };
    let turned = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let world_from_camera = carried(world, |m| rigid(m) * turned);
    Ok(CameraDesc { name: name.to_owned(), node, world_from_camera, media: None })
}

fn perspective(element: &Element<'_>) -> Checked<Node> {
    let yfov = element.required("yfov")?;
    let angle = yfov.number()?;
    if !(angle > 0.0 && angle < std::f64::consts::PI) {
        return Err(yfov.fault(format!("expected an angle between 0 and pi radians, found {angle}")));
    }
    // aspectRatio is for the size of the picture, see `film`: here it would crop or stretch what the user asks for.
    Ok(Node::new("perspective", Params::new().float("fov", angle.to_degrees() as f32).string("fovaxis", "y")))
}

/// The picture that a camera asks for by its aspectRatio; none if that is missing or senseless.
pub(super) fn film(element: &Element<'_>) -> Checked<FilmDesc> {
    const WIDTH: f64 = 1280.0;
    let Some(perspective) = element.get("perspective")? else {
        return Ok(FilmDesc::default());
    };
    let ratio = perspective.number_or("aspectRatio", 0.0)?;
    if !(0.1..=10.0).contains(&ratio) {
        return Ok(FilmDesc::default());
    }
    let (width, height) = (Some(WIDTH as u32), Some((WIDTH / ratio).round() as u32));
    Ok(FilmDesc { width, height, ..FilmDesc::default() })
}

fn orthographic(element: &Element<'_>) -> Checked<Node> {
    let half = |key| {
        let size = element.required(key)?;
        let value = size.number()?.abs() as f32;
        if value > 0.0 { Ok(value) } else { Err(size.fault("expected a number other than 0")) }
    };
    let (x, y) = (half("xmag")?, half("ymag")?);
    let window = Data::Floats(vec![-x, x, -y, y]);
    Ok(Node::new("orthographic", Params::new().with("screenwindow", ValueType::Float, window)))
}

/// The light `element` of KHR_lights_punctual, carried by a node at `world`. Its photometric numbers (candela, lux)
/// are taken as radiometric ones (W/sr, W/m^2) without a factor, as most renderers do; `range` is a hint for
/// rasterisers and ignored.
pub(super) fn light(element: &Element<'_>, name: &str, world: &Motion) -> Checked<LightDesc> {
    let color: [f64; 3] = element.numbers_or("color", [1.0; 3])?;
    let intensity = element.number_or("intensity", 1.0)?;
    let power = color.map(|c| (c * intensity) as f32);
    let kind = element.required("type")?;
    // Lights without direction need none; the others shine along -z of their node.
    let aim = |p: Params| {
        let point = |p: Params, name, v: [f32; 3]| p.with(name, ValueType::Point3, Data::Floats(v.to_vec()));
        point(point(p, "from", [0.0; 3]), "to", [0.0, 0.0, -1.0])
    };
    let node = match kind.text()? {
        "point" => Node::new("point", Params::new().rgb("I", power)),
        "directional" => Node::new("distant", aim(Params::new().rgb("L", power))),
        "spot" => {
            let (outer, inner) = cone(element)?;
            let params = aim(Params::new().rgb("I", power));
            Node::new("spot", params.float("coneangle", outer).float("conedeltaangle", outer - inner))
        }
        other => {
            return Err(kind.fault(format!("expected point, directional or spot, found \"{other}\"")));
        }
    };
    Ok(LightDesc { name: name.to_owned(), node, world_from_light: carried(world, rigid) })
}

/// Outer and inner angle of a spot light in degrees.
fn cone(element: &Element<'_>) -> Checked<(f32, f32)> {
    let spot = element.required("spot")?;
    let outer = spot.number_or("outerConeAngle", std::f64::consts::FRAC_PI_4)?;
    let inner = spot.number_or("innerConeAngle", 0.0)?;
    if !(inner >= 0.0 && inner <= outer && outer <= std::f64::consts::FRAC_PI_2 + 1e-6) {
        let message = format!("expected 0 <= innerConeAngle ({inner}) <= outerConeAngle ({outer}) <= pi/2");
        return Err(spot.fault(message));
    }
    Ok((outer.to_degrees() as f32, inner.to_degrees() as f32))
}
