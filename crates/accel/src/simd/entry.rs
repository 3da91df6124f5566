//! The walks, compiled with the processor's features switched on.
use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

use super::x86::{Avx2, Avx512, Ymm, Zmm};
use crate::{
    layout::{MovingNode, Node},
    probe::Watch,
    traverse::{Best, Cx, Kernel, Level, blocked, nearest},
};

#[inline(always)]
fn prefetch(address: *const u8, lines: usize) {
    // PERF: every other line: processors fetch them in pairs from beyond their own caches (bench kernel).
    for line in 0..lines {
        // SAFETY: prefetching an address never faults, whatever it is.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(64 * line).cast()) };
    }
}

macro_rules! kernel {
    ($token:ty, $boxes:ty, $node:ty, $moving:ty, $lines:literal, $features:literal) => {
        impl Kernel for $token {
            type Boxes = $boxes;
            type Packets = Ymm<$token>;
            type Node = $node;
            type Moving = $moving;

            #[inline(always)]
            fn nearest<W: Watch, const ROBUST: bool>(
                self,
                cx: &Cx<'_>,
                level: &Level<'_>,
                best: &mut Best,
                watch: &mut W,
            ) {
                #[target_feature(enable = $features)]
                fn walk<W: Watch, const ROBUST: bool>(
                    token: $token,
                    cx: &Cx<'_>,
                    level: &Level<'_>,
                    best: &mut Best,
                    watch: &mut W,
                ) {
                    nearest::<$token, W, ROBUST>(token, cx, level, best, watch);
                }
                // SAFETY: the token proves the features.
                unsafe { walk::<W, ROBUST>(self, cx, level, best, watch) }
            }

            #[inline(always)]
            fn blocked<W: Watch, const ROBUST: bool>(
                self,
                cx: &Cx<'_>,
                level: &Level<'_>,
                t_max: f32,
                watch: &mut W,
            ) -> bool {
                #[target_feature(enable = $features)]
                fn walk<W: Watch, const ROBUST: bool>(
                    token: $token,
                    cx: &Cx<'_>,
                    level: &Level<'_>,
                    t_max: f32,
                    watch: &mut W,
                ) -> bool {
                    blocked::<$token, W, ROBUST>(token, cx, level, t_max, watch)
                }
                // SAFETY: the token proves the features.
                unsafe { walk::<W, ROBUST>(self, cx, level, t_max, watch) }
            }

            #[inline(always)]
            fn prefetch(self, address: *const u8) {
                prefetch(address, $lines);
            }
        }
    };
}

kernel!(Avx2, Ymm<Avx2>, Node<8>, MovingNode<8>, 5, "avx2,fma,bmi1,bmi2,lzcnt,popcnt");
kernel!(
    Avx512,
    Zmm,
    Node<16>,
    MovingNode<16>,
    7,
    "avx512f,avx512vl,avx512dq,avx2,fma,bmi1,bmi2,lzcnt,popcnt"
);
