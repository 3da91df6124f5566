//! Media.
use std::rc::Rc;

use durer_core::glam::{DAffine3, DVec3};
use durer_scene::{Data, MediumDesc, MediumRef, Params, ValueType};

use super::{
    object::Object,
    phase,
    volume::{self, Grid},
    world::{World, node},
};

/// The medium that `object` is.
pub(super) fn medium(world: &mut World<'_>, object: &Rc<Object>) -> Option<MediumRef> {
    if let Some(known) = world.media.get(&Rc::as_ptr(object)) {
        return *known;
    }
    let made = made(world, object);
    world.media.insert(Rc::as_ptr(object), made);
    made
}

fn made(world: &mut World<'_>, object: &Object) -> Option<MediumRef> {
    let lacks = ["sample_emitters", "has_spectral_extinction", "majorant_resolution_factor", "majorant_grid"];
    world.check(object, &["albedo", "sigma_t", "sigma_s", "sigma_a", "scale"], &lacks[2..]);
    for prop in object.props.iter().filter(|p| lacks[..2].contains(&p.name.as_str())) {
        world.note(prop.at, format!("\"{}\" has no effect", prop.name));
    }
    let scale = object.number_or("scale", 1.0, world.said) as f32;
    let phase = phase::phase(world, object);
    let (kind, params, place) = match object.plugin.as_str() {
        "homogeneous" => ("homogeneous", even(world, object)?, DAffine3::IDENTITY),
        "heterogeneous" => uneven(world, object)?,
        other => {
            world.said.unknown(object.at, "medium", other, ["homogeneous", "heterogeneous"]);
            return None;
        }
    };
    // What has no bounds lies where its phase function does.
    let place = if kind == "homogeneous" { phase.place().unwrap_or(place) } else { place };
    if phase.place().is_some_and(|own| own != place) {
        let message = "phase function and medium lie in different boxes: the grid of the first is looked up in the second";
        world.note(object.at, message.to_owned());
    }
    let params = phase.with(params, place).float("scale", scale);
    let media = &mut world.desc.media;
    let used = |name: &str| media.iter().any(|m| m.name == name);
    let free = !object.id.is_empty() && !used(&object.id);
    let name = if free { object.id.clone() } else { format!("medium {}", media.len()) };
    media.push(MediumDesc { name, node: node(kind, params, object.at), world_from_medium: place });
    Some(MediumRef::new(media.len() as u32 - 1))
}

/// A coefficient that is the same everywhere.
fn coefficient(world: &mut World<'_>, object: &Object, name: &str) -> Option<[f32; 3]> {
    match world.named(object, name) {
        Some(volume) if volume.plugin == "constvolume" => volume::even(world, &volume, "value"),
        Some(volume) => {
            let message = format!("{} cannot be the \"{name}\" of a homogeneous medium", volume.shown());
            world.said.error(volume.at, message);
            None
        }
        None => volume::even(world, object, name),
    }
}

fn with_colors(params: Params, name: &str, colors: impl IntoIterator<Item = [f32; 3]>) -> Params {
    params.with(name, ValueType::Rgb, Data::Floats(colors.into_iter().flatten().collect()))
}

fn product(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a.get(i).unwrap_or(&0.0) * b.get(i).unwrap_or(&0.0))
}

/// Absorption and scattering from extinction and albedo.
fn split(sigma_t: [f32; 3], albedo: [f32; 3]) -> ([f32; 3], [f32; 3]) {
    let albedo = albedo.map(|a| a.clamp(0.0, 1.0));
    (product(sigma_t, albedo.map(|a| 1.0 - a)), product(sigma_t, albedo))
}

fn even(world: &mut World<'_>, object: &Object) -> Option<Params> {
    let mut of = |name: &str| coefficient(world, object, name);
    let (sigma_a, sigma_s) = match (of("sigma_a"), of("sigma_s")) {
        (None, None) => split(of("sigma_t").unwrap_or([1.0; 3]), of("albedo").unwrap_or([0.75; 3])),
        (a, s) => (a.unwrap_or_default(), s.unwrap_or_default()),
    };
    Some(with_colors(with_colors(Params::new(), "sigma_a", [sigma_a]), "sigma_s", [sigma_s]))
}

/// A grid of the extinction, and what the albedo is at its points.
fn uneven(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params, DAffine3)> {
    let sigma_t = match world.named(object, "sigma_t") {
        Some(volume) => volume::colors(world, &volume)?,
        None => {
            let values = vec![volume::even(world, object, "sigma_t").unwrap_or([1.0; 3])];
            Grid { size: [1; 3], values, place: DAffine3::IDENTITY }
        }
    };
    let albedo = match world.named(object, "albedo") {
        Some(volume) => volume::colors(world, &volume)?,
        None => {
            let values = vec![volume::even(world, object, "albedo").unwrap_or([0.75; 3])];
            Grid { size: [1; 3], values, place: sigma_t.place }
        }
    };
    let Grid { size: [nx, ny, nz], ref values, place } = sigma_t;
    let is_even = |grid: &Grid| grid.values.len() == 1;
    if !is_even(&albedo) && !is_even(&sigma_t) && albedo.place == place {
        let params = with_colors(Params::new(), "sigma_t", sigma_t.values.iter().copied());
        let shares = albedo.values.iter().map(|a| a.map(|a| a.clamp(0.0, 1.0)));
        let params = with_colors(params, "albedo", shares);
        let names = ["albedonx", "albedony", "albedonz"];
        let params = names.into_iter().zip(albedo.size).fold(params, |p, (name, n)| p.int(name, n as i32));
        return Some(("rgbgrid", sized(params, sigma_t.size), place));
    }
    if !is_even(&albedo) && !is_even(&sigma_t) {
        let message = "extinction and albedo lie in different boxes: their products at the points of the first grid are mixed";
        world.note(object.at, message.to_owned());
    }
    // Where only the albedo varies its grid is the grid of both.
    if is_even(&sigma_t) && !is_even(&albedo) && albedo.place == place {
        let Grid { size: [nx, ny, nz], .. } = albedo;
        let extinction = values.first().copied().unwrap_or_default();
        let both: Vec<_> = albedo.values.iter().map(|a| split(extinction, *a)).collect();
        return Some(("rgbgrid", sized(grids(&both), [nx, ny, nz]), place));
    }
    let albedo_from_here = albedo.place.inverse() * place;
    let mut both = Vec::with_capacity(values.len());
    for (i, extinction) in values.iter().enumerate() {
        let middle = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        let p = DVec3::new(middle(i % nx, nx), middle(i / nx % ny, ny), middle(i / (nx * ny), nz));
        both.push(split(*extinction, albedo.at(albedo_from_here.transform_point3(p))));
    }
    Some(("rgbgrid", sized(grids(&both), [nx, ny, nz]), place))
}

fn grids(both: &[([f32; 3], [f32; 3])]) -> Params {
    let params = with_colors(Params::new(), "sigma_a", both.iter().map(|b| b.0));
    with_colors(params, "sigma_s", both.iter().map(|b| b.1))
}

/// The values go on to the sides of the unit cube, as Mitsuba's do.
fn sized(params: Params, [nx, ny, nz]: [usize; 3]) -> Params {
    let params = params.int("nx", nx as i32).int("ny", ny as i32).int("nz", nz as i32);
    params.string("edges", "clamp")
}
