//! A core that is a shared library, called through the table of `include/furnace_core.h`.
//!
//! One of the files with `unsafe`: everything that follows a foreign pointer is here, in `lent`, through which the core
//! asks back, or in what that shares (`answering`) with a core of this side that is a library itself (`export`). A
//! library can do anything to the process it is loaded into, so a run loads it in a worker process (`cores::remote`) and
//! never beside its own results. Not here: what the answers are worth (`contract::validate`), and
//! what happens if none comes (`worker`).
#![expect(unsafe_code, reason = "a shared library is called through C")]

mod answering;
mod counted;
mod declaration;
mod export;
mod lent;

pub use export::exported;

use crate::contract::abi::given::{self, Given, SceneTables, struct_size};
use crate::contract::abi::{self, CoreTable, Traits};
use crate::contract::answer::Batch;
use crate::contract::question::*;
use crate::contract::{
    Acceleration, BuildStats, Built, BuiltScene, Components, Core, CoreInfo, Precision, Split,
};
use crate::cores::textbook::World;
use counted::{Answers, CountedScene};
use lent::Lent;
use libloading::Library;
use std::ffi::{CStr, c_char, c_void};
use std::mem::{MaybeUninit, offset_of};
use std::path::{Path, PathBuf};
use std::ptr::{self, NonNull};
use std::rc::Rc;

/// Why a library is no core.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The system's loader refuses.
    #[error("cannot load {path}: {why}")]
    Library {
        /// The file.
        path: PathBuf,
        /// What the loader says.
        why: String,
    },
    /// It does not export the one symbol.
    #[error("{0} exports no `{entry}`; does it end with FURNACE_CORE(...), or furnace::export_core!(...)?", entry = abi::ENTRY)]
    NoEntry(PathBuf),
    /// It answered no table.
    #[error("{0} does not support version {abi} of furnace_core.h", abi = abi::ABI)]
    Declined(PathBuf),
    /// It was compiled against another version of the header.
    #[error("{path} was compiled with version {found} of furnace_core.h, this is version {abi}: compile it again", abi = abi::ABI)]
    OtherAbi {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// It is a program, which is started and not loaded.
    #[error("`{0}` is a program: it runs in a worker, and cannot be loaded")]
    IsProgram(String),
    /// Its table says something that cannot be.
    #[error("{path} returns an invalid function table: {what}")]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
}

/// A table larger than this is a lie: a pointer for every function that anybody will ever append.
const LARGEST_TABLE: usize = 1 << 16;

/// A core in a shared library.
pub struct Dylib {
    table: CoreTable,
    info: CoreInfo,
    /// What it has taken from the bench, and the bench's own, lent to it from then on.
    taken: Components,
    lent: Option<Lent>,
    /// The code behind the table, where it is foreign.
    _library: Option<Library>,
}

// SAFETY: the boundary allows one call at a time and says nothing about which thread calls, so a core may not rely
// on one. `&mut self` sees to the one call.
unsafe impl Send for Dylib {}

/// Lets a fault inside foreign code end the process, as it would without us. Rust installs a handler that tells
/// stack overflows apart; a fault that a core *raises* returns through it and is forgotten.
pub(crate) fn let_faults_kill() {
    #[cfg(unix)]
    for signal in [libc::SIGSEGV, libc::SIGBUS] {
        // SAFETY: SIG_DFL is a valid disposition, and nothing of ours relies on the handler that is replaced.
        unsafe { libc::signal(signal, libc::SIG_DFL) };
    }
}

impl Dylib {
    /// Loads the library at `path` and asks it for its table. Its initialisers run.
    ///
    /// # Errors
    /// If it is no library, or no core of this version.
    pub fn load(path: &Path) -> std::result::Result<Self, LoadError> {
        // SAFETY: nothing can be known of a foreign library; that is why it is loaded in a worker.
        let library = unsafe { Library::new(path) }.map_err(|error| LoadError::Library {
            path: path.to_owned(),
            why: error.to_string(),
        })?;
        // SAFETY: the header gives this symbol this type.
        let entry = unsafe { library.get::<abi::Entry>(abi::ENTRY) }
            .map_err(|_| LoadError::NoEntry(path.to_owned()))?;
        // SAFETY: as above.
        let table = unsafe { entry(abi::ABI) };
        Self::of(path, table, Some(library))
    }

    /// The core behind a table.
    fn of(
        path: &Path,
        table: *const CoreTable,
        library: Option<Library>,
    ) -> std::result::Result<Self, LoadError> {
        let table = read_table(path, table)?;
        let info = core_info(path, &table)?;
        Ok(Self { table, info, taken: Components::empty(), lent: None, _library: library })
    }

