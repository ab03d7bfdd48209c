//! How long a core may think about one question: less, once it has been seen to think without end.
//!
//! A core that hangs in one function hangs in most cases that ask it. The first such question has ten times as long as
//! the core has ever taken, an eighth of the time of a trial at least and a quarter at most; others, and the same one in
//! other cases, less. Where it has only ever been silent, the other cases of that part of the suite, or of all of it, do
//! not ask it again, but say so.
//!
//! Not here: how time is charged (`guard`).

use super::spec::Limits;
use crate::contract::CoreError;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Into how many parts a trial's time is cut, of which one question has one; and no question has less, seconds, unless
/// the trial has. Of a core that has always answered, of one that has not, and where it was this very question; each of a
/// quick core and of a slow one.
const PARTS: [[u32; 2]; 3] = [[8, 4], [24, 12], [60, 24]];
const LEAST: [[u64; 2]; 3] = [[10, 10], [5, 10], [2, 5]];
/// How many times as long as its longest answer yet took a core may think.
const SLOWER: u32 = 10;
/// Silences in a row after which a question is not asked again in its part of the suite.
const MOST_SILENCES: u32 = 3;
/// What a core may waste in a run, as a share of a trial's time, before one silence is enough.
const WASTE: f64 = 0.25;
const LEAST_WASTE: Duration = Duration::from_secs(30);

/// What is known of the silences of cores, as one case of one core sees it.
#[derive(Clone, Debug, Default)]
pub struct Patience {
    known: Arc<Mutex<BTreeMap<String, Silences>>>,
    core: String,
    case: String,
    /// Whether every core counts as slow.
    is_unhurried: bool,
}

/// Of one core.
#[derive(Debug, Default)]
struct Silences {
    waited: Duration,
    /// What its longest answer took.
    longest: Duration,
    /// Questions that have had an answer, in whatever part.
    answered: BTreeSet<String>,
    /// By the part of the suite and the question.
    kinds: BTreeMap<(String, String), Silence>,
}

/// Of one question in one part of the suite: the last one, and how many in a row.
#[derive(Clone, Debug, Default)]
struct Silence {
    in_a_row: u32,
    limit: Duration,
    case: String,
}

impl Patience {
    /// That knows of no silence, and of no speed: what a core takes alone says little of what it takes with components of
    /// the bench.
    pub(crate) fn unhurried() -> Self {
        Self { is_unhurried: true, ..Self::default() }
    }

    /// The same, as a case sees it.
    pub(crate) fn in_case(&self, case: &str) -> Self {
        Self { case: case.to_owned(), ..self.clone() }
    }

    /// The same with a core.
    pub(crate) fn with(&self, core: &str) -> Self {
        Self { core: core.to_owned(), ..self.clone() }
    }

    /// How long the core may think about a question.
    pub(super) fn limit(&self, question: &str, limits: &Limits) -> Duration {
        let mut all = self.lock();
        let Silences { longest, kinds, .. } = all.entry(self.core.clone()).or_default();
        let place = match kinds.keys().any(|(_, known)| known == question) {
            true => 2,
            false => usize::from(!kinds.is_empty()),
        };
        let of = |speed: usize| {
            let least = Duration::from_secs(LEAST[place][speed]);
            (limits.time() / PARTS[place][speed]).max(least).min(limits.time())
        };
        let (quick, slow) = (of(0), of(1));
        if self.is_unhurried { slow } else { (*longest * SLOWER).clamp(quick, slow) }
    }

    /// Why a question is not asked again, if that is so.
    pub(super) fn refuses(&self, question: &str, limits: &Limits) -> Option<CoreError> {
        let all = self.lock();
        let silences = all.get(&self.core)?;
        let is_wasteful = silences.waited >= limits.time().mul_f64(WASTE).max(LEAST_WASTE);
        let never = is_wasteful && !silences.answered.contains(question);
        let of_question = |(kind, _): &(&(String, String), &Silence)| kind.1 == question;
        let anywhere = || silences.kinds.iter().find(of_question).map(|(_, silence)| silence);
        let here = silences.kinds.get(&self.kind(question));
        let Silence { in_a_row, limit, case } = here.or_else(|| never.then(anywhere).flatten())?;
        let is_enough = *in_a_row >= if is_wasteful { 1 } else { MOST_SILENCES };
        is_enough.then(|| CoreError::TimedOut {
            limit: *limit,
            during: format!("{question} in {case}, and not asked again"),
        })
    }

