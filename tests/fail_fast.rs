//! A run in a hurry stops at the first failure.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::case;
use furnace::project::Project;
use furnace::report::text::{Style, summary};
use furnace::report::{RunTree, html};
use furnace::run::{self, Plan, Request, Status, TrialRecord, run_in_memory};
use std::path::Path;
use tempfile::TempDir;

/// A rectangle of light overhead, found by uniform directions: relative deviation 3.9 a sample. The mean is
/// 0.218, 0.187, 0.167.
fn case(red: f64) -> String {
    format!(
        r#"
        title   = "A rectangle overhead"
        teaches = "Uniform directions have density 1/(2 pi)"
        source  = "made up"
        check   = "mean-radiance"
        scene   = {{ name = "rectangle-light", albedo = [0.37, 0.53, 0.71], emission = [5, 3, 2] }}
        [expect]
        ray     = {{ from = [-1.6, -1.2, 1.2], toward = [1.6, 1.2, -1.2] }}
        direct  = "hemisphere"
        detects = "20 %"
        at-most = "100 k paths"
        [[expect.row]]
        bounces  = [1, 1]
        radiance = [{red}, 0.1874334012, 0.167393352]
        "#
    )
}

/// A project of four cases; the second expects what no right core gives.
fn project() -> (TempDir, Project) {
    let folder = tempfile::tempdir().unwrap();
    let cases = folder.path().join("cases").join("light");
    std::fs::create_dir_all(&cases).unwrap();
    for (name, red) in [("a", 0.2180828882), ("b", 0.7), ("c", 0.2180828882), ("d", 0.2180828882)] {
        std::fs::write(cases.join(format!("{name}.toml")), case(red)).unwrap();
    }
    let scenes = folder.path().join("scenes");
    std::fs::create_dir_all(&scenes).unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join("rectangle-light.toml");
    std::fs::copy(scene, scenes.join("rectangle-light.toml")).unwrap();
    let project = Project::at(folder.path());
    (folder, project)
}

fn plan(project: &Project, fail_fast: bool) -> Plan {
    let cases = case::load_all(&project.cases()).unwrap();
    let cores = vec!["textbook".parse().unwrap()];
    let request = Request { cores, fail_fast, ..Request::default() };
    Plan::new(project.clone(), request, &cases).unwrap()
}

fn statuses(records: &[TrialRecord]) -> Vec<Status> {
    records.iter().map(|record| record.outcome.status()).collect()
}

#[test]
fn nothing_is_run_after_the_first_failure_and_the_report_says_so() {
    let (_folder, project) = project();
    let plan = plan(&project, true);
    let folder = run::run(&plan, &project.runs(), &mut |_| ()).unwrap();
    let tree = RunTree::load(&folder).unwrap();
    assert_eq!(statuses(&tree.trials), [Status::Pass, Status::Fail]);
    let text = summary(&tree, Style::PLAIN);
    assert!(text.contains("NOT RUN: 2 of 4 trials, after the first failure"), "{text}");
    let page = std::fs::read_to_string(html::write(&tree, &folder).unwrap()).unwrap();
    assert!(page.contains("This run stopped at the first failure."));
}

#[test]
fn a_run_that_is_in_no_hurry_tries_everything() {
    let (_folder, project) = project();
    let records = run_in_memory(&plan(&project, false));
    use Status::{Fail, Pass};
    assert_eq!(statuses(&records), [Pass, Fail, Pass, Pass]);
}
