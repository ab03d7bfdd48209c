//! What the picture test sees and what it leaves alone, beside the rules that others use: over and
//! over again, for a right core and for seven mistakes.
//!
//! ```text
//! cargo test --test picture_power -- --ignored --nocapture
//! ```
//!
//! writes `docs/simulations/picture-power.md`. The runs of a comparison are drawn from a bank of
//! independent renders by the built-in core, without replacement, so that no verdict uses one twice;
//! different comparisons share the bank. `POWER_TIMES` says how often, `POWER_BANK` how many renders.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bank;
mod mistake;
mod rules;

use bank::{Bank, Studio, Teller};
use furnace::case;
use furnace::image::metric::METRICS;
use furnace::math::rng::Seed;
use furnace::project::Project;
use furnace::run::{Outcome, Plan, Request, attempt};
use furnace::scene::reference::load;
use furnace::stats::Budget;
use mistake::Mistake;
use rules::{Row, Scores, deviations, energy, scores, table, worse};
use std::sync::Arc;

const CASE: &str = "cornell-diffuse-spheres-matches-mitsuba";
const SCENE: &str = "cornell-diffuse-spheres";
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
    let reference = load(&project.references(), SCENE, &studio.scene).unwrap();
    let cases = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec!["builtin".parse().unwrap()],
        filters: vec![CASE.to_owned()],
        budget: Budget::Default,
        seed: Seed::SUITE,
        jobs: 1,
        fail_fast: false,
    };
    let plan = Plan::new(project.clone(), request, &cases);
    let (bench, case) = (plan.bench(), Arc::clone(&plan.trials[0].case));
    let times = number("POWER_TIMES", 1000);
    let told = number("POWER_TOLD", 100).min(times);
    let right = studio.shoot("right", number("POWER_BANK", 240), SAMPLES, [0, 5]);
    let alone: Vec<_> =
        (0..=5).map(|bounce| studio.shoot("alone", 8, SAMPLES, [bounce; 2])).collect();
    let deviations = deviations(&right);
    let share = energy(&alone[5]) / energy(&right);
    let mut rows = Vec::new();
    let mut best: Vec<Vec<f64>> = vec![Vec::new(); METRICS.len()];
    for mistake in Mistake::ALL {
        let bank = Bank::of(mistake, &mut studio, &right, &alone);
        let info = studio.core.info();
        let all: Vec<Scores> = (0..times)
            .map(|time| {
                scores(&bank, &bank.order(time as u64), &reference, &deviations, time < told)
            })
            .collect();
        let named = (0..told)
            .filter(|time| {
                let order = bank.order(*time as u64);
                let mut core = Teller { bank: &bank, info: info.clone(), order };
                let trial = attempt(&bench, &case, &mut core);
                let Outcome::Judged { finding, .. } = trial.outcome else { return false };
                let clues = finding.clues.first().map_or("", |clue| clue.cause.as_str());
                if *time == 0 {
                    println!("{}: {}\n  {:?}", mistake.words(), finding.statement, finding.clues);
                }
                clues == mistake.name() || finding.statement.contains(mistake.name())
            })
            .count();
        let metrics: Vec<Vec<f64>> = (0..METRICS.len())
            .map(|metric| all.iter().filter_map(|s| s.metrics.get(metric).copied()).collect())
            .collect();
        if mistake == Mistake::None {
            best.clone_from(&metrics);
        }
        rows.push(Row {
            mistake,
            fails: all.iter().filter(|score| score.fails).count(),
            named,
            mitsuba: all.iter().filter(|score| score.mitsuba).count(),
            metrics: metrics
                .iter()
                .zip(&best)
                .zip(METRICS)
                .map(|((wrong, right), metric)| worse(wrong, right, metric.of_equals() == 0.0))
                .collect(),
        });
        let row = rows.last().unwrap();
        println!(
            "{:30} failed {} of {times}, named {} of {told}",
            mistake.words(),
            row.fails,
            row.named
        );
    }
    let text = table(&rows, times, told, share);
    std::fs::write("docs/simulations/picture-power.md", &text).unwrap();
    assert_eq!(rows[0].fails, 0);
    assert!(rows[1..].iter().all(|row| 1000 * row.fails >= 999 * times), "{text}");
}
