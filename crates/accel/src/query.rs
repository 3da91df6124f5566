//! Asking for hits.
use durer_core::math::{Point3, Ray, Vector3};

use crate::{
    Accel, Engine, Hit, NearMiss, NoTraversalProbe, NoUserGeometry, Precision, TraversalProbe, UserGeometry,
    isa::Registers,
    layout::{MovingPacket, Packet, PacketRecord},
    probe::{Sink, Told, Unwatched, Watch},
    traverse::{Best, Cx, Kernel, Level, Place, SCENE, exhaustive_blocked, exhaustive_nearest, near_misses},
    tree::{Forest, Trees},
    user::Callback,
};

/// A ray and what it asks.
///
/// ```
/// use durer_accel::math::{Point3, Ray, Vector3};
/// use durer_accel::{AccelBuilder, BuildOptions, Placement, TraversalCounts, Triangles, Visibility};
///
/// # let mut builder = AccelBuilder::new(BuildOptions::default());
/// # let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from).to_vec();
/// # let mesh = builder.triangles(Triangles { positions, indices: vec![[0, 1, 2]] })?;
/// let seen = Visibility { mask: 0b10, hides_backs: true, ..Visibility::default() };
/// builder.instance_seen(mesh, Placement::Identity, seen)?;
/// let accel = builder.build()?;
///
/// let from_behind = Ray::new(Point3::new(0.0, 0.0, -1.0), Vector3::new(0.0, 0.0, 1.0));
/// assert!(accel.query(&from_behind).any());
/// assert!(!accel.query(&from_behind).cull_backs(true).any());
/// assert!(!accel.query(&from_behind).mask(0b01).any());
///
/// let mut counts = TraversalCounts::default();
/// accel.query(&from_behind).probe(&mut counts, ()).closest();
/// assert_eq!((counts.nodes, counts.primitives), (1, 1));
/// # Ok::<(), durer_accel::BuildError>(())
/// ```
pub struct Query<'q, U = NoUserGeometry, P: TraversalProbe = NoTraversalProbe> {
    accel: &'q Accel,
    ray: &'q Ray,
    user: &'q U,
    told: Option<Told<'q, P>>,
    mask: u32,
    culls: bool,
}

impl Accel {
    /// The nearest hit of `ray` with `t` in `[t_min, t_max]`; on equal `t` the one with the smaller `(instance, prim)`.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.query(ray).closest()
    }

    /// Whether anything is hit with `t` in `[t_min, t_max]`: equal to `closest(..).is_some()`, but faster.
    #[inline]
    pub fn any(&self, ray: &Ray) -> bool {
        self.query(ray).any()
    }

    /// [`Query::near_misses`] of all instances.
    pub fn near_misses(&self, ray: &Ray, radius_of: impl Fn(f32) -> f32, visit: impl FnMut(NearMiss)) {
        self.query(ray).near_misses(radius_of, visit);
    }

    /// A query with more to say: shapes of the caller, masks, backs, a probe.
    #[inline]
    pub fn query<'q>(&'q self, ray: &'q Ray) -> Query<'q> {
        Query { accel: self, ray, user: &NoUserGeometry, told: None, mask: u32::MAX, culls: false }
    }
}

