//! A core that is asked beside a right one, for a look at single answers: which of them differ, and one of them alone.
//!
//! [`Beside`] stands in the place of a core. Where it compares, both are asked everything, and each question is noted with
//! what differs. Where it asks for one element, the right one answers all else, so that a debugger stops in that one.
//! Not here: whether what differs is wrong. Random answers differ anyway, and are noted without that.

use super::question::*;
use super::{Acceleration, BuildStats, Built, BuiltScene, Components, Core, CoreInfo};
use std::borrow::{Borrow, BorrowMut};
use std::fmt::Debug;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Relative to the larger of two numbers, and to 1: what single precision leaves of long ways.
const ALIKE: f64 = 1e-4;
/// Elements that differ and are kept of a question.
const KEPT: usize = 3;

/// One element of one question, both counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Which {
    pub(crate) question: usize,
    pub(crate) element: usize,
}

/// A question, and what came of it.
#[derive(Clone, Debug)]
pub(crate) struct Note {
    /// The method of [`Core`] or [`BuiltScene`].
    pub(crate) method: &'static str,
    /// Functions of `furnace_core.h` that answer it.
    pub(crate) in_c: &'static [&'static str],
    pub(crate) count: usize,
    /// How many differ; none where answers are random or the core's own to choose.
    pub(crate) differing: Option<usize>,
    /// Of those the first, or else the first of all.
    pub(crate) shown: Vec<Shown>,
    /// Why the core gave no answer.
    pub(crate) error: Option<CoreError>,
}

/// One element: what was asked, what is answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Shown {
    pub(crate) index: usize,
    /// Each argument with its name.
    pub(crate) asked: Vec<(&'static str, String)>,
    pub(crate) yours: String,
    pub(crate) right: String,
}

/// What was asked so far, shared with the scenes that were built.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes(Arc<Mutex<Vec<Note>>>);

impl Notes {
    pub(crate) fn lock(&self) -> MutexGuard<'_, Vec<Note>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A core and a right one beside it.
pub(crate) struct Beside<'a> {
    pub(crate) core: &'a mut dyn Core,
    pub(crate) right: &'a mut dyn Core,
    pub(crate) notes: Notes,
    /// The one element that the core is asked for.
    pub(crate) alone: Option<Which>,
}

struct SceneBeside<'a> {
    core: Built<'a>,
    right: Built<'a>,
    notes: Notes,
    alone: Option<Which>,
}

/// What stands in the way after the one element was asked for.
fn done() -> CoreError {
    CoreError::Beyond("all but the one element that was asked for".to_owned())
}

macro_rules! beside {
    (() {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            let number = self.notes.lock().len();
            let mut right = ToOwned::to_owned(&*$out);
            let told = self.right.$method($($arg,)* right.borrow_mut());
            let note = Note::of(stringify!($method), Elements::count(&*$out));
            let asked = |index| vec![$((stringify!($arg), Asked::in_words($arg, index))),*];
            let right: &$answer = right.borrow();
            if let Some(Which { question, element }) = self.alone {
                if question != number || element >= note.count {
                    self.notes.lock().push(note);
                    $out.take(right);
                    return told;
                }
                let range = element..element + 1;
                let answer = $out.of(&range);
                let result = self.core.$method($(Asked::part($arg, &range),)* answer);
                let shown = Shown {
                    index: element,
                    asked: asked(element),
                    yours: $out.show(element),
                    right: right.show(element),
                };
                let differs = is_fixed(stringify!($method)).then(|| $out.differs(right, element));
                let (differing, shown) = (differs.map(usize::from), vec![shown]);
                let note = Note { count: 1, differing, shown, error: result.err(), ..note };
                self.notes.lock().push(note);
                return Err(done());
            }
            let result = self.core.$method($($arg,)* &mut *$out);
            let error = result.as_ref().err().cloned();
            let shown = |index: usize| Shown {
                index,
                asked: asked(index),
                yours: $out.show(index),
                right: right.show(index),
            };
            // A right core that cannot be asked is no measure.
            let is_fixed = told.is_ok() && error.is_none() && is_fixed(stringify!($method));
            let differing: Vec<_> = match is_fixed {
                true => (0..note.count).filter(|index| $out.differs(right, *index)).collect(),
                false => Vec::new(),
            };
            let first: Vec<_> = match (&error, differing.is_empty()) {
                (Some(CoreError::Crashed { element: Some(culprit), .. }), _) => vec![culprit.index],
                (_, false) => differing.iter().copied().take(KEPT).collect(),
                (_, true) => (0..note.count.min(1)).collect(),
            };
            let shown = first.into_iter().map(shown).collect();
            let differing = is_fixed.then_some(differing.len());
            self.notes.lock().push(Note { shown, differing, error, ..note });
            result
        }
    };
}

