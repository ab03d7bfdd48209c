//! Energy bounce by bounce in a furnace, where bounce k is emission · albedo^k and nothing else matters.
//!
//! Each law says what a mistake makes of any sum of bounces; a law is suspected where it predicts every number of the
//! case, channel by channel. Where no law fits and indirect light is off by one grey factor a bounce, the factor is
//! fitted and told with its interval.

use super::evidence::measure;
use super::readings::{CHANNELS, Reading, channels, written};
use super::{Evidence, Suspicion};
use crate::cause::{Cause, transport};
use crate::checks::Finding;
use crate::math::ratios::names_of;
use std::f64::consts::PI;

/// The furnaces whose bounces are told one by one.
const FURNACES: [&str; 2] = [
    "integrator/a-furnace-glows-by-its-series",
    "integrator/a-furnace-by-the-hemisphere-glows-the-same",
];
/// The cavity that sees directions, which a furnace cannot.
const CAVITY: &str = "integrator/a-glowing-cap-lights-its-cavity-evenly";
/// A wall that faces sideways.
const SIDE: &str = "integrator/a-room-is-lit-from-its-middle-at-its-sides-too";
/// How much less a mistake weighs if it is not the only one that fits.
const SHARED: f64 = 0.6;
/// The last bounce that rows of a furnace ask for.
const LAST: u32 = 40;

/// Emission and albedo of one channel, as the case expects them.
#[derive(Clone, Copy, Debug)]
struct Channel {
    emission: f64,
    albedo: f64,
    /// Luminance of the three albedos.
    luminance: f64,
    /// Their mean.
    mean: f64,
}

impl Channel {
    fn of(emission: f64, albedo: f64, all: [f64; 3]) -> Self {
        let luminance = 0.2126 * all[0] + 0.7152 * all[1] + 0.0722 * all[2];
        Self { emission, albedo, luminance, mean: all.iter().sum::<f64>() / 3.0 }
    }
    /// Light that was scattered `bounce` times.
    fn bounce(&self, bounce: u32) -> f64 {
        self.emission * self.albedo.powi(bounce.cast_signed())
    }

    /// The sum over bounces of `weight(bounce)` times what is right.
    fn sum(&self, [first, last]: [u32; 2], weight: impl Fn(u32) -> f64) -> f64 {
        (first..=last.min(LAST)).map(|bounce| weight(bounce) * self.bounce(bounce)).sum()
    }
}

/// A mistake, and what it makes of the sum of bounces `first..=last`.
struct Law {
    cause: &'static Cause,
    words: &'static str,
    predict: fn(&Channel, [u32; 2]) -> f64,
    /// What it makes of light that is scattered once, over what is right.
    direct: f64,
}

impl Law {
    const fn new(
        cause: &'static Cause,
        words: &'static str,
        predict: fn(&Channel, [u32; 2]) -> f64,
    ) -> Self {
        Self { cause, words, predict, direct: 1.0 }
    }

    /// A law that direct light shows too.
    const fn with_direct(self, direct: f64) -> Self {
        Self { direct, ..self }
    }
}

/// Indirect bounces: those that need the path to go on.
fn indirect(bounce: u32) -> i32 {
    bounce.saturating_sub(1).cast_signed()
}

/// What a bounce is multiplied by if it is weighted with f cos θ · pdf, cosine-distributed: the integral of
/// cos³ θ/π³ over the hemisphere.
const TIMES_PDF: f64 = 1.0 / (2.0 * PI * PI);