impl<'q, U: UserGeometry, P: TraversalProbe> Query<'q, U, P> {
    /// `user` answers for the boxes of `AccelBuilder::user`, and for holes, those in curves and points too.
    #[inline]
    pub fn user<V: UserGeometry>(self, user: &'q V) -> Query<'q, V, P> {
        let Self { accel, ray, told, mask, culls, .. } = self;
        Query { accel, ray, user, told, mask, culls }
    }

    /// `probe` watches; events carry `id`.
    #[inline]
    pub fn probe<Q: TraversalProbe>(self, probe: &'q mut Q, id: Q::Id) -> Query<'q, U, Q> {
        let Self { accel, ray, user, mask, culls, .. } = self;
        Query { accel, ray, user, told: Some(Told { probe, id }), mask, culls }
    }

    /// Only instances whose mask shares a bit with this one are there. The default sees all.
    #[inline]
    pub fn mask(self, mask: u32) -> Self {
        Self { mask, ..self }
    }

    /// One-sided instances are not hit from behind.
    #[inline]
    pub fn cull_backs(self, culls: bool) -> Self {
        Self { culls, ..self }
    }

    /// See [`Accel::closest`].
    #[inline]
    pub fn closest(self) -> Option<Hit> {
        let cx = Cx::new(self.accel, self.user, self.mask, self.culls, U::FILTERS);
        match self.told {
            Some(mut told) if P::ACTIVE => {
                let mut sink: &mut dyn Sink = &mut told;
                cx.closest(self.ray, &mut sink)
            }
            _ => cx.closest(self.ray, &mut Unwatched),
        }
    }

    /// Visits every primitive whose enlarged bounding sphere the ray meets, hit or not, once and in the order of
    /// `(instance, prim)`. So antialiasing learns what hides between the rays of neighbouring samples: an object much
    /// smaller than a pixel is hit by none of them, but misses one by less than the pixel's size there (Whitted 1980,
    /// "An Improved Illumination Model for Shaded Display", section on antialiasing).
    ///
    /// The sphere of a primitive is that of its box in render space at the ray's time: around its centre, with half its
    /// diagonal as radius. Of triangles it is the box of their placed vertices, of other shapes the box around the
    /// corners of their placed box, which is a few millionths larger than given. A quad counts as its two triangles; the
    /// one whose centre is nearer is told. What has an infinite box is never visited: it cannot be lost.
    ///
    /// The sphere is enlarged by `radius_of(t)`, in units of render space, 0 or more, where `t` is the parameter at which the
    /// ray comes nearest to the centre, clamped to `[t_min, t_max]`. `radius_of` must not fall as `t` rises: of what is far
    /// it is asked once for all, at the far end. For an eye ray `t * s` will do, where `s` is the distance of samples on an
    /// image plane at `t = 1`. It may be asked up to `f32::MAX`.
    ///
    /// The mask counts; backs, filters and probes do not. Both engines visit the same. A ray that can hit nothing visits
    /// nothing.
    ///
    /// Takes 10 to 20 times as long as [`Query::closest`] where primitives are small and few are near (2 microseconds among
    /// 10 000 small balls), and more in proportion to how many it visits; large triangles have large spheres. The first
    /// call after a build or a change looks at all nodes and triangles once, on its thread, and keeps 4 bytes a node.
    pub fn near_misses(self, radius_of: impl Fn(f32) -> f32, mut visit: impl FnMut(NearMiss)) {
        near_misses(self.accel, self.ray, self.mask, &radius_of).into_iter().for_each(&mut visit);
    }

    /// See [`Accel::any`].
    #[inline]
    pub fn any(self) -> bool {
        let cx = Cx::new(self.accel, self.user, self.mask, self.culls, U::FILTERS);
        match self.told {
            Some(mut told) if P::ACTIVE => {
                let mut sink: &mut dyn Sink = &mut told;
                cx.any(self.ray, &mut sink)
            }
            _ => cx.any(self.ray, &mut Unwatched),
        }
    }
}

/// Runs `$call` with `$kernel` bound to the registers and `$robust` to the precision of an `Accel`.
macro_rules! dispatch {
    ($accel:expr, $kernel:ident, $robust:ident => $call:expr) => {
        match ($accel.registers, $accel.precision) {
            #[cfg(target_arch = "x86_64")]
            (Registers::Avx512($kernel), Precision::Robust) => {
                const $robust: bool = true;
                $call
            }
            #[cfg(target_arch = "x86_64")]
            (Registers::Avx512($kernel), Precision::Fast) => {
                const $robust: bool = false;
                $call
            }
            #[cfg(target_arch = "x86_64")]
            (Registers::Avx2($kernel), Precision::Robust) => {
                const $robust: bool = true;
                $call
            }
            #[cfg(target_arch = "x86_64")]
            (Registers::Avx2($kernel), Precision::Fast) => {
                const $robust: bool = false;
                $call
            }
            (Registers::Portable($kernel), Precision::Robust) => {
                const $robust: bool = true;
                $call
            }
            (Registers::Portable($kernel), Precision::Fast) => {
                const $robust: bool = false;
                $call
            }
        }
    };
}

impl<'a> Cx<'a> {
    #[inline]
    fn new(accel: &'a Accel, callback: &'a dyn Callback, mask: u32, culls: bool, filters: bool) -> Self {
        let (filters, culls) = (filters && accel.is_filtered, culls && accel.hides_backs);
        // All see rays with some bit in their mask, none those without any.
        let checks = filters || culls || accel.is_selective || mask == 0;
        let exhaustive = accel.engine == Engine::BruteForce;
        Self { accel, callback, mask, culls, filters, checks, exhaustive }
    }

    #[inline(never)]
    fn closest<W: Watch>(&self, ray: &Ray, watch: &mut W) -> Option<Hit> {
        let t_max = end(ray)?;
        let mut best = Best { t: t_max, u: 0.0, v: 0.0, place: Place::NOWHERE };
        let (best, level) = (&mut best, self.scene(ray));
        if self.exhaustive {
            for forest in std::iter::once(level.forest).chain(level.movers) {
                exhaustive_nearest(self, &Level { forest, ..level }, best, watch);
            }
        } else {
            dispatch!(self.accel, kernel, ROBUST => kernel.nearest::<W, ROBUST>(self, &level, best, watch));
        }
        self.hit(ray, best)
    }

    #[inline(never)]
    fn any<W: Watch>(&self, ray: &Ray, watch: &mut W) -> bool {
        let Some(t_max) = end(ray) else { return false };
        let level = self.scene(ray);
        if self.exhaustive {
            let mut found = false;
            for forest in std::iter::once(level.forest).chain(level.movers) {
                found |= exhaustive_blocked(self, &Level { forest, ..level }, t_max, watch);
            }
            return found;
        }
        dispatch!(self.accel, kernel, ROBUST => kernel.blocked::<W, ROBUST>(self, &level, t_max, watch))
    }

    /// The trees of the scene, that of what moves behind that of all else.
    #[inline(always)]
    fn scene<'l>(&self, ray: &'l Ray) -> Level<'l>
    where
        'a: 'l,
    {
        let accel: &'a Accel = self.accel;
        let movers = accel.movers.as_ref().map(|movers| &movers.forest);
        Level { ray, forest: &accel.scene, movers, instance: SCENE, floor: f32::MIN }
    }

    /// What callers get to see.
    #[inline(always)]
    fn hit(&self, ray: &Ray, best: &Best) -> Option<Hit> {
        let place = &best.place;
        if place.id == u32::MAX {
            return None;
        }
        let (instance, prim) = self.primitive(place.instance, place.id);
        let owner = &self.accel.instances[instance as usize];
        if owner.is_plain {
            let own = || self.accel.geometries[owner.geometry.index()].forest.as_ref();
            let forest = if place.instance == SCENE { Some(&self.accel.scene) } else { own() };
            if let Some(Forest { trees: Trees::Still(tree), .. }) = forest {
                let n_g = normal(tree.pages.get::<Packet>(place.row).triangle(place.lane as usize, 0.0));
                return Some(Hit { t: best.t, instance, prim, u: best.u, v: best.v, n_g });
            }
        }
        Some(self.other_hit(ray, best, instance, prim))
    }

    /// What callers get to see of quads, shapes, and what is moved.
    #[inline(never)]
    fn other_hit(&self, ray: &Ray, best: &Best, instance: u32, prim: u32) -> Hit {
        let n_g = self.normal(ray, &best.place, instance, prim);
        let (prim, u, v) = self.accel.called(instance, prim, best.u, best.v);
        Hit { t: best.t, instance, prim, u, v, n_g }
    }

    /// The normal of what is hit in its instance's object space.
    fn normal(&self, ray: &Ray, place: &Place, instance: u32, prim: u32) -> Vector3 {
        if place.row == Place::NO_PACKET {
            return self.shape_normal(instance, prim, ray);
        }
        let owner = &self.accel.instances[instance as usize];
        let lane = place.lane as usize;
        if place.instance == SCENE {
            let n = normal(self.accel.scene.trees()[0].pages.get::<Packet>(place.row).triangle(lane, 0.0));
            return match owner.pose.at(ray.time) {
                None => n,
                // The tree holds the mesh where it is placed, and turned round if that is mirrored.
                Some(m) => m.inverse().normal(if owner.mirrors { -n } else { n }.into()).into(),
            };
        }
        let Some(forest) = &self.accel.geometries[owner.geometry.index()].forest else {
            return Vector3::ZERO;
        };
        match &forest.trees {
            Trees::Still(tree) => normal(tree.pages.get::<Packet>(place.row).triangle(lane, 0.0)),
            Trees::Moving { times, trees } => {
                let at = durer_core::math::Segment::at(ray.time, times.len(), |i| times[i]);
                normal(trees[at.key].pages.get::<MovingPacket>(place.row).triangle(lane, at.u))
            }
        }
    }
}

#[inline(always)]
fn normal([a, b, c]: [Point3; 3]) -> Vector3 {
    (b - a).cross(c - a)
}

/// Where the ray ends; `None` if that is before it begins. A finite end keeps infinity, which a shape's division by 0
/// may return, from counting as a hit.
#[inline(always)]
fn end(ray: &Ray) -> Option<f32> {
    let t_max = if ray.t_max == f32::INFINITY { f32::MAX } else { ray.t_max };
    (ray.t_min <= t_max).then_some(t_max)
}
