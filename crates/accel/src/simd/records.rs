//! What lies in trees, vouched for.
use super::Record;
use crate::layout::{MovingNode, MovingPacket, Node, Packet};

// SAFETY: arrays of f32 and u32 only; `repr(C, align(32))`, and a test pins the sizes, which leave no padding.
unsafe impl Record for Node<8> {}
// SAFETY: as above.
unsafe impl Record for Node<16> {}
// SAFETY: as above.
unsafe impl Record for MovingNode<8> {}
// SAFETY: as above.
unsafe impl Record for MovingNode<16> {}
// SAFETY: as above: 9 or 18 arrays of 8 f32 and one of 8 u32.
unsafe impl Record for Packet {}
// SAFETY: as above.
unsafe impl Record for MovingPacket {}

/// All numbers of some arrays, one after another. PERF: the standard library's own is not always inlined (bench kernel).
#[inline(always)]
pub(crate) fn flat<const N: usize, const M: usize>(arrays: &[[f32; N]; M]) -> &[f32] {
    // SAFETY: an array of arrays holds `N * M` numbers without gaps.
    unsafe { std::slice::from_raw_parts(arrays.as_ptr().cast(), N * M) }
}
