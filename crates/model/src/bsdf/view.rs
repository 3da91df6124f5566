//! Lobes as people are told of them: names and numbers, for those who look into a picture.
use durer_core::{
    math::{Point2, Vector3, float::asin},
    spectrum::Spectrum,
};

use super::{
    Blur, Blurred, Branch, Branches, Bsdf, Draws, Interface, Lobe, Split, fresnel_dielectric,
    refract::cos_transmitted,
};

/// A lobe in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeView {
    /// What it is called: see [`Lobe::name`].
    pub name: &'static str,
    /// Share of light reflected: albedo, reflectance at normal incidence, or the classic coefficient. Of interfaces the
    /// factor on what Fresnel's equations give, or Whitted's constant.
    pub reflectance: Spectrum,
    /// Share of light transmitted; of interfaces like `reflectance`.
    pub transmittance: Spectrum,
    /// Power of the cosine by which it spreads, the smaller one of two; `None` if it spreads by no such power.
    pub exponent: Option<f32>,
    /// Width of microfacets, 0 to 1; `None` if it does not spread by microfacets.
    pub alpha: Option<f32>,
}

/// What an interface does with light that arrives along a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FresnelView {
    /// Share reflected, 0 to 1, by Fresnel's equations for unpolarised light, without the factors of the material.
    pub reflect: f32,
    /// Share transmitted: the rest.
    pub transmit: f32,
    /// Angle of incidence from which on everything is reflected, in radians; `None` if the far side is denser.
    pub critical_angle: Option<f32>,
    /// Everything is reflected.
    pub is_total: bool,
    /// The material divides light by Whitted's constants instead: `reflect` and `transmit` are what nature would do.
    pub is_constant: bool,
    /// Index of refraction on the far side divided by that on the near side.
    pub eta: f32,
}

impl Lobe<'_> {
    /// What it is called in exports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Diffuse { .. } => "diffuse",
            Self::Ambient { .. } => "ambient",
            Self::Highlight(_) => "specular",
            Self::Glossy(_) => "glossy",
            Self::Mirror { .. } => "mirror",
            Self::Interface(_) => "glass",
            Self::Gloss(_) => "gloss",
            Self::Blurred(_) => "frosted",
            Self::Matte(matte) if matte.is_behind() => "translucent",
            Self::Matte(_) => "matte",
            Self::Behind { .. } => "translucent",
            Self::Phong(_) => "phong",
            Self::Varnish(_) => "varnish",
            Self::Layered(_) => "layered",
            Self::Tilted(_) => "tilted",
            Self::Sheet(_) => "sheet",
            Self::Hair(_) => "hair",
            Self::Measured(_) => "measured",
            Self::PassThrough { .. } => "clear",
        }
    }

    /// Its numbers.
    pub fn view(&self) -> LobeView {
        let none = LobeView {
            name: self.name(),
            reflectance: Spectrum::BLACK,
            transmittance: Spectrum::BLACK,
            exponent: None,
            alpha: None,
        };
        let split = |interface: &Interface| {
            let (Split::Fresnel { reflection, transmission } | Split::Constant { reflection, transmission }) =
                interface.split;
            LobeView { reflectance: reflection, transmittance: transmission, ..none }
        };
        match self {
            Self::Diffuse { albedo } => LobeView { reflectance: *albedo, ..none },
            Self::Ambient { coefficient } => LobeView { reflectance: *coefficient, ..none },
            Self::Highlight(h) => LobeView { reflectance: h.specular, exponent: Some(h.exponent), ..none },
            Self::Glossy(g) => LobeView {
                reflectance: g.reflectance.ends().0 * g.scale,
                alpha: Some(g.facets.alpha()),
                ..none
            },
            Self::Mirror { weight } => LobeView { reflectance: *weight, ..none },
            Self::Gloss(g) => LobeView { reflectance: g.weight, exponent: Some(g.exponent), ..none },
            Self::PassThrough { weight } => LobeView { transmittance: *weight, ..none },
            Self::Matte(matte) if matte.is_behind() => LobeView { transmittance: matte.albedo(), ..none },
            Self::Matte(matte) => LobeView { reflectance: matte.albedo(), ..none },
            Self::Sheet(sheet) => {
                LobeView { transmittance: self.tint(), alpha: Some(sheet.glossy().facets.alpha()), ..none }
            }
            Self::Behind { albedo } => LobeView { transmittance: *albedo, ..none },
            Self::Hair(hair) => LobeView { reflectance: hair.tint(), ..none },
            Self::Phong(p) => LobeView { reflectance: p.specular, exponent: Some(p.exponent), ..none },
            Self::Layered(_) | Self::Tilted(_) | Self::Varnish(_) | Self::Measured(_) => LobeView {
                reflectance: self.tint(),
                alpha: self.look().map(|glossy| glossy.facets.alpha()),
                ..none
            },
            Self::Interface(interface) => split(interface),
            Self::Blurred(Blurred { interface, blur }) => match blur {
                Blur::Cosine { reflection, transmission } => {
                    LobeView { exponent: Some(reflection.min(*transmission)), ..split(interface) }
                }
                Blur::Microfacet(facets) => LobeView { alpha: Some(facets.alpha()), ..split(interface) },
            },
        }
    }
}