static LAWS: &[Law] = &[
    Law::new(
        &transport::ONE_BOUNCE_SHORT,
        "bounce k holds what belongs to bounce k − 1, and sums end one bounce early",
        |c, [first, last]| match (first, last) {
            (0, last) => c.sum([0, last.saturating_sub(1)], |_| 1.0),
            (first, last) => c.sum([first - 1, last - 1], |_| 1.0),
        },
    )
    .with_direct(0.0),
    Law::new(
        &transport::ONE_BOUNCE_SHORT,
        "the last bounce asked for is missing, from the second on",
        |c, [first, last]| match last {
            0 | 1 => c.sum([first, last], |_| 1.0),
            last => c.sum([first, last - 1], |_| 1.0),
        },
    ),
    Law::new(
        &transport::ONE_BOUNCE_SHORT,
        "the last bounce asked for is missing",
        |c, [first, last]| match last {
            0 => c.bounce(0),
            last => c.sum([first, last - 1], |_| 1.0),
        },
    )
    .with_direct(0.0),
    Law::new(
        &transport::ONE_BOUNCE_LONG,
        "bounce k holds what belongs to bounce k + 1",
        |c, [first, last]| match (first, last) {
            (0, 0) => c.bounce(0),
            (0, last) => c.sum([0, last + 1], |_| 1.0),
            (first, last) => c.sum([first + 1, last + 1], |_| 1.0),
        },
    ),
    Law::new(
        &transport::ONE_BOUNCE_LONG,
        "every sum holds one bounce more than was asked for",
        |c, [first, last]| {
            if last == 0 { c.bounce(0) } else { c.sum([first, last + 1], |_| 1.0) }
        },
    ),
    Law::new(
        &transport::DEPTH_IGNORED,
        "whatever bounce is the last asked for, all later ones are there too",
        |c, [first, _]| c.sum([first, LAST], |_| 1.0),
    ),
    Law::new(
        &transport::ZERO_DEPTH_LIT,
        "bounce 0 holds bounce 1 too, and bounce 1 alone is empty",
        |c, bounces| match bounces {
            [0, last] => c.sum([0, last.max(1)], |_| 1.0),
            [1, 1] => 0.0,
            rows => c.sum(rows, |_| 1.0),
        },
    )
    .with_direct(0.0),
    Law::new(&transport::ZERO_DEPTH_LIT, "bounce 0 holds bounce 1 too", |c, [first, last]| {
        c.sum([first, if first == 0 { last.max(1) } else { last }], |_| 1.0)
    }),
    Law::new(
        &transport::ISOLATION_IGNORED,
        "bounce k holds all bounces up to k",
        |c, [_, last]| c.sum([0, last], |_| 1.0),
    ),
    Law::new(
        &transport::ISOLATION_IGNORED,
        "bounce k holds all bounces from 1 to k",
        |c, [first, last]| c.sum([first.min(1), last], |_| 1.0),
    ),
    Law::new(
        &transport::ALBEDO_TWICE,
        "indirect bounce k is albedo^(k−1) of what it should be, in the colours of the surface",
        |c, rows| c.sum(rows, |bounce| c.albedo.powi(indirect(bounce))),
    ),
    Law::new(
        &transport::ALBEDO_FORGOTTEN,
        "indirect bounce k is 1/albedo^(k−1) of what it should be, in the colours of the surface",
        |c, rows| c.sum(rows, |bounce| c.albedo.powi(-indirect(bounce))),
    ),
    Law::new(
        &transport::WEIGHT_REPLACED,
        "from bounce 3 on there is albedo² of what glows",
        |c, rows| c.sum(rows, |bounce| c.albedo.powi(-indirect(bounce.saturating_sub(1)))),
    ),
    Law::new(
        &transport::GREY_THROUGHPUT,
        "indirect bounce k is (luminance/albedo)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| (c.luminance / c.albedo).powi(indirect(bounce))),
    ),
    Law::new(
        &transport::GREY_THROUGHPUT,
        "indirect bounce k is (mean albedo/albedo)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| (c.mean / c.albedo).powi(indirect(bounce))),
    ),
    Law::new(&transport::EMISSION_AGAIN, "every bounce is there twice", |c, rows| {
        c.sum(rows, |bounce| if bounce == 0 { 1.0 } else { 2.0 })
    })
    .with_direct(2.0),
    Law::new(
        &transport::EMISSION_AGAIN,
        "every bounce from the second on is there twice",
        |c, rows| c.sum(rows, |bounce| if bounce < 2 { 1.0 } else { 2.0 }),
    ),
    Law::new(
        &transport::EMISSION_AGAIN,
        "every bounce but the last of a sum is there twice",
        |c, [first, last]| {
            c.sum([first, last], |bounce| if bounce == 0 || bounce == last { 1.0 } else { 2.0 })
        },
    ),
    Law::new(&transport::NO_INDIRECT, "from bounce 2 on there is nothing", |c, rows| {
        c.sum(rows, |bounce| if bounce < 2 { 1.0 } else { 0.0 })
    }),
    Law::new(
        &transport::INDIRECT_FOUR_THIRDS,
        "indirect bounce k is (4/3)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| (4.0_f64 / 3.0).powi(indirect(bounce))),
    ),
    Law::new(
        &transport::BOUNCE_TIMES_PDF,
        "indirect bounce k is (1/2π²)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| TIMES_PDF.powi(indirect(bounce))),
    ),
    Law::new(
        &transport::BOUNCE_WITHOUT_COSINE,
        "indirect bounce k is 2^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| 2.0_f64.powi(indirect(bounce))),
    ),
    Law::new(&transport::EMISSION_LOST, "sums lack bounce 0", |c, [first, last]| {
        if first == last { c.bounce(first) } else { c.sum([first.max(1), last], |_| 1.0) }
    }),
    Law::new(&transport::LAST_BOUNCE_ONLY, "sums are their last bounce alone", |c, [_, last]| {
        c.bounce(last)
    }),
];

