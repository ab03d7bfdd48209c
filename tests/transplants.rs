//! What is broken is replaced by the bench's own, and everything above it is judged as if it were right.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use furnace::case;
use furnace::contract::Components;
use furnace::cores::Hosting;
use furnace::math::rng::Seed;
use furnace::project::Project;
use furnace::run::{Plan, Request, Status, TrialRecord, run_in_memory};
use furnace::stats::Budget;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{compile_core, cpp_compiler, root};

fn plan(core: &str, filters: &[&str]) -> Plan {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec![core.parse().unwrap()],
        filters: filters.iter().map(|&word| word.to_owned()).collect(),
        budget: Budget::Quick,
        seed: Seed::SUITE,
        jobs: 0,
        fail_fast: false,
    };
    let program = env!("CARGO_BIN_EXE_furnace").into();
    Plan::new(project, request, &cases).unwrap().hosted(Hosting { program, ..Hosting::default() })
}

/// The subjects of the cases that ended so.
fn subjects(records: &[TrialRecord], status: Status) -> BTreeSet<&str> {
    let ended = records.iter().filter(|record| record.outcome.status() == status);
    ended.filter_map(|record| record.case.split('/').next()).collect()
}

#[test]
fn two_mistakes_of_different_components_hide_nothing() {
    let records =
        run_in_memory(&plan("textbook:sphere-near-root-only+brdf-without-pi", &["!image"]));
    let failed = subjects(&records, Status::Fail);
    assert_eq!(subjects(&records, Status::Blocked), BTreeSet::new());
    assert!(failed.is_subset(&["shape", "bsdf"].into()), "{failed:?}");
    let with = |component| records.iter().filter(|record| record.with.contains(component)).count();
    assert!(with(Components::SPHERE_TEST) > 10 && with(Components::BSDF) > 10);
}

#[test]
fn a_third_mistake_above_two_others_is_seen() {
    let three = "textbook:sphere-near-root-only+brdf-without-pi+roulette-not-divided";
    let records = run_in_memory(&plan(three, &["!image"]));
    let failures = records.iter().filter(|record| record.outcome.status() == Status::Fail);
    let failures: Vec<_> = failures.map(|record| record.case.as_str()).collect();
    assert!(failures.contains(&"integrator/russian-roulette-leaves-the-mean-unchanged"));
    assert!(!failures.contains(&"integrator/furnace-matches-geometric-series"), "{failures:?}");
}

#[test]
fn what_is_asked_for_is_taken_whatever_fails() {
    let filter = "bsdf/diffuse-conserves-energy";
    let wrong = plan("textbook:brdf-without-pi", &[filter]);
    assert_eq!(run_in_memory(&wrong)[0].outcome.status(), Status::Fail);
    let mended = run_in_memory(&wrong.taking(Components::BSDF));
    assert_eq!(mended[0].outcome.status(), Status::Pass);
    assert!(mended[0].rerun.ends_with(" --with bsdf"), "{}", mended[0].rerun);
    // Nothing that a triangle test calls.
    let triangles = plan("textbook", &["shape/ray-triangle-hits-are-right"]);
    let record = &run_in_memory(&triangles.taking(Components::BSDF))[0];
    assert!(record.with.contains(Components::BSDF) && !record.rerun.contains("--with"));
}

#[test]
fn a_core_that_takes_nothing_is_asked_for_nothing() {
    let filter = "bsdf/diffuse-conserves-energy";
    let refused = run_in_memory(&plan("builtin", &[filter]).taking(Components::BSDF));
    assert_eq!(refused[0].outcome.statement(), "unsupported by the core: the bench's BSDF");
}

/// `examples/cpp` with one line in the place of another.
fn mistaken(name: &str, file: &str, right: &str, wrong: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for entry in std::fs::read_dir(root().join("examples/cpp")).unwrap() {
        let path = entry.unwrap().path();
        let mut text = std::fs::read_to_string(&path).unwrap();
        if path.ends_with(file) {
            assert!(text.contains(right), "{file} has no `{right}`");
            text = text.replace(right, wrong);
        }
        std::fs::write(folder.join(path.file_name().unwrap()), text).unwrap();
    }
    let library: PathBuf = folder.join("core.so");
    compile_core(&cpp_compiler(), &[], &folder.join("pathtracer.cpp"), &library);
    library.to_string_lossy().into_owned()
}

/// Something of every subject.
const SOME: &[&str] = &["shape/ray", "bvh/", "sampling/", "bsdf/", "light/", "integrator/furnace"];

#[test]
fn a_mistake_behind_the_c_boundary_hides_nothing() {
    let core =
        mistaken("sphere", "shapes.hpp", "t = within(ray, middle - half_chord) ?", "t = true ?");
    let records = run_in_memory(&plan(&core, SOME));
    assert_eq!(subjects(&records, Status::Blocked), BTreeSet::new());
    assert_eq!(subjects(&records, Status::Fail), ["shape"].into());
    let with_sphere = |record: &&TrialRecord| record.with.contains(Components::SPHERE_TEST);
    assert!(records.iter().filter(with_sphere).count() > 5);
}

