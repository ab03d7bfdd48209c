//! Energy bounce by bounce in a furnace, where bounce k is emission · albedo^k and nothing else matters.
//!
//! Each law says what a mistake makes of any sum of bounces; a law is suspected where it predicts every number of the
//! case, channel by channel. Where no law fits and indirect light is off by one grey factor a bounce, the factor is
//! fitted and told with its interval.

use super::bounce_laws::{Channel, Isolation, LAWS, Law, indirect};
use super::evidence::measure;
use super::readings::{Reading, channels, fails_as};
use super::{Degree, Evidence, RuledOut, Suspicion};
use crate::case::{Role, Subject};
use crate::cause::integrator;
use crate::checks::Finding;
use crate::image::CHANNELS;
use crate::math::ratios::names_of;
use crate::text::number::{figure, plus_minus};
use std::collections::BTreeSet;

/// The furnaces whose bounces are told one by one.
pub(crate) const FURNACES: [Role; 2] = [Role::Furnace, Role::FurnaceByHemisphere];
/// How much less a mistake weighs if it is not the only one that fits.
const SHARED: f64 = 0.6;
/// Laws that predict a failing furnace, a factor a bounce, or directions that only the cavity sees.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    FURNACES.iter().flat_map(|role| explain(evidence, *role)).collect()
}

fn explain(evidence: &Evidence<'_>, role: Role) -> Vec<Suspicion> {
    let case = evidence.case(role);
    let Some(finding) = evidence.failed_finding(role) else { return Vec::new() };
    let Some(furnace) = Furnace::of(finding) else { return Vec::new() };
    let mut fitting: Vec<_> = LAWS.iter().filter(|law| furnace.follows(law)).collect();
    let mut causes = BTreeSet::new();
    fitting.retain(|law| causes.insert(law.cause.name));
    let weight = if fitting.len() == 1 { 1.0 } else { SHARED };
    let told = |law: &&Law| Suspicion {
        cause: law.cause,
        cases: std::iter::once(case.to_owned()).chain(direct_light(evidence, law)).collect(),
        evidence: vec![furnace.table(), law.words.to_owned()],
        ruled_out: furnace.ruled_out(law),
        weight,
        degree: Degree::of_one_among(fitting.len()),
        beside: false,
    };
    if fitting.is_empty() {
        let told = furnace.no_indirect(case, evidence);
        let told = told.or_else(|| furnace.constant_factor(case, evidence));
        let told = told.or_else(|| furnace.factor_once(case, evidence));
        return told.or_else(|| furnace.lost_ways(case)).into_iter().collect();
    }
    fitting.iter().map(told).collect()
}

/// How a core comes by isolated bounces, as a furnace tells where sums are wrong.
pub(crate) fn isolation(finding: &Finding) -> Option<Isolation> {
    Furnace::of(finding)?.isolation()
}

fn direct_light(evidence: &Evidence<'_>, law: &Law) -> Vec<String> {
    let explains = |finding: &Finding| law.direct != 1.0 && fails_as(finding, law.direct);
    let failures = evidence.failures().filter(|seen| seen.is_about(Subject::Light));
    let explained = failures.filter(|seen| seen.finding.is_some_and(explains));
    explained.map(|seen| seen.case.to_owned()).collect()
}

/// A row of a furnace: which bounces it adds up, and what was read in each channel.
pub(crate) struct Row {
    pub(crate) bounces: [u32; 2],
    pub(crate) readings: [Option<Reading>; 3],
}

impl Row {
    fn is_isolated(&self) -> bool {
        self.bounces[0] == self.bounces[1]
    }

    fn is_right(&self) -> bool {
        self.readings.iter().flatten().all(|reading| reading.admits(1.0))
    }
}

struct Furnace {
    channels: [Channel; 3],
    rows: Vec<Row>,
}

impl Furnace {
    /// None if the finding has not the rows that tell emission and albedo.
    fn of(finding: &Finding) -> Option<Self> {
        let expected = |bounce: u32, channel| {
            measure(finding, &format!("bounce {bounce}"), channel).map(|m| m.expected)
        };
        let mut albedo = [0.0; 3];
        let mut emission = [0.0; 3];
        for (number, channel) in CHANNELS.into_iter().enumerate() {
            let (first, second) = (expected(1, channel)?, expected(2, channel)?);
            albedo[number] = second / first;
            emission[number] = first / albedo[number];
        }
        let channels = [0, 1, 2].map(|c| Channel::of(emission[c], albedo[c], albedo));
        Some(Self { channels, rows: rows(finding) })
    }

