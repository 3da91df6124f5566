//! Files of Mitsuba 0.x: names as Mitsuba 3 changes them when it reads such a file.
use durer_core::glam::{DAffine3, DVec3};

use super::object::{Object, Prop, Value};

/// Whether this version is before 2.
pub(super) fn is_old(version: &str) -> bool {
    version
        .split('.')
        .next()
        .and_then(|major| major.trim().parse::<u32>().ok())
        .is_some_and(|major| major < 2)
}

/// `toWorld` as `to_world`: words are parted where a small letter comes before a capital one.
pub(super) fn name(old: &str) -> String {
    let mut new = String::with_capacity(old.len() + 4);
    let mut before = ' ';
    for c in old.chars() {
        if c.is_ascii_uppercase() && before.is_ascii_lowercase() {
            new.push('_');
        }
        // Capitals behind the first belong to its word: `intIOR`.
        let in_word = c.is_ascii_uppercase() && (before.is_ascii_lowercase() || before.is_ascii_uppercase());
        new.push(if in_word && !new.is_empty() { c.to_ascii_lowercase() } else { c });
        before = c;
    }
    new
}

/// Elements that have another name today.
pub(super) fn tag(old: &str) -> &str {
    match old {
        "camera" => "sensor",
        "luminaire" => "emitter",
        other => other,
    }
}

/// Parameters that have another form today.
pub(super) fn object(object: &mut Object) {
    if object.plugin == "diffuse" {
        for prop in object.props.iter_mut().filter(|p| p.name == "diffuse_reflectance") {
            prop.name = "reflectance".to_owned();
        }
    }
    let number = |object: &Object, name: &str| match object.get(name).map(|p| &p.value) {
        Some(Value::Number(v)) => Some(*v),
        _ => None,
    };
    let [u, v, s, t] = ["uoffset", "voffset", "uscale", "vscale"].map(|name| number(object, name));
    if [u, v, s, t].iter().all(Option::is_none) {
        return;
    }
    object.props.retain(|p| !["uoffset", "voffset", "uscale", "vscale"].contains(&p.name.as_str()));
    let offset = DVec3::new(u.unwrap_or(0.0), v.unwrap_or(0.0), 0.0);
    let scale = DVec3::new(s.unwrap_or(1.0), t.unwrap_or(1.0), 1.0);
    let to_uv = DAffine3::from_scale(scale) * DAffine3::from_translation(offset);
    object.props.push(Prop { name: "to_uv".to_owned(), value: Value::Transform(to_uv), at: object.at });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_get_underscores_where_words_begin() {
        let words = ["toWorld", "intIOR", "maxDepth", "alpha", "to_world", "specularReflectance", "alphaU"];
        let new =
            ["to_world", "int_ior", "max_depth", "alpha", "to_world", "specular_reflectance", "alpha_u"];
        assert_eq!(words.map(name), new);
    }

    #[test]
    fn versions_before_two_are_old() {
        assert!(is_old("0.4.0") && is_old("1.9") && !is_old("2.0.0") && !is_old("3.5.0") && !is_old("three"));
    }
}