/// Whether right cores give the same answers.
fn is_fixed(method: &str) -> bool {
    !method.starts_with("sample") && !["radiance", "render", "render_codes"].contains(&method)
}

impl Note {
    fn of(method: &'static str, count: usize) -> Self {
        let question = QUESTIONS.iter().find(|it| it.method == method);
        let in_c = question.map_or(&[][..], |question| question.in_c);
        Self { method, in_c, count, differing: None, shown: Vec::new(), error: None }
    }
}

impl Core for Beside<'_> {
    fn info(&self) -> CoreInfo {
        self.core.info()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        self.core.take_components(components)
    }

    each_question! { Core beside () }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        let core = self.core.build_scene(scene, how)?;
        let right = self.right.build_scene(scene, how)?;
        let (notes, alone) = (self.notes.clone(), self.alone);
        Ok(Box::new(SceneBeside { core, right, notes, alone }))
    }
}

impl BuiltScene for SceneBeside<'_> {
    fn stats(&self) -> BuildStats {
        self.core.stats()
    }

    each_question! { Scene beside () }
}

/// Without the names of our types of vectors: they are not the reader's.
fn plain(value: impl Debug) -> String {
    format!("{value:?}").replace("DVec3(", "(").replace("DVec2(", "(")
}

/// What a question is asked with, an element at a time.
trait Asked: Sized {
    fn in_words(self, index: usize) -> String;

    /// Only this part of a batch.
    fn part(self, _: &Range<usize>) -> Self {
        self
    }
}

impl<T: Debug> Asked for &[T] {
    fn in_words(self, index: usize) -> String {
        self.get(index).map_or_else(String::new, plain)
    }

    fn part(self, range: &Range<usize>) -> Self {
        &self[range.clone()]
    }
}

impl Asked for Randomness<'_> {
    fn in_words(self, index: usize) -> String {
        let Self { points, lobes, seed } = self;
        format!("{:?}, lobe {:?}, seed {seed}", points.get(index), lobes.get(index))
    }

    fn part(self, range: &Range<usize>) -> Self {
        Self { points: &self.points[range.clone()], lobes: &self.lobes[range.clone()], ..self }
    }
}

/// The same for all elements.
macro_rules! shared {
    ($($of:ty),*) => { $(
        impl Asked for $of {
            fn in_words(self, _: usize) -> String {
                plain(&self)
            }
        }
    )* };
}
shared! {
    u32, Sampler, AdaptiveSettings, &Camera, &Primitive, &Material, &Aabb, &IntegratorSettings,
    &RenderSettings
}

/// What a question fills, an element at a time; a picture is one.
trait Elements {
    fn count(&self) -> usize;

    /// The part of the answer that a part of the batch fills.
    fn of(&mut self, range: &Range<usize>) -> &mut Self;

    fn take(&mut self, other: &Self);

    fn show(&self, index: usize) -> String;

    fn differs(&self, other: &Self, index: usize) -> bool;
}

impl<T: Element> Elements for [T] {
    fn count(&self) -> usize {
        self.len()
    }

    fn of(&mut self, range: &Range<usize>) -> &mut Self {
        &mut self[range.clone()]
    }

    fn take(&mut self, other: &Self) {
        self.copy_from_slice(other);
    }

    fn show(&self, index: usize) -> String {
        self[index].show()
    }

