//! Indices of refraction that Mitsuba knows by name (Hecht, "Optics", 4th edition; about 589 nm, 0 to 20 degrees Celsius).
use super::{
    object::{Object, Value},
    world::World,
};

const NAMES: [(&str, f64); 23] = [
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// The index of what is inside by that of what is outside.
pub(super) fn relative(world: &mut World<'_>, object: &Object, usual: &str) -> f32 {
    (index(world, object, "int_ior", usual) / index(world, object, "ext_ior", "air")) as f32
}

/// The index that parameter `name` gives or names.
pub(super) fn index(world: &mut World<'_>, object: &Object, name: &str, usual: &str) -> f64 {
    let of = |word: &str| NAMES.iter().find(|(n, _)| *n == word).map(|(_, v)| *v);
    let known = of(usual).unwrap_or(1.5);
    let Some(prop) = object.get(name) else { return known };
    match &prop.value {
        Value::Text(word) => {
            let found = of(&word.to_lowercase());
            if found.is_none() {
                world.said.unknown(prop.at, "substance", word, NAMES.iter().map(|(n, _)| *n));
            }
            found.unwrap_or(known)
        }
        _ => match object.number(name, world.said) {
            Some(v) if (0.1..=10.0).contains(&v) => v,
            Some(v) => {
                world.said.error(
                    prop.at,
                    format!("\"{name}\" is {v}, expected an index of refraction from 0.1 to 10"),
                );
                known
            }
            None => known,
        },
    }
}
