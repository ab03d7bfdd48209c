//! What each rule said over and over again, kept from one attempt to the next, and the table of it all.

use super::mistake::Mistake;
use super::{LAST, SAMPLES, SCENE};
use furnace::image::metric::METRICS;
use furnace::scene::reference::fingerprint;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::Path;

/// What was said of a mistake.
#[derive(Serialize, Deserialize)]
pub struct Tally {
    /// Comparisons that `furnace` failed.
    pub fails: usize,
    /// Messages that named the mistake.
    pub named: usize,
    /// Comparisons that Mitsuba's rule failed.
    pub mitsuba: usize,
    /// What each metric measured, time after time.
    pub metrics: Vec<Vec<f64>>,
}

/// The tallies of all mistakes: those that this very program has kept, and `make` for the others.
pub fn kept(key: &str, mut make: impl FnMut(Mistake) -> Tally) -> Vec<Tally> {
    let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    let folder = format!("picture-power-{}-{key}", &fingerprint(&program)[..12]);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    std::fs::create_dir_all(&folder).unwrap();
    let tally = |mistake: &Mistake| {
        let path = folder.join(format!("{mistake:?}.json"));
        if let Ok(text) = std::fs::read_to_string(&path) {
            return serde_json::from_str(&text).unwrap();
        }
        let tally = make(*mistake);
        std::fs::write(path, serde_json::to_string(&tally).unwrap()).unwrap();
        println!("{}: failed {}, named {}", mistake.words(), tally.fails, tally.named);
        tally
    };
    Mistake::ALL.iter().map(tally).collect()
}

/// How many are worse than the worst of the right ones.
fn worse(wrong: &[f64], right: &[f64], larger_is_worse: bool) -> usize {
    let worst = |a: f64, b: f64| if (b > a) == larger_is_worse { b } else { a };
    let limit = right.iter().copied().reduce(worst).unwrap();
    wrong.iter().filter(|value| !(**value == limit || worst(**value, limit) == limit)).count()
}

pub fn table(tallies: &[Tally], times: usize, told: usize, share: f64) -> String {
    let mut text = format!(
        "# What the picture test sees\n\n\
         Written by `POWER_TIMES={times} POWER_TOLD={told} cargo test --test picture_power -- --ignored --nocapture`. Scene `{SCENE}` at 128 × 96, {SAMPLES} samples \
         a pixel and run, the\nbudget of its case: a screen of 16 runs, two confirmations of 32. Bounce {LAST}, the last, has \
         {:.2} % of the light.\n\n\
         `furnace`: failed of {times}. `named`: the message of the case names the mistake, of {told}. `Mitsuba`: the rule of \
         its render tests, of {times}.\nThe metrics: of {told}, how many are worse than the worst of {told} right pictures, \
         which is the most that any threshold\non them could tell without ever blaming a right core. Mitsuba's rule and the \
         metrics see the mean of the 16 runs of the screen.\n\n| mistake | furnace | named | Mitsuba |",
        100.0 * share
    );
    METRICS.iter().for_each(|metric| write!(text, " {} |", metric.name).unwrap());
    writeln!(text, "\n|---|---|---|---|{}", "---|".repeat(METRICS.len())).unwrap();
    for (mistake, tally) in Mistake::ALL.iter().zip(tallies) {
        let Tally { fails, named, mitsuba, metrics } = tally;
        write!(text, "| {} | {fails} | {named} | {mitsuba} |", mistake.words()).unwrap();
        for ((wrong, right), metric) in metrics.iter().zip(&tallies[0].metrics).zip(METRICS) {
            write!(text, " {} |", worse(wrong, right, metric.of_equals == 0.0)).unwrap();
        }
        text.push('\n');
    }
    text
}