    /// Whether every number is as the law has it, however isolated bounces are come by.
    fn follows(&self, law: &Law) -> bool {
        Isolation::ALL.into_iter().any(|isolation| {
            let predict = |channel: &Channel, bounces| isolation.read(law, channel, bounces);
            self.rows.iter().all(|row| self.row_admits(row, &predict))
        })
    }

    fn row_admits(&self, row: &Row, predict: &impl Fn(&Channel, [u32; 2]) -> f64) -> bool {
        self.channels.iter().zip(&row.readings).all(|(channel, reading)| {
            let right = channel.sum(row.bounces, |_| 1.0);
            reading.is_none_or(|reading| reading.admits(predict(channel, row.bounces) / right))
        })
    }

    /// How the core comes by isolated bounces, if its sums are wrong, and emission and direct light alone are right.
    fn isolation(&self) -> Option<Isolation> {
        let (isolated, sums): (Vec<&Row>, Vec<&Row>) =
            self.rows.iter().partition(|row| row.is_isolated());
        let (direct, later): (Vec<&Row>, Vec<&Row>) =
            isolated.into_iter().partition(|row| row.bounces[0] < 2);
        let are_right = |rows: &[&Row]| rows.iter().all(|row| row.is_right());
        if !are_right(&direct) || are_right(&sums) || later.is_empty() {
            return None;
        }
        match are_right(&later) {
            true => Some(Isolation::Apart),
            false => self.adds_up(&sums, &later).then_some(Isolation::ByDifference),
        }
    }

    /// Whether isolated bounces are what separates two sums, wherever all between the two are known.
    fn adds_up(&self, sums: &[&Row], later: &[&Row]) -> bool {
        let pairs = sums.iter().flat_map(|less| sums.iter().map(move |more| [*less, *more]));
        let pairs = pairs.filter(|[less, more]| {
            less.bounces[0] == more.bounces[0] && less.bounces[1] < more.bounces[1]
        });
        let between = |[less, more]: [&Row; 2]| {
            let mut bounces = less.bounces[1] + 1..=more.bounces[1];
            let all = bounces.all(|k| later.iter().any(|row| row.bounces[0] == k));
            let within =
                |row: &&Row| less.bounces[1] < row.bounces[0] && row.bounces[0] <= more.bounces[1];
            all.then(|| later.iter().copied().filter(within).collect::<Vec<_>>())
        };
        let mut known = pairs.filter_map(|pair| Some((pair, between(pair)?))).peekable();
        known.peek().is_some()
            && known.all(|(pair, between)| {
                (0..self.channels.len()).all(|channel| self.separate(channel, pair, &between))
            })
    }

    /// Whether these rows may be what one sum has more than the other.
    fn separate(&self, channel: usize, [less, more]: [&Row; 2], between: &[&Row]) -> bool {
        let light = |row: &Row| {
            let right = self.channels[channel].sum(row.bounces, |_| 1.0);
            row.readings[channel].map(|reading| reading.interval.map(|ratio| ratio * right))
        };
        let isolated: Option<Vec<_>> = between.iter().map(|row| light(row)).collect();
        let (Some(less), Some(more), Some(isolated)) = (light(less), light(more), isolated) else {
            return false;
        };
        let [low, high] = [0, 1].map(|end| isolated.iter().map(|light| light[end]).sum::<f64>());
        more[0] - less[1] <= high && low <= more[1] - less[0]
    }

    /// Isolated bounces beside what they should be; where these are right, their sums.
    fn table(&self) -> String {
        let adds_up = self.rows.iter().filter(|row| row.is_isolated()).all(Row::is_right);
        let rows = self.rows.iter().filter(|row| row.is_isolated() != adds_up);
        let cells: Vec<_> = rows
            .filter_map(|row| {
                let ratios: Vec<_> =
                    row.readings.iter().flatten().map(Reading::told_from_one).collect();
                let label = name(row.bounces).replace("bounces ", "").replace("bounce ", "");
                (!ratios.is_empty()).then(|| format!("{label}: {}", ratios.join(" ")))
            })
            .collect();
        let what = if adds_up { "sums of bounces" } else { "bounce by bounce" };
        format!("{what}, over what it should be (red green blue): {}", cells.join(" · "))
    }