impl Bsdf<'_> {
    /// What the interface among the lobes does with light that leaves along `wo`; `None` if there is none.
    pub fn fresnel(&self, wo: Vector3) -> Option<FresnelView> {
        self.lobes().find_map(|lobe| match lobe {
            Lobe::Interface(interface) | Lobe::Blurred(Blurred { interface, .. }) => Some(interface.view(wo)),
            _ => None,
        })
    }

    /// Name of the lobe that the `number`-th of [`Bsdf::branches`] belongs to.
    pub fn lobe_of_branch(&self, wo: Vector3, number: usize) -> Option<&'static str> {
        self.lobe_of(number, |lobe, own| lobe.add_branches(wo, own))
    }
    /// Name of the lobe that the `number`-th of [`Bsdf::sharp`] belongs to.
    pub fn lobe_of_sharp(&self, wo: Vector3, number: usize) -> Option<&'static str> {
        self.lobe_of(number, |lobe, own| lobe.add_sharp_branches(wo, own))
    }
    fn lobe_of(&self, number: usize, add: impl Fn(&Lobe, &mut Branches)) -> Option<&'static str> {
        let mut count = 0;
        let is_it = |lobe: &&Lobe| {
            let mut own = Branches::default();
            add(lobe, &mut own);
            own.dim(self.arriving);
            count += own.iter().count();
            number < count
        };
        self.lobes().find(is_it).map(Lobe::name)
    }

    /// The number among the lobes, and the lobe, of the `number`-th of [`Bsdf::draws`].
    pub fn lobe_of_draw(
        &self,
        wo: Vector3,
        u: impl Fn(u32) -> Point2,
        number: usize,
    ) -> Option<(u32, &Lobe<'_>)> {
        let mut count = 0;
        let is_it = |(index, lobe): &(u32, &Lobe<'_>)| {
            let mut own = Draws::default();
            lobe.draw(wo, u(*index), &mut own);
            count += own.iter().count();
            number < count
        };
        (0..).zip(self.lobes()).find(is_it)
    }
    /// What is missing among [`Bsdf::draws`] because a microfacet sends it to the wrong side of the surface, where single
    /// scattering loses it: the direction, and the weight it would have had if no other microfacet were in its way.
    pub fn lost_draws(&self, wo: Vector3, u: impl Fn(u32) -> Point2) -> Vec<LostDraw> {
        let mut all = Vec::new();
        for (number, lobe) in (0..).zip(self.lobes()) {
            let mut add = |branch: Branch| {
                let branch = Branch { weight: self.arriving * branch.weight, ..branch };
                all.push(LostDraw { branch, lobe: lobe.name(), number });
            };
            match lobe {
                Lobe::Glossy(glossy) if glossy.spreads() => {
                    glossy.lost(wo, u(number)).into_iter().for_each(&mut add)
                }
                Lobe::Blurred(blurred) => {
                    blurred.lost(wo, u(number)).into_iter().flatten().for_each(&mut add)
                }
                _ => {}
            }
        }
        all
    }

    /// True if nothing that arrives goes on, whatever its direction: all lobes are black, or what leaves is absorbed on
    /// its way.
    pub fn is_black(&self) -> bool {
        let keeps = |lobe: &Lobe| {
            let view = lobe.view();
            view.reflectance.is_black() && view.transmittance.is_black()
        };
        self.arriving.is_black() || self.lobes().all(keeps)
    }
}

/// A draw that single scattering loses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostDraw {
    /// Where it would have gone, and with which weight at most.
    pub branch: Branch,
    /// Name of its lobe.
    pub lobe: &'static str,
    /// Number of the lobe.
    pub number: u32,
}

impl Interface {
    fn view(&self, wo: Vector3) -> FresnelView {
        let eta = self.eta_seen(wo);
        let cos = wo.z.abs().min(1.0);
        let reflect = fresnel_dielectric(cos, eta);
        FresnelView {
            reflect,
            transmit: 1.0 - reflect,
            critical_angle: (eta < 1.0).then(|| asin(eta)),
            is_total: cos_transmitted(cos, 1.0 / eta).is_none(),
            is_constant: matches!(self.split, Split::Constant { .. }),
            eta,
        }
    }
}
