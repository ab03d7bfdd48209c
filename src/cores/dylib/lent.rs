//! The bench's own components, lent to a foreign core: the lesson of `textbook` as a table of functions in C.
//!
//! The table is that of every core, so that a core asks the bench as the bench asks it. Each function answers for
//! itself alone and may be called from any thread. Not here: what the lesson says, and what a core makes of it.
#![expect(unsafe_code, reason = "a foreign core calls back through C")]

use super::answering::{Answerer, status, table_of};
use crate::contract::abi::{self, CoreTable, Status};
use crate::contract::question::*;
use crate::contract::{Acceleration, BuiltScene, Conventions, Core};
use crate::cores::textbook::{Textbook, World, variant};
use std::ffi::c_void;
use std::rc::Rc;

/// A right core that follows the conventions of the foreign one. Both parts stay where they are: C points to them.
pub(super) struct Lent {
    textbook: Rc<Textbook>,
    table: Rc<CoreTable>,
}

impl Lent {
    /// For a core of these conventions.
    pub(super) fn new(conventions: Conventions) -> Self {
        let textbook = Rc::new(variant::following(conventions));
        let this = Rc::as_ptr(&textbook).cast_mut().cast();
        let table = table_of::<Self>(this, Capabilities::all());
        let named = CoreTable { name: c"bench".as_ptr(), version: c"".as_ptr(), ..table };
        Self { textbook, table: Rc::new(named) }
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

/// Nothing changes by being asked.
impl Answerer for Lent {
    unsafe fn core(this: *mut c_void, ask: impl FnOnce(&mut dyn Core) -> Result<()>) -> Status {
        // SAFETY: the caller's.
        let mut textbook = unsafe { &*this.cast::<Textbook>() };
        status(&ask(&mut textbook))
    }

    unsafe fn scene(
        _this: *mut c_void,
        built: *mut abi::Built,
        ask: impl FnOnce(&mut dyn BuiltScene) -> Result<()>,
    ) -> Status {
        // SAFETY: the caller's.
        let mut world = unsafe { &*built.cast::<World<'_>>() };
        status(&ask(&mut world))
    }
}
