//! The BVH that rays traverse: nodes of eight children, leaves of triangles four at a time, and spheres.
//! Brute force is a tree of one leaf of each kind, so both ask exactly the same primitive tests.

use super::bounds::Bounds;
use crate::contract::BuildStats;
use glam::{DVec3, Vec3};

pub(crate) const WIDTH: usize = 8;
/// Triangles in a block.
pub(crate) const LANES: usize = 4;

/// Everything a ray walks through.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// Where rays start: nothing, one node, or a leaf of each kind.
    pub(crate) roots: Vec<Child>,
    /// Inner nodes, parents before children.
    pub(crate) nodes: Vec<WideNode>,
    /// Triangles; the blocks of a leaf follow each other.
    pub(crate) blocks: Vec<TriangleBlock>,
    /// Spheres; those of a leaf follow each other.
    pub(crate) spheres: Vec<PackedSphere>,
    /// Leaves and the longest way to one.
    pub(crate) leaves: u64,
    /// Nodes on the longest way from the root to a leaf.
    pub(crate) depth: u64,
}

impl Tree {
    pub(crate) fn stats(&self) -> BuildStats {
        let bytes = size_of_val(self.nodes.as_slice())
            + size_of_val(self.blocks.as_slice())
            + size_of_val(self.spheres.as_slice());
        BuildStats {
            nodes: self.nodes.len() as u64 + self.leaves,
            leaves: self.leaves,
            max_depth: self.depth,
            bytes: bytes as u64,
        }
    }
}

/// What hangs on a node: an inner node, the first block of a leaf, or the first sphere of a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(pub(crate) u32);

/// A [`Child`], taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    Node(usize),
    Triangles(usize),
    Spheres(usize),
}

impl Child {
    const LEAF: u32 = 1 << 31;
    const SPHERES: u32 = 1 << 30;
    const INDEX: u32 = Self::SPHERES - 1;

    /// No child. Its box is empty, so no ray comes here.
    pub(crate) const NONE: Self = Self(u32::MAX);

    pub(crate) fn node(index: usize) -> Self {
        Self(Self::checked(index))
    }

    /// The leaf that starts at block `index`.
    pub(crate) fn triangles(index: usize) -> Self {
        Self(Self::checked(index) | Self::LEAF)
    }

    /// The leaf that starts at sphere `index`.
    pub(crate) fn spheres(index: usize) -> Self {
        Self(Self::checked(index) | Self::LEAF | Self::SPHERES)
    }

    #[inline(always)]
    pub(crate) fn target(self) -> Target {
        let index = (self.0 & Self::INDEX) as usize;
        if self.0 & Self::LEAF == 0 {
            Target::Node(index)
        } else if self.0 & Self::SPHERES == 0 {
            Target::Triangles(index)
        } else {
            Target::Spheres(index)
        }
    }

    fn checked(index: usize) -> u32 {
        assert!(index < NUMBERS as usize, "a scene has fewer than 2²⁹ primitives");
        index as u32
    }
}

/// Eight boxes and what is in them. Boxes of missing children are empty. Four cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct WideNode {
    /// Row `2 · axis` holds the lower planes of the eight boxes, row `2 · axis + 1` the upper ones.
    pub(crate) planes: [[f32; WIDTH]; 6],
    /// One for each box.
    pub(crate) children: [Child; WIDTH],
    pub(crate) child_count: u32,
}

impl WideNode {
    const LOWER: [f32; WIDTH] = [f32::INFINITY; WIDTH];
    const UPPER: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];

    pub(crate) const EMPTY: Self = Self {
        planes: [Self::LOWER, Self::UPPER, Self::LOWER, Self::UPPER, Self::LOWER, Self::UPPER],
        children: [Child::NONE; WIDTH],
        child_count: 0,
    };

    /// Hangs `child` with its box into `slot`, which was empty.
    pub(crate) fn set(&mut self, slot: usize, bounds: Bounds, child: Child) {
        for axis in 0..3 {
            self.planes[2 * axis][slot] = bounds.min[axis];
            self.planes[2 * axis + 1][slot] = bounds.max[axis];
        }
        self.children[slot] = child;
        self.child_count += 1;
    }
}

/// Primitives have numbers below this.
const NUMBERS: u32 = 1 << 29;
/// In the first number of a block, and in that of a sphere: the leaf goes on with the next one.
const MORE: u32 = 1 << 31;

fn flag(more: bool) -> u32 {
    if more { MORE } else { 0 }
}

/// One to four triangles. Corners of missing ones are NaN, which nothing hits.
#[derive(Clone, Debug)]
#[repr(C, align(16))]
pub(crate) struct TriangleBlock {
    /// For each axis, the coordinates of each corner of the four triangles.
    pub(crate) corners: [[[f32; LANES]; 3]; 3],
    /// Below the primitive numbers, the first has room for how many there are, less one, and for [`MORE`].
    numbers: [u32; LANES],
}

impl TriangleBlock {
    /// Packs at most four triangles with their primitive numbers.
    pub(crate) fn new(triangles: impl Iterator<Item = (u32, [Vec3; 3])>, more: bool) -> Self {
        let mut block = Self { corners: [[[f32::NAN; LANES]; 3]; 3], numbers: [0; LANES] };
        let mut last = 0;
        for (lane, (number, corners)) in triangles.enumerate() {
            last = lane as u32;
            block.numbers[lane] = number;
            for (axis, rows) in block.corners.iter_mut().enumerate() {
                for (row, corner) in rows.iter_mut().zip(corners) {
                    row[lane] = corner[axis];
                }
            }
        }
        block.numbers[0] |= flag(more) | (last * NUMBERS);
        block
    }

    /// The primitive number of a lane.
    #[inline(always)]
    pub(crate) fn number(&self, lane: usize) -> u32 {
        self.numbers[lane] & (NUMBERS - 1)
    }

    /// Whether the leaf goes on with the next block.
    #[inline(always)]
    pub(crate) fn is_followed(&self) -> bool {
        self.numbers[0] & MORE != 0
    }

    #[inline(always)]
    pub(crate) fn triangle_count(&self) -> u64 {
        1 + u64::from(self.numbers[0] / NUMBERS % LANES as u32)
    }
}

/// A sphere, in double precision: its quadratic cancels too much in single.
#[derive(Clone, Debug)]
pub(crate) struct PackedSphere {
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
    number: u32,
}

impl PackedSphere {
    pub(crate) fn new(number: u32, centre: DVec3, radius: f64, more: bool) -> Self {
        Self { centre, radius, number: number | flag(more) }
    }

    #[inline(always)]
    pub(crate) fn number(&self) -> u32 {
        self.number & !MORE
    }

    /// Whether the leaf goes on with the next sphere.
    #[inline(always)]
    pub(crate) fn is_followed(&self) -> bool {
        self.number & MORE != 0
    }
}

const _: () = {
    assert!(size_of::<WideNode>() == 256);
    assert!(size_of::<TriangleBlock>() == 160);
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_child_remembers_what_it_refers_to() {
        assert_eq!(Child::node(7).target(), Target::Node(7));
        assert_eq!(Child::triangles(8).target(), Target::Triangles(8));
        assert_eq!(Child::spheres(0).target(), Target::Spheres(0));
    }

    #[test]
    fn a_block_keeps_numbers_and_the_flag_apart() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let block = TriangleBlock::new([(5, corners), (0, corners)].into_iter(), true);
        assert_eq!((block.number(0), block.number(1)), (5, 0));
        assert_eq!((block.triangle_count(), block.is_followed()), (2, true));
        assert!(block.corners[0][0][2].is_nan());
    }
}
