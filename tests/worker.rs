//! A worker changes nothing but where a core lives: the same core gives the same findings in it, and cores that come with
//! the project as examples are asked like any other.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use furnace::case;
use furnace::cores::Hosting;
use furnace::project::Project;
use furnace::run::{Plan, Request, Status, TrialRecord, run_in_memory};
use furnace::stats::Budget;
use std::path::Path;
use std::process::Command;
use support::{compile_core, cpp_compiler, root};

fn run(core: &str, filters: &[&str], isolates_own: bool) -> Vec<TrialRecord> {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec![core.parse().unwrap()],
        filters: filters.iter().map(ToString::to_string).collect(),
        budget: Budget::Quick,
        jobs: 2,
        ..Request::default()
    };
    let program = env!("CARGO_BIN_EXE_furnace").into();
    let hosting = Hosting { program, isolates_own, ..Hosting::default() };
    run_in_memory(&Plan::new(project, request, &cases).unwrap().hosted(hosting))
}

/// Every kind of request: rays, shapes, boxes, samplers, surfaces, streams, scenes, light, pictures.
const EVERYTHING: &[&str] = &[
    "camera/",
    "shape/ray",
    "bvh/flat",
    "bvh/spheres-and",
    "adaptive/known-streams",
    "integrator/reported-variance",
    "sampling/cosine-pdf",
    "bsdf/sampling-agrees",
    "light/sphere-light-samples",
    "light/point-light-f",
    "image/point-light",
];

#[test]
fn a_core_gives_the_same_findings_in_a_worker() {
    let here = run("builtin", EVERYTHING, false);
    let away = run("builtin", EVERYTHING, true);
    assert!(here.len() > EVERYTHING.len(), "{} cases", here.len());
    for (here, away) in here.iter().zip(&away) {
        assert_eq!(here.case, away.case);
        // In words, for NaN, which one picture alone has for its standard error, is not equal to itself.
        let [here_told, away_told] = [here, away].map(|trial| format!("{:?}", trial.outcome));
        assert_eq!(here_told, away_told, "{}", here.case);
    }
}

fn assert_nothing_fails(trials: &[TrialRecord], least: usize) {
    assert!(trials.len() >= least, "{} trials", trials.len());
    for trial in trials {
        let status = trial.outcome.status();
        let is_fine = matches!(status, Status::Pass | Status::Inconclusive | Status::Skipped);
        assert!(is_fine, "{}: {}\n{}", trial.case, trial.outcome.statement(), trial.printed);
    }
}

/// Pictures take long; `cargo furnace --core` tries them too.
fn assert_cpp_example_is_right(name: &str, flags: &[&str]) {
    let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let source = root().join("examples/cpp/pathtracer.cpp");
    compile_core(&cpp_compiler(), flags, &source, &library);
    assert_nothing_fails(&run(&library.to_string_lossy(), &["!image/"], false), 60);
}

#[test]
fn the_cpp_example_is_right() {
    assert_cpp_example_is_right("libpathtracer.so", &[]);
}

#[test]
fn the_cpp_example_is_right_in_single_precision() {
    // No double takes part in it unseen.
    let flags = ["-DREAL=float", "-Wdouble-promotion"];
    assert_cpp_example_is_right("libpathtracer-single.so", &flags);
}

#[test]
fn the_numpy_example_is_right() {
    let python = std::env::var("FURNACE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let imports = Command::new(&python).args(["-c", "import numpy, furnace_core"]).output();
    if !imports.is_ok_and(|output| output.status.success()) {
        eprintln!(
            "skipped: `{python}` has no numpy and furnace_core; see adapters/python/README.md"
        );
        return;
    }
    let script = root().join("examples/python/numpy_core.py");
    let core = format!("exec: {python} '{}'", script.display());
    // A speed belongs in no test, and this one is a seventh of its time.
    let filters = ["camera/", "shape/", "bvh/", "!bvh/bvh-is-faster"];
    assert_nothing_fails(&run(&core, &filters, false), 15);
}

/// Renderers that others wrote and everybody trusts; `docs/book/src/trusted-renderers.md` tells of every case.
#[test]
fn embree_is_right() {
    let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join("libfurnace_embree.so");
    let [source, include] =
        ["adapters/embree/furnace_embree.cpp", "include"].map(|p| root().join(p));
    let linked = |name: &str| {
        let mut compiler = Command::new(cpp_compiler());
        compiler.args(["-std=c++17", "-O2", "-shared", "-fPIC", "-I"]).arg(&include);
        compiler.arg(&source).arg(format!("-l{name}")).arg("-o").arg(&library).output().unwrap()
    };
    let made = [linked("embree4"), linked("embree3")];
    if !made.iter().any(|output| output.status.success()) {
        let told = String::from_utf8_lossy(&made[1].stderr).into_owned();
        assert!(told.contains("Embree is not installed"), "{told}");
        eprintln!("skipped: Embree is not installed, as `apt install libembree-dev` would");
        return;
    }
    let filters = ["shape/ray", "shape/random", "shape/hits-lie", "bvh/", "!bvh/bvh-is-faster"];
    assert_nothing_fails(&run(&library.to_string_lossy(), &filters, false), 10);
}

#[test]
fn mitsuba_is_right() {
    let python = std::env::var("FURNACE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = root().join("adapters/python/mitsuba_core.py");
    let starts = Command::new(&python).arg(&script).stdin(std::process::Stdio::null()).output();
    let starts = starts.map(|output| (output.status.success(), output.stderr));
    if !matches!(starts, Ok((true, _))) {
        let why = starts.map(|(_, told)| String::from_utf8_lossy(&told).trim().to_owned());
        eprintln!("skipped: {}", why.unwrap_or_else(|error| format!("{python}: {error}")));
        return;
    }
    let core = format!("exec: {python} '{}'", script.display());
    let filters = ["shape/ray-t", "bsdf/glass", "bsdf/sampling-agrees", "light/point-light-f"];
    assert_nothing_fails(&run(&core, &filters, false), 4);
}
