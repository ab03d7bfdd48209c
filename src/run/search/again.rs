//! The failing cases of a core, tried again with components of the bench: at a glance where that is enough, and never twice.

use super::{Tried, Tries};
use crate::case::Subject;
use crate::checks::{Finding, Measure, STANDARD_ERRORS};
use crate::contract::Components;
use crate::run::attempt::run_taking;
use crate::run::bench::Bench;
use crate::run::outcome::Status;
use crate::run::plan::Trial;
use crate::run::purse::{LONGEST_TRIAL, Purse, price};
use crate::run::record::TrialRecord;
use crate::stats::{Allowance, Budget, TestKind};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::SQRT_2;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What was asked: which case, with what of the bench, and how.
type Asked = (usize, Components, Look);

/// What came of it.
#[derive(Clone, Copy, Debug)]
struct Answer {
    /// Whether the case passes; none where that is not known.
    passes: Option<bool>,
    /// What it took, in the work of a purse.
    price: u64,
}

/// How a case is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Look {
    /// With few samples.
    Glance,
    Closely,
    /// Closely, with random numbers that nothing was found with.
    Anew,
}

/// What is known of cases.
#[derive(Debug, Default)]
struct Known(BTreeMap<Asked, Answer>);

impl Known {
    /// What came of it, or of asking with less or with more: what passes with some components passes with others beside
    /// them. Where that is not so, the proof at the end tells, of which nothing is taken for granted.
    fn answer(&self, asked: &Asked) -> Option<Option<bool>> {
        let (case, with, look) = *asked;
        let [first, last] = [Components::empty(), Components::all()];
        let of_case = || {
            let looks = self.0.range((case, first, Look::Glance)..=(case, last, Look::Anew));
            looks.filter(move |((.., other), _)| *other == look)
        };
        let follows = || {
            of_case().find_map(|((_, other, _), answer)| match answer.passes {
                Some(true) if with.contains(*other) => Some(Some(true)),
                Some(false) if other.contains(with) => Some(Some(false)),
                _ => None,
            })
        };
        let asked_so = self.0.get(asked).map(|answer| answer.passes);
        if look == Look::Anew { asked_so } else { asked_so.or_else(follows) }
    }
}

/// What failed, and what came of trying it again.
pub(super) struct Again<'a> {
    /// The cheapest first: should there be too little for all, it is for the longest.
    pub(super) failing: Vec<(&'a Trial, &'a TrialRecord)>,
    pub(super) purse: Purse,
    jobs: usize,
    closely: Bench,
    glancing: Bench,
    anew: Bench,
    /// By how much the smallest error that was seen in the run is multiplied, as a budget says it.
    coarseness: f64,
    known: Mutex<Known>,
}

impl<'a> Again<'a> {
    pub(super) fn new(
        mut failing: Vec<(&'a Trial, &'a TrialRecord)>,
        purse: Purse,
        jobs: usize,
        bench: &Bench,
    ) -> Self {
        failing.sort_by_key(|(_, record)| price(record));
        let allowance =
            Allowance { stops_at_failure: true, judges_alone: true, ..Budget::Quick.into() };
        let closely = Bench { allowance, ..without_patience(bench) };
        let allowance = Allowance { looks_roughly: true, ..allowance };
        let glancing = Bench { allowance, ..closely.clone() };
        let anew = Bench { seed: closely.seed.child("anew"), ..closely.clone() };
        let coarseness = bench.allowance.coarseness();
        let known = Mutex::default();
        Self { failing, purse, jobs, closely, glancing, anew, coarseness, known }
    }

    /// Those that fail here as they did in the run. A small error that only a larger budget sees would pass here whatever is
    /// taken, and prove nothing; a gross one is not asked for.
    pub(super) fn failing_still(&self, cases: Vec<usize>) -> Vec<usize> {
        let is_as_sharp = self.times_coarser(&self.closely) <= 1.0;
        let is_sure = |case: &usize| is_as_sharp || self.is_gross(*case, &self.closely);
        let with_nothing = |case: &usize| (*case, Components::empty(), Look::Closely);
        let asked: Vec<_> = cases.iter().filter(|case| !is_sure(case)).map(with_nothing).collect();
        self.ask(&asked);
        let known = self.known();
        let fails = |case: &usize| known.answer(&with_nothing(case)) == Some(Some(false));
        cases.into_iter().filter(|case| is_sure(case) || fails(case)).collect()
    }