    /// The first row at which each other law of the same family fails.
    fn ruled_out(&self, law: &Law) -> Vec<RuledOut> {
        let is_rival = |rival: &&Law| rival.cause.name != law.cause.name && !self.follows(rival);
        let rivals = LAWS.iter().filter(is_rival);
        let refuted = rivals.filter_map(|rival| {
            let row = self.rows.iter().find(|row| !self.row_admits(row, &rival.predict))?;
            let (channel, reading) =
                self.channels.iter().zip(&row.readings).find_map(|(c, r)| Some((c, (*r)?)))?;
            let right = channel.sum(row.bounces, |_| 1.0);
            let predicted = (rival.predict)(channel, row.bounces) / right;
            let [predicted, read] = [predicted, reading.ratio].map(figure);
            let why = format!("{} would be {predicted}, not {read}", name(row.bounces));
            Some(RuledOut::new(rival.cause.headline, why))
        });
        refuted.take(2).collect()
    }

    /// No light from the second bounce on and all that is direct, beside sums that are wrong in another way, too.
    fn no_indirect(&self, case: &str, evidence: &Evidence<'_>) -> Option<Suspicion> {
        let law = LAWS.iter().find(|law| law.cause == &integrator::NO_INDIRECT)?;
        let isolated = || self.rows.iter().filter(|row| row.is_isolated());
        let indirect = || isolated().filter(|row| row.bounces[0] > 1);
        let mut light = indirect().flat_map(|row| row.readings).flatten().peekable();
        let is_dark = light.peek().is_some() && light.all(|reading| reading.ratio == 0.0);
        let fits = isolated().all(|row| self.row_admits(row, &law.predict));
        (is_dark && fits).then(|| Suspicion {
            cause: law.cause,
            cases: fitting_too(evidence, case, |_| [0.0; 2]),
            evidence: vec![self.table(), law.words.to_owned()],
            ruled_out: Vec::new(),
            weight: SHARED,
            degree: Degree::LooksLike,
            beside: false,
        })
    }

