//! Which instructions walk the tree.
use crate::lanes::Portable;
#[cfg(target_arch = "x86_64")]
use crate::simd::{Avx2, Avx512};

/// A set of vector instructions. All of them find the same hits, bit for bit.
///
/// ```
/// use durer_accel::{AccelBuilder, BuildOptions, Isa};
///
/// for isa in Isa::available() {
///     let options = BuildOptions { isa: Some(isa), ..BuildOptions::default() };
///     assert_eq!(AccelBuilder::new(options).build()?.isa(), isa);
/// }
/// # Ok::<(), durer_accel::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Isa {
    /// x86-64 with AVX-512 F, VL and DQ: nodes of 16 boxes.
    Avx512,
    /// x86-64 with AVX2 and FMA: nodes of 8 boxes.
    Avx2,
    /// Any processor: nodes of 8 boxes, vectors of the `wide` crate.
    Portable,
}

impl Isa {
    /// Those this processor has, widest first; never empty.
    pub fn available() -> Vec<Self> {
        let all = [Self::Avx512, Self::Avx2, Self::Portable];
        all.into_iter().filter(|isa| Registers::new(*isa).is_some()).collect()
    }

    /// As it is called on command lines and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Portable => "portable",
        }
    }
}

/// The same with proof that the processor has them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Registers {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    Portable(Portable),
}

impl Registers {
    /// `None` if the processor lacks them.
    pub(crate) fn new(isa: Isa) -> Option<Self> {
        match isa {
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => Avx512::detect().map(Self::Avx512),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => Avx2::detect().map(Self::Avx2),
            Isa::Portable => Some(Self::Portable(Portable)),
            #[cfg(not(target_arch = "x86_64"))]
            _ => None,
        }
    }

    /// The widest there are.
    pub(crate) fn best() -> Self {
        let widest = [Isa::Avx512, Isa::Avx2].into_iter().find_map(Self::new);
        widest.unwrap_or(Self::Portable(Portable))
    }

    pub(crate) fn isa(self) -> Isa {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => Isa::Avx512,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => Isa::Avx2,
            Self::Portable(_) => Isa::Portable,
        }
    }

    /// Children of a node.
    pub(crate) fn width(self) -> usize {
        if self.isa() == Isa::Avx512 { 16 } else { 8 }
    }
}
