#![cfg_attr(
    target_arch = "x86_64",
    expect(
        unsafe_code,
        reason = "vector loads and stores, and calls of functions compiled for AVX2"
    )
)]
//! The kernel for x86-64 processors with AVX2 and FMA. The only file of the core with `unsafe`.
//!
//! The walk itself is `traverse.rs`, inlined here into a function that is compiled for those features; whether
//! the processor has them is asked once per tracer, by [`is_available`].

use super::segment::Segment;
use super::traverse::{Candidate, Stack};
use super::tree::Tree;
use crate::contract::TraversalStats;

/// Whether this processor can run the kernel.
pub(crate) fn is_available() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("popcnt")
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}

/// [`super::traverse::walk`] with this kernel, to be called only where [`is_available`].
#[inline]
pub(crate) fn walk<const ANY: bool>(
    tree: &Tree,
    segment: &Segment,
    stack: &mut Stack,
    stats: &mut TraversalStats,
) -> Option<Candidate> {
    #[cfg(target_arch = "x86_64")]
    {
        debug_assert!(is_available());
        // SAFETY: the only caller is a tracer, which asked `is_available` when it was made.
        unsafe { x86::walk::<ANY>(tree, segment, stack, stats) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        super::traverse::walk::<super::traverse::Portable, ANY>(tree, segment, stack, stats)
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::super::segment::{Segment, Shear, Slabs};
    use super::super::traverse::{self, Candidate, Kernel, Met, Stack};
    use super::super::tree::{LANES, Tree, TriangleBlock, WIDTH, WideNode};
    use crate::contract::TraversalStats;
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx2,fma,bmi1,popcnt")]
    pub(super) fn walk<const ANY: bool>(
        tree: &Tree,
        segment: &Segment,
        stack: &mut Stack,
        stats: &mut TraversalStats,
    ) -> Option<Candidate> {
        traverse::walk::<Avx2, ANY>(tree, segment, stack, stats)
    }

    /// Private, so that nothing but `walk` above can reach its methods.
    struct Avx2;

    impl Kernel for Avx2 {
        #[inline(always)]
        fn boxes(node: &WideNode, slabs: &Slabs, t_after: f32, t_beyond: f32) -> Met<WIDTH> {
            // SAFETY: inlined into `walk`, whose caller has made sure of the features.
            unsafe { boxes(node, slabs, t_after, t_beyond) }
        }

        #[inline(always)]
        fn triangles(
            block: &TriangleBlock,
            shear: &Shear,
            t_after: f32,
            t_last: f32,
        ) -> Met<LANES> {
            // SAFETY: inlined into `walk`, whose caller has made sure of the features.
            unsafe { triangles(block, shear, t_after, t_last) }
        }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn boxes(node: &WideNode, slabs: &Slabs, t_after: f32, t_beyond: f32) -> Met<WIDTH> {
        let mut enter = _mm256_set1_ps(t_after);
        let mut exit = _mm256_set1_ps(t_beyond);
        for axis in 0..3 {
            let inverse = _mm256_set1_ps(slabs.inverse[axis]);
            let enter_offset = _mm256_set1_ps(slabs.enter_offset[axis]);
            let exit_offset = _mm256_set1_ps(slabs.exit_offset[axis]);
            let [first_planes, last_planes] = slabs.rows(axis).map(|row| load8(&node.planes[row]));
            enter = _mm256_max_ps(_mm256_fmsub_ps(first_planes, inverse, enter_offset), enter);
            exit = _mm256_min_ps(_mm256_fmsub_ps(last_planes, inverse, exit_offset), exit);
        }
        let magnitude = _mm256_andnot_ps(_mm256_set1_ps(-0.0), exit);
        let beyond = _mm256_fmadd_ps(magnitude, _mm256_set1_ps(Segment::MARGIN), exit);
        let met = _mm256_cmp_ps::<_CMP_LE_OQ>(enter, beyond);
        (_mm256_movemask_ps(met) as u32, store8(enter))
    }

    /// The same operations in the same order as [`traverse::Portable`], and no fused multiplication.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn triangles(block: &TriangleBlock, shear: &Shear, t_after: f32, t_last: f32) -> Met<LANES> {
        let origin = shear.origin.map(|coordinate| _mm_set1_ps(coordinate));
        let factors = shear.factors.map(|factor| _mm_set1_ps(factor));
        let [x_rows, y_rows, z_rows] = shear.axes.map(|axis| &block.corners[usize::from(axis)]);
        let (mut x, mut y, mut z) =
            ([_mm_setzero_ps(); 3], [_mm_setzero_ps(); 3], [_mm_setzero_ps(); 3]);
        for corner in 0..3 {
            z[corner] = _mm_sub_ps(load4(&z_rows[corner]), origin[2]);
            x[corner] = _mm_sub_ps(
                _mm_sub_ps(load4(&x_rows[corner]), origin[0]),
                _mm_mul_ps(factors[0], z[corner]),
            );
            y[corner] = _mm_sub_ps(
                _mm_sub_ps(load4(&y_rows[corner]), origin[1]),
                _mm_mul_ps(factors[1], z[corner]),
            );
        }
        let u = edge(x[2], y[1], y[2], x[1]);
        let v = edge(x[0], y[2], y[0], x[2]);
        let w = edge(x[1], y[0], y[1], x[0]);
        let determinant = _mm_add_ps(_mm_add_ps(u, v), w);
        let depth =
            _mm_add_ps(_mm_add_ps(_mm_mul_ps(u, z[0]), _mm_mul_ps(v, z[1])), _mm_mul_ps(w, z[2]));
        let t = _mm_div_ps(_mm_mul_ps(depth, factors[2]), determinant);
        let zero = _mm_setzero_ps();
        let least = _mm_min_ps(_mm_min_ps(u, v), w);
        let most = _mm_max_ps(_mm_max_ps(u, v), w);
        let inside = _mm_or_ps(_mm_cmpge_ps(least, zero), _mm_cmple_ps(most, zero));
        // Where an edge function is NaN, t is NaN too, and fails here.
        let in_time =
            _mm_and_ps(_mm_cmpgt_ps(t, _mm_set1_ps(t_after)), _mm_cmple_ps(t, _mm_set1_ps(t_last)));
        let mut hits = _mm_and_ps(inside, in_time);
        if _mm_movemask_ps(hits) != 0 {
            hits = _mm_and_ps(hits, _mm_and_ps(surround_zero(x), surround_zero(y)));
        }
        (_mm_movemask_ps(hits) as u32, store4(t))
    }

    /// Whether 0 lies between the least and the most of three numbers.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn surround_zero([a, b, c]: [__m128; 3]) -> __m128 {
        let zero = _mm_setzero_ps();
        let least = _mm_min_ps(_mm_min_ps(a, b), c);
        let most = _mm_max_ps(_mm_max_ps(a, b), c);
        _mm_and_ps(_mm_cmple_ps(least, zero), _mm_cmpge_ps(most, zero))
    }

    /// `a · b − c · d`, each product rounded.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn edge(a: __m128, b: __m128, c: __m128, d: __m128) -> __m128 {
        _mm_sub_ps(_mm_mul_ps(a, b), _mm_mul_ps(c, d))
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn load8(numbers: &[f32; 8]) -> __m256 {
        // SAFETY: eight numbers are read from a reference to eight numbers.
        unsafe { _mm256_loadu_ps(numbers.as_ptr()) }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn load4(numbers: &[f32; 4]) -> __m128 {
        // SAFETY: four numbers are read from a reference to four numbers.
        unsafe { _mm_loadu_ps(numbers.as_ptr()) }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn store8(vector: __m256) -> [f32; 8] {
        let mut numbers = [0.0; 8];
        // SAFETY: eight numbers are written to an array of eight numbers.
        unsafe { _mm256_storeu_ps(numbers.as_mut_ptr(), vector) };
        numbers
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn store4(vector: __m128) -> [f32; 4] {
        let mut numbers = [0.0; 4];
        // SAFETY: four numbers are written to an array of four numbers.
        unsafe { _mm_storeu_ps(numbers.as_mut_ptr(), vector) };
        numbers
    }
}
