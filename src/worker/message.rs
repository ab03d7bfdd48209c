//! What headers say: requests to a core and its answers, and the arrays that go with them.
//!
//! A request is one call of [`crate::contract`], an answer what came of it. `docs/protocol.md` is
//! this file for people who write a core in another language; a test holds the two together.

use super::confine::Confinement;
use super::frame::{self, FrameError};
use crate::contract::{
    Acceleration, AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue,
    BuildStats, Capabilities, Conventions, CoreError, CoreInfo, DirectionSample, Hit,
    IntegratorSettings, LightSample, Precision, Ray, RenderSettings, Sampler, TraversalStats,
};
use crate::image::encoding::Encoding;
use crate::scene::{Camera, Light, Material};
use bytemuck::Pod;
use glam::{DVec2, DVec3};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::time::Duration;

/// What a core is asked. The comments say which arrays go along, and which come back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "request", rename_all = "kebab-case", rename_all_fields = "kebab-case")]
pub enum Request {
    /// Who are you? → [`Answer::Core`]
    Hello,
    /// `film` → `rays`
    GenerateRays {
        /// Through which.
        camera: Camera,
    },
    /// `positions`, `normals` (three each), `rays` → `hits`
    IntersectTriangle,
    /// `spheres` (one), `rays` → `hits`
    IntersectSphere,
    /// `bounds` (smallest and largest coordinates), `rays` → `box-hits`
    IntersectBox,
    /// `points`, `lobes` → `samples`
    SampleDirection {
        /// Which.
        sampler: Sampler,
        /// For a core that draws its own numbers.
        seed: u64,
    },
    /// `directions` → `pdf`
    DirectionPdf {
        /// Which.
        sampler: Sampler,
    },
    /// `queries` → `values`
    EvalBsdf {
        /// Of which.
        material: Material,
    },
    /// `wo`, `points`, `lobes` → `samples`
    SampleBsdf {
        /// Of which.
        material: Material,
        /// For a core that draws its own numbers.
        seed: u64,
    },
    /// `values` (all streams, one after another), `lengths` (of each) → `means`
    AdaptiveMean {
        /// The rule.
        #[serde(flatten)]
        settings: AdaptiveSettings,
    },
    /// `positions`, `normals`, `indices`, `spheres`, `sphere-kinds` → [`Answer::Built`]
    Build {
        /// What the arrays do not say of the scene.
        scene: SceneHeader,
        /// How to build.
        acceleration: Acceleration,
    },
    /// Forget the scene.
    Release,
    /// `rays` → `hits`, [`Answer::Traced`]
    Intersect,
    /// `rays` → `occluded`, [`Answer::Traced`]
    Occluded,
    /// `from`, `points`, `lobes` → `samples`
    SampleLight {
        /// Number of the light.
        light: u32,
        /// For a core that draws its own numbers.
        seed: u64,
    },
    /// `rays` → `radiance`
    Radiance {
        /// How paths are traced.
        settings: IntegratorSettings,
    },
    /// → `pixels`, `sample-counts`, and `variances` of a core that reports them
    Render {
        /// From where.
        camera: Camera,
        /// How.
        settings: RenderSettings,
    },
    /// → `codes`, [`Answer::Coded`]
    RenderCodes {
        /// From where.
        camera: Camera,
        /// How.
        settings: RenderSettings,
    },
}

impl Request {
    /// What it is called, for messages.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Hello => "hello",
            Self::GenerateRays { .. } => "generate-rays",
            Self::IntersectTriangle => "intersect-triangle",
            Self::IntersectSphere => "intersect-sphere",
            Self::IntersectBox => "intersect-box",
            Self::SampleDirection { .. } => "sample-direction",
            Self::DirectionPdf { .. } => "direction-pdf",
            Self::EvalBsdf { .. } => "eval-bsdf",
            Self::SampleBsdf { .. } => "sample-bsdf",
            Self::AdaptiveMean { .. } => "adaptive-mean",
            Self::Build { .. } => "build",
            Self::Release => "release",
            Self::Intersect => "intersect",
            Self::Occluded => "occluded",
            Self::SampleLight { .. } => "sample-light",
            Self::Radiance { .. } => "radiance",
            Self::Render { .. } => "render",
            Self::RenderCodes { .. } => "render-codes",
        }
    }
}