    /// What a call came to.
    fn answered(&self, wanted: Capabilities, status: abi::Status) -> Result<()> {
        match status {
            abi::OK => Ok(()),
            abi::UNSUPPORTED => Err(match self.reason() {
                Some(reason) if !reason.is_empty() => CoreError::Beyond(reason),
                _ => CoreError::Unsupported(wanted),
            }),
            abi::INVALID | abi::FAILED => Err(CoreError::Refused(self.last_error())),
            other => {
                Err(CoreError::breach(format!("unknown status {other}: not in furnace_core.h")))
            }
        }
    }

    fn last_error(&self) -> String {
        self.reason().unwrap_or_else(|| "no reason given (no last_error)".to_owned())
    }

    /// In the core's own words, if it has any.
    fn reason(&self) -> Option<String> {
        let last_error = self.table.last_error?;
        // SAFETY: the header gives the function this type.
        text(unsafe { last_error(self.table.this) })
    }

    /// The table of counted tests that a core with that trait is handed.
    fn counted_tests(&self, scene: &SceneDescription, how: Acceleration) -> Option<CountedTests> {
        let traits = Traits::from_bits_truncate(self.table.traits);
        let takes = traits.contains(Traits::COUNTED_TESTS)
            && (how.is_counted() || !traits.contains(Traits::OWN_TESTS));
        takes.then(|| CountedTests::new(scene))
    }

    /// The scene as the bench takes it in, for a core that has taken anything from it.
    fn bench_scene(&self, scene: &SceneDescription, how: Acceleration) -> Option<Rc<World<'_>>> {
        let lent = self.lent.as_ref().filter(|_| !self.taken.is_empty());
        lent.map(|lent| lent.built(scene, how))
    }

    /// Whether the core declares what an ordinary BVH request does not need.
    fn can_build(&self, acceleration: Acceleration) -> Result<()> {
        let needed = match acceleration {
            Acceleration::BruteForce => Capabilities::BRUTE_FORCE,
            Acceleration::Bvh { split: Split::CoresChoice, .. } => Capabilities::BUILD_SCENE,
            Acceleration::Bvh { .. } => Capabilities::SPLIT_RULES,
        };
        if self.info.capabilities.contains(needed) {
            Ok(())
        } else {
            Err(CoreError::Unsupported(needed))
        }
    }
}

/// Copies as much of a core's table as both sides know.
fn read_table(path: &Path, table: *const CoreTable) -> std::result::Result<CoreTable, LoadError> {
    let malformed = |what: String| LoadError::Malformed { path: path.to_owned(), what };
    let Some(table) = NonNull::new(table.cast_mut()) else {
        return Err(LoadError::Declined(path.to_owned()));
    };
    if !table.is_aligned() {
        return Err(malformed("it is not aligned".to_owned()));
    }
    // SAFETY: a core that answers a table answers at least these two numbers.
    let (abi, size) = unsafe { ((*table.as_ptr()).abi, (*table.as_ptr()).struct_size as usize) };
    if abi != abi::ABI {
        return Err(LoadError::OtherAbi { path: path.to_owned(), found: abi });
    }
    let smallest = offset_of!(CoreTable, generate_rays);
    if !(smallest..=LARGEST_TABLE).contains(&size) || !size.is_multiple_of(8) {
        return Err(malformed(format!("struct_size is {size}")));
    }
    let mut copy = MaybeUninit::<CoreTable>::zeroed();
    let known = size.min(size_of::<CoreTable>());
    // SAFETY: the core says that `size` bytes are there. All zeros are a table of nulls, so a copy that ends early
    // is a table whose last functions are not supported.
    unsafe {
        ptr::copy_nonoverlapping(table.as_ptr().cast::<u8>(), copy.as_mut_ptr().cast(), known);
        Ok(copy.assume_init())
    }
}

fn core_info(path: &Path, table: &CoreTable) -> std::result::Result<CoreInfo, LoadError> {
    let conventions = declaration::conventions(&table.conventions).ok_or_else(|| {
        let what = "it declares an unknown convention: not in furnace_core.h".to_owned();
        LoadError::Malformed { path: path.to_owned(), what }
    })?;
    let traits = Traits::from_bits_truncate(table.traits);
    let single = traits.contains(Traits::SINGLE_PRECISION);
    Ok(CoreInfo {
        name: text(table.name).unwrap_or_else(|| "(no name)".to_owned()),
        version: text(table.version).unwrap_or_else(|| "(no version)".to_owned()),
        capabilities: declaration::capabilities(table),
        components: match table.take_components {
            Some(_) => Components::from_bits_truncate(table.components),
            None => Components::empty(),
        },
        precision: if single { Precision::Single } else { Precision::Double },
        conventions,
    })
}