    fn differs(&self, other: &Self, index: usize) -> bool {
        self[index].differs(&other[index])
    }
}

macro_rules! picture {
    ($($of:ty),*) => { $(
        impl Elements for $of {
            fn count(&self) -> usize {
                1
            }

            fn of(&mut self, _: &Range<usize>) -> &mut Self {
                self
            }

            fn take(&mut self, other: &Self) {
                self.clone_from(other);
            }

            fn show(&self, _: usize) -> String {
                format!("an image of {} × {} pixels", self.width, self.height)
            }

            fn differs(&self, _: &Self, _: usize) -> bool {
                false
            }
        }
    )* };
}
picture! { Film, Picture }

/// One answer.
trait Element: Copy {
    fn show(&self) -> String;

    fn differs(&self, other: &Self) -> bool;
}

/// Whether two numbers are farther apart than single precision explains; NaN differs from all.
fn apart(a: f64, b: f64) -> bool {
    // Infinities of one sign are alike, and their difference is NaN.
    !(a == b || (a - b).abs() <= ALIKE * a.abs().max(b.abs()).max(1.0))
}

fn apart_in(a: DVec3, b: DVec3) -> bool {
    (0..3).any(|axis| apart(a[axis], b[axis]))
}

/// How answers are shown, and which of their numbers are compared.
macro_rules! elements {
    ($($of:ty: |$a:ident, $b:ident| $differs:expr, $show:expr;)*) => { $(
        impl Element for $of {
            fn show(&self) -> String {
                let $a = self;
                $show
            }

            fn differs(&self, other: &Self) -> bool {
                let ($a, $b) = (self, other);
                $differs
            }
        }
    )* };
}
elements! {
    bool: |a, b| a != b, a.to_string();
    f64: |a, b| apart(*a, *b), a.to_string();
    [f64; 3]: |a, b| (0..3).any(|c| apart(a[c], b[c])), format!("{a:?}");
    Ray: |a, b| apart_in(a.origin, b.origin) || apart_in(a.direction, b.direction)
        || apart(a.t_min, b.t_min) || apart(a.t_max, b.t_max),
        format!("from {} toward {}, t from {} to {}", a.origin, a.direction, a.t_min, a.t_max);
    Hit: |a, b| a.is_hit() != b.is_hit() || a.is_hit() && (apart(a.t, b.t)
        || apart_in(a.geometric_normal, b.geometric_normal)
        || apart_in(a.shading_normal, b.shading_normal)),
        if a.is_hit() {
            let (shape, primitive) = (a.shape, a.primitive);
            let normals = format!("normals {} {}", a.geometric_normal, a.shading_normal);
            format!("t = {}, shape {shape}, primitive {primitive}, {normals}", a.t)
        } else {
            "a miss".to_owned()
        };
    BoxHit: |a, b| a.hit != b.hit
        || a.hit == 1 && (apart(a.t_enter, b.t_enter) || apart(a.t_exit, b.t_exit)),
        if a.hit == 0 { "a miss".to_owned() } else { format!("t from {} to {}", a.t_enter, a.t_exit) };
    DirectionSample: |a, b| apart(a.pdf, b.pdf), format!("{}, pdf {}", a.direction, a.pdf);
    BsdfValue: |a, b| apart(a.pdf, b.pdf) || (0..3).any(|c| apart(a.f[c], b.f[c])),
        format!("f {:?}, pdf {}", a.f, a.pdf);
    BsdfSample: |a, b| apart(a.pdf, b.pdf),
        format!("wi {}, f {:?}, pdf {}, delta {}, valid {}", a.wi, a.f, a.pdf, a.is_delta, a.is_valid);
    LightSample: |a, b| apart(a.pdf, b.pdf),
        format!("wi {}, distance {}, radiance {:?}, pdf {}, delta {}, valid {}", a.wi, a.distance,
            a.radiance, a.pdf, a.is_delta, a.is_valid);
    AdaptiveMean: |a, b| apart(a.mean, b.mean) || a.used != b.used,
        format!("mean {}, {} samples", a.mean, a.used);
}
