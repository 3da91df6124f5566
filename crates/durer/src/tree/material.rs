//! What a surface does with light, as the document tells it.
use crate::{
    Scene,
    model::{
        bsdf::{FresnelView, LobeView},
        texture::{Looked, TextureLookup},
    },
    probe::TreeMedia,
    spectrum::Basis,
};

use super::{
    capture::of_weight,
    document::{Body, Fresnel, Lobe, Lookup, Media},
    number::Number,
};

pub(super) fn media(scene: &Scene, basis: &Basis, media: &TreeMedia) -> Media {
    let body = |id| {
        let medium = scene.media.get(id);
        let fills = |o: &&crate::Object| scene.media.of_material(o.material) == Some(id);
        let object = scene.objects.iter().find(fills).map(|o| o.name.clone());
        Body { object: object.unwrap_or_default(), priority: medium.priority, ior: Number(medium.eta(basis)) }
    };
    Media {
        before: media.before.iter().map(body).collect(),
        after: media.after.iter().map(body).collect(),
        n1: Number(media.n1),
        n2: Number(media.n2),
    }
}

pub(super) fn fresnel(view: &FresnelView) -> Fresnel {
    Fresnel {
        reflect: Number(view.reflect),
        transmit: Number(view.transmit),
        critical_angle: view.critical_angle.map(|a| Number(a.to_degrees())),
        tir: view.is_total,
        constant: view.is_constant,
        eta: Number(view.eta),
    }
}

pub(super) fn lobe(basis: &Basis, view: &LobeView) -> Lobe {
    Lobe {
        name: view.name.to_owned(),
        reflectance: of_weight(basis, view.reflectance),
        transmittance: of_weight(basis, view.transmittance),
        exponent: view.exponent.map(Number),
        alpha: view.alpha.map(Number),
    }
}

pub(super) fn lookups(scene: &Scene, log: &[TextureLookup]) -> Vec<Lookup> {
    let lookup = |l: &TextureLookup| Lookup {
        name: scene.texture_names.get(l.texture as usize).cloned().unwrap_or_default(),
        uv: [l.uv.x, l.uv.y].map(Number),
        value: match l.value {
            Looked::Color(color) => color.rgb.map(Number).to_vec(),
            Looked::Number(v) => vec![Number(v)],
        },
        footprint: None,
        level: None,
    };
    log.iter().map(lookup).collect()
}
