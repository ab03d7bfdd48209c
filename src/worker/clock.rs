//! CPU time: on a machine that does other things too, wall time says little.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// CPU time of this process so far, of all its threads.
#[cfg(unix)]
pub(super) fn now() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    let seconds = u64::try_from(time.tv_sec).unwrap_or(0);
    Duration::new(seconds, u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// Wall time since the first call, where processes have no clock.
#[cfg(not(unix))]
pub(super) fn now() -> Duration {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed()
}

/// What a core's process says that it has computed for its answers. It stands still if the process does not say.
#[derive(Clone, Debug, Default)]
pub(crate) struct CpuClock(Arc<AtomicU64>);

impl CpuClock {
    /// NaN and what is negative, as a program may say, count as nothing.
    pub(super) fn add(&self, seconds: f64) {
        self.0.fetch_add((1e9 * seconds.max(0.0)) as u64, Ordering::Relaxed);
    }

    /// So far.
    pub(crate) fn seconds(&self) -> f64 {
        1e-9 * self.0.load(Ordering::Relaxed) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_computed_is_counted() {
        let clock = CpuClock::default();
        [0.25, -1.0, f64::NAN, 0.5].into_iter().for_each(|seconds| clock.add(seconds));
        assert!((clock.seconds() - 0.75).abs() < 1e-9);
    }
}