/// A scene without its long lists.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct SceneHeader {
    /// As its file calls it.
    pub name: String,
    /// Where pictures are taken from, if the scene says so.
    pub camera: Option<Camera>,
    /// Shapes refer to them by number.
    pub materials: Vec<Material>,
    /// In the order in which their vertices and triangles lie in the arrays.
    pub meshes: Vec<MeshHeader>,
    /// Names of the spheres.
    pub spheres: Vec<String>,
    /// Every light, area lights included.
    pub lights: Vec<Light>,
}

/// A mesh without its vertices and triangles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct MeshHeader {
    /// As the scene file calls it.
    pub name: String,
    /// Number of the material.
    pub material: u32,
    /// How many of `positions` are its own.
    pub vertices: u64,
    /// Whether as many of `normals` are its own; otherwise its faces are flat and it has none.
    pub smooth: bool,
    /// How many of `indices` are its own; they count its own vertices from 0.
    pub triangles: u64,
}

/// What came of a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "answer", rename_all = "kebab-case", rename_all_fields = "kebab-case")]
pub enum Answer {
    /// Before anything is asked: what the worker may reach. Sent by furnace itself.
    Confined {
        /// What holds and what does not.
        #[serde(flatten)]
        confinement: Confinement,
    },
    /// To [`Request::Hello`].
    Core {
        /// Who it is.
        #[serde(flatten)]
        core: CoreHeader,
    },
    /// The arrays are the answer.
    Done,
    /// To [`Request::Build`].
    Built {
        /// What the build made.
        stats: BuildStats,
    },
    /// To [`Request::Intersect`] and [`Request::Occluded`].
    Traced {
        /// What the traversal did.
        stats: TraversalStats,
    },
    /// To [`Request::RenderCodes`].
    Coded {
        /// From radiance to codes.
        encoding: Encoding,
    },
    /// [`CoreError::Unsupported`]
    Unsupported {
        /// Names of what is missing.
        capabilities: Vec<String>,
    },
    /// [`CoreError::Beyond`]
    Beyond {
        /// What is beyond the core.
        why: String,
    },
    /// [`CoreError::Refused`]
    Refused {
        /// In the core's own words.
        why: String,
    },
    /// [`CoreError::BrokeContract`]
    BrokeContract {
        /// What is wrong with the answer.
        why: String,
    },
    /// [`CoreError::Crashed`], where the worker has survived it.
    Crashed {
        /// A panic's message.
        how: String,
        /// The request it was answering.
        during: String,
    },
    /// [`CoreError::TimedOut`], where the worker itself has waited: for a program that it had started.
    TimedOut {
        /// How long.
        limit: Duration,
        /// For what.
        during: String,
    },
}

impl Answer {
    /// The answer that carries an error across.
    pub fn of_error(error: CoreError) -> Self {
        match error {
            CoreError::Unsupported(missing) => Self::Unsupported { capabilities: missing.names() },
            CoreError::Beyond(why) => Self::Beyond { why },
            CoreError::Refused(why) => Self::Refused { why },
            CoreError::BrokeContract(why) => Self::BrokeContract { why },
            CoreError::Crashed { how, during } => Self::Crashed { how, during },
            CoreError::TimedOut { limit, during } => Self::TimedOut { limit, during },
        }
    }