/// A C string, if there is one.
fn text(characters: *const c_char) -> Option<String> {
    // SAFETY: the header asks for a string that ends.
    (!characters.is_null())
        .then(|| unsafe { CStr::from_ptr(characters) }.to_string_lossy().into_owned())
}

/// Calls a function of the table if it is there: `ask!(core, GENERATE_RAYS, generate_rays(arguments...))`.
macro_rules! ask {
    ($core:expr, $capability:ident, $function:ident($($argument:expr),* $(,)?)) => {{
        let core = $core;
        let Some(function) = core.table.$function else {
            return Err(CoreError::Unsupported(Capabilities::$capability));
        };
        // SAFETY: the header gives the function this type; every pointer is valid for the call, and every slice is
        // as long as the count that goes with it, which `Given::lent` has checked.
        let status = unsafe { function(core.table.this, $($argument),*) };
        core.answered(Capabilities::$capability, status)
    }};
}

/// Calls the function of a question that C is asked with the same arguments; of a scene with that before them, and of a
/// traversal with its counts after them.
macro_rules! called {
    (($($core:ident)?; $($built:ident)?) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> ();
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<()> {
            let count = $out.len();
            $(let $arg = $arg.lent(count);)*
            $out.receive_batch(|out| {
                ask!(self$(.$core)?, $can, $method(
                    $(self.$built.as_ptr(),)? $(<$ty as Given>::passed(&$arg),)* out.as_mut_ptr(), count
                ))
            })
        }
    };
    ($of:tt {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> TraversalStats;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<TraversalStats> {
            let count = $out.len();
            let mut stats = TraversalStats::default();
            $(let $arg = $arg.lent(count);)*
            $out.receive_batch(|out| {
                let (built, out, stats) = (self.built.as_ptr(), out.as_mut_ptr(), &raw mut stats);
                ask!(self.core, $can, $method(
                    built, $(<$ty as Given>::passed(&$arg),)* out, count, stats
                ))
            })?;
            self.counts(stats, $out)
        }
    };
}

impl Core for Dylib {
    fn info(&self) -> CoreInfo {
        self.info.clone()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        let lent = self.lent.get_or_insert_with(|| Lent::new(self.info.conventions));
        let taken = abi::Taken {
            struct_size: struct_size::<abi::Taken>(),
            taken: components.bits(),
            bench: lent.table(),
        };
        self.taken = components;
        let Some(take) = self.table.take_components else {
            return Err(CoreError::Unsupported(Capabilities::empty()));
        };
        // SAFETY: the header gives the function this type; what it is handed lives as long as the core.
        let status = unsafe { take(self.table.this, &raw const taken) };
        self.answered(Capabilities::empty(), status)
    }

    each_question! { PlainCore called (;) }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        let count = hits.len();
        let (rays, out) = (rays.lent(count), hits.as_mut_ptr());
        match primitive {
            Primitive::Triangle { positions, normals } => {
                let (positions, normals) = (positions.as_ptr(), normals.as_ptr());
                ask!(
                    self,
                    INTERSECT_PRIMITIVE,
                    intersect_triangle(positions, normals, rays, out, count)
                )
            }
            Primitive::Sphere { centre, radius } => {
                let centre = ptr::from_ref(centre);
                ask!(self, INTERSECT_PRIMITIVE, intersect_sphere(centre, *radius, rays, out, count))
            }
        }
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        let count = hits.len();
        let (min, max) = (ptr::from_ref(&bounds.min), ptr::from_ref(&bounds.max));
        let (rays, out) = (rays.lent(count), hits.as_mut_ptr());
        ask!(self, INTERSECT_BOX, intersect_box(min, max, rays, out, count))
    }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        self.can_build(how)?;
        let counted = self.counted_tests(scene, how);
        let bench = self.bench_scene(scene, how);
        let settings = given::build(
            how,
            counted.as_ref().map_or(ptr::null(), |counted| Rc::as_ptr(&counted.table)),
            bench.as_ref().map_or(ptr::null_mut(), lent::built_pointer),
        );
        let tables = SceneTables::new(scene);
        let scene = tables.as_abi();
        let (mut built, mut stats) = (ptr::null_mut(), BuildStats::default());
        let out = &raw mut built;
        ask!(
            &*self,
            BUILD_SCENE,
            build(&raw const scene, &raw const settings, out, &raw mut stats)
        )?;
        let built = NonNull::new(built)
            .ok_or_else(|| CoreError::breach("build returned FURNACE_OK without a scene"))?;
        Ok(Box::new(BuiltDylib { core: self, built, stats, counted, _bench: bench }))
    }
}

