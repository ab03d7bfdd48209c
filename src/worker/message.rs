//! What headers say: requests to a core and its answers.
//!
//! A request is one call of [`crate::contract`], which says what crosses; an answer is what came of it.
//! `docs/book/src/protocol.md` is this for people who write a core in another language; `tests/contract.rs` holds the two
//! together.

use super::frame::{self, FrameError};
use super::spec::Confinement;
use crate::contract::{Breach, BuildStats, Capabilities, CoreError, CoreInfo, TraversalStats};
use crate::image::encoding::Encoding;
use crate::scene::{Camera, Light, Material};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::time::Duration;

pub use crate::contract::crossing::{ArrayHeader, Element, Received, Request, Sent, Wanted};

/// A scene without its long lists.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) struct SceneHeader {
    pub(crate) name: String,
    /// Where pictures are taken from, if the scene says so.
    pub(crate) camera: Option<Camera>,
    /// Shapes refer to them by number.
    pub(crate) materials: Vec<Material>,
    /// In the order in which their vertices and triangles lie in the arrays.
    pub(crate) meshes: Vec<MeshHeader>,
    pub(crate) spheres: Vec<String>,
    /// Every light, area lights included.
    pub(crate) lights: Vec<Light>,
}

/// A mesh without its vertices and triangles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) struct MeshHeader {
    pub(crate) name: String,
    pub(crate) material: u32,
    /// How many of `positions` are its own.
    pub(crate) vertices: u64,
    /// Whether as many of `normals` are its own; otherwise its faces are flat and it has none.
    pub(crate) smooth: bool,
    /// How many of `indices` are its own; they count its own vertices from 0.
    pub(crate) triangles: u64,
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
    /// To `hello`.
    Core {
        /// Who it is.
        #[serde(flatten)]
        core: CoreInfo,
    },
    /// The arrays are the answer.
    Done,
    /// To `build`.
    Built {
        /// What the build made.
        stats: BuildStats,
    },
    /// The arrays are the answer, and a traversal tells what it took.
    Traced {
        /// What the traversal did.
        stats: TraversalStats,
    },
    /// The arrays are the answer: codes of a picture.
    Coded {
        /// From radiance to codes.
        encoding: Encoding,
    },
    /// [`CoreError::Unsupported`]
    Unsupported {
        /// What is missing.
        capabilities: Capabilities,
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
        breach: Box<Breach>,
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
    /// What the protocol calls it.
    pub(crate) fn word(&self) -> String {
        let told = serde_json::to_value(self).unwrap_or_default();
        told["answer"].as_str().unwrap_or_default().to_owned()
    }

    /// The answer that carries an error across.
    pub(crate) fn of_error(error: CoreError) -> Self {
        match error {
            CoreError::Unsupported(capabilities) => Self::Unsupported { capabilities },
            CoreError::Beyond(why) => Self::Beyond { why },
            CoreError::Refused(why) => Self::Refused { why },
            CoreError::BrokeContract(breach) => Self::BrokeContract { breach },
            CoreError::Crashed { how, during, .. } => Self::Crashed { how, during },
            CoreError::TimedOut { limit, during } => Self::TimedOut { limit, during },
        }
    }

    /// The same on the other side: what is no error is handed back. Fails with what the core answered, if it is an
    /// error.
    pub(crate) fn into_result(self) -> Result<Self, CoreError> {
        Err(match self {
            Self::Unsupported { capabilities } => CoreError::Unsupported(capabilities),
            Self::Beyond { why } => CoreError::Beyond(why),
            Self::Refused { why } => CoreError::Refused(why),
            Self::BrokeContract { breach } => CoreError::BrokeContract(breach),
            Self::Crashed { how, during } => CoreError::Crashed { how, during, element: None },
            Self::TimedOut { limit, during } => CoreError::TimedOut { limit, during },
            other => return Ok(other),
        })
    }
}

/// What is told besides the arrays of an answer.
pub(crate) trait Told: Sized {
    /// The answer that says it.
    fn into_answer(self) -> Answer;

    /// What an answer says; none if it says something else.
    fn of(answer: &Answer) -> Option<Self>;
}

impl Told for () {
    fn into_answer(self) -> Answer {
        Answer::Done
    }

    fn of(answer: &Answer) -> Option<Self> {
        (*answer == Answer::Done).then_some(())
    }
}

impl Told for TraversalStats {
    fn into_answer(self) -> Answer {
        Answer::Traced { stats: self }
    }

    fn of(answer: &Answer) -> Option<Self> {
        if let Answer::Traced { stats } = answer { Some(*stats) } else { None }
    }
}

impl Told for Encoding {
    fn into_answer(self) -> Answer {
        Answer::Coded { encoding: self }
    }

    fn of(answer: &Answer) -> Option<Self> {
        if let Answer::Coded { encoding } = answer { Some(*encoding) } else { None }
    }
}

/// A request or an answer with the list of its arrays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Header<M> {
    #[serde(flatten)]
    pub(crate) message: M,
    /// In the order in which they lie in the body.
    #[serde(default)]
    pub(crate) arrays: Vec<ArrayHeader>,
    /// CPU time that the core's process has used for an answer, if it says so.
    #[serde(default, rename = "cpu-seconds", skip_serializing_if = "Option::is_none")]
    pub(crate) cpu_seconds: Option<f64>,
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
    cpu_seconds: Option<f64>,
) -> Result<(), FrameError> {
    let arrays_named = arrays.iter().map(Sent::header).collect();
    let header = Header { message, arrays: arrays_named, cpu_seconds };
    let header = serde_json::to_vec(&header)
        .map_err(|error| FrameError::Malformed(format!("a header that cannot be: {error}")))?;
    let arrays: Vec<_> = arrays.iter().map(Sent::bytes).collect();
    frame::encode(buffer, number, &header, &arrays)
}

/// Reads a header. Fails if it is not JSON, or says what nobody knows.
pub(crate) fn parse<T: DeserializeOwned>(header: &[u8]) -> Result<T, FrameError> {
    // Where in a line of JSON that a program has written says nothing to people.
    serde_json::from_slice(header).map_err(|error| {
        let said = error.to_string();
        let (what, _) = said.rsplit_once(" at line ").unwrap_or((&said, ""));
        FrameError::Unknown(what.to_owned())
    })
}
