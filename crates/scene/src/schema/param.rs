//! One parameter of a schema.
use crate::ValueType;

/// What a parameter holds, in the terms of its user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamType {
    /// A truth value.
    Bool,
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// A position.
    Point3,
    /// A direction.
    Vector3,
    /// Any number of whole numbers.
    Ints,
    /// Any number of numbers.
    Floats,
    /// Any number of 2D points.
    Point2s,
    /// Any number of positions.
    Point3s,
    /// Any number of directions.
    Vector3s,
    /// Any number of normals.
    Normals,
    /// Any text.
    Text,
    /// Any number of texts, such as names.
    Texts,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A path relative to the scene file.
    File,
    /// An index of refraction: a number, or a spectrum.
    Index,
    /// A colour.
    Color,
    /// A colour, or a colour texture's name.
    ColorTexture,
    /// Any number of linear RGB colours.
    Colors,
    /// A number, or a float texture's name.
    FloatTexture,
}

impl ParamType {
    /// The declared types a file may use for it.
    pub fn accepts(self) -> &'static [ValueType] {
        use ValueType as V;
        match self {
            Self::Bool => &[V::Bool],
            Self::Int | Self::Ints => &[V::Integer],
            Self::Float | Self::Floats => &[V::Float],
            Self::Point2s => &[V::Point2, V::Vector2],
            Self::Point3 | Self::Point3s => &[V::Point3],
            Self::Vector3 | Self::Vector3s => &[V::Vector3],
            Self::Normals => &[V::Normal],
            Self::Text | Self::Texts | Self::Choice(_) | Self::File => &[V::String],
            Self::Index => &[V::Float, V::Spectrum],
            Self::Color => &[V::Rgb, V::Spectrum, V::Blackbody],
            Self::ColorTexture => &[V::Rgb, V::Spectrum, V::Blackbody, V::Texture],
            Self::Colors => &[V::Rgb],
            Self::FloatTexture => &[V::Float, V::Texture],
        }
    }
    /// True if it takes any number of values.
    pub fn is_list(self) -> bool {
        matches!(
            self,
            Self::Ints
                | Self::Floats
                | Self::Point2s
                | Self::Point3s
                | Self::Vector3s
                | Self::Normals
                | Self::Texts
                | Self::Colors
        )
    }
}

/// The value of a parameter that a file leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamDefault {
    /// It may not be left out.
    Required,
    /// The kind decides, see its documentation.
    Unset,
    /// A truth value.
    Bool(bool),
    /// A whole number.
    Int(i32),
    /// A number, for [`ParamType::Float`], [`ParamType::Index`] and [`ParamType::FloatTexture`].
    Float(f32),
    /// Three numbers: a point, vector or linear RGB colour.
    Triple([f32; 3]),
    /// A text.
    Text(&'static str),
}

/// Name, type, default, unit, range and meaning of a parameter.
#[derive(Clone, Copy, Debug)]
pub struct ParamSpec {
    /// The word in scene files.
    pub name: &'static str,
    /// What it holds.
    pub ty: ParamType,
    /// Its value if left out.
    pub default: ParamDefault,
    /// Unit of numbers; empty for pure numbers.
    pub unit: &'static str,
    /// The range each number must lie in, its ends included but for `open`.
    pub range: (f32, f32),
    /// Whether the lower end of the range is itself forbidden.
    pub open: bool,
    /// What it does.
    pub doc: &'static str,
}

impl ParamSpec {
    /// A parameter without unit and range.
    pub const fn new(name: &'static str, ty: ParamType, default: ParamDefault, doc: &'static str) -> Self {
        Self { name, ty, default, unit: "", range: (f32::NEG_INFINITY, f32::INFINITY), open: false, doc }
    }
    /// A number.
    pub const fn float(name: &'static str, default: f32, doc: &'static str) -> Self {
        Self::new(name, ParamType::Float, ParamDefault::Float(default), doc)
    }
    /// A colour.
    pub const fn color(name: &'static str, default: [f32; 3], doc: &'static str) -> Self {
        Self::new(name, ParamType::Color, ParamDefault::Triple(default), doc)
    }
    /// A colour or colour texture.
    pub const fn color_texture(name: &'static str, default: [f32; 3], doc: &'static str) -> Self {
        Self::new(name, ParamType::ColorTexture, ParamDefault::Triple(default), doc)
    }
    /// A number or float texture.
    pub const fn float_texture(name: &'static str, default: f32, doc: &'static str) -> Self {
        Self::new(name, ParamType::FloatTexture, ParamDefault::Float(default), doc)
    }
    /// Whether it is an amount of light, and not a share of it: it has a unit then.
    pub const fn is_light(&self) -> bool {
        !self.unit.is_empty()
    }
    /// With a unit.
    #[must_use]
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }
    /// With a closed range.
    #[must_use]
    pub const fn range(mut self, min: f32, max: f32) -> Self {
        self.range = (min, max);
        self
    }
    /// With a range that its lower end is not part of.
    #[must_use]
    pub const fn above(mut self, min: f32, max: f32) -> Self {
        self.open = true;
        self.range(min, max)
    }
    /// Whether a number lies in the range.
    pub fn allows(&self, value: f32) -> bool {
        let (min, max) = self.range;
        value >= min && value <= max && !(self.open && value == min)
    }
    /// The range in words.
    pub fn expected(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        match self.range {
            (min, max) if self.open && max.is_finite() => format!("more than {min}, {max}{unit} at most"),
            (min, _) if self.open => format!("more than {min}{unit}"),
            (min, max) if min.is_finite() && max.is_finite() => format!("{min} to {max}{unit}"),
            (min, _) if min.is_finite() => format!("{min}{unit} or more"),
            (_, max) if max.is_finite() => format!("{max}{unit} or less"),
            _ => format!("a finite number{unit}"),
        }
    }
}
