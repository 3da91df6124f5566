//! The words a pbrt file is made of, and where each may stand.

/// Where a directive may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Before `WorldBegin`.
    Options,
    /// After it.
    World,
    /// Anywhere.
    Any,
}

/// A directive of pbrt-v4, or one of our additions, `InverseTransform` and `TransformKeys`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Directive {
    Accelerator,
    ActiveTransform,
    AreaLightSource,
    Attribute,
    AttributeBegin,
    AttributeEnd,
    Camera,
    ColorSpace,
    ConcatTransform,
    CoordSysTransform,
    CoordinateSystem,
    Film,
    Identity,
    Import,
    Include,
    Integrator,
    InverseTransform,
    LightSource,
    LookAt,
    MakeNamedMaterial,
    MakeNamedMedium,
    Material,
    MediumInterface,
    NamedMaterial,
    ObjectBegin,
    ObjectEnd,
    ObjectInstance,
    Option,
    PixelFilter,
    ReverseOrientation,
    Rotate,
    Sampler,
    Scale,
    Shape,
    Texture,
    Transform,
    TransformBegin,
    TransformEnd,
    TransformKeys,
    TransformTimes,
    Translate,
    WorldBegin,
    WorldEnd,
}

use Directive as D;

/// Every directive with its word and place.
const TABLE: &[(&str, Directive, Place)] = &[
    ("AttributeBegin", D::AttributeBegin, Place::World),
    ("AttributeEnd", D::AttributeEnd, Place::World),
    ("Transform", D::Transform, Place::Any),
    ("ObjectInstance", D::ObjectInstance, Place::World),
    ("Shape", D::Shape, Place::World),
    ("NamedMaterial", D::NamedMaterial, Place::World),
    ("Material", D::Material, Place::World),
    ("Translate", D::Translate, Place::Any),
    ("Scale", D::Scale, Place::Any),
    ("Rotate", D::Rotate, Place::Any),
    ("ConcatTransform", D::ConcatTransform, Place::Any),
    ("ObjectBegin", D::ObjectBegin, Place::World),
    ("ObjectEnd", D::ObjectEnd, Place::World),
    ("AreaLightSource", D::AreaLightSource, Place::World),
    ("LightSource", D::LightSource, Place::World),
    ("ReverseOrientation", D::ReverseOrientation, Place::World),
    ("Texture", D::Texture, Place::World),
    ("MakeNamedMaterial", D::MakeNamedMaterial, Place::World),
    ("MakeNamedMedium", D::MakeNamedMedium, Place::Any),
    ("MediumInterface", D::MediumInterface, Place::Any),
    ("Include", D::Include, Place::Any),
    ("Import", D::Import, Place::World),
    ("Attribute", D::Attribute, Place::Any),
    ("TransformBegin", D::TransformBegin, Place::World),
    ("TransformEnd", D::TransformEnd, Place::World),
    ("Identity", D::Identity, Place::Any),
    ("LookAt", D::LookAt, Place::Any),
    ("CoordinateSystem", D::CoordinateSystem, Place::Any),
    ("CoordSysTransform", D::CoordSysTransform, Place::Any),
    ("ActiveTransform", D::ActiveTransform, Place::Any),
    ("InverseTransform", D::InverseTransform, Place::Any),
    ("TransformKeys", D::TransformKeys, Place::Any),
    ("TransformTimes", D::TransformTimes, Place::Options),
    ("ColorSpace", D::ColorSpace, Place::Any),
    ("Option", D::Option, Place::Any),
    ("Accelerator", D::Accelerator, Place::Options),
    ("Camera", D::Camera, Place::Options),
    ("Film", D::Film, Place::Options),
    ("Integrator", D::Integrator, Place::Options),
    ("PixelFilter", D::PixelFilter, Place::Options),
    ("Sampler", D::Sampler, Place::Options),
    ("WorldBegin", D::WorldBegin, Place::Options),
    ("WorldEnd", D::WorldEnd, Place::World),
];

/// Words of older pbrt versions, each with what to do.
const RETIRED: &[(&str, &str)] = &[
    ("SurfaceIntegrator", "this is pbrt-v2's word; in pbrt-v4 write Integrator before WorldBegin"),
    ("VolumeIntegrator", "this is pbrt-v2's word; in pbrt-v4 write Integrator \"volpath\" before WorldBegin"),
    ("Renderer", "this is pbrt-v2's word; pbrt-v4 has none, remove it"),
    ("Volume", "this is pbrt-v2's word; in pbrt-v4 write MakeNamedMedium and MediumInterface"),
];

impl Directive {
    /// The directive called `word`.
    pub(super) fn of(word: &str) -> Option<Self> {
        TABLE.iter().find(|line| line.0 == word).map(|line| line.1)
    }
    /// Its word.
    pub(super) fn word(self) -> &'static str {
        TABLE.iter().find(|line| line.1 == self).map_or("", |line| line.0)
    }
    /// Where it may stand.
    pub(super) fn place(self) -> Place {
        TABLE.iter().find(|line| line.1 == self).map_or(Place::Any, |line| line.2)
    }
    /// All words.
    pub(super) fn words() -> impl Iterator<Item = &'static str> {
        TABLE.iter().map(|line| line.0)
    }
    /// What to do about a word of an older version.
    pub(super) fn retired(word: &str) -> Option<&'static str> {
        RETIRED.iter().find(|line| line.0 == word).map(|line| line.1)
    }
}
