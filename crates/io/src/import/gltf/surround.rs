//! EXT_lights_image_based: a picture all around on the faces of a cube. Blurred copies of it and irradiance, which the file
//! brings for those who cannot compute them, are left out.
//!
//! Faces are +x, -x, +y, -y, +z, -z, each as a camera in the middle of the cube sees it that looks along the axis: up is +y, but
//! -z on the face of +y and +z on that of -y. (The extension has the faces of OpenGL's cube maps, which are seen from outside,
//! flipped.) Pictures with alpha are packed as RGBD: colours, sRGB-encoded, are divided by alpha.
use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Motion, float::pow},
};
use durer_scene::{Assets, Image, ImageData, LightDesc, Node, Params};

use super::{
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    kept,
};
use crate::FileAssets;

/// The name of the extension.
const NAME: &str = "EXT_lights_image_based";
/// What the picture is called that the faces become.
const PICTURE: &str = "surroundings.pfm";
/// Most pixels along an edge of a face.
const MOST: u32 = 2048;
/// Forward and up of each face.
const FACES: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::NEG_Z),
    (DVec3::NEG_Y, DVec3::Z),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
];

/// One face, linear.
struct Face {
    size: u32,
    pixels: Vec<[f32; 3]>,
}

/// The light around the scene that is drawn, if it has one; its picture is made known under a name.
pub(super) fn light(
    (document, buffers): (&Document<'_>, &Buffers),
    assets: &mut FileAssets,
) -> Checked<Option<LightDesc>> {
    let scene = document.root.list_item("scenes", document.root.index_or("scene", 0)?)?;
    let Some(scene) = scene else { return Ok(None) };
    let Some(carrier) = scene.extension(NAME)? else { return Ok(None) };
    let reference = carrier.required("light")?;
    let lights = document.root.extension(NAME)?.map_or(Ok(Vec::new()), |all| all.list("lights"))?;
    let light = lights.get(reference.index()?).ok_or_else(|| {
        reference.fault(format!("refers to a light that is not there: the file has {}", lights.len()))
    })?;
    let intensity = light.number_or("intensity", 1.0)?;
    if intensity < 0.0 {
        return Err(light.fault_at("intensity", format!("expected 0 or more, found {intensity}")));
    }
    let turned = DQuat::from_array(light.numbers_or("rotation", [0.0, 0.0, 0.0, 1.0])?);
    let sizes = light.required("specularImages")?;
    let sharp =
        sizes.items()?.next().ok_or_else(|| sizes.fault("expected the 6 faces of a cube, found none"))?;
    let references = sharp.items()?;
    if references.len() != FACES.len() {
        return Err(sharp.fault(format!("expected the 6 faces of a cube, found {}", references.len())));
    }
    let faces = references.map(|reference| face((document, buffers), assets, &reference));
    let faces = faces.collect::<Checked<Vec<Face>>>()?;
    assets.insert(PICTURE, picture(&faces));
    let params = Params::new().string("filename", PICTURE).string("layout", "latlong");
    let turned = if turned.length_squared() > 0.0 { turned.normalize() } else { DQuat::IDENTITY };
    Ok(Some(LightDesc {
        name: light.name().to_owned(),
        node: Node::new("infinite", params.float("scale", intensity as f32)),
        world_from_light: Motion::still(DAffine3::from_quat(turned)),
    }))
}

fn face(
    (document, buffers): (&Document<'_>, &Buffers),
    assets: &mut FileAssets,
    reference: &Element<'_>,
) -> Checked<Face> {
    let image = document.item("images", reference)?;
    let embedded = format!("image:{}", reference.index()?);
    let name = kept::file((document, buffers), assets, &image, embedded)?;
    let picture = assets.image(&name).map_err(|error| reference.fault(error.to_string()))?;
    let size = picture.width;
    if picture.height != size || size > MOST {
        let message =
            format!("a face of {size} x {} pixels, expected a square one of at most {MOST}", picture.height);
        return Err(reference.fault(message));
    }
    Ok(Face { size, pixels: pixels(&picture) })
}

/// A value of sRGB, linear (IEC 61966-2-1).
fn decoded(v: f32) -> f32 {
    if v <= 0.04045 { v / 12.92 } else { pow((v + 0.055) / 1.055, 2.4) }
}

/// The colours of a picture, linear.
fn pixels(picture: &Image) -> Vec<[f32; 3]> {
    let lanes = (picture.channels as usize).max(1);
    let of = |encoded: &[f32], decode: &dyn Fn(f32) -> f32| match *encoded {
        [r, g, b, d] if d > 0.0 => [r, g, b].map(|v| decode(v) / d),
        [r, g, b, ..] => [r, g, b].map(decode),
        [grey, ..] => [decode(grey); 3],
        [] => [0.0; 3],
    };
    let all = |values: Vec<f32>, decode: &dyn Fn(f32) -> f32| {
        values.chunks_exact(lanes).map(|pixel| of(pixel, decode)).collect()
    };
    match &picture.data {
        ImageData::U8(v) => all(v.iter().map(|v| f32::from(*v) / 255.0).collect(), &decoded),
        ImageData::U16(v) => all(v.iter().map(|v| f32::from(*v) / 65535.0).collect(), &decoded),
        ImageData::F32(v) => all(v.clone(), &|v| v),
    }
}

impl Face {
    /// Bilinear, at a place from 0 to 1 across and down.
    fn at(&self, [u, v]: [f64; 2]) -> [f32; 3] {
        let last = f64::from(self.size - 1);
        let [x, y] = [u, v].map(|t| (t * f64::from(self.size) - 0.5).clamp(0.0, last));
        let pixel = |dx: u32, dy: u32| {
            let [x, y] = [(x as u32 + dx).min(self.size - 1), (y as u32 + dy).min(self.size - 1)];
            self.pixels.get((y * self.size + x) as usize).copied().unwrap_or_default()
        };
        let (fx, fy) = (x.fract() as f32, y.fract() as f32);
        let corners = [
            (pixel(0, 0), (1.0 - fx) * (1.0 - fy)),
            (pixel(1, 0), fx * (1.0 - fy)),
            (pixel(0, 1), (1.0 - fx) * fy),
            (pixel(1, 1), fx * fy),
        ];
        corners.into_iter().fold([0.0; 3], |sum, (pixel, weight)| {
            let mut sum = sum;
            sum.iter_mut().zip(pixel).for_each(|(sum, v)| *sum += v * weight);
            sum
        })
    }
}

/// What is seen in a direction.
fn seen(faces: &[Face], d: DVec3) -> [f32; 3] {
    let size = d.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let is_behind = d.to_array().get(axis).is_some_and(|v| *v < 0.0);
    let number = 2 * axis + usize::from(is_behind);
    let (Some(face), Some((forward, up))) = (faces.get(number), FACES.get(number)) else { return [0.0; 3] };
    let depth = d.dot(*forward);
    let (right, up) = (d.dot(forward.cross(*up)) / depth, d.dot(*up) / depth);
    face.at([0.5 + 0.5 * right, 0.5 - 0.5 * up])
}

/// All faces on one picture of latitude and longitude, z up, as a portable float map.
fn picture(faces: &[Face]) -> Vec<u8> {
    use std::f64::consts::{PI, TAU};
    let size = faces.iter().map(|face| face.size).max().unwrap_or(1);
    let (width, height) = (4 * size, 2 * size);
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    // The lowest row is the first in the file.
    for y in (0..height).rev() {
        let (sin, cos) = (PI * (f64::from(y) + 0.5) / f64::from(height)).sin_cos();
        for x in 0..width {
            let (y, x) = (TAU * (f64::from(x) + 0.5) / f64::from(width)).sin_cos();
            let color = seen(faces, DVec3::new(sin * x, sin * y, cos));
            color.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        }
    }
    bytes
}
