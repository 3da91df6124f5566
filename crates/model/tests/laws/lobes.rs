//! One of every lobe, and more where it has several ways. A lobe that is missing here does not compile: see `number`.
use durer_core::math::Vector3;
use durer_core::spectrum::Spectrum;
use durer_model::bsdf::{
    Again, Below, Blur, Blurred, Bounced, Bsdf, Burley, Cloud, Coat, Distribution, Facets, Gloss, Glossy,
    Hair, Highlight, Interface, Layered, Lobe, Matte, Phong, Reflectance, Shadowing, Sheen, Sheet, Split,
    Strand, Tilted, Under, Varnish, Veil,
};

use super::measured;

/// Grey of a value.
fn grey(v: f32) -> Spectrum {
    Spectrum::splat(v)
}

/// Facets of different widths along a direction that is no axis.
pub(super) fn brushed(x: f32, y: f32) -> Facets {
    Facets::along(Vector3::new(0.6, 0.8, 0.0), x, y)
}

/// Rough reflection that loses nothing but what bounces twice.
pub(super) fn glossy(facets: Facets) -> Lobe<'static> {
    let reflectance = Reflectance::Schlick { f0: Spectrum::ONE, f90: Spectrum::ONE };
    Lobe::Glossy(Glossy { reflectance, facets, scale: 1.0 })
}

/// The same facets by Beckmann's distribution.
pub(super) fn normal(facets: Facets) -> Facets {
    facets.distributed(Distribution::Beckmann)
}

/// The same facets that hide each other for each direction by itself.
fn apart(facets: Facets) -> Facets {
    facets.shadowed(Shadowing::Separable)
}

/// What a coat of glass reflects, dimmed.
fn tinted(facets: Facets) -> Lobe<'static> {
    let reflectance = Reflectance::Tinted { eta: 1.5, tint: grey(0.4) };
    Lobe::Glossy(Glossy { reflectance, facets, scale: 1.0 })
}

/// Rough metal.
pub(super) fn metal(facets: Facets) -> Lobe<'static> {
    let reflectance = Reflectance::Index { eta: grey(0.2), k: grey(3.0) };
    Lobe::Glossy(Glossy { reflectance, facets, scale: 1.0 })
}

/// Frosted glass.
pub(super) fn frosted(eta: f32, facets: Facets) -> Lobe<'static> {
    Lobe::Blurred(Blurred { interface: Interface::clear(eta), blur: Blur::Microfacet(facets) })
}

/// A matte body of this albedo below a coat of this roughness, walks of `bounces`.
pub(super) fn coated(albedo: f32, alpha: f32, bounces: u32) -> Lobe<'static> {
    coated_as(albedo, alpha, bounces, Again::Colored)
}

/// The same whose body is something else to light that comes back.
fn coated_as(albedo: f32, alpha: f32, bounces: u32, again: Again) -> Lobe<'static> {
    let coat = Coat::new((1.5, None), 0.01, (Some(alpha), Facets::round(alpha)));
    Lobe::Matte(Matte::Coated(coat.body((grey(albedo), again), (1.5, &Facets::round(alpha)), bounces, 1.0)))
}

/// Metal below a coat.
pub(super) fn layered(coat: Facets, metal: Facets) -> Lobe<'static> {
    clouded((coat, 0.01), Cloud::NONE, Below::Metal { eta: grey(0.2), k: grey(2.0), facets: metal }, 5)
}

/// Something below a coat of these facets and thickness that light scatters in.
pub(super) fn clouded(
    (coat, thickness): (Facets, f32),
    cloud: Cloud,
    below: Below,
    bounces: u16,
) -> Lobe<'static> {
    Lobe::Layered(Layered { eta: 1.5, coat, thickness, cloud, below, bounces, walks: 1, scale: 1.0 })
}

/// Particles of this albedo and asymmetry.
fn cloud(albedo: f32, g: f32) -> Cloud {
    Cloud::new(grey(albedo), g)
}

/// What such white facets lose.
pub(super) fn bounced(facets: Facets) -> Lobe<'static> {
    let white = Reflectance::Schlick { f0: Spectrum::ONE, f90: Spectrum::ONE };
    let lost = Bounced::of(&white, &facets).expect("rough facets");
    Lobe::Matte(Matte::Bounced(lost))
}

/// What Schlick's formula gives glass, on facets of this width.
fn clear(alpha: f32) -> Glossy {
    let reflectance = Reflectance::Schlick { f0: grey(0.04), f90: Spectrum::ONE };
    Glossy { reflectance, facets: Facets::round(alpha), scale: 1.0 }
}

