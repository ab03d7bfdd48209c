//! BVH traversal: the same for every kernel, closest hit and any hit.
//!
//! A kernel is the arithmetic of two tests, eight boxes and four triangles at a time. The triangle test is the
//! same to the last bit in all kernels (no fused multiplication), so a hit does not depend on the processor.

use super::segment::{Segment, Shear, Slabs};
use super::sphere;
use super::tree::{Child, LANES, PackedSphere, Target, Tree, TriangleBlock, WIDTH, WideNode};
use crate::contract::TraversalStats;

/// Entries of the stack. A node pushes at most seven, and `build` bounds the depth at 96.
const CAPACITY: usize = 1024;

/// Which of `N` are met, one bit each, and where.
pub(crate) type Met<const N: usize> = (u32, [f32; N]);

/// The two tests, in whatever arithmetic.
pub(crate) trait Kernel {
    /// Which of the eight boxes the segment meets, and where it enters them.
    fn boxes(node: &WideNode, slabs: &Slabs, t_after: f32, t_beyond: f32) -> Met<WIDTH>;

    /// Which of the four triangles are hit with `t_after < t ≤ t_last`, and where.
    fn triangles(block: &TriangleBlock, shear: &Shear, t_after: f32, t_last: f32) -> Met<LANES>;
}

/// What a walk finds, to be refined by `Geometry::surface`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    /// In units of the scaled direction.
    pub(crate) t: f32,
    /// Of the primitive in the scene.
    pub(crate) number: u32,
}

impl Candidate {
    const NO_NUMBER: u32 = u32::MAX;

    /// Equally near primitives: the lower number wins, whatever the order of the walk.
    #[inline(always)]
    fn improve(&mut self, t: f32, number: u32) {
        if t < self.t || (t == self.t && number < self.number) {
            *self = Self { t, number };
        }
    }
}

/// Children still to be visited, with the `t` where the ray enters them. Lives as long as its tracer, because
/// clearing it for each ray would cost more than the walk.
pub(crate) struct Stack(Box<[Entry; CAPACITY]>);

impl Stack {
    pub(crate) fn new() -> Self {
        Self(Box::new([Entry(0); CAPACITY]))
    }
}

/// The bits of `t` above those of a child: for t ≥ 0 entries compare like their `t`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u64);

