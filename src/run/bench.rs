//! What every trial of a run shares.

use crate::case::Case;
use crate::contract::{CoreError, CoreInfo};
use crate::cores::{CoreSpec, HostError, Hosted, Hosting};
use crate::math::rng::Seed;
use crate::scene::Library;
use crate::scene::motion::Motion;
use crate::stats::Allowance;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// What every trial of a run shares.
#[derive(Clone, Debug)]
pub struct Bench {
    pub(crate) scenes: Arc<Library>,
    /// The folders of references; the first that has one counts.
    pub references: Vec<PathBuf>,
    pub(crate) allowance: Allowance,
    pub(crate) seed: Seed,
    /// Where scenes are taken from; not to be worked out from [`Self::seed`] where a run has a salt.
    pub(crate) motions: Seed,
    pub(crate) hosting: Hosting,
    /// Cores that died before they said who they are: how, and what they printed. Nothing else is asked of them.
    pub(crate) unfit: BTreeMap<String, (CoreError, String)>,
    /// Who cores are, of those that were asked; nothing of one that does not start.
    pub(crate) known: Arc<Mutex<BTreeMap<String, Option<CoreInfo>>>>,
}

impl Bench {
    /// The seed of a case: the same for every core.
    pub(crate) fn seed_of(&self, case: &Case) -> Seed {
        self.seed.child(&case.id)
    }

    /// Where the scenes of a case are shown: the same for every core.
    pub(crate) fn motion_of(&self, case: &Case) -> Motion {
        Motion::drawn(self.motions.child(&case.id))
    }

    /// Brings up a core as a trial does. Fails if it does not start.
    #[cfg(feature = "cli")]
    pub(crate) fn host(&self, core: &CoreSpec) -> Result<Hosted, HostError> {
        self.hosting.host(core)
    }

    /// Who a core is. It is started for that question once, where something has failed; nothing if it does not start.
    pub(crate) fn info(&self, core: &CoreSpec) -> Option<CoreInfo> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let ask = || Some(self.hosting.host(core).ok()?.core_mut().info());
        known.entry(core.to_string()).or_insert_with(ask).clone()
    }
}