/// A white body below clear facets, and a coat and fibres if they are there.
pub(super) fn under(alpha: f32, coat: f32, sheen: f32) -> Under {
    let veil =
        Veil { coat, coat_alpha: 0.2, coat_normal: Vector3::new(0.36, 0.48, 0.8), sheen, sheen_alpha: 0.3 };
    Under::new(Spectrum::ONE, &clear(alpha), veil, Vector3::new(0.6, 0.0, 0.8))
}

/// A white coat whose normal leans this way.
pub(super) fn tilted(alpha: f32, normal: Vector3) -> Lobe<'static> {
    let reflectance = Reflectance::Schlick { f0: Spectrum::ONE, f90: Spectrum::ONE };
    let glossy = Glossy { reflectance, facets: Facets::round(alpha), scale: 1.0 };
    Lobe::Tilted(Tilted { glossy, normal })
}

/// A rough sheet that reflects nothing.
pub(super) fn sheet(alpha: f32) -> Lobe<'static> {
    let none = Reflectance::Schlick { f0: Spectrum::BLACK, f90: Spectrum::BLACK };
    let outside = Glossy { reflectance: none, ..clear(alpha) };
    Lobe::Sheet(Sheet::below(&outside, Spectrum::ONE))
}

/// A hair of this absorption and roughness, hit at `h`.
pub(super) fn hair(sigma_a: f32, beta: [f32; 2], h: f32) -> Lobe<'static> {
    let strand = Strand { along: Vector3::new(0.6, -0.8, 0.0), is_left: h < 0.0, h };
    Lobe::Hair(Hair::new(&strand, grey(sigma_a), 1.55, beta, 2f32.to_radians()))
}

/// Lobes that spread, wide enough for the cells of a histogram.
pub(super) fn spread() -> Vec<Lobe<'static>> {
    let round = Facets::round;
    let split = Split::Constant { reflection: grey(0.3), transmission: grey(0.6) };
    let blur = Blur::Cosine { reflection: 5.0, transmission: 20.0 };
    let phong = |exponent, half| Lobe::Phong(Phong { specular: grey(1.0), exponent, half });
    let mut all = vec![
        Lobe::Diffuse { albedo: Spectrum::ONE },
        Lobe::Behind { albedo: Spectrum::ONE },
        Lobe::Highlight(Highlight { specular: grey(0.4), exponent: 12.0 }),
        Lobe::Gloss(Gloss { weight: Spectrum::ONE, exponent: 12.0 }),
        Lobe::Blurred(Blurred { interface: Interface { eta: 1.5, split }, blur }),
        glossy(round(0.2)),
        glossy(brushed(0.6, 0.2)),
        metal(round(0.3)),
        metal(brushed(0.2, 0.9)),
        glossy(normal(round(0.2))),
        glossy(normal(brushed(0.7, 0.25))),
        metal(normal(round(1.0))),
        metal(apart(round(0.4))),
        glossy(apart(brushed(0.6, 0.2))),
        metal(apart(normal(brushed(0.3, 0.7)))),
        frosted(1.5, apart(round(0.4))),
        frosted(1.5, apart(normal(round(0.5)))),
        tinted(round(0.3)),
        frosted(1.5, round(0.4)),
        frosted(1.0 / 1.33, brushed(0.25, 0.6)),
        frosted(1.5, normal(round(0.4))),
        frosted(1.5, normal(brushed(0.3, 0.8))),
        Lobe::Matte(Matte::rough(Spectrum::ONE, 1.0)),
        Lobe::Matte(Matte::rough(grey(0.5), 0.4)),
        coated(1.0, 0.0, 5),
        Lobe::Matte(Matte::Sheen(Sheen::new(Spectrum::ONE, 0.5, Vector3::new(0.6, 0.0, 0.8)))),
        Lobe::Matte(Matte::Sheen(Sheen::new(Spectrum::ONE, 0.05, Vector3::new(0.6, 0.0, 0.8)))),
        bounced(round(0.8)),
        bounced(normal(round(0.8))),
        coated(0.8, 0.4, 5),
        coated_as(0.3, 0.4, 1000, Again::White),
        coated_as(0.7, 0.0, 1000, Again::White),
        phong(1.0, false),
        phong(40.0, false),
        phong(60.0, true),
        layered(round(0.3), round(0.2)),
        layered(round(0.0), brushed(0.3, 0.15)),
        layered(brushed(0.2, 0.4), round(0.0)),
        layered(normal(round(0.3)), normal(brushed(0.2, 0.4))),
        clouded((round(0.0), 0.5), cloud(1.0, 0.3), Below::Matte { albedo: grey(0.8) }, 5),
        clouded((round(0.3), 1.0), cloud(0.9, -0.2), Below::Matte { albedo: grey(0.5) }, 5),
        clouded(
            (round(0.2), 0.3),
            cloud(0.8, 0.6),
            Below::Metal { eta: grey(0.2), k: grey(2.0), facets: round(0.2) },
            5,
        ),
        clouded(
            (round(0.0), 0.3),
            cloud(0.8, 0.0),
            Below::Metal { eta: grey(0.2), k: grey(2.0), facets: round(0.0) },
            5,
        ),
        leaving(1.5),
        Lobe::Matte(Matte::Under(under(0.3, 0.0, 0.0))),
        Lobe::Matte(Matte::Under(under(0.0, 0.8, 0.7))),
        Lobe::Matte(Matte::Under(under(0.3, 0.8, 0.0).seen_through())),
        Lobe::Matte(Matte::Burley(burley(0.0))),
        Lobe::Matte(Matte::Burley(burley(0.7))),
        Lobe::Varnish(Varnish { share: 1.0, alpha: 0.1 }),
        tilted(0.25, Vector3::new(0.36, 0.48, 0.8)),
        tilted(0.4, Vector3::new(-0.28, 0.0, 0.96)),
        sheet(0.3),
        hair(0.0, [0.9, 0.9], 0.3),
        hair(0.3, [0.4, 0.7], -0.8),
        hair(1.2, [0.7, 0.35], 0.0),
    ];
    all.extend(measured::lobes());
    all
}

