//! The graphics state and the blocks that save it.
use std::sync::Arc;

use durer_scene::{MaterialRef, MediumInterface, Node, Span};

use super::{
    color_space::ColorSpace,
    directive::Directive,
    params::{MOST_PARAMS, ParamList},
    placement::{Active, Placement},
};

/// What an `Attribute` directive gives parameters to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// Shapes.
    Shape,
    /// Lights.
    Light,
    /// Materials.
    Material,
    /// Textures.
    Texture,
    /// Media.
    Medium,
}

/// Parameters that later nodes take unless they give their own.
#[derive(Clone, Debug, Default)]
pub(super) struct Inherited {
    shape: Arc<ParamList>,
    light: Arc<ParamList>,
    material: Arc<ParamList>,
    texture: Arc<ParamList>,
    medium: Arc<ParamList>,
}

impl Inherited {
    /// The parameters for `target`.
    pub(super) fn of(&self, target: Target) -> &ParamList {
        match target {
            Target::Shape => &self.shape,
            Target::Light => &self.light,
            Target::Material => &self.material,
            Target::Texture => &self.texture,
            Target::Medium => &self.medium,
        }
    }
    /// Adds parameters; a later one of the same name replaces the earlier. False if there are too many.
    pub(super) fn add(&mut self, target: Target, params: ParamList) -> bool {
        let list = match target {
            Target::Shape => &mut self.shape,
            Target::Light => &mut self.light,
            Target::Material => &mut self.material,
            Target::Texture => &mut self.texture,
            Target::Medium => &mut self.medium,
        };
        let list = Arc::make_mut(list);
        list.retain(|old| params.iter().all(|new| new.name != old.name));
        list.extend(params);
        list.len() <= MOST_PARAMS
    }
}

/// What `AttributeBegin` saves.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// The current transformation matrices.
    pub(super) ctm: Placement,
    /// Which of them change.
    pub(super) active: Active,
    /// Material of the next shape.
    pub(super) material: Option<MaterialRef>,
    /// `ReverseOrientation` was given an odd number of times.
    pub(super) reverse: bool,
    /// Light that the next shapes send out.
    pub(super) area_light: Option<Arc<Node>>,
    /// What is on the two sides of the next surfaces, and around the next camera, if anything was said.
    pub(super) media: Option<MediumInterface>,
    /// What colours mean.
    pub(super) color_space: ColorSpace,
    /// From `Attribute`.
    pub(super) inherited: Inherited,
}

impl State {
    pub(super) fn new() -> Self {
        Self {
            ctm: Placement::identity(),
            active: Active::All,
            material: None,
            reverse: false,
            area_light: None,
            media: None,
            color_space: ColorSpace::SRGB,
            inherited: Inherited::default(),
        }
    }
}

/// An open block.
#[derive(Debug)]
pub(super) struct Block {
    /// `AttributeBegin`, `TransformBegin` or `ObjectBegin`.
    pub(super) begin: Directive,
    /// Where it was written.
    pub(super) at: Span,
    /// The state outside.
    pub(super) saved: State,
}

impl Block {
    /// The state behind the block, from that at its end. `TransformBegin` saves nothing but the transformation.
    pub(super) fn restore(self, now: &mut State) {
        if self.begin == Directive::TransformBegin {
            now.ctm = self.saved.ctm;
            now.active = self.saved.active;
        } else {
            *now = self.saved;
        }
    }
}
