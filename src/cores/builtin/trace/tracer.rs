//! Asks a tree with the best kernel that the processor has.

use super::segment::Segment;
use super::simd;
use super::traverse::{Candidate, Portable, Stack, walk};
use super::tree::Tree;
use crate::contract::TraversalStats;

/// Walks one tree, ray after ray, and counts.
pub(crate) struct Tracer<'a> {
    tree: &'a Tree,
    stack: Stack,
    has_simd: bool,
    pub(crate) stats: TraversalStats,
}

impl<'a> Tracer<'a> {
    /// With the best kernel of this processor.
    pub(crate) fn new(tree: &'a Tree) -> Self {
        Self { has_simd: simd::is_available(), ..Self::portable(tree) }
    }

    /// With the kernel that runs everywhere.
    pub(crate) fn portable(tree: &'a Tree) -> Self {
        Self { tree, stack: Stack::new(), has_simd: false, stats: TraversalStats::default() }
    }

    pub(crate) fn nearest(&mut self, segment: &Segment) -> Option<Candidate> {
        let (tree, stack, stats) = (self.tree, &mut self.stack, &mut self.stats);
        if self.has_simd {
            simd::walk::<false>(tree, segment, stack, stats)
        } else {
            walk::<Portable, false>(tree, segment, stack, stats)
        }
    }

    pub(crate) fn is_blocked(&mut self, segment: &Segment) -> bool {
        let (tree, stack, stats) = (self.tree, &mut self.stack, &mut self.stats);
        if self.has_simd {
            simd::walk::<true>(tree, segment, stack, stats).is_some()
        } else {
            walk::<Portable, true>(tree, segment, stack, stats).is_some()
        }
    }
}