/// Laws that predict a failing furnace, a factor a bounce, or directions that only the cavity sees.
pub fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let mut suspicions: Vec<_> = FURNACES.iter().flat_map(|case| explain(evidence, case)).collect();
    suspicions.extend(wrong_directions(evidence));
    suspicions.extend(world_cosine(evidence));
    suspicions
}

fn explain(evidence: &Evidence<'_>, case: &str) -> Vec<Suspicion> {
    let Some(finding) = evidence.failed_finding(case) else { return Vec::new() };
    let Some(furnace) = Furnace::of(finding) else { return Vec::new() };
    let fitting: Vec<_> = LAWS.iter().filter(|law| furnace.admits(law.predict)).collect();
    let weight = if fitting.len() == 1 { 1.0 } else { SHARED };
    let told = |law: &&Law| Suspicion {
        cause: law.cause,
        cases: std::iter::once(case.to_owned()).chain(direct_light(evidence, law)).collect(),
        evidence: vec![furnace.table(), law.words.to_owned()],
        ruled_out: furnace.ruled_out(law),
        weight,
    };
    if fitting.is_empty() {
        let factor = furnace.constant_factor(case);
        return factor.or_else(|| furnace.lost_ways(case)).into_iter().collect();
    }
    fitting.iter().map(told).collect()
}

/// Failing cases of direct light that a law explains too.
fn direct_light(evidence: &Evidence<'_>, law: &Law) -> Vec<String> {
    let explains = |finding: &Finding| {
        let mut wrong = finding.failed_measures().filter_map(Reading::of).peekable();
        law.direct != 1.0 && wrong.peek().is_some() && wrong.all(|r| r.admits(law.direct))
    };
    let failures = evidence.failures().filter(|seen| seen.case.starts_with("lights/"));
    let explained = failures.filter(|seen| seen.finding.is_some_and(explains));
    explained.map(|seen| seen.case.to_owned()).collect()
}

/// A row of a furnace: which bounces it adds up, and what was read in each channel.
struct Row {
    bounces: [u32; 2],
    readings: [Option<Reading>; 3],
}

/// The rows of a failing furnace.
struct Furnace {
    channels: [Channel; 3],
    rows: Vec<Row>,
}

impl Furnace {
    /// None if the finding has not the rows that tell emission and albedo.
    fn of(finding: &Finding) -> Option<Self> {
        let expected = |bounce: u32, channel: &str| {
            measure(finding, &format!("bounce {bounce}, {channel}")).map(|m| m.expected)
        };
        let mut albedo = [0.0; 3];
        let mut emission = [0.0; 3];
        for (number, channel) in CHANNELS.iter().enumerate() {
            let (first, second) = (expected(1, channel)?, expected(2, channel)?);
            albedo[number] = second / first;
            emission[number] = first / albedo[number];
        }
        let channels = [0, 1, 2].map(|c| Channel::of(emission[c], albedo[c], albedo));
        Some(Self { channels, rows: rows(finding) })
    }

    /// Whether a law predicts every number.
    fn admits(&self, predict: fn(&Channel, [u32; 2]) -> f64) -> bool {
        self.rows.iter().all(|row| self.row_admits(row, &predict))
    }

    fn row_admits(&self, row: &Row, predict: &impl Fn(&Channel, [u32; 2]) -> f64) -> bool {
        self.channels.iter().zip(&row.readings).all(|(channel, reading)| {
            let right = channel.sum(row.bounces, |_| 1.0);
            reading.is_none_or(|reading| reading.admits(predict(channel, row.bounces) / right))
        })
    }

