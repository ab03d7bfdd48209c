//! A table of functions in C that a core in Rust answers: the bench's own parts (`lent`), or an exported core (`export`).
//!
//! Each function finds who is asked by the pointers that it is handed back, and reads its arguments as the header has
//! them. Not here: who answers, and what C is told besides.
#![expect(unsafe_code, reason = "C calls a core in Rust")]

use crate::contract::abi::given::{Given, struct_size};
use crate::contract::abi::{self, CoreTable, Status, taken};
use crate::contract::answer::Batch;
use crate::contract::argument::Argument;
use crate::contract::question::*;
use crate::contract::{BuiltScene, Core};
use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr;
use std::slice;

/// Who answers.
pub(super) trait Answerer {
    /// Asks what needs no scene.
    ///
    /// SAFETY: `this` is that of its table.
    unsafe fn core(this: *mut c_void, ask: impl FnOnce(&mut dyn Core) -> Result<()>) -> Status;

    /// Asks a scene that it has taken in.
    ///
    /// SAFETY: as above, and `built` is what it has handed out as that.
    unsafe fn scene(
        this: *mut c_void,
        built: *mut abi::Built,
        ask: impl FnOnce(&mut dyn BuiltScene) -> Result<()>,
    ) -> Status;
}

/// The function of a plain question takes its place.
macro_rules! fill {
    (($table:ident, $can:ident) {
        $(#[$doc:meta])* $needed:ident $(= $bit:literal)?
        fn $method:ident($($arguments:tt)*) -> $told:ty;
    }) => {
        if $can.contains(Capabilities::$needed) {
            $table.$method = Some($method::<A>);
        }
    };
}

/// The functions of the questions that it can be asked; the rest of the table is empty.
pub(super) fn table_of<A: Answerer>(this: *mut c_void, can: Capabilities) -> CoreTable {
    let mut table = CoreTable {
        abi: abi::ABI,
        struct_size: struct_size::<CoreTable>(),
        conventions: abi::Conventions::default(),
        this,
        // SAFETY: zeros are numbers, null pointers and functions that are not there.
        ..unsafe { std::mem::zeroed() }
    };
    if can.contains(Capabilities::INTERSECT_PRIMITIVE) {
        table.intersect_triangle = Some(intersect_triangle::<A>);
        table.intersect_sphere = Some(intersect_sphere::<A>);
    }
    if can.contains(Capabilities::INTERSECT_BOX) {
        table.intersect_box = Some(intersect_box::<A>);
    }
    each_question! { PlainCore fill (table, can) }
    each_question! { PlainScene fill (table, can) }
    table
}

/// An argument that C has passed; none if it is no value of the contract.
trait Back<'a>: Given + Argument<'a> {
    /// SAFETY: `passed` is what the header says: a pointer to `count` elements, or to one struct.
    unsafe fn back<'b>(passed: Self::Passed, count: usize) -> Option<Self::Kept<'b>>;
}

impl<'a, T: crate::contract::crossing::Element> Back<'a> for &'a [T] {
    unsafe fn back<'b>(passed: *const T, count: usize) -> Option<&'b [T]> {
        // SAFETY: the caller's.
        Some(unsafe { slice::from_raw_parts(passed, count) })
    }
}

/// Structs that grow, and what they are.
macro_rules! structs {
    ($($type:ty = $of:path;)*) => { $(
        impl<'a> Back<'a> for $type {
            unsafe fn back<'b>(passed: Self::Passed, _: usize) -> Option<Self::Kept<'b>> {
                // SAFETY: the caller's.
                Some($of(&unsafe { read_grown(passed) }))
            }
        }
    )* };
}
structs! {
    &'a Camera = taken::camera;
    &'a IntegratorSettings = taken::integrator;
    AdaptiveSettings = taken::adaptive;
}

impl<'a> Back<'a> for &'a Material {
    unsafe fn back<'b>(passed: *const abi::Material, _: usize) -> Option<Self::Kept<'b>> {
        // SAFETY: the caller's.
        taken::material(unsafe { &*passed })
    }
}

impl Back<'_> for Sampler {
    unsafe fn back<'b>(passed: u32, _: usize) -> Option<Self::Kept<'b>> {
        taken::sampler(passed)
    }
}

impl Back<'_> for u32 {
    unsafe fn back<'b>(passed: u32, _: usize) -> Option<Self::Kept<'b>> {
        Some(passed)
    }
}

impl<'a> Back<'a> for Randomness<'a> {
    unsafe fn back<'b>(passed: *const abi::Randomness, count: usize) -> Option<Randomness<'b>> {
        // SAFETY: the caller's.
        unsafe {
            let abi::Randomness { points, lobes, seed } = *passed;
            let points = slice::from_raw_parts(points, count);
            Some(Randomness { points, lobes: slice::from_raw_parts(lobes, count), seed })
        }
    }
}

impl<'a> Back<'a> for &'a [&'a [f64]] {
    unsafe fn back<'b>(passed: *const abi::Stream, count: usize) -> Option<Vec<&'b [f64]>> {
        // SAFETY: the caller's.
        let streams = unsafe { slice::from_raw_parts(passed, count) };
        let one = |stream: &abi::Stream| {
            let length = usize::try_from(stream.count).ok()?;
            // SAFETY: the caller's.
            Some(unsafe { slice::from_raw_parts(stream.values, length) })
        };
        streams.iter().map(one).collect()
    }
}

