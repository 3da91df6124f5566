//! A scene of meshes at another moment: trees of what rests stay as they are, trees of what has moved follow it.
use std::{
    collections::{HashMap, hash_map::Entry},
    sync::Arc,
    time::Instant,
};

use durer_accel::{Accel, GeometryData, GeometryId, Placement};
use durer_scene::Mesh;

use super::geometry::{Held, Pending, PendingMesh, Placed, baked};
use crate::scene::Target;

/// More new forms than this in one step are made as fast by building anew: each costs a look at the scene's own tree.
const MOST_REFITS: usize = 64;
/// How much dearer rays may become before trees are built anew.
const MOST_COST: f64 = 4.0 / 3.0;

impl Placed {
    /// What this becomes if its meshes are to be where and as they are in `pending`; `None` if that is better built anew:
    /// other meshes, meshes with more triangles or keys, shapes that are no meshes.
    pub(super) fn moved(&self, pending: &Pending) -> Option<Self> {
        let start = Instant::now();
        let has_shapes = !pending.shapes.is_empty() || !pending.movers.is_empty();
        if has_shapes || !self.shapes.is_empty() || !self.movers.is_empty() {
            return None;
        }
        let (single, several): (Vec<&PendingMesh>, Vec<&PendingMesh>) =
            pending.meshes.iter().partition(|mesh| mesh.is_baked());
        let single = single.into_iter().filter(|mesh| !mesh.mesh.indices.is_empty());
        let wanted: Vec<&PendingMesh> = single.chain(several).collect();
        let fits = self.held.len() == wanted.len() && self.held.iter().zip(&wanted).all(|(h, w)| h.fits(w));
        if !fits {
            return None;
        }
        let cost = *self.cost.get_or_init(|| self.accel.sah_cost());
        let mut step = Step { accel: &self.accel, own: None, forms: HashMap::new(), refits: 0 };
        let mut held = self.held.to_vec();
        let mut targets = self.targets.to_vec();
        let mut places = Vec::new();
        for (held, wanted) in held.iter_mut().zip(wanted) {
            let target = targets.get_mut(held.instance as usize)?;
            if held.is_baked {
                if !Arc::ptr_eq(&held.mesh, &wanted.mesh) || held.motion != wanted.motion {
                    let mesh = Arc::new(baked(&wanted.mesh, &wanted.motion.at(0.0)));
                    let (positions, indices) = (&mesh.positions, &mesh.indices);
                    step.refit(held.geometry, GeometryData::Triangles { positions, indices })?;
                    *target = Target::Baked(held.object, mesh);
                }
            } else {
                step.form(held, &wanted.mesh)?;
                *target = Target::Mesh(held.object, Arc::clone(&wanted.mesh));
                if held.motion != wanted.motion {
                    places.push((held.instance, Placement::from_motion(&wanted.motion)));
                }
            }
            (held.mesh, held.motion) = (Arc::clone(&wanted.mesh), wanted.motion.clone());
        }
        if !places.is_empty() {
            step.own().set_placements(places).ok()?;
        }
        let accel = match step.own {
            None => Arc::clone(&self.accel),
            Some(own) if own.sah_cost() > cost * MOST_COST => return None,
            Some(own) => Arc::new(own),
        };
        let (targets, held, building) = (targets.into(), held.into(), start.elapsed());
        Some(Self { accel, targets, held, building, ..self.clone() })
    }
}

impl Held {
    /// Whether it can become what is wanted without being built anew.
    fn fits(&self, wanted: &PendingMesh) -> bool {
        let (a, b) = (&self.mesh, &wanted.mesh);
        self.object == wanted.object
            && self.is_baked == wanted.is_baked()
            && (Arc::ptr_eq(a, b) || (a.indices.len() == b.indices.len() && a.keys() == b.keys()))
    }
}

/// Changes of a kernel, which is copied before the first.
struct Step<'a> {
    accel: &'a Accel,
    own: Option<Accel>,
    /// The mesh that each geometry has become.
    forms: HashMap<GeometryId, *const Mesh>,
    refits: usize,
}

impl Step<'_> {
    fn own(&mut self) -> &mut Accel {
        self.own.get_or_insert_with(|| self.accel.clone())
    }
    fn refit(&mut self, geometry: GeometryId, data: GeometryData<'_>) -> Option<()> {
        self.refits += 1;
        if self.refits > MOST_REFITS {
            return None;
        }
        self.own().refit(geometry, data).ok()
    }
    /// Gives the geometry of something the form of `mesh`; all that share it must agree.
    fn form(&mut self, held: &Held, mesh: &Arc<Mesh>) -> Option<()> {
        match self.forms.entry(held.geometry) {
            Entry::Occupied(known) => (*known.get() == Arc::as_ptr(mesh)).then_some(()),
            Entry::Vacant(new) => {
                new.insert(Arc::as_ptr(mesh));
                if Arc::ptr_eq(&held.mesh, mesh) {
                    return Some(());
                }
                let indices = &mesh.indices;
                let data = match mesh.is_still() {
                    true => GeometryData::Triangles { positions: &mesh.positions, indices },
                    false => {
                        let keys = (0..mesh.keys()).map(|key| mesh.key(key)).collect();
                        GeometryData::KeyedTriangles { indices, keys }
                    }
                };
                self.refit(held.geometry, data)
            }
        }
    }
}
