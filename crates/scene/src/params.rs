//! Typed parameter lists as written in a file.
use serde::Serialize;

use crate::Location;

/// The type a parameter was declared with; the words of the pbrt language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ValueType {
    /// `bool`
    Bool,
    /// `integer`
    Integer,
    /// `float`
    Float,
    /// `point2`
    Point2,
    /// `vector2`
    Vector2,
    /// `point3` or `point`
    Point3,
    /// `vector3` or `vector`
    Vector3,
    /// `normal3` or `normal`
    Normal,
    /// `rgb`: linear Rec. 709
    Rgb,
    /// `blackbody`: a temperature in kelvin
    Blackbody,
    /// `spectrum`: wavelength and value pairs, or the name of one
    Spectrum,
    /// `string`
    String,
    /// `texture`: the name of one
    Texture,
}

impl ValueType {
    /// Numbers per value: 3 for points, 1 for floats.
    pub fn arity(self) -> usize {
        match self {
            Self::Point2 | Self::Vector2 => 2,
            Self::Point3 | Self::Vector3 | Self::Normal | Self::Rgb => 3,
            _ => 1,
        }
    }
    /// The word in the pbrt language.
    pub fn word(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Integer => "integer",
            Self::Float => "float",
            Self::Point2 => "point2",
            Self::Vector2 => "vector2",
            Self::Point3 => "point3",
            Self::Vector3 => "vector3",
            Self::Normal => "normal3",
            Self::Rgb => "rgb",
            Self::Blackbody => "blackbody",
            Self::Spectrum => "spectrum",
            Self::String => "string",
            Self::Texture => "texture",
        }
    }
}

/// The values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Data {
    /// Of `bool`.
    Bools(Vec<bool>),
    /// Of `integer`.
    Ints(Vec<i32>),
    /// Of everything numeric else, flattened.
    Floats(Vec<f32>),
    /// Of `string`, `texture` and named `spectrum`.
    Strings(Vec<String>),
}

impl Data {
    /// Number of scalars.
    pub fn len(&self) -> usize {
        match self {
            Self::Bools(v) => v.len(),
            Self::Ints(v) => v.len(),
            Self::Floats(v) => v.len(),
            Self::Strings(v) => v.len(),
        }
    }
    /// True if there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// One parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Param {
    /// Its name.
    pub name: String,
    /// The type it was declared with.
    pub ty: ValueType,
    /// Its values; their kind and count fit `ty`.
    pub data: Data,
    /// Where it was written.
    pub at: Location,
}

/// The parameters of a node, in the order written.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Params {
    list: Vec<Param>,
}

impl Params {
    /// No parameters.
    pub const fn new() -> Self {
        Self { list: Vec::new() }
    }
    /// Appends a parameter.
    pub fn push(&mut self, param: Param) {
        self.list.push(param);
    }
    /// Appends a parameter that no text names (importers of other formats).
    #[must_use]
    pub fn with(mut self, name: &str, ty: ValueType, data: Data) -> Self {
        self.push(Param { name: name.to_owned(), ty, data, at: Location::None });
        self
    }
    /// [`Self::with`] for one float.
    #[must_use]
    pub fn float(self, name: &str, value: f32) -> Self {
        self.with(name, ValueType::Float, Data::Floats(vec![value]))
    }
    /// [`Self::with`] for one linear RGB colour.
    #[must_use]
    pub fn rgb(self, name: &str, value: [f32; 3]) -> Self {
        self.with(name, ValueType::Rgb, Data::Floats(value.to_vec()))
    }
    /// [`Self::with`] for one string.
    #[must_use]
    pub fn string(self, name: &str, value: &str) -> Self {
        self.with(name, ValueType::String, Data::Strings(vec![value.to_owned()]))
    }
    /// [`Self::with`] for a texture's name.
    #[must_use]
    pub fn texture(self, name: &str, texture: &str) -> Self {
        self.with(name, ValueType::Texture, Data::Strings(vec![texture.to_owned()]))
    }
    /// [`Self::with`] for one truth value.
    #[must_use]
    pub fn bool(self, name: &str, value: bool) -> Self {
        self.with(name, ValueType::Bool, Data::Bools(vec![value]))
    }
    /// [`Self::with`] for one integer.
    #[must_use]
    pub fn int(self, name: &str, value: i32) -> Self {
        self.with(name, ValueType::Integer, Data::Ints(vec![value]))
    }
    /// The parameter called `name`.
    pub fn get(&self, name: &str) -> Option<&Param> {
        self.list.iter().find(|p| p.name == name)
    }
    /// All parameters.
    pub fn iter(&self) -> std::slice::Iter<'_, Param> {
        self.list.iter()
    }
    /// Replaces the value of `name`, or appends it: how command-line options override a file.
    pub fn set(&mut self, param: Param) {
        match self.list.iter_mut().find(|p| p.name == param.name) {
            Some(old) => *old = param,
            None => self.list.push(param),
        }
    }
}
