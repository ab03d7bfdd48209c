//! The bench's own components, lent to a foreign core: the lesson of `textbook` as a table of functions in C.
//!
//! The table is that of every core, so that a core asks the bench as the bench asks it. Each function answers for
//! itself alone and may be called from any thread. Not here: what the lesson says, and what a core makes of it.
#![expect(unsafe_code, reason = "a foreign core calls back through C")]

use crate::contract::abi::given::{Given, struct_size};
use crate::contract::abi::{self, CoreTable, Status, taken};
use crate::contract::answer::Batch;
use crate::contract::argument::Argument;
use crate::contract::question::*;
use crate::contract::{Acceleration, BuiltScene, Conventions, Core};
use crate::cores::textbook::{Textbook, World, variant};
use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr;
use std::rc::Rc;
use std::slice;

/// A right core that follows the conventions of the foreign one. Both parts stay where they are: C points to them.
pub(super) struct Lent {
    textbook: Rc<Textbook>,
    table: Rc<CoreTable>,
}

impl Lent {
    /// For a core of these conventions.
    pub(super) fn new(conventions: Conventions) -> Self {
        let textbook = Rc::new(variant::following(conventions));
        let table = Rc::new(table_of(&textbook));
        Self { textbook, table }
    }

    /// Valid as long as `self`.
    pub(super) fn table(&self) -> *const CoreTable {
        Rc::as_ptr(&self.table)
    }

    /// The scene as the bench itself takes it in.
    pub(super) fn built(
        &self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Rc<World<'_>> {
        Rc::new(self.textbook.built(scene, acceleration))
    }
}

/// What the functions below are handed back; valid as long as the scene.
pub(super) fn built_pointer(world: &Rc<World<'_>>) -> *mut abi::Built {
    Rc::as_ptr(world).cast_mut().cast()
}

/// The function of a plain question takes its place.
macro_rules! fill {
    ($table:ident {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arguments:tt)*) -> $told:ty;
    }) => {
        $table.$method = Some($method);
    };
}

fn table_of(textbook: &Rc<Textbook>) -> CoreTable {
    let mut table = CoreTable {
        abi: abi::ABI,
        struct_size: struct_size::<CoreTable>(),
        conventions: abi::Conventions::default(),
        name: c"bench".as_ptr(),
        version: c"".as_ptr(),
        this: Rc::as_ptr(textbook).cast_mut().cast(),
        intersect_triangle: Some(intersect_triangle),
        intersect_sphere: Some(intersect_sphere),
        intersect_box: Some(intersect_box),
        // SAFETY: zeros are numbers, null pointers and functions that are not there.
        ..unsafe { std::mem::zeroed() }
    };
    each_question! { PlainCore fill table }
    each_question! { PlainScene fill table }
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
unsafe fn read_grown<T>(from: *const T) -> T {
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
fn status(answered: Result<()>) -> Status {
    match answered {
        Ok(()) => abi::OK,
        Err(CoreError::Unsupported(_) | CoreError::Beyond(_)) => abi::UNSUPPORTED,
        Err(_) => abi::INVALID,
    }
}

/// The functions of plain questions, to the lesson and to a scene that it has taken in.
macro_rules! lent {
    ((($($before:tt)*), $asked:ident, $of:ty) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> ();
    }) => {
        /// SAFETY: the bench's own pointers; all else as the header says.
        unsafe extern "C" fn $method(
            $($before)*
            $($arg: <$ty as Given>::Passed,)*
            $out: *mut <$answer as Batch>::Foreign,
            count: usize,
        ) -> Status {
            // SAFETY: as above.
            let (mut asked, $out) = unsafe {
                (&*$asked.cast::<$of>(), slice::from_raw_parts_mut($out, count))
            };
            $(
                // SAFETY: as above.
                let kept = unsafe { <$ty as Back<'_>>::back($arg, count) };
                let Some($arg) = kept else { return abi::INVALID };
                let $arg: $ty = Argument::lend(&$arg);
            )*
            status(asked.$method($($arg,)* $out))
        }
    };
    // Traversals are written out below.
    ($with:tt $entry:tt) => {};
}
each_question! { PlainCore lent ((bench: *mut c_void,), bench, Textbook) }
each_question! { PlainScene lent ((_bench: *mut c_void, built: *mut abi::Built,), built, World<'_>) }

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect_triangle(
    bench: *mut c_void,
    positions: *const DVec3,
    normals: *const DVec3,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> Status {
    // SAFETY: as above; the header gives a triangle three of each.
    unsafe {
        let [positions, normals] = [positions, normals].map(|of| *of.cast::<[DVec3; 3]>());
        primitive(bench, &Primitive::Triangle { positions, normals }, rays, out, count)
    }
}

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect_sphere(
    bench: *mut c_void,
    centre: *const DVec3,
    radius: f64,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> Status {
    // SAFETY: as above.
    unsafe { primitive(bench, &Primitive::Sphere { centre: *centre, radius }, rays, out, count) }
}

/// SAFETY: as the functions above.
unsafe fn primitive(
    bench: *mut c_void,
    primitive: &Primitive,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
) -> Status {
    // SAFETY: as above.
    let (mut bench, rays, out) = unsafe { batch::<Textbook, _, _>(bench, rays, out, count) };
    status(bench.intersect_primitive(primitive, rays, out))
}

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect_box(
    bench: *mut c_void,
    min: *const DVec3,
    max: *const DVec3,
    rays: *const Ray,
    out: *mut BoxHit,
    count: usize,
) -> Status {
    // SAFETY: as above.
    let (bounds, (mut bench, rays, out)) = unsafe {
        (Aabb { min: *min, max: *max }, batch::<Textbook, _, _>(bench, rays, out, count))
    };
    status(bench.intersect_box(&bounds, rays, out))
}

/// SAFETY: as the functions above.
unsafe extern "C" fn intersect(
    _bench: *mut c_void,
    built: *mut abi::Built,
    rays: *const Ray,
    out: *mut Hit,
    count: usize,
    stats: *mut TraversalStats,
) -> Status {
    // SAFETY: as above.
    let (mut built, rays, out) =
        unsafe { batch::<World<'_>, _, _>(built.cast(), rays, out, count) };
    // SAFETY: as above.
    status(built.intersect(rays, out).map(|took| unsafe { *stats = took }))
}

/// SAFETY: as the functions above.
unsafe extern "C" fn occluded(
    _bench: *mut c_void,
    built: *mut abi::Built,
    rays: *const Ray,
    out: *mut u8,
    count: usize,
    stats: *mut TraversalStats,
) -> Status {
    // SAFETY: as above.
    let (built, rays, out) = unsafe { batch::<World<'_>, _, _>(built.cast(), rays, out, count) };
    let mut took = TraversalStats { rays: count as u64, ..Default::default() };
    for (ray, out) in rays.iter().zip(out) {
        *out = built.any_hit(ray, &mut took).into();
    }
    // SAFETY: as above.
    unsafe { *stats = took };
    abi::OK
}

/// Who is asked, about what, and where the answers go.
///
/// SAFETY: as the functions above.
unsafe fn batch<'a, T, Q, A>(
    asked: *mut c_void,
    questions: *const Q,
    answers: *mut A,
    count: usize,
) -> (&'a T, &'a [Q], &'a mut [A]) {
    // SAFETY: the caller's.
    unsafe {
        let questions = slice::from_raw_parts(questions, count);
        (&*asked.cast(), questions, slice::from_raw_parts_mut(answers, count))
    }
}
