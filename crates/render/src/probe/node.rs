//! A ray of the ray tree with all that is known of it.
use durer_accel::Hit;
use durer_core::{
    Id,
    math::{Normal3, Point3, Vector3},
    spectrum::Spectrum,
};
use durer_model::{
    bsdf::{FresnelView, LobeView},
    texture::TextureLookup,
};

use super::{Choice, Floating, Gathered, LightEvent, Limit, Particle, RandomNumbers, RayKind, StopReason};
use crate::{MediumStack, Object, PathRay};

/// Where a ray met a surface. Places and directions are in render space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeHit {
    /// What was hit.
    pub object: Id<Object>,
    /// Ray parameter, instance, primitive and barycentrics, as the kernel has them.
    pub hit: Hit,
    /// The point.
    pub p: Point3,
    /// Geometric normal, unit, on the outside.
    pub n_g: Normal3,
    /// Shading normal, unit: interpolated or tilted by a normal map.
    pub n_s: Normal3,
    /// Surface coordinates.
    pub uv: [f32; 2],
    /// The ray came from the outside.
    pub from_outside: bool,
    /// Cosine between the ray, backwards, and the shading normal on its side, 0 to 1.
    pub cos: f32,
    /// Corners of the triangle at the moment of the ray; `None` for other shapes.
    pub triangle: Option<[Point3; 3]>,
}

impl TreeHit {
    /// Weights of the three corners at the point; they sum to 1. `None` for what is no triangle.
    pub fn barycentric(&self) -> Option<[f32; 3]> {
        self.triangle.map(|_| [1.0 - self.hit.u - self.hit.v, self.hit.u, self.hit.v])
    }
}

/// The transparent bodies on both sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeMedia {
    /// Those before it, in the order in which they were entered.
    pub before: MediumStack,
    /// Those behind it.
    pub after: MediumStack,
    /// Index of refraction before it.
    pub n1: f32,
    /// Index of refraction behind it; `n1` where nothing is refracted.
    pub n2: f32,
}

/// How a hit was shaded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeShading {
    /// The lobes of the surface, in their order.
    pub lobes: Vec<LobeView>,
    /// What the interface among them does with light; `None` if there is none.
    pub fresnel: Option<FresnelView>,
    /// What is transparent around it; `None` where nothing is.
    pub media: Option<TreeMedia>,
    /// The share of light that is left at the start of the ray of what leaves the surface: absorption in bodies and
    /// distance attenuation; 1 in air.
    pub arrived: Spectrum,
    /// Part of [`TreeNode::local`]: what the surface sends out by itself, `arrived` included.
    pub emission: Spectrum,
    /// Part of [`TreeNode::local`]: the ambient term, `arrived` included.
    pub ambient: Spectrum,
    /// Part of [`TreeNode::local`]: the sky's blurred image in glossy lobes, `arrived` included.
    pub blurred_sky: Spectrum,
    /// Textures in the order in which they were asked; those asked by others come before them.
    pub textures: Vec<TextureLookup>,
}

/// One ray.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeNode {
    /// The ray it was spawned by.
    pub parent: Option<u32>,
    /// What it is for.
    pub kind: RayKind,
    /// Bounces before it.
    pub depth: u32,
    /// Origin, in render space.
    pub o: Point3,
    /// Direction; for shadow rays of lights at a place its length is the distance.
    pub d: Vector3,
    /// The ray as it was traced, with its sampler and the bodies it starts in: what it can be traced again from.
    pub path: PathRay,
    /// What the parent multiplies the result with.
    pub weight: Spectrum,
    /// Share in the pixel.
    pub throughput: Spectrum,
    /// How `weight` came about; `None` for eye rays, and for those that merely pass a surface which is not there.
    pub chosen: Option<Choice>,
    /// The random numbers that chose the ray: of the eye ray place in the pixel, moment and point of the lens.
    pub random: Vec<RandomNumbers>,
    /// Radiance from no other ray.
    pub local: Spectrum,
    /// The ray's radiance.
    pub result: Spectrum,
    /// Where it met a surface.
    pub hit: Option<TreeHit>,
    /// How that was shaded. `None` without a hit, and for shadow rays.
    pub shading: Option<TreeShading>,
    /// What floats on its way; `None` where nothing does, and for shadow rays.
    pub floating: Option<Floating>,
    /// What photons brought to the surface that was hit; `None` where none are gathered.
    pub gathered: Option<Gathered>,
    /// What a shadow ray found out.
    pub light: Option<LightEvent>,
    /// Why nothing follows.
    pub stop: Option<StopReason>,
    /// What the ray had and what was allowed, if it stopped by a limit.
    pub limit: Option<Limit>,
    /// Share in the pixel that an untraced ray would have had.
    pub lost: Spectrum,
    /// Nodes of hierarchies entered, each of which holds up to 8 or 16 boxes. The search for a blocker does not count,
    /// here and below.
    pub node_tests: u32,
    /// Primitives tested, of all types.
    pub primitive_tests: u32,
    /// Triangles among them; the others are shapes: spheres, planes, disks.
    pub triangle_tests: u32,
    /// Nanoseconds from when it was announced to its result, its children's time included; `None` unless asked for.
    pub ns: Option<u64>,
    /// Boxes in the order in which they were tested; empty unless asked for.
    pub walk: Vec<BoxTest>,
}

/// A box that a ray was tested against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxTest {
    /// Corners of smallest and largest coordinates, in render space: around the box if an instance turns it.
    pub bounds: [Point3; 2],
    /// Edges from the root of the scene's hierarchy.
    pub depth: u32,
    /// The ray enters it before it ends.
    pub hit: bool,
}

impl TreeNode {
    /// What share of the light along this ray the surface hands on that it left: its weight without what comes of choosing
    /// it among others, and without what the index of refraction does to radiance. `above` is the ray that ended there.
    pub fn share(&self, above: &TreeNode) -> Spectrum {
        let chance = self.chosen.map_or(1.0, |chosen| chosen.chance * chosen.kept);
        self.weight * (chance * above.path.compression / self.path.compression)
    }
    /// What this ray itself adds to the pixel: the contributions of all nodes sum to the pixel, up to rounding.
    pub fn contribution(&self) -> Spectrum {
        self.throughput * self.local
    }
    /// True unless it was given up before it was traced.
    pub fn is_traced(&self) -> bool {
        !self.stop.is_some_and(StopReason::is_untraced)
    }
    /// The particle that it met.
    pub fn particle(&self) -> Option<&Particle> {
        self.floating.as_ref()?.particle.as_ref()
    }
    /// Ray length, in metres: to the hit, to the particle or to the light.
    pub fn length(&self) -> Option<f32> {
        match (&self.hit, &self.light) {
            (None, None) => self.particle().map(|particle| particle.t),
            (Some(hit), _) => Some(hit.hit.t * self.d.length()),
            (None, Some(light)) if light.visible && light.point.is_some() => Some(self.d.length()),
            _ => None,
        }
    }
}