    /// Looks at all that seems gross at a glance as it is: what passes so would pass so with any component, and is looked at
    /// closely from here on.
    pub(super) fn see_through_luck(&self) {
        let gross = (0..self.failing.len()).filter(|case| self.is_rough(*case));
        let as_they_are = gross.map(|case| (case, Components::empty(), Look::Glance));
        self.ask(&Vec::from_iter(as_they_are));
    }

    fn seen(&self, asked: Vec<Asked>) -> Tried {
        self.ask(&asked);
        let known = self.known();
        let of = |wanted: Option<bool>| {
            let told = asked.iter().filter(|asked| known.answer(asked) == Some(wanted));
            told.map(|(case, ..)| *case).collect()
        };
        Tried { passing: of(Some(true)), failing: of(Some(false)), unknown: of(None) }
    }

    /// What a case may take when it is tried again. A picture has a sample a pixel, at a glance as well: its price is what it
    /// took so.
    pub(super) fn price(&self, number: usize) -> u64 {
        let record = self.failing[number].1;
        let look = if self.is_rough(number) { &self.glancing } else { &self.closely };
        let expected = (price(record) as f64 / self.times_coarser(look).powi(2)) as u64;
        let glance = (number, Components::empty(), Look::Glance);
        match Subject::of_case(&record.case) {
            Some(Subject::Image) => {
                self.known().0.get(&glance).map_or(expected, |taken| taken.price.max(expected))
            }
            _ => expected,
        }
    }

    /// Asks what is not known, for as much as can be paid.
    fn ask(&self, all: &[Asked]) {
        let new: Vec<_> = all.iter().filter(|asked| self.known().answer(asked).is_none()).collect();
        let answers = self.purse.pay_each(self.jobs, new.len(), &|place| {
            let answer = self.answer(*new[place]);
            (answer, answer.price)
        });
        self.known().0.extend(new.into_iter().copied().zip(answers));
    }

    fn answer(&self, (number, with, look): Asked) -> Answer {
        let (trial, record) = self.failing[number];
        if !with.is_empty() && record.with.contains(with) {
            // So it was tried in the run.
            return Answer { passes: Some(false), price: 0 };
        }
        let bench = match look {
            Look::Glance => &self.glancing,
            Look::Closely => &self.closely,
            Look::Anew => &self.anew,
        };
        let (ended, own) = run_taking(bench, trial, record.with | with);
        let ended = ended.record;
        // Of silence it cannot be told what would have come of waiting longer, where there was none before.
        let was_silent = record.outcome.status() == Status::TimedOut;
        let passes = match ended.outcome.status() {
            Status::TimedOut if !was_silent => None,
            // It may have failed for what the core did not take after all.
            _ if !own.is_empty() => None,
            ended => passes(ended),
        };
        Answer { passes, price: price(&ended) }
    }

    /// Whether the failure would be seen by such a look.
    fn is_gross(&self, number: usize, look: &Bench) -> bool {
        let finding = self.failing[number].1.outcome.finding();
        finding.is_some_and(|finding| is_gross(finding, self.times_coarser(look)))
    }

