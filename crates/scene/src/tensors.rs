//! Arrays of numbers by name, as measurements of materials are kept.
use std::{
    any::Any,
    collections::BTreeMap,
    fmt,
    ops::Range,
    sync::{Arc, OnceLock},
};

/// What the numbers of a field are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TensorType {
    /// Bytes: texts and switches.
    U8,
    /// Single precision.
    F32,
    /// Something else, of this many bytes each.
    Other(usize),
}

impl TensorType {
    /// Bytes of a number.
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::F32 => 4,
            Self::Other(bytes) => bytes,
        }
    }
}

/// An array in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tensor {
    /// What it is of.
    pub ty: TensorType,
    /// Numbers along each axis; the last one changes fastest.
    pub shape: Vec<usize>,
    /// Where it lies in the file.
    pub place: Range<usize>,
}

/// The arrays of a file.
pub struct Tensors {
    file: Arc<[u8]>,
    fields: BTreeMap<String, Tensor>,
    made: OnceLock<Arc<dyn Any + Send + Sync>>,
}

impl fmt::Debug for Tensors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(&self.fields).finish()
    }
}

impl Tensors {
    /// From a file and what is in it; `None` if a field does not lie within, or is not as long as its shape says.
    pub fn new(file: Arc<[u8]>, fields: BTreeMap<String, Tensor>) -> Option<Self> {
        let fits = |tensor: &Tensor| {
            let count = tensor.shape.iter().try_fold(1usize, |all, n| all.checked_mul(*n));
            let length = count.and_then(|count| count.checked_mul(tensor.ty.bytes()));
            file.get(tensor.place.clone()).is_some_and(|bytes| Some(bytes.len()) == length)
        };
        fields.values().all(fits).then_some(Self { file, fields, made: OnceLock::new() })
    }
    /// What `make` makes of them, made once for all who use the file.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn made<T: Any + Send + Sync, E>(
        &self,
        make: impl FnOnce(&Self) -> Result<T, E>,
    ) -> Result<Arc<T>, E> {
        if let Some(made) = self.made.get().and_then(|made| Arc::clone(made).downcast::<T>().ok()) {
            return Ok(made);
        }
        let made = Arc::new(make(self)?);
        // Somebody else may have been faster: theirs is the same.
        drop(self.made.set(Arc::clone(&made) as Arc<dyn Any + Send + Sync>));
        Ok(made)
    }
    /// The names and arrays.
    pub fn fields(&self) -> impl Iterator<Item = (&str, &Tensor)> {
        self.fields.iter().map(|(name, tensor)| (name.as_str(), tensor))
    }
    /// The array of this name.
    pub fn get(&self, name: &str) -> Option<&Tensor> {
        self.fields.get(name)
    }
    /// Its bytes.
    pub fn bytes(&self, tensor: &Tensor) -> &[u8] {
        self.file.get(tensor.place.clone()).unwrap_or_default()
    }
    /// Its numbers; none if they are not of single precision.
    pub fn floats(&self, tensor: &Tensor) -> impl Iterator<Item = f32> {
        let bytes = if tensor.ty == TensorType::F32 { self.bytes(tensor) } else { &[] };
        bytes.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b))
    }
}