    /// The same on the other side: what is no error is handed back.
    ///
    /// # Errors
    /// What the core answered, if it is an error.
    pub fn into_result(self) -> Result<Self, CoreError> {
        Err(match self {
            Self::Unsupported { capabilities } => match Capabilities::from_names(&capabilities) {
                Ok(missing) => CoreError::Unsupported(missing),
                Err(unknown) => CoreError::Beyond(unknown),
            },
            Self::Beyond { why } => CoreError::Beyond(why),
            Self::Refused { why } => CoreError::Refused(why),
            Self::BrokeContract { why } => CoreError::BrokeContract(why),
            Self::Crashed { how, during } => CoreError::Crashed { how, during },
            Self::TimedOut { limit, during } => CoreError::TimedOut { limit, during },
            other => return Ok(other),
        })
    }
}

/// [`CoreInfo`] as it crosses: capabilities by their names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct CoreHeader {
    /// What the core calls itself.
    pub name: String,
    /// Its own version.
    pub version: String,
    /// What it can be asked.
    pub capabilities: Vec<String>,
    /// The arithmetic it computes in.
    pub precision: Precision,
    /// What it has freely chosen.
    #[serde(default)]
    pub conventions: Conventions,
}

impl CoreHeader {
    /// The header of `info`.
    pub fn new(info: &CoreInfo) -> Self {
        Self {
            name: info.name.clone(),
            version: info.version.clone(),
            capabilities: info.capabilities.names(),
            precision: info.precision,
            conventions: info.conventions,
        }
    }

    /// What the header says.
    ///
    /// # Errors
    /// With the word, if there is no such capability.
    pub fn info(&self) -> Result<CoreInfo, String> {
        Ok(CoreInfo {
            name: self.name.clone(),
            version: self.version.clone(),
            capabilities: Capabilities::from_names(&self.capabilities)?,
            precision: self.precision,
            conventions: self.conventions,
        })
    }
}

/// A request or an answer with the list of its arrays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header<M> {
    /// The request or the answer.
    #[serde(flatten)]
    pub message: M,
    /// In the order in which they lie in the body.
    #[serde(default)]
    pub arrays: Vec<ArrayHeader>,
}