/// Disney's body, this flat.
pub(super) fn burley(flatness: f32) -> Burley {
    Burley { color: grey(0.8), sheen: grey(0.3), roughness: 0.6, flatness }
}

/// What leaves a smooth body of this index, seen from below.
fn leaving(eta: f32) -> Lobe<'static> {
    let mut bsdf = Bsdf::default().with(Lobe::Interface(Interface::clear(eta)));
    bsdf.leave(Vector3::new(0.6, 0.0, -0.8));
    let found = bsdf.lobes().find(|lobe| matches!(lobe, Lobe::Matte(_))).copied();
    found.unwrap_or(Lobe::Mirror { weight: Spectrum::ONE })
}

/// Lobes that do not.
pub(super) fn sharp() -> Vec<Lobe<'static>> {
    vec![
        Lobe::Ambient { coefficient: Spectrum::ONE },
        Lobe::Mirror { weight: grey(0.9) },
        Lobe::Interface(Interface::clear(1.5)),
        Lobe::PassThrough { weight: grey(0.5) },
        glossy(Facets::round(0.0)),
        tilted(0.0, Vector3::new(0.0, 0.6, 0.8)),
    ]
}

/// The place of a lobe among its kinds.
fn number(lobe: &Lobe) -> usize {
    match lobe {
        Lobe::Diffuse { .. } => 0,
        Lobe::Ambient { .. } => 1,
        Lobe::Highlight(_) => 2,
        Lobe::Glossy(_) => 3,
        Lobe::Mirror { .. } => 4,
        Lobe::Interface(_) => 5,
        Lobe::Gloss(_) => 6,
        Lobe::Blurred(_) => 7,
        Lobe::Matte(Matte::Rough { .. }) => 8,
        Lobe::Matte(Matte::Coated(_)) => 9,
        Lobe::Behind { .. } => 10,
        Lobe::Phong(_) => 11,
        Lobe::Layered(_) => 12,
        Lobe::PassThrough { .. } => 13,
        Lobe::Matte(Matte::Sheen(_)) => 14,
        Lobe::Matte(Matte::Bounced(_)) => 15,
        Lobe::Matte(Matte::Under(_)) => 16,
        Lobe::Tilted(_) => 17,
        Lobe::Sheet(_) => 18,
        Lobe::Hair(_) => 19,
        Lobe::Matte(Matte::Leaving(_)) => 20,
        Lobe::Matte(Matte::Burley(_)) => 21,
        Lobe::Varnish(_) => 22,
        Lobe::Measured(_) => 23,
    }
}

#[test]
fn every_kind_of_lobe_is_here() {
    let mut here: Vec<usize> = spread().iter().chain(&sharp()).map(number).collect();
    here.sort_unstable();
    here.dedup();
    assert_eq!(here, (0..24).collect::<Vec<_>>());
}
