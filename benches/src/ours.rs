//! The kernel of this project. All that touches `durer::accel` is here.
use std::hint::black_box;

use durer::{
    accel::{self, Accel, AccelBuilder, BuildOptions, Hit, Placement, Precision},
    math::Ray,
};

use crate::{
    rays::{Found, Query},
    scene::Scene,
    turns::Kernel,
};

/// Instructions that a ray is traced with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Isa {
    /// 16 lanes.
    Avx512,
    /// 8 lanes.
    Avx2,
    /// What every processor has.
    Portable,
}

impl Isa {
    /// Fastest first.
    pub const ALL: [Self; 3] = [Self::Avx512, Self::Avx2, Self::Portable];

    /// As options, tables and JSON call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Portable => "portable",
        }
    }

    /// Whether this machine has the instructions.
    pub fn is_here(self) -> bool {
        accel::Isa::available().contains(&self.of_kernel())
    }

    fn of_kernel(self) -> accel::Isa {
        match self {
            Self::Avx512 => accel::Isa::Avx512,
            Self::Avx2 => accel::Isa::Avx2,
            Self::Portable => accel::Isa::Portable,
        }
    }
}

/// How much time a build may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Soon done.
    Fast,
    /// In between.
    Balanced,
    /// For the fastest rays.
    High,
}

impl Preset {
    /// As tables and JSON call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Balanced => "balanced",
            Self::High => "high",
        }
    }
}

/// Whether rays may slip through between triangles that share an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// They may not.
    Robust,
    /// They may.
    Fast,
}

impl Mode {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Robust, Self::Fast];

    /// As tables and JSON call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Robust => "robust",
            Self::Fast => "fast",
        }
    }
}

/// A scene as the kernel's builder takes it: meshes are borrowed.
pub struct Input<'a> {
    scene: &'a Scene,
}

impl<'a> Input<'a> {
    /// Of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene }
    }
}

/// A scene in our kernel.
pub struct Ours {
    accel: Accel,
}

impl Ours {
    /// Builds all trees. `isa`: `None` is the best one of the machine.
    ///
    /// # Panics
    /// If the kernel refuses the scene.
    pub fn build(input: Input<'_>, preset: Preset, isa: Option<Isa>, mode: Mode) -> Self {
        let preset = match preset {
            Preset::Fast => accel::Preset::Fast,
            Preset::Balanced => accel::Preset::Balanced,
            Preset::High => accel::Preset::High,
        };
        let precision = match mode {
            Mode::Robust => Precision::Robust,
            Mode::Fast => Precision::Fast,
        };
        let isa = isa.map(Isa::of_kernel);
        let mut builder =
            AccelBuilder::new(BuildOptions { preset, precision, isa, ..BuildOptions::default() });
        let meshes = input.scene.meshes.iter();
        let ids = meshes.map(|mesh| builder.borrowed_triangles(&mesh.positions, &mesh.indices));
        let ids: Vec<_> = ids.map(|id| id.expect("a mesh that the kernel takes")).collect();
        for instance in &input.scene.instances {
            let placement = instance.placed.map_or(Placement::Identity, Placement::Still);
            builder.instance(ids[instance.mesh], placement).expect("a transform that has an inverse");
        }
        Self { accel: builder.build().expect("instructions that are here, and trees within limits") }
    }

    /// Memory that the trees take.
    pub fn bytes(&self) -> u64 {
        self.accel.stats().bytes
    }

    #[inline(never)]
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.accel.closest(ray)
    }

    #[inline(never)]
    fn any(&self, ray: &Ray) -> bool {
        self.accel.any(ray)
    }
}

impl Kernel for Ours {
    fn trace(&self, rays: &[Ray], query: Query) {
        for ray in rays {
            match query {
                Query::Closest => _ = black_box(self.closest(ray)),
                Query::Any => _ = black_box(self.any(ray)),
            }
        }
    }

    fn find(&self, ray: &Ray, query: Query) -> Option<Found> {
        match query {
            Query::Closest => {
                self.closest(ray).map(|hit| Found { t: hit.t, instance: hit.instance, prim: hit.prim })
            }
            Query::Any => self.any(ray).then_some(Found { t: 0.0, instance: 0, prim: 0 }),
        }
    }
}