/// As much of a struct as both sides know, and zeros.
///
/// SAFETY: `from` points to a struct of plain numbers and pointers that begins with its size.
pub(super) unsafe fn read_grown<T>(from: *const T) -> T {
    let mut copy = MaybeUninit::<T>::zeroed();
    // SAFETY: the caller's; all zeros are a value of such a struct.
    unsafe {
        let size = *from.cast::<u32>() as usize;
        ptr::copy_nonoverlapping(
            from.cast::<u8>(),
            copy.as_mut_ptr().cast(),
            size.min(size_of::<T>()),
        );
        copy.assume_init()
    }
}

/// What C is told.
pub(super) const fn status(answered: &Result<()>) -> Status {
    match answered {
        Ok(()) => abi::OK,
        Err(CoreError::Unsupported(_) | CoreError::Beyond(_)) => abi::UNSUPPORTED,
        Err(_) => abi::INVALID,
    }
}

/// What is told where an argument is no value of the contract.
pub(super) fn unknown() -> CoreError {
    CoreError::Refused("there is a number that furnace_core.h does not have".to_owned())
}

/// The functions of plain questions, to a core and to a scene that it has taken in.
macro_rules! answered {
    (($who:ident($($pointer:ident: $type:ty),*)) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> ();
    }) => {
        /// SAFETY: its own pointers; all else as the header says.
        unsafe extern "C" fn $method<A: Answerer>(
            $($pointer: $type,)*
            $($arg: <$ty as Given>::Passed,)*
            $out: *mut <$answer as Batch>::Foreign,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            unsafe {
                A::$who($($pointer,)* |asked| {
                    $(
                        let $arg = <$ty as Back<'_>>::back($arg, count).ok_or_else(unknown)?;
                        let $arg: $ty = Argument::lend(&$arg);
                    )*
                    asked.$method($($arg,)* slice::from_raw_parts_mut($out, count))
                })
            }
        }
    };
    // Traversals are written out below.
    ($with:tt $entry:tt) => {};
}
each_question! { PlainCore answered (core(this: *mut c_void)) }
each_question! { PlainScene answered (scene(this: *mut c_void, built: *mut abi::Built)) }

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect_triangle<A: Answerer>(
    this: *mut c_void,
    positions: *const DVec3,
    normals: *const DVec3,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> Status {
    // SAFETY: as above; the header gives a triangle three of each.
    unsafe {
        let [positions, normals] = [positions, normals].map(|of| *of.cast::<[DVec3; 3]>());
        primitive::<A>(this, &Primitive::Triangle { positions, normals }, rays, out, count)
    }
}

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect_sphere<A: Answerer>(
    this: *mut c_void,
    centre: *const DVec3,
    radius: f64,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> Status {
    // SAFETY: as above.
    unsafe {
        primitive::<A>(this, &Primitive::Sphere { centre: *centre, radius }, rays, out, count)
    }
}

/// SAFETY: as the functions above.
unsafe fn primitive<A: Answerer>(
    this: *mut c_void,
    primitive: &Primitive,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> Status {
    // SAFETY: as above.
    unsafe {
        let (rays, hits) = batch(rays, out, count);
        A::core(this, |asked| asked.intersect_primitive(primitive, rays, hits))
    }
}

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect_box<A: Answerer>(
    this: *mut c_void,
    min: *const DVec3,
    max: *const DVec3,
    rays: *const Ray,
    out: *mut BoxHit,
    count: usize,
) -> Status {
    // SAFETY: as above.
    unsafe {
        let (bounds, (rays, hits)) = (Aabb { min: *min, max: *max }, batch(rays, out, count));
        A::core(this, |asked| asked.intersect_box(&bounds, rays, hits))
    }
}

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect<A: Answerer>(
    this: *mut c_void,
    built: *mut abi::Built,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
    stats: *mut TraversalStats,
) -> Status {
    // SAFETY: as above.
    unsafe {
        let (rays, hits) = batch(rays, out, count);
        A::scene(this, built, |asked| asked.intersect(rays, hits).map(|took| *stats = took))
    }
}

/// SAFETY: as the functions above.
unsafe extern "C" fn occluded<A: Answerer>(
    this: *mut c_void,
    built: *mut abi::Built,
    rays: *const Ray,
    out: *mut u8,
    count: usize,
    stats: *mut TraversalStats,
) -> Status {
    // SAFETY: as above. Zeros are flags, whatever stood there.
    unsafe {
        out.write_bytes(0, count);
        let (rays, flags) = batch(rays, out.cast::<bool>(), count);
        A::scene(this, built, |asked| asked.occluded(rays, flags).map(|took| *stats = took))
    }
}

/// What is asked, and where the answers go.
///
/// SAFETY: as the functions above.
unsafe fn batch<'a, Q, A>(
    questions: *const Q,
    answers: *mut A,
    count: usize,
) -> (&'a [Q], &'a mut [A]) {
    // SAFETY: the caller's.
    unsafe { (slice::from_raw_parts(questions, count), slice::from_raw_parts_mut(answers, count)) }
}