    /// Isolated bounces beside what they should be.
    fn table(&self) -> String {
        let isolated = self.rows.iter().filter(|row| row.bounces[0] == row.bounces[1]);
        let cells: Vec<_> = isolated
            .filter_map(|row| {
                let ratios: Vec<_> =
                    row.readings.iter().flatten().map(|reading| written(reading.ratio)).collect();
                (!ratios.is_empty()).then(|| format!("{}: {}", row.bounces[0], ratios.join(" ")))
            })
            .collect();
        format!("bounce by bounce, over what it should be (red green blue): {}", cells.join(" · "))
    }

    /// The first row at which each other law of the same family fails.
    fn ruled_out(&self, law: &Law) -> Vec<String> {
        let rivals = LAWS.iter().filter(|rival| rival.cause.name != law.cause.name);
        let refuted = rivals.filter_map(|rival| {
            let row = self.rows.iter().find(|row| !self.row_admits(row, &rival.predict))?;
            let (channel, reading) =
                self.channels.iter().zip(&row.readings).find_map(|(c, r)| Some((c, (*r)?)))?;
            let right = channel.sum(row.bounces, |_| 1.0);
            let predicted = (rival.predict)(channel, row.bounces) / right;
            let [first, last] = row.bounces;
            let what = if first == last {
                format!("bounce {first}")
            } else {
                format!("bounces {first} to {last}")
            };
            Some(format!(
                "{} ({what} would be {}, not {})",
                rival.cause.headline,
                written(predicted),
                written(reading.ratio)
            ))
        });
        refuted.take(2).collect()
    }

    /// One grey factor for every indirect bounce, if all isolated bounces agree on it.
    fn constant_factor(&self, case: &str) -> Option<Suspicion> {
        let mut interval = [f64::NEG_INFINITY, f64::INFINITY];
        let mut most = 0;
        for row in self.rows.iter().filter(|row| row.bounces[0] == row.bounces[1]) {
            let bounce = row.bounces[0];
            for reading in row.readings.iter().flatten() {
                if bounce < 2 {
                    if !reading.admits(1.0) {
                        return None;
                    }
                    continue;
                }
                let root = |value: f64| value.max(0.0).powf(1.0 / f64::from(indirect(bounce)));
                interval[0] = interval[0].max(root(reading.interval[0]));
                interval[1] = interval[1].min(root(reading.interval[1]));
                most = most.max(bounce);
            }
        }
        let [low, high] = interval;
        (most > 2 && low <= high && high.is_finite()).then(|| self.of_factor(case, interval))
    }

    /// Direct light is right, and indirect light is off by other grey factors at each bounce: it does not come
    /// from where it should.
    fn lost_ways(&self, case: &str) -> Option<Suspicion> {
        let isolated = || self.rows.iter().filter(|row| row.bounces[0] == row.bounces[1]);
        let mut direct = isolated().filter(|row| row.bounces[0] == 1).peekable();
        let right = direct.peek().is_some()
            && direct.all(|row| row.readings.iter().flatten().all(|r| r.admits(1.0)));
        let mut indirect = isolated().filter(|row| row.bounces[0] > 1).peekable();
        let grey = indirect.peek().is_some() && indirect.all(|row| is_grey(&row.readings));
        (right && grey).then(|| Suspicion {
            cause: &transport::BOUNCE_DIRECTIONS,
            cases: vec![case.to_owned()],
            evidence: vec![self.table(), "the same in all colours, and no power of k".to_owned()],
            ruled_out: vec!["a wrong weight of bounces (it would be a power of k)".to_owned()],
            weight: SHARED,
        })
    }

    fn of_factor(&self, case: &str, [low, high]: [f64; 2]) -> Suspicion {
        let factor = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        let fit = format!("bounce k is {factor:.4}^(k−1) ± {half:.4} of what it should be, grey");
        let named = names_of([low, high], &[]);
        let name = named.first().map(|name| format!("the factor a bounce is {}", name.name));
        let below_one = factor < 1.0 && name.is_none();
        let cause =
            if below_one { &transport::ROULETTE_NOT_DIVIDED } else { &transport::INDIRECT_FACTOR };
        let mut evidence = vec![self.table(), fit];
        evidence.extend(name);
        Suspicion {
            cause,
            cases: vec![case.to_owned()],
            evidence,
            ruled_out: vec!["the albedo twice or not at all (it would be coloured)".to_owned()],
            weight: SHARED,
        }
    }
}

