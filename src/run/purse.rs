//! How much may still be tried for one core once its trials have ended.
//!
//! A purse counts what cores are asked and not the time that it takes: it is empty at the same place on a busy machine and
//! on an idle one, with one thread and with many, in a run that was killed and resumed and in one that was not. Time ends
//! it only where a core is much slower than the bench's own.

use super::record::TrialRecord;
use crate::run::Status;
use crate::worker::crowding;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// What the textbook core does in a second of a processor, about: of all cases it is asked 1.66 · 10⁹ in 91 s.
pub(super) const A_SECOND: u64 = 15_000_000;
/// Seconds of it that may always be tried. With 20 the search through four mistakes of which three lose hits ended before the
/// last was found, once rows after the first that fails took fewer paths: the share of the trials had been 26.
pub(super) const LEAST: u64 = 30;
/// What begins and ends with every trial.
const A_TRIAL: u64 = A_SECOND / 50;
/// How many times the time that it would take the textbook core is waited for, on a machine with nothing else to do.
const SLOWEST: f64 = 4.0;
/// What a trial may take that is paid for so: at its budget a right core needs a second or two.
pub(super) const LONGEST_TRIAL: u64 = 10;

/// Work that is left, and until when.
pub(super) struct Purse {
    left: Mutex<u64>,
    /// What of it is kept for later.
    kept: AtomicU64,
    end: Instant,
}

impl Purse {
    /// A share of what the trials of a core took, and no less than so many seconds of the textbook core.
    pub(super) fn of_share<'a>(
        share: f64,
        least: u64,
        records: impl Iterator<Item = &'a TrialRecord> + Clone,
    ) -> Self {
        let answered = records.filter(|record| record.outcome.status() != Status::TimedOut);
        let work: u64 = answered.clone().map(price).sum();
        let seconds: f64 = answered.map(|record| record.timing.seconds).sum();
        let seconds = (share * seconds).max(least as f64) * SLOWEST * crowding();
        let work = ((share * work as f64) as u64).max(least * A_SECOND);
        Self::of(work, Duration::from_secs_f64(seconds))
    }

    fn of(work: u64, time: Duration) -> Self {
        Self { left: Mutex::new(work), kept: AtomicU64::new(0), end: Instant::now() + time }
    }

    pub(super) fn left(&self) -> u64 {
        self.lock().saturating_sub(self.kept())
    }

    /// Keeps as much for each of so many others as for what is asked next.
    pub(super) fn keep_for(&self, others: usize) {
        let left = *self.lock();
        let own = left / (others as u64 + 1);
        self.kept.store(left - own, Ordering::Relaxed);
    }

    fn kept(&self) -> u64 {
        self.kept.load(Ordering::Relaxed)
    }

    fn lock(&self) -> MutexGuard<'_, u64> {
        self.left.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What `work` answers to each of so many numbers, several at a time, with its price, for as many as can be paid,
    /// the first ones first. What was begun beyond them, while others were under way, is forgotten.
    pub(super) fn pay_each<T: Send>(
        &self,
        jobs: usize,
        count: usize,
        work: &(dyn Fn(usize) -> (T, u64) + Sync),
    ) -> Vec<T> {
        let left = self.left();
        let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        done.lock().unwrap_or_else(PoisonError::into_inner).resize_with(count, || None);
        let lock = || done.lock().unwrap_or_else(PoisonError::into_inner);
        let take = || {
            while Instant::now() < self.end {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= count || is_spent(&lock(), left) {
                    return;
                }
                let answer = work(number);
                lock()[number] = Some(answer);
            }
        };
        std::thread::scope(|threads| {
            for _ in 0..jobs.min(count) {
                threads.spawn(take);
            }
        });
        let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut left = self.lock();
        let paid = done.into_iter().map_while(|answer| {
            let (answer, price) = answer.filter(|_| *left > self.kept())?;
            *left = left.saturating_sub(price);
            Some(answer)
        });
        paid.collect()
    }
}

/// Whether nothing is left after those of the first that have an answer.
fn is_spent<T>(done: &[Option<(T, u64)>], left: u64) -> bool {
    let rest = done.iter().try_fold(left, |left, answer| match (answer, left) {
        (_, 0) => ControlFlow::Break(0),
        (None, left) => ControlFlow::Break(left),
        (Some((_, price)), left) => ControlFlow::Continue(left.saturating_sub(*price)),
    });
    matches!(rest, ControlFlow::Break(0) | ControlFlow::Continue(0))
}

/// What a trial took. Of silence it is all that it may take.
pub(super) fn price(record: &TrialRecord) -> u64 {
    let silence = match record.outcome.status() {
        Status::TimedOut => LONGEST_TRIAL * A_SECOND,
        _ => 0,
    };
    A_TRIAL + record.work + silence
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINUTE: Duration = Duration::from_secs(60);

    #[test]
    fn the_same_is_paid_for_by_one_thread_and_by_many() {
        let paid = |jobs: usize| {
            let purse = Purse::of(100 * A_SECOND, MINUTE);
            // The first ones take the longest.
            let work = |number: usize| {
                std::thread::sleep(Duration::from_millis(20 / (1 + number as u64)));
                (number, 30 * A_SECOND)
            };
            (purse.pay_each(jobs, 8, &work), purse.left())
        };
        assert_eq!(paid(1), (vec![0, 1, 2, 3], 0));
        for jobs in [2, 3, 8] {
            assert_eq!(paid(jobs), paid(1), "{jobs} threads");
        }
    }

    #[test]
    fn what_begins_with_something_left_is_paid_for_and_nothing_with_an_empty_purse() {
        let purse = Purse::of(LEAST * A_SECOND, MINUTE);
        assert_eq!(purse.pay_each(1, 2, &|number| (number, LEAST * A_SECOND)), [0]);
        assert_eq!(purse.pay_each(2, 2, &|number| (number, 1)), [0; 0]);
    }

    #[test]
    fn one_with_much_to_ask_leaves_the_others_as_much() {
        let purse = Purse::of(90 * A_SECOND, MINUTE);
        let paid = || purse.pay_each(1, 9, &|number| (number, 10 * A_SECOND)).len();
        let all = [2, 1, 0].map(|others| {
            purse.keep_for(others);
            paid()
        });
        assert_eq!((all, purse.left()), ([3, 3, 3], 0));
    }

    #[test]
    fn a_core_that_is_much_slower_is_not_waited_for() {
        let purse = Purse::of(LEAST * A_SECOND, Duration::ZERO);
        assert_eq!(purse.pay_each(2, 2, &|number| (number, 1)), [0; 0]);
    }
}
