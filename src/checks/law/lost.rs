//! Light of which a share of the samples is lost: that share is exactly 0, and the others have the mean that all should have.
//! Of light that is weighted wrongly no sample is 0 that should not be.

use crate::checks::Measure;
use crate::checks::phrase::percent;

/// The law, in the words of a headline.
pub(crate) const LOST_SAMPLES: &str =
    "a share of the samples contributes nothing, and the others what all should";

/// The same of one case: `40 % of the samples contribute nothing, and the others what all should`.
pub(crate) fn lost_in_words(share: f64) -> String {
    format!("{} of the samples contribute nothing, and the others what all should", percent(share))
}

/// Fewer estimates tell no share.
const FEWEST: u64 = 1000;
/// How many standard errors of the share of dark estimates are forgiven: more come once in 16,000 times.
const ERRORS: f64 = 4.0;

/// Estimates of one mean, and how many of them were 0.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lost {
    pub(crate) samples: u64,
    pub(crate) dark: u64,
}

impl Lost {
    /// The share that is 0, if without it each of these means is what it should be. A right core may have dark samples,
    /// too: it has its mean with them.
    pub(crate) fn share(self, means: &[Measure]) -> Option<f64> {
        let share = self.dark as f64 / self.samples as f64;
        let error = ERRORS * (share * (1.0 - share) / self.samples as f64).sqrt();
        let is_left = |mean: &Measure| {
            let [left, slack] = [1.0 - share, error].map(|of_all| of_all * mean.expected);
            let [low, high] = mean.interval.unwrap_or([mean.measured; 2]);
            low - slack <= left && left <= high + slack
        };
        let is_told = self.samples >= FEWEST
            && (0.01..0.99).contains(&share)
            && means.iter().any(Measure::failed)
            && means.iter().all(is_left);
        is_told.then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Verdict;

    #[test]
    fn what_the_others_bring_is_what_all_should() {
        let means = |ratio: f64| {
            [0.3, 0.2].map(|expected| Measure {
                interval: Some([0.999, 1.001].map(|off| off * ratio * expected)),
                verdict: Verdict::pass_if(ratio == 1.0),
                ..Measure::exact("", ratio * expected, expected, 1e-3)
            })
        };
        let share = |dark, ratio| Lost { samples: 100_000, dark }.share(&means(ratio));
        assert_eq!(share(43_000, 0.57), Some(0.43));
        assert_eq!(share(0, 0.5), None, "halved");
        assert_eq!(share(50_000, 0.4), None, "the others are wrong, too");
        assert_eq!(
            share(50_000, 1.0),
            None,
            "a right core that misses the light with every second ray"
        );
        assert_eq!(share(100_000, 0.0), None, "darkness");
        assert_eq!(share(43_000, f64::NAN), None);
        assert_eq!(Lost { samples: 100, dark: 43 }.share(&means(0.57)), None, "too few");
    }
}