    fn times_coarser(&self, look: &Bench) -> f64 {
        look.allowance.coarseness() / self.coarseness
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Tries for Again<'_> {
    fn tried(&self, with: Components, cases: &[usize], closely: &BTreeSet<usize>) -> Tried {
        let look = |case: usize| match closely.contains(&case) || !self.is_rough(case) {
            true => Look::Closely,
            false => Look::Glance,
        };
        self.seen(cases.iter().map(|case| (*case, with, look(*case))).collect())
    }

    fn proven(&self, with: Components, cases: &[usize]) -> Tried {
        self.seen(cases.iter().map(|case| (*case, with, Look::Anew)).collect())
    }

    fn is_rough(&self, case: usize) -> bool {
        let as_it_is = (case, Components::empty(), Look::Glance);
        let passes = self.known().answer(&as_it_is) == Some(Some(true));
        self.is_gross(case, &self.glancing) && !passes
    }

    fn is_spent(&self) -> bool {
        self.purse.left() == 0
    }
}

/// Whether a case passes that ended so; none where with these components it cannot be asked, or cannot be judged with so few
/// samples.
fn passes(ended: Status) -> Option<bool> {
    match ended {
        Status::Skipped | Status::Blocked | Status::Broken | Status::Inconclusive => None,
        ended => Some(ended == Status::Pass),
    }
}

/// Whether something is so wrong that it would still fail were its error and its noise that many times as large as what is
/// seen of them. A picture fails by its standard errors; how bright it is only tells what they are of, down to the last
/// digit of a sky without noise.
pub(in crate::run) fn is_gross(finding: &Finding, coarser: f64) -> bool {
    let counts_errors = |measure: &&Measure| measure.unit == STANDARD_ERRORS;
    let is_picture = finding.measures.iter().any(|measure| counts_errors(&measure));
    // A slope over fewer counts is another number, and no noisier one.
    let is_slope = |one: &Measure| one.hypothesis.is_some_and(|of| of.kind == TestKind::Slope);
    let mut judging = finding
        .failed_measures()
        .filter(|one| !is_slope(one) && (!is_picture || counts_errors(one)));
    judging.any(|measure| {
        let Measure { measured, expected, allowed, .. } = measure;
        // A picture is screened by half of the runs that confirm it.
        let coarser = if is_picture { SQRT_2 * coarser } else { coarser };
        let is_far = |noise: f64| (measured - expected).abs() > coarser * (allowed + noise);
        measure.noise().is_some_and(is_far)
    })
}

/// The bench for trials with transplants: it knows nothing of the silences of a core without them.
pub(in crate::run) fn without_patience(bench: &Bench) -> Bench {
    let mut hosting = bench.hosting.clone().patient();
    hosting.limits.seconds =
        hosting.limits.seconds.map(|seconds| seconds.min(LONGEST_TRIAL as f64));
    Bench { hosting, ..bench.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Hypothesis;

    #[test]
    fn what_passes_with_some_components_passes_with_more_and_is_proven_with_all_of_them() {
        const BOX: Components = Components::BOX_TEST;
        let both = BOX | Components::BSDF;
        let mut known = Known::default();
        let of = |passes: bool| Answer { passes: Some(passes), price: 0 };
        known.0.insert((1, BOX, Look::Glance), of(true));
        assert_eq!(known.answer(&(1, both, Look::Glance)), Some(Some(true)));
        assert_eq!(known.answer(&(1, Components::BSDF, Look::Glance)), None);
        assert_eq!(known.answer(&(1, both, Look::Closely)), None);
        assert_eq!(known.answer(&(2, both, Look::Glance)), None);
        known.0.insert((3, both, Look::Closely), of(false));
        known.0.insert((3, both, Look::Anew), of(false));
        assert_eq!(known.answer(&(3, BOX, Look::Closely)), Some(Some(false)));
        assert_eq!(known.answer(&(3, BOX, Look::Anew)), None);
    }

    #[test]
    fn what_is_too_noisy_to_be_judged_is_no_failure_of_what_was_taken() {
        assert_eq!(passes(Status::Inconclusive), None);
        assert_eq!(passes(Status::Crashed), Some(false));
        assert_eq!(passes(Status::Pass), Some(true));
    }

    #[test]
    fn what_is_far_beyond_its_noise_and_what_is_allowed_is_seen_at_a_glance() {
        let of = |measured: f64, noise: f64| {
            let mean = Measure::exact("mean", measured, 1.0, 0.05);
            let interval = Some([measured - noise, measured + noise]);
            Finding::of("", "", vec![Measure { interval, ..mean }])
        };
        assert!(is_gross(&of(1.5, 0.1), 2.5));
        assert!(!is_gross(&of(1.5, 0.2), 2.5));
        assert!(!is_gross(&of(1.1, 0.0), 2.5));
        assert!(!is_gross(&of(f64::NAN, 0.1), 2.5));
        let sky = Measure {
            interval: Some([0.999_994, 0.999_996]),
            ..Measure::exact("sky", 0.999_995, 1.0, 0.0)
        };
        let picture = |errors: f64| {
            let worst = Measure::exact("worst tile", errors, 0.0, 9.0).in_unit(STANDARD_ERRORS);
            Finding::of("", "", vec![sky.clone(), worst])
        };
        assert!(is_gross(&picture(50.0), 2.5));
        assert!(!is_gross(&picture(14.0), 2.5), "how bright the sky is fails no picture");
        let slope = of(1.5, 0.1).measures.remove(0);
        let hypothesis = Some(Hypothesis::new(TestKind::Slope, false));
        let slope = vec![Measure { hypothesis, ..slope }];
        assert!(!is_gross(&Finding::of("", "", slope), 2.5), "fewer counts have another slope");
        let exact = vec![Measure::exact("hits", 9.0, 1.0, 0.05)];
        assert!(
            !is_gross(&Finding::of("", "", exact), 2.5),
            "no fewer samples where there are none"
        );
    }
}
