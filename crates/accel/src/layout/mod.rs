//! How a tree lies in memory: nodes of 8 or 16 boxes and packets of 8 triangles, in rows of 32 bytes, named by [`Link`].
mod link;
mod node;
mod packet;

pub(crate) use link::{Link, Target};
pub(crate) use node::{BoxNode, MovingNode, Node, NodePlanes, NodeWriter};
pub(crate) use packet::{Axis, MovingPacket, PACKET, Packet, PacketRecord};