/// Puts a message and its arrays into `buffer` as one frame.
///
/// # Errors
/// If the message is too long for a frame.
pub fn encode<M: Serialize>(
    buffer: &mut Vec<u8>,
    number: u64,
    message: M,
    arrays: &[Sent<'_>],
) -> Result<(), FrameError> {
    let header = Header { message, arrays: arrays.iter().map(Sent::header).collect() };
    let header = serde_json::to_vec(&header)
        .map_err(|error| FrameError::Malformed(format!("a header that cannot be: {error}")))?;
    let arrays: Vec<_> = arrays.iter().map(Sent::bytes).collect();
    frame::encode(buffer, number, &header, &arrays)
}

/// Reads a header.
///
/// # Errors
/// If it is not JSON, or says what nobody knows.
pub fn parse<T: DeserializeOwned>(header: &[u8]) -> Result<T, FrameError> {
    serde_json::from_slice(header)
        .map_err(|error| FrameError::Malformed(format!("its header says {error}")))
}

/// One array: what it is called, what each element is, how many there are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArrayHeader(pub String, pub String, pub u64);

/// An element of arrays: the same bytes on both sides.
pub trait Element: Pod {
    /// What it is called.
    const NAME: &'static str;
}

/// The elements there are: their names, and the types that have just those bytes.
macro_rules! elements {
    ($($name:literal: $type:ty),* $(,)?) => {
        $(impl Element for $type { const NAME: &'static str = $name; })*
        /// Every element by its name, with its size in bytes.
        pub const ELEMENTS: &[(&str, usize)] = &[$(($name, size_of::<$type>())),*];
    };
}

elements! {
    "u8": u8,
    "u32": u32,
    "u64": u64,
    "f64": f64,
    "vec2": DVec2,
    "vec3": DVec3,
    "rgb": [f64; 3],
    "rgb-f32": [f32; 3],
    "rgb-u8": [u8; 3],
    "triangle": [u32; 3],
    "sphere": [f64; 4],
    "sphere-kind": [u32; 2],
    "ray": Ray,
    "hit": Hit,
    "box-hit": BoxHit,
    "direction-sample": DirectionSample,
    "bsdf-query": BsdfQuery,
    "bsdf-value": BsdfValue,
    "bsdf-sample": BsdfSample,
    "light-sample": LightSample,
    "adaptive-mean": AdaptiveMean,
}

/// An array that is sent.
#[derive(Clone, Copy, Debug)]
pub struct Sent<'a> {
    name: &'static str,
    element: &'static str,
    count: usize,
    bytes: &'a [u8],
    /// Whether each element of the batch needs all of it.
    shared: bool,
}

impl<'a> Sent<'a> {
    /// `elements`, called `name`.
    pub fn new<T: Element>(name: &'static str, elements: &'a [T]) -> Self {
        let bytes = bytemuck::cast_slice(elements);
        Self { name, element: T::NAME, count: elements.len(), bytes, shared: false }
    }

    /// Elements that go with every part of a batch: the corners of the triangle that rays meet.
    /// Numbers that may be NaN or infinite travel so, since JSON has none.
    pub fn shared<T: Element>(name: &'static str, elements: &'a [T]) -> Self {
        Self { shared: true, ..Self::new(name, elements) }
    }

    /// Whether each element of the batch needs all of it.
    pub const fn is_shared(&self) -> bool {
        self.shared
    }

    /// Its line in the header.
    pub fn header(&self) -> ArrayHeader {
        ArrayHeader(self.name.to_owned(), self.element.to_owned(), self.count as u64)
    }

    /// Its bytes.
    pub const fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// How many elements there are.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Some of its elements; all of them, if they are shared.
    pub fn part(&self, range: Range<usize>) -> Self {
        if self.shared {
            return *self;
        }
        let size = self.bytes.len() / self.count.max(1);
        let bytes = &self.bytes[range.start * size..range.end * size];
        Self { count: range.len(), bytes, ..*self }
    }

    /// One element in words: its numbers.
    pub fn describe(&self, index: usize) -> String {
        let bytes = self.part(index..index + 1).bytes;
        let Ok(numbers) = bytemuck::try_cast_slice::<u8, f64>(bytes) else {
            return format!("{bytes:?}");
        };
        match (self.element, numbers) {
            ("ray", [ox, oy, oz, t_min, dx, dy, dz, t_max]) => format!(
                "origin [{ox}, {oy}, {oz}], direction [{dx}, {dy}, {dz}], t from {t_min} to {t_max}"
            ),
            _ => format!("{} {numbers:?}", self.name),
        }
    }
}

/// An array that is to be filled by an answer.
#[derive(Debug)]
pub struct Wanted<'a> {
    name: &'static str,
    element: &'static str,
    count: usize,
    bytes: &'a mut [u8],
}

impl<'a> Wanted<'a> {
    /// `elements`, called `name`.
    pub fn new<T: Element>(name: &'static str, elements: &'a mut [T]) -> Self {
        let count = elements.len();
        Self { name, element: T::NAME, count, bytes: bytemuck::cast_slice_mut(elements) }
    }

    /// Its line in the header.
    pub fn header(&self) -> ArrayHeader {
        ArrayHeader(self.name.to_owned(), self.element.to_owned(), self.count as u64)
    }

    /// Where its bytes go.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        self.bytes
    }

    /// How many bytes it has.
    pub fn size(&self) -> usize {
        self.bytes.len()
    }

    /// How many elements there are.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Memory for another answer of the same kind, with `count` elements.
    pub fn blank(&self, count: usize) -> Blank {
        let size = self.bytes.len() / self.count.max(1);
        Blank { name: self.name, element: self.element, count, bytes: vec![0; size * count] }
    }
}

/// Memory for an answer that nobody looks at.
#[derive(Debug)]
pub struct Blank {
    name: &'static str,
    element: &'static str,
    count: usize,
    bytes: Vec<u8>,
}

impl Blank {
    /// As it is asked for.
    pub fn wanted(&mut self) -> Wanted<'_> {
        let Self { name, element, count, bytes } = self;
        Wanted { name, element, count: *count, bytes }
    }
}
