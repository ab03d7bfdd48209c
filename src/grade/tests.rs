use super::*;
use crate::case::load_project;
use crate::project::Project;
use crate::report::RunTree;
use crate::run::{Outcome, TrialRecord, run_in_memory};
use std::collections::BTreeSet;

fn project() -> Project {
    Project::at(env!("CARGO_MANIFEST_DIR"))
}

/// A suite as its file would say.
fn suite(text: &str) -> Result<Suite, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.toml");
    std::fs::write(&path, format!("title = \"Small\"\nversion = \"1\"\n{text}")).unwrap();
    Suite::find(&project(), &path.to_string_lossy()).map_err(|error| error.to_string())
}

const SMALL: &str = "
budget = \"quick\"
optional = [\"roulette\", \"a sky\"]
[[part]]
name = \"Rays\"
points = 10
cases = [\"ray-sphere-hit-is\", \"ray-triangle-hits-are\", \"flat-boxes\", \"hits-lie-between\"]
hidden = 1
";

/// The grade of a core, with its trials changed by `spoil`.
fn graded(core: &str, spoil: impl Fn(&mut TrialRecord)) -> Grade {
    let suite = suite(SMALL).unwrap();
    let cases = load_project(&project()).unwrap();
    let selected = suite.select(&cases).unwrap();
    let request = crate::run::Request {
        cores: vec![core.parse().unwrap()],
        budget: suite.budget,
        seed: suite.seed(""),
        ..Default::default()
    };
    let plan = crate::run::Plan::new(project(), request, &selected.cases()).unwrap();
    let mut trials = run_in_memory(&plan);
    trials.iter_mut().for_each(spoil);
    Grade::of(&suite, &selected, "", &tree(core, trials))
}

fn tree(core: &str, trials: Vec<TrialRecord>) -> RunTree {
    let mut tree = crate::report::example::Example::mixed();
    tree.run.cores.truncate(1);
    let record = &mut tree.run.cores[0];
    (record.spec, record.diagnosis, record.score) = (core.to_owned(), None, None);
    record.capabilities = crate::contract::Capabilities::all().names();
    let folder = std::path::PathBuf::new();
    RunTree { run: tree.run, trials, folder }.diagnosed()
}

fn ended(outcome: Outcome) -> impl Fn(&mut TrialRecord) {
    move |trial| {
        if trial.case.ends_with("flat-boxes-are-hit") {
            trial.outcome = outcome.clone();
        }
    }
}

fn blocked() -> Outcome {
    Outcome::Blocked { by: "shape/x".to_owned() }
}

fn skipped(word: &str) -> Outcome {
    Outcome::Skipped { missing: vec![word.to_owned()] }
}

#[test]
fn what_passes_earns_all_and_what_is_not_decided_stays_open() {
    let all = graded("builtin", |_| ());
    assert_eq!(all.points, Points { of: 10.0, earned: 10.0, open: 0.0 });
    let worth = |outcome: Outcome| graded("builtin", ended(outcome)).points;
    assert_eq!(worth(blocked()), Points { of: 10.0, earned: 7.5, open: 2.5 });
    assert_eq!(worth(Outcome::Broken { why: "x".into() }).open, 2.5);
    let crash = Outcome::Crashed { how: "x".into(), during: "y".into() };
    assert_eq!(worth(crash), Points { of: 10.0, earned: 7.5, open: 0.0 });
}

#[test]
fn what_the_suite_asks_for_is_lost_where_it_is_missing_and_what_it_does_not_is_left_out() {
    let worth = |word: &str| graded("builtin", ended(skipped(word))).points;
    assert_eq!(worth("intersect-box"), Points { of: 10.0, earned: 7.5, open: 0.0 });
    assert_eq!(worth("roulette"), Points { of: 10.0, earned: 10.0, open: 0.0 });
    assert_eq!(worth("a sky"), Points { of: 10.0, earned: 10.0, open: 0.0 });
    // Excuses of a core's own are none.
    assert!(worth("no roulette today").are_lost());
}

#[test]
fn nothing_proven_is_never_full_marks() {
    for outcome in [blocked(), skipped("roulette"), skipped("intersect-box")] {
        let grade = graded("builtin", |trial| trial.outcome = outcome.clone());
        assert_eq!(grade.points.earned, 0.0, "{outcome:?}");
        assert_eq!(grade.points.of, 10.0);
    }
    let suite = suite(SMALL).unwrap();
    let absent = Grade::absent(&suite, "x", "no such file");
    assert_eq!(absent.points, Points { of: 10.0, earned: 0.0, open: 0.0 });
}

#[test]
fn a_broken_sphere_test_costs_its_own_points_and_a_share_of_its_rows_is_kept() {
    let broken = graded("textbook:sphere-far-root", |_| ());
    let lost: Vec<_> = broken.cases().filter(|(_, case)| case.points.are_lost()).collect();
    assert!(!lost.is_empty());
    assert!(lost.iter().all(|(_, case)| case.case.contains("sphere")), "{lost:?}");
    assert!(broken.points.earned >= 7.5 && broken.points.earned < 10.0);
}

#[test]
fn hidden_cases_are_drawn_by_version_and_salt() {
    let suite = suite(SMALL).unwrap();
    let cases = load_project(&project()).unwrap();
    let selected = suite.select(&cases).unwrap();
    let drawn = |salt: &str| -> BTreeSet<String> {
        selected.parts(&suite, salt).flat_map(|(_, _, hidden)| hidden).collect()
    };
    assert_eq!(drawn("a"), drawn("a"));
    let all: BTreeSet<_> = (0..40).map(|n| drawn(&n.to_string())).collect();
    assert_eq!(all.len(), 4, "each is drawn by some salt");
    assert_ne!(suite.seed("a"), suite.seed("b"));
    let next = Suite { version: "2".to_owned(), ..suite.clone() };
    assert_ne!(suite.seed("a"), next.seed("a"));
}

#[test]
fn a_suite_that_makes_no_sense_is_refused_where_it_is_wrong() {
    let part = "[[part]]\nname = \"p\"\n";
    let refusal = |text: &str| suite(text).unwrap_err();
    assert!(refusal(&format!("{part}points = 0\ncases = [\"1\"]")).contains("not positive"));
    assert!(refusal(&format!("{part}point = 1\ncases = [\"1\"]")).contains("points"));
    assert!(
        refusal(&format!("time = \"soon\"\n{part}points = 1\ncases = [\"1\"]")).contains("20 min")
    );
    let twice =
        format!("{part}points = 1\ncases = [\"1\"]\n{part}points = 1\ncases = [\"shape/\"]");
    let cases = load_project(&project()).unwrap();
    let select =
        |text: &str| suite(text).unwrap().select(&cases).map(|_| ()).unwrap_err().to_string();
    assert!(select(&twice).contains("belongs to `p` already"));
    assert!(select(&format!("{part}points = 1\ncases = [\"nohwere\"]")).contains("hint"));
    let unknown = Suite::find(&project(), "cs184-hw4").unwrap_err().to_string();
    assert!(unknown.contains("did you mean `cs184-hw3`?"), "{unknown}");
}

#[test]
fn the_suites_of_the_bench_select_and_know_what_they_excuse() {
    let suite = Suite::find(&project(), "cs184-hw3").unwrap();
    suite.select(&load_project(&project()).unwrap()).unwrap();
    let points: f64 = suite.parts.iter().map(|part| part.points).sum();
    assert_eq!(points, 100.0);
    let names = suite.optional.iter().filter(|word| !word.contains(' ')).cloned();
    let names: Vec<_> = names.collect();
    crate::contract::Capabilities::from_names(&names).unwrap();
    // The adapter's own words, as it says them.
    let adapter = include_str!("../../adapters/cs184/furnace_cs184.cpp");
    let words = suite.optional.iter().filter(|word| word.contains(' '));
    words.for_each(|word| assert!(adapter.contains(word), "{word}"));
}

const WITH_IMAGES: &str = "
budget = \"quick\"
[[part]]
name = \"Triangles\"
points = 10
cases = [\"hits-lie-between-t-min\"]
[[part]]
name = \"Light\"
points = 10
cases = [\"light/point-light-follows\"]
[[part]]
name = \"Images\"
points = 10
transplants = false
partial = \"none\"
cases = [\"image/area-light-plane-matches\"]
";

#[test]
fn images_are_judged_as_they_are_whatever_costs_points_elsewhere() {
    let suite = suite(WITH_IMAGES).unwrap();
    let cases = load_project(&project()).unwrap();
    let selected = suite.select(&cases).unwrap();
    let core = "textbook:triangle-ignores-t-max";
    let plan = suite.plan(&project(), &selected, "", core.parse().unwrap(), 2).unwrap();
    let grade = Grade::of(&suite, &selected, "", &tree(core, run_in_memory(&plan)));
    let [triangles, light, images] = &grade.parts[..] else { panic!("three parts") };
    assert!(triangles.points.are_lost());
    assert_eq!(light.points.earned, 10.0);
    assert!(!light.cases[0].with.is_empty());
    assert_eq!(images.points, Points { of: 10.0, earned: 0.0, open: 0.0 });
    assert!(images.cases[0].with.is_empty());
}

/// What is told of a submission.
fn told(cause: &str, degree: Degree, mistake: &str) -> Told {
    let [cause, mistake] = [cause, mistake].map(str::to_owned);
    let (evidence, explains) = (vec!["seen".to_owned()], vec!["a/b".to_owned()]);
    let [look_at, fix, command] = ["here", "this", "that"].map(str::to_owned);
    Told { cause, degree, mistake, evidence, look_at, fix, command, explains }
}

#[test]
fn a_class_is_grouped_by_causes_and_apart_from_them_by_places() {
    let row = |called: &str, causes: Vec<Told>| {
        let grade = Grade::absent(&suite(SMALL).unwrap(), called, "");
        class::Row { called: called.to_owned(), grade: Grade { causes, ..grade }, report: None }
    };
    let pi = |degree| told("brdf-without-pi", degree, "the BRDF is not divided by pi");
    let place = || told("", Degree::DiffersHere, "direct light differs");
    let rows = vec![
        row("ada", vec![pi(Degree::Named), place()]),
        row("bea", vec![place()]),
        row("cem", vec![pi(Degree::LooksLike)]),
    ];
    let class = class::Class::new("A class".to_owned(), String::new(), None, rows);
    let page = class::page(&class);
    let (causes, places) = page.split_once("Places where they differ").unwrap();
    let (_, causes) = causes.split_once("Mistakes").unwrap();
    assert!(!causes.contains("direct light differs"), "{causes}");
    let row =
        "<code>brdf-without-pi</code></td><td class=\"number\">2</td><td>ada</td><td>cem</td>";
    assert!(causes.contains(row), "{causes}");
    assert!(
        places.contains("direct light differs</td><td class=\"number\">2</td><td>ada, bea</td>")
    );
    let table = class::table(&class);
    assert!(table.contains("brdf-without-pi,,direct light differs\r\n"), "{table}");
}

mod formats;
