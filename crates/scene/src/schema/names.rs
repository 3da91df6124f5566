//! Textures by name: parameters refer to thousands of them, so that looking through the list each time takes quadratic
//! time.
use std::collections::HashMap;

use crate::{TextureDesc, TextureValue};

/// Where the textures of a description are.
#[derive(Debug, Default)]
pub struct TextureNames<'a> {
    floats: HashMap<&'a str, usize>,
    colors: HashMap<&'a str, usize>,
}

impl<'a> TextureNames<'a> {
    /// Of all `textures`; of two with the same name and value the first counts.
    pub fn of(textures: &'a [TextureDesc]) -> Self {
        let mut names = Self::default();
        for (index, texture) in textures.iter().enumerate() {
            let by_name = match texture.value {
                TextureValue::Float => &mut names.floats,
                TextureValue::Color => &mut names.colors,
            };
            by_name.entry(texture.name.as_str()).or_insert(index);
        }
        names
    }
    /// The index of the texture that yields `value`.
    pub fn find(&self, value: TextureValue, name: &str) -> Option<usize> {
        let by_name = match value {
            TextureValue::Float => &self.floats,
            TextureValue::Color => &self.colors,
        };
        by_name.get(name).copied()
    }
}