    /// Learns that a question was answered, and how long that took.
    pub(super) fn answered(&self, question: &str, took: Duration) {
        let mut all = self.lock();
        let silences = all.entry(self.core.clone()).or_default();
        silences.longest = silences.longest.max(took);
        silences.answered.insert(question.to_owned());
        if let Some(silence) = silences.kinds.get_mut(&self.kind(question)) {
            silence.in_a_row = 0;
        }
    }

    /// Learns that it was not, within `limit`.
    pub(super) fn timed_out(&self, question: &str, limit: Duration) {
        let mut all = self.lock();
        let silences = all.entry(self.core.clone()).or_default();
        silences.waited += limit;
        let silence = silences.kinds.entry(self.kind(question)).or_default();
        *silence = Silence { in_a_row: silence.in_a_row + 1, limit, case: self.case.clone() };
    }

    fn kind(&self, question: &str) -> (String, String) {
        let part = self.case.split('/').next().unwrap_or_default();
        (part.to_owned(), question.to_owned())
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<String, Silences>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn in_case(patience: &Patience, case: &str) -> Patience {
        patience.with("core.so").in_case(case)
    }

    /// Asks until nothing is asked again, and answers how long that took.
    fn waited(patience: &Patience, cases: &[&str]) -> Duration {
        let limits = Limits::default();
        let one = |case: &&str| {
            let patience = in_case(patience, case);
            if patience.refuses("radiance", &limits).is_some() {
                return Duration::ZERO;
            }
            let limit = patience.limit("radiance", &limits);
            patience.timed_out("radiance", limit);
            limit
        };
        cases.iter().map(one).sum()
    }

    #[test]
    fn a_core_that_never_answers_is_waited_for_half_a_minute_in_all() {
        let cases: Vec<_> = ["integrator", "light", "image", "camera"]
            .iter()
            .flat_map(|part| (0..20).map(move |number| format!("{part}/{number}")))
            .collect();
        let cases: Vec<_> = cases.iter().map(String::as_str).collect();
        let waited = waited(&Patience::default(), &cases);
        assert!((25 * SECOND..=35 * SECOND).contains(&waited), "{waited:?}");
    }

    #[test]
    fn what_is_not_asked_again_names_the_question_and_the_case() {
        let patience = Patience::default();
        waited(&patience, &["light/a", "light/b", "light/c"]);
        let refusal = in_case(&patience, "light/d").refuses("radiance", &Limits::default());
        let words = "radiance in light/c, and not asked again".to_owned();
        assert_eq!(refusal, Some(CoreError::TimedOut { limit: 2 * SECOND, during: words }));
        let other_part = in_case(&patience, "camera/d");
        assert_eq!(other_part.refuses("radiance", &Limits::default()), None);
        let other_core = patience.with("other.so").in_case("light/d");
        assert_eq!(other_core.limit("radiance", &Limits::default()), 15 * SECOND);
    }

    #[test]
    fn a_slow_core_has_more_time_than_a_fast_one() {
        let patience = in_case(&Patience::default(), "shape/a");
        let limit = |question| patience.limit(question, &Limits::default());
        for (took, first) in
            [(SECOND, 15 * SECOND), (2 * SECOND, 20 * SECOND), (9 * SECOND, 30 * SECOND)]
        {
            patience.answered("intersect", took);
            assert_eq!(limit("radiance"), first, "{took:?}");
        }
        patience.timed_out("radiance", 30 * SECOND);
        assert_eq!([limit("radiance"), limit("render")], [5 * SECOND, 10 * SECOND]);
        let of_quick = in_case(&Patience::default(), "shape/a");
        let of_any = in_case(&Patience::unhurried(), "shape/a");
        let short = Limits { seconds: Some(10.0), ..Limits::default() };
        let after_silence = [of_quick, of_any].map(|patience| {
            patience.timed_out("radiance", 15 * SECOND);
            ["radiance", "render"].map(|question| patience.limit(question, &short))
        });
        assert_eq!(after_silence, [[2 * SECOND, 5 * SECOND], [5 * SECOND, 10 * SECOND]]);
    }

    #[test]
    fn a_question_that_is_answered_at_times_is_always_asked() {
        let patience = Patience::default();
        for _ in 0..6 {
            assert!(waited(&patience, &["light/a"]) >= 2 * SECOND);
            in_case(&patience, "light/b").answered("radiance", SECOND);
        }
    }

    #[test]
    fn nobody_waits_longer_than_a_trial_may_take() {
        let limits = Limits { seconds: Some(2.0), ..Limits::default() };
        assert_eq!(Patience::default().limit("render", &limits), 2 * SECOND);
    }
}
