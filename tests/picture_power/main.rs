//! What the picture test sees and what it leaves alone, beside the rules that others use: over and
//! over again, for a right core and for seven mistakes.
//!
//! ```text
//! cargo test --test picture_power -- --ignored --nocapture
//! ```
//!
//! writes `docs/simulations/picture-power.md`. The runs of a comparison are drawn from a bank of independent renders by
//! the built-in core, without replacement, so that no verdict uses one twice; different comparisons share the bank.
//! `POWER_TIMES` says how often, `POWER_BANK` how many renders, `POWER_TOLD` for how many the message is read and the
//! metrics are measured. What is known of each mistake is kept below `target/tmp`, so that the same program goes on
//! where it was cut off.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bank;
mod mistake;
mod rules;
mod tally;

use bank::{Bank, Studio, Teller};
use furnace::case;
use furnace::image::metric::METRICS;
use furnace::project::Project;
use furnace::run::{Outcome, Plan, Request, attempt};
use furnace::scene::reference::load;
use mistake::Mistake;
use rayon::prelude::*;
use rules::{Scores, deviations, energy, scores};
use std::sync::Arc;
use tally::{Tally, table};

const CASE: &str = "cornell-six-bounces-match-mitsuba";
const REFERENCE: &str = "cornell-six-bounces";
const SCENE: &str = "cornell-diffuse-spheres";
/// The last bounce of the case.
const LAST: u32 = 6;
/// Samples a pixel of each run, and what has to be seen: those of the case.
const SAMPLES: u32 = 12;
const DETECTS: f64 = 0.01;
/// Runs that the screen takes: the other rules get their mean.
const SCREEN_RUNS: usize = 16;

fn number(name: &str, otherwise: usize) -> usize {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

#[test]
#[ignore = "some minutes: cargo test --test picture_power -- --ignored --nocapture"]
fn a_thousand_comparisons_of_right_and_wrong_pictures() {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let mut studio = Studio::new(&project);
    let reference = load(&project.references(), REFERENCE, &studio.scene).unwrap();
    let cases = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec!["builtin".parse().unwrap()],
        filters: vec![CASE.to_owned()],
        ..Request::default()
    };
    let plan = Plan::new(project.clone(), request, &cases).unwrap();
    let (bench, case) = (plan.bench(), Arc::clone(&plan.trials[0].case));
    let times = number("POWER_TIMES", 1000);
    let told = number("POWER_TOLD", 100).min(times);
    let right = studio.shoot("right", number("POWER_BANK", 240), SAMPLES, [0, LAST]);
    let alone: Vec<_> =
        (0..=LAST).map(|bounce| studio.shoot("alone", 8, SAMPLES, [bounce; 2])).collect();
    let deviations = deviations(&right);
    let share = energy(&alone[LAST as usize]) / energy(&right);
    let tally = |mistake: Mistake| {
        let bank = Bank::of(mistake, &mut studio, &right, &alone);
        let all: Vec<Scores> = (0..times)
            .into_par_iter()
            .map(|time| {
                scores(&bank, &bank.order(time as u64), &reference, &deviations, time < told)
            })
            .collect();
        let named = |time: &usize| {
            let order = bank.order(*time as u64);
            let mut core = Teller { bank: &bank, info: studio.core.info(), order };
            let trial = attempt(&bench, &case, &mut core);
            let Outcome::Judged { finding, .. } = trial.outcome else { return false };
            let first = finding.clues.first().map_or("", |clue| clue.cause.as_str());
            let is_named = mistake.is_named_by(first, &finding.statement);
            if *time == 0 || !is_named {
                println!("{}: {}\n  {:?}", mistake.words(), finding.statement, finding.clues);
            }
            is_named
        };
        Tally {
            fails: all.iter().filter(|score| score.fails).count(),
            named: (0..told).filter(named).count(),
            mitsuba: all.iter().filter(|score| score.mitsuba).count(),
            metrics: (0..METRICS.len())
                .map(|metric| all.iter().filter_map(|s| s.metrics.get(metric).copied()).collect())
                .collect(),
        }
    };
    let key = format!("{times}-{told}-{}", right.len());
    let tallies: Vec<Tally> = tally::kept(&key, tally);
    let text = table(&tallies, times, told, share);
    std::fs::write("docs/simulations/picture-power.md", &text).unwrap();
    assert_eq!(tallies[0].fails, 0);
    assert!(tallies[1..].iter().all(|tally| 1000 * tally.fails >= 999 * times), "{text}");
}
