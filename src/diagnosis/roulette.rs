//! Means under Russian roulette: what is forgotten at the roulette predicts a mean for each stopping probability.

use super::readings::{CHANNELS, Reading, channels, written};
use super::{Evidence, Suspicion};
use crate::cause::{Cause, transport};

/// The furnace at four roulettes.
const CASE: &str = "integrator/roulette-does-not-change-the-mean";
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

    /// How often roulette was played before the light of `bounce` is gathered.
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
        cause: &transport::ROULETTE_NOT_DIVIDED,
        words: "what survives n roulettes is survival^n of what it should be",
        factor: |play, bounce| (1.0 - play.stop).powi(play.played(bounce)),
    },
    Law {
        cause: &transport::ROULETTE_DIVIDED_BY_STOP,
        words: "what survives n roulettes is (survival/stop)^n of what it should be",
        factor: |play, bounce| ((1.0 - play.stop) / play.stop).powi(play.played(bounce)),
    },
    Law {
        cause: &transport::ROULETTE_DIVIDED_WHEN_GUARANTEED,
        words: "guaranteed bounces are 1/survival of what they should be",
        factor: |play, bounce| (1.0 - play.stop).powi(-play.spared(bounce)),
    },
    Law {
        cause: &transport::ROULETTE_STOPS_DIRECT,
        words: "the light of each bounce is survival of what it should be where roulette was played at its vertex",
        factor: |play, bounce| {
            let at_vertex = bounce > play.guaranteed;
            if bounce > 0 && at_vertex { 1.0 - play.stop } else { 1.0 }
        },
    },
];

/// Laws that predict the mean of every row.
pub fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let Some(finding) = evidence.failed_finding(CASE) else { return Vec::new() };
    let mut rows: Vec<(Play, [Option<Reading>; 3], [f64; 3])> = Vec::new();
    let mut seen: Vec<&str> = Vec::new();
    for measure in &finding.measures {
        let Some((row, _)) = measure.name.rsplit_once(", ") else { continue };
        if let Some(play) = Play::of(row).filter(|_| !seen.contains(&row)) {
            seen.push(row);
            let expected = CHANNELS.map(|channel| {
                let name = format!("{row}, {channel}");
                finding.measures.iter().find(|m| m.name == name).map_or(0.0, |m| m.expected)
            });
            rows.push((play, channels(finding, row), expected));
        }
    }
    let fits = |law: &&Law| {
        !rows.is_empty()
            && rows.iter().all(|(play, readings, expected)| {
                readings.iter().zip(EMISSION).zip(expected).all(|((reading, emission), total)| {
                    let predicted = predicted_ratio(law, *play, emission, *total);
                    reading.is_none_or(|reading| reading.admits(predicted))
                })
            })
    };
    LAWS.iter().filter(fits).map(|law| suspicion(law, &rows)).collect()
}

/// Emission of the furnace of the case; its albedo follows from the total.
const EMISSION: [f64; 3] = [0.7, 0.5, 0.9];

/// Mean over what it should be.
fn predicted_ratio(law: &Law, play: Play, emission: f64, total: f64) -> f64 {
    let albedo = 1.0 - emission / total;
    let light = |bounce: i32| emission * albedo.powi(bounce) * (law.factor)(play, bounce);
    (0..=LAST).map(light).sum::<f64>() / total
}

fn suspicion(law: &Law, rows: &[(Play, [Option<Reading>; 3], [f64; 3])]) -> Suspicion {
    let row = |(play, readings, expected): &(Play, [Option<Reading>; 3], [f64; 3])| {
        let reading = readings[0]?;
        Some(format!(
            "stop {}, {} guaranteed: {} ± {} (predicted {})",
            play.stop,
            play.guaranteed,
            written(reading.ratio),
            written(reading.half_width()),
            written(predicted_ratio(law, *play, EMISSION[0], expected[0]))
        ))
    };
    let measured: Vec<_> = rows.iter().filter_map(row).collect();
    Suspicion {
        cause: law.cause,
        cases: vec![CASE.to_owned()],
        evidence: vec![law.words.to_owned(), format!("red over right: {}", measured.join(" · "))],
        ruled_out: Vec::new(),
        weight: 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, mean, means};

    #[test]
    fn every_law_is_told_by_its_own_means() {
        let plays = [(0.35, 0), (0.35, 1), (0.1, 1), (0.6, 2)];
        let totals = [1.111111111, 0.9090909091, 1.8];
        for law in LAWS {
            let mut measures = Vec::new();
            for (stop, guaranteed) in plays {
                for channel in 0..3 {
                    let play = Play { stop, guaranteed };
                    let ratio = predicted_ratio(law, play, EMISSION[channel], totals[channel]);
                    let name =
                        format!("stop {stop}, {guaranteed} guaranteed, {}", CHANNELS[channel]);
                    measures.push(mean(&name, totals[channel], ratio, 0.003));
                }
            }
            let diagnosis = diagnose(&Made::new().with(CASE, means(measures)).evidence());
            assert_eq!(diagnosis.first().map(|cause| cause.name), Some(law.cause.name));
        }
    }

    #[test]
    fn the_emission_is_that_of_the_case() {
        let text = include_str!("../../cases/integrator/roulette-does-not-change-the-mean.toml");
        assert!(text.contains("emission = [0.7, 0.5, 0.9]"));
    }
}
