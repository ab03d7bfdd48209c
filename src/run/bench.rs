//! What every trial of a run shares.

use crate::case::Case;
use crate::contract::CoreError;
use crate::cores::Hosting;
use crate::math::rng::Seed;
use crate::scene::Library;
use crate::stats::Allowance;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What every trial of a run shares.
#[derive(Clone, Debug)]
pub struct Bench {
    pub(crate) scenes: Arc<Library>,
    /// The folder of references.
    pub references: PathBuf,
    pub(crate) allowance: Allowance,
    pub(crate) seed: Seed,
    pub(crate) hosting: Hosting,
    /// Cores that died before they said who they are: how, and what they printed. Nothing else is asked of them.
    pub(crate) unfit: BTreeMap<String, (CoreError, String)>,
}

impl Bench {
    /// The seed of a case: the same for every core.
    pub(crate) fn seed_of(&self, case: &Case) -> Seed {
        self.seed.child(&case.id)
    }
}
