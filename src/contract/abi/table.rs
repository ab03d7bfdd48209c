//! The functions of a core, in the order of `furnace_core.h`: those of the table of questions, some with
//! arguments that C has in another form, and what comes before every question.

#![expect(missing_docs, reason = "the header documents the fields")]

use super::given::Given;
use super::{Build, Built, Camera as CameraInC, Conventions, Render, Scene, Status, Taken};
use crate::contract::BuildStats;
use crate::contract::answer::Batch;
use crate::contract::crossing::Layout;
use crate::contract::question::*;
use std::ffi::{c_char, c_void};
use std::mem::offset_of;

/// Functions whose arguments C has in another form than the table of questions.
macro_rules! functions {
    ($($name:ident($($argument:ident: $type:ty),*) $(-> $status:ty)?;)*) => {
        $(pub(crate) type $name =
            unsafe extern "C" fn(this: *mut c_void, $($argument: $type),*) $(-> $status)?;)*
    };
}
functions! {
    IntersectTriangle(
        positions: *const DVec3, normals: *const DVec3, rays: *const Ray, out: *mut Hit, count: usize
    ) -> Status;
    IntersectSphere(
        centre: *const DVec3, radius: f64, rays: *const Ray, out: *mut Hit, count: usize
    ) -> Status;
    IntersectBox(
        min: *const DVec3, max: *const DVec3, rays: *const Ray, out: *mut BoxHit, count: usize
    ) -> Status;
    BuildScene(
        scene: *const Scene, settings: *const Build, out: *mut *mut Built, stats: *mut BuildStats
    ) -> Status;
    Release(built: *mut Built);
    TakeComponents(components: *const Taken) -> Status;
    RenderPicture(
        built: *mut Built, camera: *const CameraInC, settings: *const Render,
        pixels: *mut [f32; 3], sample_counts: *mut u32
    ) -> Status;
}

/// The type of a function: of a plain one as the question is, with `self`, the scene, the answer and its length.
macro_rules! function {
    (Core plain {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> ();
    }) => {
        unsafe extern "C" fn(
            *mut c_void, $(<$ty as Given>::Passed,)* *mut <$answer as Batch>::Foreign, usize,
        ) -> Status
    };
    (Scene plain {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $($stats:ident)? $(())?;
    }) => {
        unsafe extern "C" fn(
            *mut c_void, *mut Built, $(<$ty as Given>::Passed,)*
            *mut <$answer as Batch>::Foreign, usize $(, *mut $stats)?
        ) -> Status
    };
    ($kind:ident $type:ident $entry:tt) => { $type };
}

macro_rules! core_table {
    (() $($kind:ident ($($c:ident: $type:ident),*) $entry:tt)*) => {
        core_table! {
            abi: u32,
            struct_size: u32,
            traits: u32,
            components: u32,
            conventions: Conventions,
            name: *const c_char,
            version: *const c_char,
            this: *mut c_void,
            last_error: Option<unsafe extern "C" fn(this: *mut c_void) -> *const c_char>,
            $($($c: Option<function!($kind $type $entry)>,)*)*
        }
    };
    ($($field:ident: $type:ty,)*) => {
        /// `furnace_core`: who the core is, and its functions. `None` is "not supported".
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        pub struct CoreTable {
            $(pub $field: $type),*
        }

        /// How that lies; C calls `this` `self`.
        pub const CORE: Layout = Layout {
            name: "furnace_core",
            size: size_of::<CoreTable>(),
            fields: &[$((stringify!($field), offset_of!(CoreTable, $field))),*],
        };
    };
}
questions! { core_table, () }