    /// One grey factor for every indirect bounce, if all isolated bounces agree on it and it is not 1.
    fn constant_factor(&self, case: &str, evidence: &Evidence<'_>) -> Option<Suspicion> {
        let mut interval = [f64::NEG_INFINITY, f64::INFINITY];
        let mut most = 0;
        for row in self.rows.iter().filter(|row| row.is_isolated()) {
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
        let is_wrong = 0.0 < low && (high < 1.0 || 1.0 < low);
        (most > 2 && low <= high && high.is_finite() && is_wrong).then(|| {
            let cases =
                fitting_too(evidence, case, |bounce| interval.map(|f| f.powi(indirect(bounce))));
            Suspicion { cases, ..self.of_factor(case, interval) }
        })
    }

    /// One grey factor for all indirect light, if all isolated bounces agree on it and it is not 1.
    fn factor_once(&self, case: &str, evidence: &Evidence<'_>) -> Option<Suspicion> {
        let isolated = || self.rows.iter().filter(|row| row.is_isolated());
        let of = |bounces: std::ops::RangeInclusive<u32>| {
            isolated().filter(move |row| bounces.contains(&row.bounces[0]))
        };
        let readings = |row: &'_ Row| row.readings.into_iter().flatten();
        let direct_is_right = of(0..=1).flat_map(readings).all(|reading| reading.admits(1.0));
        let indirect: Vec<_> = of(2..=u32::MAX).flat_map(readings).collect();
        let low = indirect.iter().map(|r| r.interval[0]).fold(f64::NEG_INFINITY, f64::max);
        let high = indirect.iter().map(|r| r.interval[1]).fold(f64::INFINITY, f64::min);
        let is_wrong = 0.0 < low && (high < 1.0 || 1.0 < low);
        let bounces = of(2..=u32::MAX).count();
        (direct_is_right && bounces > 1 && low <= high && is_wrong).then(|| {
            let factor = plus_minus(0.5 * (low + high), 0.5 * (high - low));
            let fit =
                format!("from bounce 2 on it is f times what it should be, with f = {factor}");
            Suspicion {
                cause: &integrator::INDIRECT_FACTOR_ONCE,
                cases: fitting_too(evidence, case, |_| [low, high]),
                evidence: vec![self.table(), fit],
                ruled_out: vec![RuledOut::new("a factor a bounce", "it would be a power of k")],
                weight: SHARED,
                degree: Degree::LooksLike,
                beside: false,
            }
        })
    }

    /// Direct light is right, and indirect light is off by other grey factors at each bounce from the first on: it does
    /// not come from where it should.
    fn lost_ways(&self, case: &str) -> Option<Suspicion> {
        let isolated = || self.rows.iter().filter(|row| row.is_isolated());
        let mut direct = isolated().filter(|row| row.bounces[0] == 1).peekable();
        let right = direct.peek().is_some() && direct.all(Row::is_right);
        let indirect = || isolated().filter(|row| row.bounces[0] > 1);
        let first = indirect().filter(|row| row.bounces[0] == 2);
        let wrong = first.flat_map(|row| row.readings.iter().flatten()).any(|r| !r.admits(1.0));
        let grey = indirect().all(|row| is_grey(&row.readings));
        (right && wrong && grey).then(|| Suspicion {
            cause: &integrator::BOUNCE_DIRECTIONS,
            cases: vec![case.to_owned()],
            evidence: vec![self.table(), "the same in all colours, and no power of k".to_owned()],
            ruled_out: vec![RuledOut::new("a wrong weight of bounces", "it would be a power of k")],
            weight: SHARED,
            degree: Degree::LooksLike,
            beside: false,
        })
    }

    fn of_factor(&self, case: &str, [low, high]: [f64; 2]) -> Suspicion {
        let factor = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        let fit = format!(
            "bounce k is f^(k−1) of what it should be, grey, with f = {}",
            plus_minus(factor, half)
        );
        let named = names_of([low, high], &[]);
        let name = named.first().map(|name| format!("the factor a bounce is {}", name.name));
        let is_roulette = || {
            let survivors = "survivors that are not divided by their probability";
            (factor < 1.0)
                .then(|| format!("Russian roulette of your own would be that, with {survivors}"))
        };
        let mut evidence = vec![self.table(), fit];
        evidence.extend(name.or_else(is_roulette));
        Suspicion {
            cause: &integrator::INDIRECT_FACTOR,
            cases: vec![case.to_owned()],
            evidence,
            ruled_out: vec![RuledOut::new(
                "the albedo twice or not at all",
                "it would be coloured",
            )],
            weight: SHARED,
            degree: Degree::LooksLike,
            beside: false,
        }
    }
}

/// The furnace's case, and every other that fails by what `factor` says of its isolated bounces from the second on.
fn fitting_too(
    evidence: &Evidence<'_>,
    case: &str,
    factor: impl Fn(u32) -> [f64; 2],
) -> Vec<String> {
    let predicted = |row: &Row| {
        let [low, high] = if row.bounces[0] < 2 { [1.0; 2] } else { factor(row.bounces[0]) };
        let fits = |one: &Reading| one.interval[0] <= high && low <= one.interval[1];
        row.readings.iter().flatten().all(fits)
    };
    let fits = |finding: &Finding| {
        let isolated = || rows(finding).into_iter().filter(|row| row.is_isolated());
        isolated().any(|row| row.bounces[0] > 1) && isolated().all(|row| predicted(&row))
    };
    let others =
        evidence.failures().filter(|seen| seen.case != case && seen.finding.is_some_and(fits));
    std::iter::once(case).chain(others.map(|seen| seen.case)).map(str::to_owned).collect()
}

/// Whether one ratio fits all channels.
fn is_grey(readings: &[Option<Reading>; 3]) -> bool {
    let low = readings.iter().flatten().map(|r| r.interval[0]).fold(f64::NEG_INFINITY, f64::max);
    let high = readings.iter().flatten().map(|r| r.interval[1]).fold(f64::INFINITY, f64::min);
    low <= high
}

/// `bounce 2` and `bounces 0 to 3`, as the checks name them.
fn name([first, last]: [u32; 2]) -> String {
    if first == last { format!("bounce {first}") } else { format!("bounces {first} to {last}") }
}

pub(crate) fn rows(finding: &Finding) -> Vec<Row> {
    let mut seen: Vec<[u32; 2]> = Vec::new();
    for measure in &finding.measures {
        if let Some(bounces) = bounces_of(&measure.row).filter(|bounces| !seen.contains(bounces)) {
            seen.push(bounces);
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::Cause;
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, mean, means};

    const EMISSION: [f64; 3] = [0.7, 0.5, 0.9];
    const ALBEDO: [f64; 3] = [0.37, 0.53, 0.71];
    const ROWS: [[u32; 2]; 8] = [[0, 0], [1, 1], [2, 2], [3, 3], [5, 5], [0, 1], [0, 3], [0, 5]];

    fn channel(number: usize) -> Channel {
        Channel::of(EMISSION[number], ALBEDO[number], ALBEDO)
    }

    fn furnace(predict: impl Fn(&Channel, [u32; 2]) -> f64) -> Finding {
        let mut measures = Vec::new();
        for bounces in ROWS {
            for (number, red_green_blue) in CHANNELS.into_iter().enumerate() {
                let channel = channel(number);
                let right = channel.sum(bounces, |_| 1.0);
                let ratio = predict(&channel, bounces) / right;
                measures.push(mean(&name(bounces), red_green_blue, right, ratio, 0.003));
            }
        }
        means(measures)
    }

    #[test]
    fn every_law_is_told_by_its_own_numbers() {
        for law in LAWS {
            let made = Made::new().with(FURNACES[0], furnace(law.predict));
            assert_eq!(made.first(), Some(law.cause.name), "{}", law.words);
            let seen = &diagnose(&made.evidence()).headlines[0].evidence[0];
            assert!(
                !seen.ends_with(": 0: 1 1 1 · 1: 1 1 1 · 2: 1 1 1 · 3: 1 1 1 · 5: 1 1 1"),
                "{seen}"
            );
        }
    }

    /// A law of the sums alone.
    fn law(cause: &Cause, words: &str) -> &'static Law {
        let mut of_cause = LAWS.iter().filter(|law| law.cause.name == cause.name);
        of_cause.find(|law| law.words.contains(words)).unwrap()
    }

    #[test]
    fn a_law_of_sums_is_told_however_isolated_bounces_are_come_by() {
        let laws = [
            law(&integrator::DEPTH_IGNORED, "of two bounces and more"),
            law(&integrator::ONE_BOUNCE_LONG, "every sum holds one bounce more"),
            law(&integrator::ONE_BOUNCE_SHORT, "from the second on"),
        ];
        for law in laws {
            for way in [Isolation::ByDifference, Isolation::Apart] {
                let finding = furnace(|channel, rows| way.read(law, channel, rows));
                assert_eq!(isolation(&finding), Some(way), "{}", law.words);
                let made = Made::new().with(FURNACES[0], finding);
                assert_eq!(made.first(), Some(law.cause.name), "{}, {way:?}", law.words);
            }
        }
    }

    #[test]
    fn how_isolated_bounces_are_come_by_is_open_where_they_tell_it_otherwise() {
        let everywhere = law(&integrator::DEPTH_IGNORED, "whatever bounce");
        assert_eq!(isolation(&furnace(everywhere.predict)), None);
        let twice = |c: &Channel, rows: [u32; 2]| c.sum(rows, |_| 2.0);
        assert_eq!(isolation(&furnace(twice)), None);
        assert_eq!(isolation(&furnace(|c, rows| c.sum(rows, |_| 1.0))), None);
    }

    #[test]
    fn a_grey_factor_below_one_is_told_with_its_interval_and_may_be_roulette() {
        let rr = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 0.7_f64.powi(indirect(k)));
        let made = Made::new().with(FURNACES[0], furnace(rr));
        let diagnosis = diagnose(&made.evidence());
        let headline = &diagnosis.headlines[0];
        assert_eq!(headline.cause, integrator::INDIRECT_FACTOR.name);
        let [_, fit, roulette, ..] = &headline.evidence[..] else { panic!("{headline:?}") };
        assert!(fit.ends_with("with f = 0.7000 ± 0.0009"), "{fit}");
        assert!(roulette.starts_with("Russian roulette of your own"), "{roulette}");
        assert!(headline.ruled_out[0].contains("coloured"));
    }

