//! The whole suite on both cores with other random numbers, many times: no correct core fails, and first stages
//! suspect correct cores no more often than their levels say.
//!
//! ```sh
//! FURNACE_SEEDS=200 cargo test --test false_alarms -- --ignored --nocapture
//! FURNACE_SHARD=1/4 ...                      # the first of four parts, for other machines
//! FURNACE_PICTURES=20 ...                    # so many of the seeds also draw pictures
//! FURNACE_CASES=bvh/,shape/ ...        # only these
//! ```
//!
//! Results are kept below `target/tmp`, by program and seed: what was cut off goes on where it was, and the same
//! program asked again only counts.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "support/audit.rs"]
mod audit;

use audit::{number, shard};
use furnace::case;
use furnace::cores::CORES;
use furnace::math::rng::Seed;
use furnace::project::Project;
use furnace::run::{Plan, Request, Status, TrialRecord, run_in_memory};
use furnace::stats::{TestKind, binomial_at_least, share_interval};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Probability of calling a right error rate wrong, over all hypotheses together.
const LEVEL: f64 = 1e-3;

/// How the trials of one seed ended.
#[derive(Serialize, Deserialize)]
struct Drawn {
    failed: Vec<String>,
    inconclusive: Vec<String>,
    /// Of every hypothesis whether its first stage suspected it.
    suspected: BTreeMap<String, (TestKind, bool)>,
    seconds: f64,
}

impl Drawn {
    fn of(records: &[TrialRecord], seconds: f64) -> Self {
        let ended = |wanted: fn(Status) -> bool| {
            let of = records.iter().filter(|r| r.tier.is_graded() && wanted(r.outcome.status()));
            of.map(|r| format!("{} on {}: {}", r.case, r.core, r.outcome.statement())).collect()
        };
        Self {
            failed: ended(|status| !matches!(status, Status::Pass | Status::Inconclusive)),
            inconclusive: ended(|status| status == Status::Inconclusive),
            suspected: records.iter().flat_map(hypotheses).collect(),
            seconds,
        }
    }
}

/// The hypotheses of a trial, by names that no other has.
fn hypotheses(record: &TrialRecord) -> Vec<(String, (TestKind, bool))> {
    let measures = record.outcome.finding().map_or(&[][..], |finding| &finding.measures);
    let named = measures.iter().enumerate().filter_map(|(number, measure)| {
        let name = format!("{} on {}: {number}, {}", record.case, record.core, measure.name());
        measure.hypothesis.map(|one| (name, (one.kind, one.suspected)))
    });
    named.collect()
}

/// How often each hypothesis was drawn, and how often it was suspected.
#[derive(Default)]
struct Audit {
    seeds: u32,
    failed: Vec<String>,
    inconclusive: BTreeMap<String, u32>,
    hypotheses: BTreeMap<String, (TestKind, u64, u64)>,
}

impl Audit {
    fn take(&mut self, seed: u32, drawn: Drawn) {
        self.seeds += 1;
        self.failed.extend(drawn.failed.into_iter().map(|what| format!("seed {seed}: {what}")));
        for what in drawn.inconclusive {
            *self.inconclusive.entry(what).or_default() += 1;
        }
        for (name, (kind, suspected)) in drawn.suspected {
            let counted = self.hypotheses.entry(name).or_insert((kind, 0, 0));
            counted.1 += 1;
            counted.2 += u64::from(suspected);
        }
    }

    /// Hypotheses that are suspected more often than their level can explain.
    fn over_suspected(&self) -> Vec<String> {
        let level = LEVEL / self.hypotheses.len().max(1) as f64;
        let too_often = |(name, (kind, drawn, suspected)): (&String, &(TestKind, u64, u64))| {
            let expected = kind.suspicion()?;
            let chance = binomial_at_least(*suspected, *drawn, expected);
            (chance < level).then(|| {
                format!("{name}: {suspected} of {drawn} at {expected:.1e} (chance {chance:.1e})")
            })
        };
        self.hypotheses.iter().filter_map(too_often).collect()
    }