/// A scene that a library has taken in.
struct BuiltDylib<'a> {
    core: &'a Dylib,
    built: NonNull<abi::Built>,
    stats: BuildStats,
    /// What the library was lent to count with; outlives what it built.
    counted: Option<CountedTests>,
    /// The same scene of the bench's own, lent as well.
    _bench: Option<Rc<World<'a>>>,
}

/// The bench's ray tests of a scene, and the table through which a core calls them. C points to both.
struct CountedTests {
    scene: Rc<CountedScene>,
    table: Rc<abi::CountedTests>,
}

impl CountedTests {
    fn new(scene: &SceneDescription) -> Self {
        let scene = Rc::new(CountedScene::new(scene));
        Self { table: Rc::new(tests_of(&scene)), scene }
    }
}

impl Drop for BuiltDylib<'_> {
    fn drop(&mut self) {
        if let Some(release) = self.core.table.release {
            // SAFETY: the header gives the function this type, and nobody uses the scene afterwards.
            unsafe { release(self.core.table.this, self.built.as_ptr()) };
        }
    }
}

impl BuiltDylib<'_> {
    /// The bench's own counts where the core was lent its tests, the core's word otherwise: also of one that answers by
    /// other components of the bench, which count nothing.
    fn counts<T>(&self, reported: TraversalStats, answers: &[T]) -> Result<TraversalStats>
    where
        [T]: Answers,
    {
        match &self.counted {
            Some(counted) if self.core.taken.is_empty() || counted.scene.has_counted() => {
                counted.scene.take_counts(answers, answers.len())
            }
            _ => Ok(reported),
        }
    }
}

impl BuiltScene for BuiltDylib<'_> {
    fn stats(&self) -> BuildStats {
        self.stats
    }

    each_question! { PlainScene called (core; built) }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        let count = settings.width as usize * settings.height as usize;
        assert_eq!([film.pixels.len(), film.sample_counts.len()], [count; 2], "of that size");
        if !self.core.info.capabilities.contains(Capabilities::ADAPTIVE_SAMPLING) {
            film.sample_counts.fill(settings.samples_per_pixel);
        }
        let camera = camera.lent(1);
        let integrator = settings.integrator.lent(1);
        let adaptive = settings.adaptive.map(|adaptive| adaptive.lent(1));
        let mut settings = given::render(settings, &integrator, adaptive.as_ref());
        if self.core.info.capabilities.contains(Capabilities::REPORTED_VARIANCE) {
            assert_eq!(film.variances.len(), count, "of that size");
            settings.variances = film.variances.as_mut_ptr();
        }
        let (built, camera, settings) =
            (self.built.as_ptr(), &raw const camera, &raw const settings);
        let (pixels, sample_counts) = (film.pixels.as_mut_ptr(), film.sample_counts.as_mut_ptr());
        ask!(self.core, RENDER, render(built, camera, settings, pixels, sample_counts))
    }
}

fn tests_of(scene: &Rc<CountedScene>) -> abi::CountedTests {
    abi::CountedTests {
        struct_size: struct_size::<abi::CountedTests>(),
        reserved: 0,
        bench: Rc::as_ptr(scene).cast_mut().cast(),
        primitive: counted_primitive,
        r#box: counted_box,
    }
}

/// SAFETY: `bench` is what [`tests_of`] put there and lives as long as the built scene; `ray` and `hit` are the
/// core's, valid by the header.
unsafe extern "C" fn counted_primitive(
    bench: *mut c_void,
    shape: u32,
    primitive: u32,
    ray: *const Ray,
    hit: *mut Hit,
) -> u32 {
    // SAFETY: as above.
    let (scene, ray) = unsafe { (&*bench.cast::<CountedScene>(), &*ray) };
    let Some(found) = scene.hit_primitive(shape, primitive, ray) else { return 0 };
    // SAFETY: as above.
    unsafe { hit.write(found) };
    1
}

/// SAFETY: as [`counted_primitive`].
unsafe extern "C" fn counted_box(
    bench: *mut c_void,
    min: *const DVec3,
    max: *const DVec3,
    ray: *const Ray,
    hit: *mut BoxHit,
) -> u32 {
    // SAFETY: as above.
    let (scene, min, max, ray) = unsafe { (&*bench.cast::<CountedScene>(), *min, *max, &*ray) };
    let Some(found) = scene.hit_box(min, max, ray) else { return 0 };
    // SAFETY: as above.
    unsafe { hit.write(found) };
    1
}