/// Whether one ratio fits all channels.
fn is_grey(readings: &[Option<Reading>; 3]) -> bool {
    let low = readings.iter().flatten().map(|r| r.interval[0]).fold(f64::NEG_INFINITY, f64::max);
    let high = readings.iter().flatten().map(|r| r.interval[1]).fold(f64::INFINITY, f64::min);
    low <= high
}

/// `bounce 2` and `bounces 0 to 3`, as the checks name them.
fn rows(finding: &Finding) -> Vec<Row> {
    let mut seen: Vec<[u32; 2]> = Vec::new();
    for measure in &finding.measures {
        let Some((row, _)) = measure.name.rsplit_once(", ") else { continue };
        if let Some(bounces) = bounces_of(row).filter(|bounces| !seen.contains(bounces)) {
            seen.push(bounces);
        }
    }
    let name = |[first, last]: [u32; 2]| {
        if first == last { format!("bounce {first}") } else { format!("bounces {first} to {last}") }
    };
    seen.into_iter()
        .map(|bounces| Row { bounces, readings: channels(finding, &name(bounces)) })
        .collect()
}

fn bounces_of(row: &str) -> Option<[u32; 2]> {
    if let Some(one) = row.strip_prefix("bounce ") {
        let bounce = one.parse().ok()?;
        return Some([bounce, bounce]);
    }
    let (first, last) = row.strip_prefix("bounces ")?.split_once(" to ")?;
    Some([first.parse().ok()?, last.parse().ok()?])
}

/// In a furnace every direction is like every other: what is right there and wrong in the cavity is where light goes.
fn wrong_directions(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let cavity = evidence.failed_finding(CAVITY)?;
    if !evidence.has_passed(FURNACES[0]) {
        return None;
    }
    let rows = rows(cavity);
    let admits_one = |bounce: u32| {
        rows.iter()
            .filter(|row| row.bounces == [bounce, bounce])
            .flat_map(|row| row.readings.iter().flatten())
            .all(|reading| reading.admits(1.0))
    };
    (admits_one(1) && !admits_one(2)).then(|| Suspicion {
        cause: &transport::BOUNCE_DIRECTIONS,
        cases: vec![CAVITY.to_owned()],
        evidence: vec![
            "bounce 1 of the cavity is right and bounce 2 is not".to_owned(),
            format!("{} passes: the energy of each bounce is right", FURNACES[0]),
        ],
        ruled_out: vec!["a wrong weight of bounces (the furnace would see it)".to_owned()],
        weight: 1.0,
    })
}

/// Where a room faces sideways, a cosine with +z weighs the ball in its middle otherwise; averaged over all
/// directions, as in the furnace and the cavity, it is the same.
fn world_cosine(evidence: &Evidence<'_>) -> Option<Suspicion> {
    let finding = evidence.failed_finding(SIDE)?;
    let admits_one = |bounce: u32| {
        let readings = channels(finding, &format!("bounce {bounce}"));
        readings.iter().flatten().all(|reading| reading.admits(1.0))
    };
    let averages = [FURNACES[0], CAVITY].iter().all(|case| evidence.has_withstood(case));
    (averages && admits_one(1) && !admits_one(2)).then(|| Suspicion {
        cause: &transport::BOUNCE_WORLD_COSINE,
        cases: std::iter::once(SIDE.to_owned()).chain(delta_cases(evidence)).collect(),
        evidence: vec![
            "at a wall that faces sideways bounce 1 is right and bounce 2 is not".to_owned(),
            format!(
                "{} and {CAVITY} do not fail: over all directions the weights are right",
                FURNACES[0]
            ),
        ],
        ruled_out: vec!["bounces in wrong directions (the cavity would see it)".to_owned()],
        weight: 1.0,
    })
}

