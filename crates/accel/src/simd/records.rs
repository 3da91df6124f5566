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
