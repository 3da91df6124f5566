//! What needs `unsafe`: vector registers, uninitialised memory, big pages. Everything here has a safe face.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod entry;
mod pages;
mod records;
mod stack;
mod widest;
#[cfg(target_arch = "x86_64")]
mod x86;

pub(crate) use pages::{Pages, ROW, Record, roomy};
pub(crate) use records::flat;
pub(crate) use stack::{Slots, Stack};
pub(crate) use widest::{Work, widest};
#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Avx512};
