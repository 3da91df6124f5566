//! The lecture's loop: every primitive of every instance, whatever was found before. Same tests, same hits.
use super::{Best, Cx, Level, leaf::Leaves};
use crate::{
    lanes::Portable,
    layout::{Link, MovingPacket, Packet, PacketRecord, Target},
    probe::Watch,
    space::enter_space,
    tree::Trees,
};

/// Offers every hit to `best`.
pub(crate) fn exhaustive_nearest<W: Watch>(cx: &Cx<'_>, level: &Level<'_>, best: &mut Best, watch: &mut W) {
    match &level.forest.trees {
        Trees::Still(_) => all_nearest::<Packet, W>(cx, level, best, watch),
        Trees::Moving { .. } => all_nearest::<MovingPacket, W>(cx, level, best, watch),
    }
}

/// Whether anything is hit; never returns early.
pub(crate) fn exhaustive_blocked<W: Watch>(
    cx: &Cx<'_>,
    level: &Level<'_>,
    t_max: f32,
    watch: &mut W,
) -> bool {
    match &level.forest.trees {
        Trees::Still(_) => all_blocked::<Packet, W>(cx, level, t_max, watch),
        Trees::Moving { .. } => all_blocked::<MovingPacket, W>(cx, level, t_max, watch),
    }
}

fn all_nearest<R: PacketRecord, W: Watch>(cx: &Cx<'_>, level: &Level<'_>, best: &mut Best, watch: &mut W) {
    let (tree, moment) = level.forest.tree(level.ray.time);
    enter_space!(world, true, level.ray, level.forest.region);
    for &link in &tree.leaves {
        if let Target::Instance(index) = Link::target(link) {
            let Some((admitted, entered)) = cx.window(index, &world, best.t) else { continue };
            cx.inside(index, &world, entered, |level| {
                // What the box excludes is tested too, and the result forgotten.
                let mut scratch = *best;
                exhaustive_nearest(cx, level, if admitted { best } else { &mut scratch }, watch);
            });
        } else {
            let mut leaves =
                Leaves::<_, R, W, true>::new(Portable, cx, (level, &world), (tree, moment), watch);
            leaves.nearest(link, best);
        }
    }
}

fn all_blocked<R: PacketRecord, W: Watch>(cx: &Cx<'_>, level: &Level<'_>, t_max: f32, watch: &mut W) -> bool {
    let (tree, moment) = level.forest.tree(level.ray.time);
    enter_space!(world, true, level.ray, level.forest.region);
    let mut blocked = false;
    for &link in &tree.leaves {
        if let Target::Instance(index) = Link::target(link) {
            let Some((admitted, entered)) = cx.window(index, &world, t_max) else { continue };
            let hit = cx.inside(index, &world, entered, |level| exhaustive_blocked(cx, level, t_max, watch));
            blocked |= admitted && hit == Some(true);
        } else {
            let mut leaves =
                Leaves::<_, R, W, true>::new(Portable, cx, (level, &world), (tree, moment), watch);
            blocked |= leaves.blocked(link, t_max);
        }
    }
    blocked
}