    #[test]
    fn a_factor_explains_every_case_whose_bounces_are_off_by_it() {
        let rr = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 0.7_f64.powi(indirect(k)));
        let second = |ratio| means(vec![mean("bounce 2", CHANNELS[0], 0.5, ratio, 0.003)]);
        let made = Made::new()
            .with(FURNACES[0], furnace(rr))
            .with("integrator/fits", second(0.7))
            .with("integrator/other", second(0.5));
        let diagnosis = diagnose(&made.evidence());
        let explains = &diagnosis.headlines[0].explains;
        assert!(explains.contains(&"integrator/fits".to_owned()), "{explains:?}");
        assert!(!explains.contains(&"integrator/other".to_owned()), "{explains:?}");
    }

    #[test]
    fn a_small_factor_is_told_with_the_digits_that_show_it() {
        let once = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| if k > 1 { 1.0061 } else { 1.0 });
        let diagnosis = diagnose(&Made::new().with(FURNACES[0], furnace(once)).evidence());
        let seen = &diagnosis.headlines[0].evidence[0];
        assert!(seen.contains("1: 1 1 1 · 2: 1.0061 1.0061 1.0061"), "{seen}");
    }

    #[test]
    fn indirect_light_that_is_not_there_is_no_factor_whatever_the_sums_lack() {
        let of_two_mistakes = |c: &Channel, [first, last]: [u32; 2]| {
            let first = if first < last { first.max(1) } else { first };
            c.sum([first, last], |k| if k < 2 { 1.0 } else { 0.0 })
        };
        let made = Made::new().with(FURNACES[0], furnace(of_two_mistakes));
        let diagnosis = diagnose(&made.evidence());
        let headline = &diagnosis.headlines[0];
        assert_eq!(headline.cause, integrator::NO_INDIRECT.name);
        assert_eq!(headline.degree, Degree::LooksLike);
    }

    #[test]
    fn one_factor_of_all_indirect_light_is_told_with_its_interval() {
        let once = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| if k > 1 { 1.43 } else { 1.0 });
        let diagnosis = diagnose(&Made::new().with(FURNACES[0], furnace(once)).evidence());
        let headline = &diagnosis.headlines[0];
        assert_eq!(headline.cause, integrator::INDIRECT_FACTOR_ONCE.name);
        assert_eq!(headline.degree, Degree::LooksLike);
        assert!(headline.evidence.iter().any(|s| s.contains("with f = 1.43")), "{headline:?}");
    }

    #[test]
    fn light_that_is_lost_from_a_later_bounce_on_has_not_lost_its_way() {
        let ended = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| if k > 2 { 0.9 } else { 1.0 });
        let made = Made::new().with(FURNACES[0], furnace(ended));
        assert_eq!(made.first(), None);
    }

    #[test]
    fn a_factor_with_a_name_is_named() {
        let half = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 0.5_f64.powi(indirect(k)));
        let diagnosis = diagnose(&Made::new().with(FURNACES[0], furnace(half)).evidence());
        let headline = &diagnosis.headlines[0];
        assert_eq!(headline.cause, integrator::INDIRECT_FACTOR.name);
        assert!(headline.evidence.iter().any(|s| s.ends_with("is 1/2")), "{headline:?}");
    }

    #[test]
    fn numbers_of_no_law_and_a_factor_that_may_be_one_are_not_given_a_name() {
        let sums_only = |c: &Channel, rows: [u32; 2]| {
            c.sum(rows, |_| 1.0) * if rows[0] == rows[1] { 1.0 } else { 0.9 }
        };
        let odd = |c: &Channel, rows: [u32; 2]| c.sum(rows, |k| 1.0 + 0.1 * f64::from(k % 2));
        for furnace in [furnace(sums_only), furnace(odd)] {
            assert_eq!(Made::new().with(FURNACES[0], furnace).first(), None);
        }
    }
}
