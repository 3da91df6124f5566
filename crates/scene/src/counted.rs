//! "1 triangle", "2 triangles": numbers of things in messages.

/// A number and the word for that many of `one`.
pub fn counted(count: usize, one: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {}", plural(one)) }
}

/// The word for several.
fn plural(one: &str) -> String {
    match one {
        "index" => "indices".to_owned(),
        "vertex" => "vertices".to_owned(),
        "mesh" => "meshes".to_owned(),
        _ => format!("{one}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_stands_alone() {
        assert_eq!(counted(1, "element"), "1 element");
        assert_eq!(counted(0, "element"), "0 elements");
        assert_eq!([counted(2, "vertex"), counted(2, "mesh")], ["2 vertices", "2 meshes"]);
    }
}