    fn print(&self) {
        let hypotheses = self.hypotheses.len();
        println!("{} seeds, {hypotheses} hypotheses, {} failures", self.seeds, self.failed.len());
        println!("first stages that suspected a correct core, by kind of test:");
        use TestKind::{Codes, Counts, Mean, Picture, Share};
        for kind in [Mean, Counts, Share, Picture, Codes] {
            let of_kind = || self.hypotheses.values().filter(|one| one.0 == kind);
            let drawn: u64 = of_kind().map(|one| one.1).sum();
            let suspected: u64 = of_kind().map(|one| one.2).sum();
            if drawn == 0 {
                continue;
            }
            let [low, high] = share_interval(suspected, drawn, 0.5 * LEVEL);
            let level = kind.suspicion();
            let level = level.map_or("no level".to_owned(), |level| format!("level {level:.1e}"));
            println!(
                "  {:<9} {suspected} of {drawn}: {:.1e}, 99.9 % interval {low:.1e} to {high:.1e}, {level}",
                kind.plural(),
                suspected as f64 / drawn as f64,
            );
        }
        println!(
            "(hypotheses on the same runs are suspected together; the interval does not know that)"
        );
        for (what, times) in &self.inconclusive {
            println!("inconclusive {times} times: {what}");
        }
        self.failed.iter().for_each(|what| println!("FAILED {what}"));
    }
}

/// Which cases are drawn, as a run on the command line would be told.
fn filters(with_pictures: bool) -> Vec<String> {
    let asked = std::env::var("FURNACE_CASES").unwrap_or_default();
    let asked = asked.split(',').filter(|filter| !filter.is_empty()).map(str::to_owned);
    let without = (!with_pictures).then(|| "!image/".to_owned());
    asked.chain(without).collect()
}

fn draw(seed: u32, with_pictures: bool) -> Drawn {
    let clock = Instant::now();
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: CORES.iter().map(|kind| kind.name.parse().unwrap()).collect(),
        filters: filters(with_pictures),
        seed: Seed::SUITE.child("false alarms").child(seed),
        jobs: 0,
        ..Request::default()
    };
    let records = run_in_memory(&Plan::new(project, request, &cases).unwrap());
    Drawn::of(&records, clock.elapsed().as_secs_f64())
}

/// Where the results of this very program are kept.
fn folder() -> PathBuf {
    let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    let hash: String = Sha256::digest(&program)[..8].iter().map(|b| format!("{b:02x}")).collect();
    let asked = std::env::var("FURNACE_CASES").unwrap_or_default().replace(['/', ','], "_");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("false-alarms").join(hash + &asked);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// What was drawn with this seed, now or earlier.
fn drawn(folder: &Path, seed: u32, with_pictures: bool) -> Drawn {
    let with = if with_pictures { "-with-pictures" } else { "" };
    let path = folder.join(format!("{seed}{with}.json"));
    if let Ok(text) = std::fs::read_to_string(&path) {
        return serde_json::from_str(&text).unwrap();
    }
    let drawn = draw(seed, with_pictures);
    std::fs::write(&path, serde_json::to_string(&drawn).unwrap()).unwrap();
    drawn
}

#[test]
#[ignore = "hours: the suite 200 times on both cores, for audits"]
fn a_correct_core_fails_nothing_whatever_the_random_numbers() {
    let (seeds, pictures) = (number("FURNACE_SEEDS", 200), number("FURNACE_PICTURES", 10));
    let (part, of) = shard();
    let folder = folder();
    println!("results are kept in {}", folder.display());
    let mut audit = Audit::default();
    for seed in (0..seeds).filter(|seed| seed % of == part - 1) {
        let drawn = drawn(&folder, seed, seed < pictures);
        let suspected = drawn.suspected.values().filter(|(_, suspected)| *suspected).count();
        println!(
            "seed {seed}: {} failed, {} inconclusive, {suspected} of {} hypotheses suspected, {:.0} s",
            drawn.failed.len(),
            drawn.inconclusive.len(),
            drawn.suspected.len(),
            drawn.seconds
        );
        audit.take(seed, drawn);
    }
    audit.print();
    let over_suspected = audit.over_suspected();
    over_suspected.iter().for_each(|what| println!("SUSPECTED TOO OFTEN {what}"));
    assert!(audit.failed.is_empty() && over_suspected.is_empty());
}

#[test]
fn the_audit_counts_failures_and_sees_a_wrong_level() {
    let drawn = |suspected| Drawn {
        failed: Vec::new(),
        inconclusive: vec!["a".to_owned()],
        suspected: BTreeMap::from([("hypothesis".to_owned(), (TestKind::Mean, suspected))]),
        seconds: 0.0,
    };
    let mut audit = Audit::default();
    (0..199).for_each(|seed| audit.take(seed, drawn(seed == 0)));
    assert!(audit.over_suspected().is_empty(), "one of 199 is chance");
    (199..205).for_each(|seed| audit.take(seed, drawn(true)));
    assert_eq!(audit.over_suspected().len(), 1);
    assert_eq!(audit.inconclusive["a"], 205);
    audit.take(205, Drawn { failed: vec!["b".to_owned()], ..drawn(false) });
    assert_eq!(audit.failed, ["seed 205: b"]);
}
