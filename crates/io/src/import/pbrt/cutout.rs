//! Shapes with holes: pbrt's parameter `alpha` of shapes becomes a material of the kind `mask` around the shape's own.
use durer_core::Id;
use durer_scene::{Data, Location, MaterialRef, NamedNode, Node, Param, Params, ValueType};

use super::{
    params::{ParamList, take},
    world::World,
};

/// Takes the alpha of a shape off its parameters, unless all of the shape is there, or it is wrong: then the shape's own
/// check says so.
pub(super) fn take_alpha(params: &mut ParamList) -> Option<Param> {
    let alpha = params.iter().find(|p| p.name == "alpha")?;
    let is_sound = match (alpha.ty, &alpha.data) {
        (ValueType::Float, Data::Floats(values)) => {
            matches!(values[..], [alpha] if (0.0..1.0).contains(&alpha))
        }
        (ValueType::Texture, Data::Strings(names)) => names.len() == 1,
        _ => false,
    };
    if is_sound { take(params, "alpha") } else { None }
}

impl World<'_> {
    /// The mask around `material` with this alpha; equal ones are one.
    pub(super) fn masked(&mut self, material: Option<MaterialRef>, alpha: Param) -> MaterialRef {
        let key = (material, format!("{:?}", alpha.data));
        if let Some(mask) = self.masks.get(&key) {
            return *mask;
        }
        let below = material.unwrap_or_else(|| self.material(Node::new("diffuse", Params::new())));
        let name = self.named(below);
        let at = alpha.at.clone();
        let mut params = Params::new();
        let name = Data::Strings(vec![name]);
        let location = Location::None;
        params.push(Param { name: "material".to_owned(), ty: ValueType::String, data: name, at: location });
        params.push(alpha);
        self.desc
            .materials
            .push(NamedNode { name: String::new(), node: Node { kind: "mask".to_owned(), params, at } });
        let mask = Id::new(self.desc.materials.len() as u32 - 1);
        self.masks.insert(key, mask);
        mask
    }

    /// What a material is called, which gets a name if it has none.
    fn named(&mut self, material: MaterialRef) -> String {
        let index = material.index();
        let taken = |name: &str| self.desc.materials.iter().any(|other| other.name == name);
        let (kind, mut name) = match self.desc.materials.get(index) {
            Some(own) => (own.node.kind.clone(), own.name.clone()),
            None => return String::new(),
        };
        if name.is_empty() {
            name = format!("{kind} {index}");
            while taken(&name) {
                name.push('\'');
            }
        }
        if let Some(own) = self.desc.materials.get_mut(index) {
            own.name.clone_from(&name);
        }
        name
    }
}