#[test]
fn a_right_core_stays_right_with_everything_of_the_bench() {
    let right = mistaken("right", "shapes.hpp", "", "");
    let all = Components::all() - Components::RANDOM_NUMBERS;
    for taken in all.iter().chain([all]) {
        let filters =
            ["bvh/spheres", "light/sphere", "bsdf/rough", "integrator/furnace", "adaptive/"];
        for record in run_in_memory(&plan(&right, &filters).taking(taken)) {
            let status = record.outcome.status();
            assert_ne!(status, Status::Fail, "{} with {:?}", record.case, taken.names());
            assert_ne!(status, Status::Crashed, "{} with {:?}", record.case, taken.names());
        }
    }
}

/// It can do one thing, and that wrongly: every ray misses every sphere.
const ONE_THING: &str = r#"#include "furnace_core.hpp"
struct OneThing {
   furnace_hit intersect_sphere(furnace_vec3, double, const furnace_ray &) { return furnace::miss(); }
};
FURNACE_CORE(OneThing, "one thing", "1", FURNACE_DETERMINISTIC)
"#;

#[test]
fn what_a_core_lacks_is_skipped_whatever_else_is_broken() {
    let folder = tempfile::tempdir().unwrap();
    let (source, library) = (folder.path().join("one.cpp"), folder.path().join("one.so"));
    std::fs::write(&source, ONE_THING).unwrap();
    compile_core(&cpp_compiler(), &[], &source, &library);
    let records = run_in_memory(&plan(&library.to_string_lossy(), &[]));
    assert!(subjects(&records, Status::Fail).contains("shape"));
    let said = |case: &str| {
        let of_it = records.iter().find(|record| record.case == case).unwrap();
        of_it.outcome.statement()
    };
    // It rests on spheres, which are broken; but what it asks for is not there at all.
    assert_eq!(
        said("integrator/furnace-matches-geometric-series"),
        "the core has no build-scene, radiance, isolated-bounces"
    );
    assert_eq!(subjects(&records, Status::Blocked), BTreeSet::new());
}

/// The core of `tests/fixtures/python` that is wrong so, if there is a Python for it.
fn lit(wrong: &str) -> Option<String> {
    let python = std::env::var("FURNACE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let imports = Command::new(&python).args(["-c", "import numpy, furnace_core"]).output();
    if !imports.is_ok_and(|output| output.status.success()) {
        eprintln!(
            "skipped: `{python}` has no numpy and furnace_core; see adapters/python/README.md"
        );
        return None;
    }
    let [script, example] =
        ["tests/fixtures/python/lit.py", "examples/python"].map(|path| root().join(path));
    Some(format!("exec: {python} '{}' '{}' {wrong}", script.display(), example.display()))
}

/// What a core of `diffuse` surfaces and point lights is asked.
const LIT: &[&str] = &["camera/", "bsdf/diffuse", "light/point-light"];

#[test]
fn a_core_in_python_takes_components() {
    let Some(right) = lit("nothing") else { return };
    for taken in [Components::CAMERA, Components::TRAVERSAL, Components::LIGHT_SAMPLING] {
        let records = run_in_memory(&plan(&right, &["light/point-light"]).taking(taken));
        let passed = records.iter().filter(|it| it.outcome.status() == Status::Pass).count();
        assert!(passed >= 2, "{taken:?}: {:?}", told(&records));
    }
    let records = run_in_memory(&plan(&lit("bsdf").unwrap(), LIT));
    assert_eq!(subjects(&records, Status::Fail), ["bsdf"].into(), "{:?}", told(&records));
    assert_eq!(subjects(&records, Status::Blocked), BTreeSet::new(), "{:?}", told(&records));
    assert!(records.iter().filter(|record| record.with.contains(Components::BSDF)).count() >= 2);
}

#[test]
fn what_a_core_in_python_does_not_ask_for_is_its_own() {
    let Some(unasked) = lit("bsdf-unasked") else { return };
    let records = run_in_memory(&plan(&unasked, LIT));
    assert_eq!(subjects(&records, Status::Fail), ["bsdf"].into(), "{:?}", told(&records));
    assert!(subjects(&records, Status::Blocked).contains("light"), "{:?}", told(&records));
    // A core is told to take nothing that it does not name.
    let unnamed = plan(&lit("nothing").unwrap(), &["light/point-light-f"]).taking(Components::PATH);
    assert_eq!(told(&run_in_memory(&unnamed)).concat().matches("the bench's path").count(), 1);
    // Nor does the bench lend what it has not told a core to take.
    let forward = plan(&lit("forward").unwrap(), &["light/point-light"]).taking(Components::BSDF);
    let words = told(&run_in_memory(&forward)).concat();
    assert!(words.contains("it asked the bench for `radiance`"), "{words}");
}

fn told(records: &[TrialRecord]) -> Vec<String> {
    records.iter().map(|it| format!("{}: {}\n", it.case, it.outcome.statement())).collect()
}
