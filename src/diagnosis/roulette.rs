//! Means under Russian roulette: what is forgotten at the roulette predicts a mean for each stopping probability.

use super::evidence::measure;
use super::readings::{Reading, channels};
use super::{Degree, Evidence, Suspicion};
use crate::case::Role;
use crate::cause::{Cause, integrator};
use crate::checks::{Finding, Measure};
use crate::image::{CHANNELS, Channel};

const FURNACE: Role = Role::FurnaceUnderRoulette;
/// Bounces that a prediction adds up; what is beyond is below 1e-12 of the whole.
const LAST: i32 = 40;

/// A row of the case: `stop 0.35, 1 guaranteed`.
#[derive(Clone, Copy)]
struct Play {
    stop: f64,
    guaranteed: i32,
}

impl Play {
    fn of(row: &str) -> Option<Self> {
        let (stop, guaranteed) = row.strip_prefix("stop ")?.split_once(", ")?;
        let guaranteed = guaranteed.strip_suffix(" guaranteed")?.parse().ok()?;
        Some(Self { stop: stop.parse().ok()?, guaranteed })
    }

    /// How often roulette was played before the light of `bounce` is added.
    fn played(&self, bounce: i32) -> i32 {
        (bounce - 1 - self.guaranteed).max(0)
    }

    /// How often it was not, although the path went on.
    fn spared(&self, bounce: i32) -> i32 {
        (bounce - 1).max(0) - self.played(bounce)
    }
}

/// A mistake, and the factor it puts on the light of a bounce.
struct Law {
    cause: &'static Cause,
    words: &'static str,
    factor: fn(Play, i32) -> f64,
}

static LAWS: &[Law] = &[
    Law {
        cause: &integrator::ROULETTE_NOT_DIVIDED,
        words: "what survives n roulettes is survival^n of what it should be",
        factor: |play, bounce| (1.0 - play.stop).powi(play.played(bounce)),
    },
    Law {
        cause: &integrator::ROULETTE_DIVIDED_BY_STOP,
        words: "what survives n roulettes is (survival/stop)^n of what it should be",
        factor: |play, bounce| ((1.0 - play.stop) / play.stop).powi(play.played(bounce)),
    },
    Law {
        cause: &integrator::ROULETTE_DIVIDED_WHEN_GUARANTEED,
        words: "guaranteed bounces are 1/survival of what they should be",
        factor: |play, bounce| (1.0 - play.stop).powi(-play.spared(bounce)),
    },
    Law {
        cause: &integrator::ROULETTE_STOPS_DIRECT,
        words: "the light of each bounce is survival of what it should be where roulette was played at its vertex",
        factor: |play, bounce| {
            let at_vertex = bounce > play.guaranteed;
            if bounce > 0 && at_vertex { 1.0 - play.stop } else { 1.0 }
        },
    },
];

struct Row {
    play: Play,
    readings: [Option<Reading>; 3],
    /// What the whole series adds up to in each channel.
    totals: [f64; 3],
}

/// Laws that predict the mean of every row.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let Some(finding) = evidence.failed_finding(FURNACE) else { return Vec::new() };
    let rows = rows(finding);
    let fits = |law: &&Law| !rows.is_empty() && rows.iter().all(|row| row.admits(law));
    let fitting: Vec<_> = LAWS.iter().filter(fits).collect();
    let degree = Degree::of_one_among(fitting.len());
    let case = evidence.case(FURNACE);
    let told = |law: &Law| Suspicion { degree, ..suspicion(case, law, &rows) };
    fitting.into_iter().map(told).collect()
}

fn rows(finding: &Finding) -> Vec<Row> {
    let is_red = |measure: &&Measure| measure.channel == Some(Channel::Red);
    let row = |name: &str| {
        let totals = CHANNELS
            .map(|channel| measure(finding, name, channel).map_or(f64::NAN, |m| m.expected));
        Some(Row { play: Play::of(name)?, readings: channels(finding, name), totals })
    };
    finding.measures.iter().filter(is_red).filter_map(|measure| row(&measure.row)).collect()
}

impl Row {
    fn admits(&self, law: &Law) -> bool {
        (0..3).all(|channel| {
            let predicted = law.ratio(self.play, channel, self.totals[channel]);
            self.readings[channel].is_none_or(|reading| reading.admits(predicted))
        })
    }

    fn words(&self, law: &Law) -> Option<String> {
        let reading = self.readings[0]?;
        Some(format!(
            "stop {}, {} guaranteed: {}",
            self.play.stop,
            self.play.guaranteed,
            reading.beside(law.ratio(self.play, 0, self.totals[0]))
        ))
    }
}

/// Emission of the furnace of the case; its albedo follows from the total.
const EMISSION: [f64; 3] = [0.7, 0.5, 0.9];

impl Law {
    fn ratio(&self, play: Play, channel: usize, total: f64) -> f64 {
        let emission = EMISSION[channel];
        let albedo = 1.0 - emission / total;
        let light = |bounce: i32| emission * albedo.powi(bounce) * (self.factor)(play, bounce);
        (0..=LAST).map(light).sum::<f64>() / total
    }
}

fn suspicion(case: &str, law: &Law, rows: &[Row]) -> Suspicion {
    let measured: Vec<_> = rows.iter().filter_map(|row| row.words(law)).collect();
    Suspicion {
        cause: law.cause,
        cases: vec![case.to_owned()],
        evidence: vec![law.words.to_owned(), format!("red over right: {}", measured.join(" · "))],
        ruled_out: Vec::new(),
        weight: 1.0,
        degree: Degree::Named,
        beside: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::testing::{Made, mean, means};

    #[test]
    fn every_law_is_told_by_its_own_means() {
        let plays = [(0.35, 0), (0.35, 1), (0.1, 1), (0.6, 2)];
        let totals = [1.111111111, 0.9090909091, 1.8];
        for law in LAWS {
            let mut measures = Vec::new();
            for (stop, guaranteed) in plays {
                for channel in CHANNELS {
                    let (play, total) = (Play { stop, guaranteed }, totals[channel.index()]);
                    let ratio = law.ratio(play, channel.index(), total);
                    let row = format!("stop {stop}, {guaranteed} guaranteed");
                    measures.push(mean(&row, channel, total, ratio, 0.003));
                }
            }
            let made = Made::new().with(FURNACE, means(measures));
            assert_eq!(made.first(), Some(law.cause.name));
        }
    }

    #[test]
    fn the_emission_is_that_of_the_case() {
        let text =
            include_str!("../../cases/integrator/russian-roulette-leaves-the-mean-unchanged.toml");
        assert!(text.contains("emission = [0.7, 0.5, 0.9]"));
    }
}