impl Entry {
    #[inline(always)]
    fn new(t: f32, child: Child) -> Self {
        Self(u64::from(t.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    fn t(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// The walk. `ANY` is for shadow rays: it is content with the first hit that it meets.
///
/// Children are visited in the order in which the ray enters them; the farther ones wait on the stack, and are
/// dropped if something nearer has been found meanwhile.
#[inline(always)]
pub(crate) fn walk<K: Kernel, const ANY: bool>(
    tree: &Tree,
    segment: &Segment,
    stack: &mut Stack,
    stats: &mut TraversalStats,
) -> Option<Candidate> {
    let stack = &mut *stack.0;
    let mut top = push_roots(tree, segment, stack);
    let mut best = Candidate { t: segment.t_last, number: Candidate::NO_NUMBER };
    let mut counts = TraversalStats { rays: 1, ..TraversalStats::default() };
    while top > 0 {
        top -= 1;
        let mut child = stack[top].child();
        let beyond = Segment::beyond(best.t);
        if stack[top].t() > beyond {
            continue;
        }
        while let Target::Node(index) = child.target() {
            let node = &tree.nodes[index];
            counts.box_tests += u64::from(node.child_count);
            let (mask, entries) = K::boxes(node, &segment.slabs, segment.t_after, beyond);
            child = push_all_but_nearest(node, mask, &entries, stack, &mut top);
        }
        visit_leaf::<K>(tree, segment, child, &mut best, &mut counts.primitive_tests);
        if ANY && best.number != Candidate::NO_NUMBER {
            break;
        }
    }
    *stats += counts;
    (best.number != Candidate::NO_NUMBER).then_some(best)
}

#[inline(always)]
fn push_roots(tree: &Tree, segment: &Segment, stack: &mut [Entry; CAPACITY]) -> usize {
    for (entry, &root) in stack.iter_mut().zip(&tree.roots) {
        *entry = Entry::new(segment.t_after, root);
    }
    tree.roots.len()
}

/// Answers the nearest of the children in `mask`, or [`Child::NONE`], and pushes the others, the nearest on top.
#[inline(always)]
fn push_all_but_nearest(
    node: &WideNode,
    mut mask: u32,
    entries: &[f32; WIDTH],
    stack: &mut [Entry; CAPACITY],
    top: &mut usize,
) -> Child {
    let mut next = || {
        let slot = mask.trailing_zeros() as usize % WIDTH;
        let is_any = mask != 0;
        mask &= mask.wrapping_sub(1);
        is_any.then(|| Entry::new(entries[slot], node.children[slot]))
    };
    // Most often one or two children are met, and then nothing needs sorting.
    let Some(first) = next() else { return Child::NONE };
    let Some(second) = next() else { return first.child() };
    let (mut nearest, farther) = if first < second { (first, second) } else { (second, first) };
    let bottom = *top;
    stack[bottom] = farther;
    *top += 1;
    while let Some(mut entry) = next() {
        if entry < nearest {
            std::mem::swap(&mut entry, &mut nearest);
        }
        insert(entry, stack, bottom, *top);
        *top += 1;
    }
    nearest.child()
}

/// Insertion into `stack[bottom..top]`, which is sorted with the nearest on top.
#[inline(always)]
fn insert(entry: Entry, stack: &mut [Entry; CAPACITY], bottom: usize, top: usize) {
    let mut place = top;
    while place > bottom && stack[place - 1] < entry {
        stack[place] = stack[place - 1];
        place -= 1;
    }
    stack[place] = entry;
}

#[inline(always)]
fn visit_leaf<K: Kernel>(
    tree: &Tree,
    segment: &Segment,
    leaf: Child,
    best: &mut Candidate,
    tests: &mut u64,
) {
    if leaf == Child::NONE {
        return;
    }
    match leaf.target() {
        Target::Triangles(first) => visit_blocks::<K>(&tree.blocks[first..], segment, best, tests),
        Target::Spheres(first) => visit_spheres(&tree.spheres[first..], segment, best, tests),
        Target::Node(_) => {}
    }
}

#[inline(always)]
fn visit_blocks<K: Kernel>(
    blocks: &[TriangleBlock],
    segment: &Segment,
    best: &mut Candidate,
    tests: &mut u64,
) {
    for block in blocks {
        *tests += block.triangle_count();
        let (mut mask, ts) = K::triangles(block, &segment.shear, segment.t_after, best.t);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize % LANES;
            best.improve(ts[lane], block.number(lane));
            mask &= mask - 1;
        }
        if !block.is_followed() {
            break;
        }
    }
}

fn visit_spheres(
    spheres: &[PackedSphere],
    segment: &Segment,
    best: &mut Candidate,
    tests: &mut u64,
) {
    for sphere in spheres {
        *tests += 1;
        if let Some(t) = sphere::first_root_inside(sphere, segment, best.t) {
            best.improve(t, sphere.number());
        }
        if !sphere.is_followed() {
            break;
        }
    }
}

/// The kernel for every processor: arrays, which the compiler turns into what vectors there are.
pub(crate) struct Portable;

impl Kernel for Portable {
    #[inline(always)]
    fn boxes(node: &WideNode, slabs: &Slabs, t_after: f32, t_beyond: f32) -> Met<WIDTH> {
        let (mut enter, mut exit) = ([t_after; WIDTH], [t_beyond; WIDTH]);
        for axis in 0..3 {
            let [first, last] = slabs.rows(axis).map(|row| &node.planes[row]);
            for lane in 0..WIDTH {
                let near = first[lane] * slabs.inverse[axis] - slabs.enter_offset[axis];
                let far = last[lane] * slabs.inverse[axis] - slabs.exit_offset[axis];
                enter[lane] = if near > enter[lane] { near } else { enter[lane] };
                exit[lane] = if far < exit[lane] { far } else { exit[lane] };
            }
        }
        (
            bits(std::array::from_fn::<_, WIDTH, _>(|lane| {
                enter[lane] <= Segment::beyond(exit[lane])
            })),
            enter,
        )
    }

    #[inline(always)]
    fn triangles(block: &TriangleBlock, shear: &Shear, t_after: f32, t_last: f32) -> Met<LANES> {
        let [x_axis, y_axis, z_axis] = shear.axes.map(usize::from);
        let mut ts = [0.0; LANES];
        let mut hits = [false; LANES];
        for lane in 0..LANES {
            let z: [f32; 3] =
                std::array::from_fn(|corner| block.corners[z_axis][corner][lane] - shear.origin[2]);
            let along = |axis: usize, origin: f32, factor: f32| -> [f32; 3] {
                std::array::from_fn(|corner| {
                    (block.corners[axis][corner][lane] - origin) - factor * z[corner]
                })
            };
            let x = along(x_axis, shear.origin[0], shear.factors[0]);
            let y = along(y_axis, shear.origin[1], shear.factors[1]);
            // Without fused multiplication the sign of an edge function is right or zero, and two triangles
            // that share an edge get exactly opposite ones: no ray passes between them.
            let u = x[2] * y[1] - y[2] * x[1];
            let v = x[0] * y[2] - y[0] * x[2];
            let w = x[1] * y[0] - y[1] * x[0];
            let determinant = u + v + w;
            let t = ((u * z[0] + v * z[1] + w * z[2]) * shear.factors[2]) / determinant;
            let is_inside =
                (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
            // A triangle seen edge-on has determinant 0 and t = ±∞ or NaN, which fails here.
            // Of a triangle that is tiny for its distance all edge functions may round to zero. It can only be hit
            // by a ray, which is the origin here, inside the box of its corners.
            let is_near = surround_zero(x) && surround_zero(y);
            hits[lane] = is_inside && is_near && t > t_after && t <= t_last;
            ts[lane] = t;
        }
        (bits(hits), ts)
    }
}

/// Whether 0 lies between the least and the most of three numbers.
#[inline(always)]
fn surround_zero([a, b, c]: [f32; 3]) -> bool {
    a.min(b).min(c) <= 0.0 && a.max(b).max(c) >= 0.0
}

/// One bit for each element that is true.
#[inline(always)]
fn bits<const N: usize>(flags: [bool; N]) -> u32 {
    flags.iter().rev().fold(0, |bits, &flag| bits << 1 | u32::from(flag))
}