/// Failing cases of mirrors and glass, whose only direction has a cosine too.
fn delta_cases(evidence: &Evidence<'_>) -> Vec<String> {
    let about = ["mirror", "glass"];
    let failures = evidence.failures().filter(|seen| seen.case.starts_with("integrator/"));
    failures
        .filter(|seen| about.iter().any(|word| seen.case.contains(word)))
        .map(|seen| seen.case.to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, mean, means, passing};

    const EMISSION: [f64; 3] = [0.7, 0.5, 0.9];
    const ALBEDO: [f64; 3] = [0.37, 0.53, 0.71];
    const ROWS: [[u32; 2]; 8] = [[0, 0], [1, 1], [2, 2], [3, 3], [5, 5], [0, 1], [0, 3], [0, 5]];

    fn channel(number: usize) -> Channel {
        Channel::of(EMISSION[number], ALBEDO[number], ALBEDO)
    }

    fn furnace(predict: impl Fn(&Channel, [u32; 2]) -> f64) -> Finding {
        let mut measures = Vec::new();
        for bounces in ROWS {
            let [first, last] = bounces;
            let row = if first == last {
                format!("bounce {first}")
            } else {
                format!("bounces {first} to {last}")
            };
            for (number, name) in CHANNELS.iter().enumerate() {
                let channel = channel(number);
                let right = channel.sum(bounces, |_| 1.0);
                let ratio = predict(&channel, bounces) / right;
                measures.push(mean(&format!("{row}, {name}"), right, ratio, 0.003));
            }
        }
        means(measures)
    }

    #[test]
    fn every_law_is_told_by_its_own_numbers() {
        for law in LAWS {
            let made = Made::new().with(FURNACES[0], furnace(law.predict));
            let diagnosis = diagnose(&made.evidence());
            let name = diagnosis.first().map(|cause| cause.name);
            assert_eq!(name, Some(law.cause.name), "{}", law.words);
        }
    }

    #[test]
    fn a_grey_factor_below_one_is_roulette_and_is_told_with_its_interval() {
        let rr = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 0.7_f64.powi(indirect(k)));
        let made = Made::new().with(FURNACES[0], furnace(rr));
        let diagnosis = diagnose(&made.evidence());
        let headline = &diagnosis.headlines[0];
        assert_eq!(headline.cause.name, transport::ROULETTE_NOT_DIVIDED.name);
        assert!(headline.evidence[1].starts_with("bounce k is 0.700"), "{:?}", headline.evidence);
        assert!(headline.ruled_out[0].contains("coloured"));
    }

    #[test]
    fn a_factor_with_a_name_is_named() {
        let half = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 0.5_f64.powi(indirect(k)));
        let diagnosis = diagnose(&Made::new().with(FURNACES[0], furnace(half)).evidence());
        let headline = &diagnosis.headlines[0];
        assert_eq!(headline.cause.name, transport::INDIRECT_FACTOR.name);
        assert!(headline.evidence.iter().any(|s| s.ends_with("is 1/2")), "{headline:?}");
    }

    #[test]
    fn numbers_of_no_law_are_not_given_a_name() {
        let odd = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 1.0 + 0.1 * f64::from(k % 2));
        let diagnosis = diagnose(&Made::new().with(FURNACES[0], furnace(odd)).evidence());
        assert_eq!(diagnosis.first(), None, "{diagnosis:?}");
    }

    #[test]
    fn a_wall_that_faces_sideways_shows_a_cosine_with_the_world() {
        let rows = [("bounce 1", 1.0), ("bounce 2", 0.8)];
        let side = rows.map(|(row, ratio)| mean(&format!("{row}, red"), 0.2, ratio, 0.004));
        let made = |cavity: Finding| {
            Made::new()
                .with(FURNACES[0], passing())
                .with(CAVITY, cavity)
                .with(SIDE, means(side.to_vec()))
        };
        let name = |made: Made| diagnose(&made.evidence()).first().map(|cause| cause.name);
        assert_eq!(name(made(passing())), Some(transport::BOUNCE_WORLD_COSINE.name));
        assert_eq!(name(made(crate::diagnosis::testing::failing("too"))), None);
    }

    #[test]
    fn a_cavity_that_is_wrong_where_the_furnace_is_right_is_about_directions() {
        let rows = [("bounce 1", 1.0), ("bounce 2", 0.8)];
        let measures = rows.map(|(row, ratio)| mean(&format!("{row}, red"), 0.2, ratio, 0.004));
        let made = Made::new().with(FURNACES[0], passing()).with(CAVITY, means(measures.into()));
        let name = diagnose(&made.evidence()).first().map(|cause| cause.name);
        assert_eq!(name, Some(transport::BOUNCE_DIRECTIONS.name));
    }
}
