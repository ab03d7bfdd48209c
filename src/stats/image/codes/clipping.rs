//! Whether what should be clipped is: of pixels that are brighter than white, only that is seen.

use super::Codes;
use super::channel::{Channel, Standing};
use crate::image::encoding::WHITE;
use crate::stats::image::draw::Levels;
use crate::stats::{ImageDraw, ImageEffort, Moments, Stage, student_upper};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClippingReport {
    /// Channels of pixels that should be clipped in most pictures.
    pub(crate) channels: usize,
    /// Share of them that is, over the last pictures drawn.
    pub(crate) share: f64,
    /// The share that should be at least.
    pub(crate) expected: f64,
    /// Whether every stage found too few.
    pub(crate) rejects: bool,
}

/// The account, stage by stage.
pub(super) struct Clipping {
    levels: Levels,
    places: Vec<usize>,
    /// The least mean share that a correct core can have.
    expected: f64,
    /// Of each stage, by how much pictures fall short of that.
    missing: [Moments; 3],
}

impl Clipping {
    pub(super) fn new(channels: &[Channel], levels: Levels) -> Self {
        let clipped = |(index, channel): (usize, &Channel)| {
            (channel.standing == Standing::Clipped).then_some((index, channel.clipped))
        };
        let (places, shares): (Vec<_>, Vec<_>) =
            channels.iter().enumerate().filter_map(clipped).unzip();
        let expected = shares.iter().sum::<f64>() / shares.len() as f64;
        Self { levels, places, expected, missing: Default::default() }
    }

    pub(super) fn take(&mut self, stage: Stage, codes: &[u8]) {
        if self.places.is_empty() {
            return;
        }
        let clipped = self.places.iter().filter(|place| f64::from(codes[**place]) == WHITE).count();
        let missing = self.expected - clipped as f64 / self.places.len() as f64;
        self.missing[stage.index()].push(missing);
    }

    /// Draws the confirmations, if too little was clipped and nothing else asked for them.
    pub(super) fn confirm<E>(
        &mut self,
        effort: &ImageEffort,
        draw: &mut dyn FnMut(ImageDraw) -> Result<Codes, E>,
    ) -> Result<(), E> {
        if !self.rejects(Stage::First) {
            return Ok(());
        }
        for stage in [Stage::Second, Stage::Third] {
            let drawn = self.missing[stage.index()].count();
            for run in (0..effort.confirm_runs()).filter(|run| u64::from(*run) >= drawn) {
                let picture = draw(ImageDraw { stage, run })?;
                self.take(stage, picture.pixels.as_flattened());
            }
        }
        Ok(())
    }

    fn rejects(&self, stage: Stage) -> bool {
        let missing = &self.missing[stage.index()];
        let level = match stage {
            Stage::First => self.levels.screen,
            _ => self.levels.confirm,
        };
        if missing.count() < 2 {
            return false;
        }
        let critical = student_upper(level, (missing.count() - 1) as f64);
        missing.mean() > critical * missing.standard_error() && missing.mean() > 0.0
    }

    pub(super) fn report(&self) -> Option<ClippingReport> {
        let last = self.missing.iter().rev().find(|missing| missing.count() > 0)?;
        Some(ClippingReport {
            channels: self.places.len(),
            share: self.expected - last.mean(),
            expected: self.expected,
            rejects: Stage::DECIDING.into_iter().all(|stage| self.rejects(stage)),
        })
    }
}
