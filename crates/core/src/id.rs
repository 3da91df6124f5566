//! Typed indices: how scene objects refer to one another without lifetimes.
use std::{fmt, hash, marker::PhantomData};

/// Index of a `T` in the `Vec<T>` that owns it.
pub struct Id<T: ?Sized> {
    index: u32,
    of: PhantomData<fn() -> Box<T>>,
}

impl<T: ?Sized> Id<T> {
    /// The id of element `index`.
    pub const fn new(index: u32) -> Self {
        Self { index, of: PhantomData }
    }

    /// Position in the owning array.
    pub const fn index(self) -> usize {
        self.index as usize
    }
}

impl<T: ?Sized> Clone for Id<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: ?Sized> Copy for Id<T> {}
impl<T: ?Sized> PartialEq for Id<T> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}
impl<T: ?Sized> Eq for Id<T> {}
impl<T: ?Sized> hash::Hash for Id<T> {
    fn hash<H: hash::Hasher>(&self, state: &mut H) {
        self.index.hash(state);
    }
}
impl<T: ?Sized> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}
impl<T: ?Sized> serde::Serialize for Id<T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u32(self.index)
    }
}
