//! One row of a case of mean radiance, put to one core.

use super::estimate::{Aim, estimate};
use crate::checks::law::Lost;
use crate::checks::{CheckError, Measure, Result};
use crate::contract::{BuiltScene, IntegratorSettings};
use crate::image::CHANNELS;
use crate::math::rng::Seed;
use crate::stats::{Band, Claim, Effort, judge_means};

/// Samples of a row that has no variance.
const EXACT_SAMPLES: u64 = 64;

/// Samples of a row that has to be dark: one photon is enough to fail.
pub(super) const DARK_SAMPLES: u64 = 16_384;

/// Rays may start so far ahead of a surface, in parts of its size: those that graze it at such an angle pass through
/// what is behind, and carry so much of what shines there.
const GAP: f64 = 1e-4;

/// One row, put to one core.
pub(super) struct Question {
    pub(super) name: String,
    pub(super) aim: Aim,
    pub(super) settings: IntegratorSettings,
    pub(super) expected: [f64; 3],
    /// Relative error allowed where nothing is left to chance.
    pub(super) exact: Option<f64>,
    pub(super) seed: Seed,
    /// The largest radiance that surfaces of the scene emit.
    pub(super) brightest: f64,
}

/// What came of a row.
pub(super) struct Judged {
    /// Of each of the three channels.
    pub(super) measures: Vec<Measure>,
    /// The share of samples that bring no light, where the others bring what all should.
    pub(super) lost: Option<f64>,
}

impl Question {
    pub(super) fn judge(&self, scene: &mut dyn BuiltScene, effort: &Effort) -> Result<Judged> {
        let (lit, dark): (Vec<_>, Vec<_>) = (0..3).partition(|c| self.expected[*c] != 0.0);
        let mut lost = Lost::default();
        let mut measures = match self.exact {
            _ if lit.is_empty() => Vec::new(),
            Some(tolerance) => self.judge_exact(scene, &lit, tolerance)?,
            None => self.judge_lit(scene, &lit, effort, &mut lost)?,
        };
        let lost = lost.share(&measures);
        if !dark.is_empty() {
            measures.extend(self.judge_dark(scene, &dark)?);
        }
        let measures = measures.into_iter().map(|measure| measure.of_row(&self.name)).collect();
        Ok(Judged { measures, lost })
    }

    /// The means of channels with light.
    fn judge_lit(
        &self,
        scene: &mut dyn BuiltScene,
        channels: &[usize],
        effort: &Effort,
        lost: &mut Lost,
    ) -> Result<Vec<Measure>> {
        let claim = |channel: &usize| Claim::value(self.expected[*channel], Band::RADIANCE);
        let claims: Vec<_> = channels.iter().map(claim).collect();
        let reports = judge_means(&claims, effort, &mut |draw| {
            let seed = draw.seed(self.seed);
            let run = estimate(scene, self.aim, &self.settings, seed, draw.samples)?;
            lost.samples += draw.samples;
            lost.dark += run.dark;
            Ok::<_, CheckError>(channels.iter().map(|channel| run.mean[*channel]).collect())
        })?;
        let measures = channels.iter().zip(&reports);
        Ok(measures.map(|(c, report)| Measure::of("", report).of_channel(CHANNELS[*c])).collect())
    }

    /// No light at all: not one sample may carry any but what slips through a gap.
    fn judge_dark(&self, scene: &mut dyn BuiltScene, channels: &[usize]) -> Result<Vec<Measure>> {
        let run = estimate(scene, self.aim, &self.settings, self.seed, DARK_SAMPLES)?;
        let allowed = GAP * self.brightest;
        let dark =
            |c: usize| Measure::exact("", run.largest[c], 0.0, allowed).of_channel(CHANNELS[c]);
        Ok(channels.iter().copied().map(dark).collect())
    }

    /// No variance: a few samples say it all.
    fn judge_exact(
        &self,
        scene: &mut dyn BuiltScene,
        channels: &[usize],
        tolerance: f64,
    ) -> Result<Vec<Measure>> {
        let run = estimate(scene, self.aim, &self.settings, self.seed, EXACT_SAMPLES)?;
        let exact = |c: usize| {
            let allowed = tolerance * self.expected[c].abs();
            Measure::exact("", run.mean[c], self.expected[c], allowed).of_channel(CHANNELS[c])
        };
        Ok(channels.iter().copied().map(exact).collect())
    }
}
