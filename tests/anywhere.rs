//! The program needs nothing beside it: in an empty folder, outside any checkout, it runs every case, and what `furnace new`
//! writes is ready to run.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::Path;
use std::process::{Command, Output};

/// `$CXX` or `c++`.
fn cpp_compiler() -> String {
    std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned())
}

/// An empty folder, and a cache of its own.
struct Elsewhere {
    folder: tempfile::TempDir,
    cache: tempfile::TempDir,
}

impl Elsewhere {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), cache: tempfile::tempdir().unwrap() }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn furnace(&self, words: &[&str]) -> Output {
        self.furnace_in(".", words)
    }

    fn furnace_in(&self, folder: &str, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_furnace"));
        command.args(words).current_dir(self.path().join(folder));
        command.env("FURNACE_CACHE", self.cache.path());
        command.env_remove("FURNACE_HOME").env_remove("CARGO_PKG_NAME");
        command.output().unwrap()
    }

    /// What is printed where all goes well.
    fn told(&self, folder: &str, words: &[&str]) -> String {
        let output = self.furnace_in(folder, words);
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{words:?} ends with {}: {complaint}", output.status);
        String::from_utf8(output.stdout).unwrap()
    }

    fn shell(&self, folder: &str, line: &str) {
        let mut command = Command::new("sh");
        command.args(["-c", line]).current_dir(self.path().join(folder));
        let output = command.output().unwrap();
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn cases_and_references_are_there_and_runs_go_to_the_folder_where_one_stands() {
    let here = Elsewhere::new();
    assert!(here.told(".", &["lint"]).contains("valid"));
    let told =
        here.told(".", &["run", "point-light-plane", "ray-sphere-hits", "--core", "builtin"]);
    assert!(told.contains("2 trials") && told.contains("2 pass"), "{told}");
    assert!(here.path().join("reports/runs").is_dir());
    assert_eq!(std::fs::read_dir(here.path()).unwrap().count(), 1, "nothing else is left here");
    assert!(here.told(".", &["explain", "roulette"]).contains("furnace run "));
    assert!(!here.told(".", &["explain", "roulette"]).contains("cargo furnace"));
    let told = here.told(".", &["reference", "list"]);
    assert!(told.contains("teapot"), "{told}");
}

#[test]
fn what_is_unpacked_is_what_the_checkout_has() {
    let here = Elsewhere::new();
    here.told(".", &["list", "cases"]);
    let unpacked = std::fs::read_dir(here.cache.path()).unwrap().next().unwrap().unwrap().path();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in walkdir::WalkDir::new(&unpacked) {
        let entry = entry.unwrap();
        if entry.file_type().is_file() {
            let inside = entry.path().strip_prefix(&unpacked).unwrap();
            let [there, here] =
                [entry.path(), &root.join(inside)].map(|p| std::fs::read(p).unwrap());
            assert!(there == here, "{}", inside.display());
        }
    }
    for file in ["include/furnace_core.h", "adapters/cs184/CMakeLists.txt", "suites/cs184-hw3.toml"]
    {
        assert!(unpacked.join(file).is_file(), "{file}");
    }
    assert!(unpacked.join("references/teapot/reference.exr").is_file());
}

#[test]
fn a_project_is_laid_over_the_bench() {
    let here = Elsewhere::new();
    let told = here.told(".", &["new", "case", "light/mine-adds-nothing"]);
    assert!(told.contains("cases/light/mine-adds-nothing.toml"), "{told}");
    here.told(".", &["lint"]);
    here.told(".", &["run", "light/mine-adds-nothing", "--core", "builtin"]);
    assert!(here.told(".", &["list", "cases"]).contains("light/mine-adds-nothing"));
    let again = here.furnace(&["new", "case", "light/mine-adds-nothing"]);
    assert_eq!(again.status.code(), Some(2), "nothing is overwritten");
    // A scene of one's own counts before the bench's of that name.
    std::fs::create_dir(here.path().join("scenes")).unwrap();
    std::fs::write(here.path().join("scenes/empty.toml"), "nonsense = 1\n").unwrap();
    assert_eq!(here.furnace(&["lint"]).status.code(), Some(2));
}

#[test]
fn a_folder_above_that_is_only_called_like_ours_is_no_project() {
    let here = Elsewhere::new();
    for folder in ["suites/theirs", "cases", "mine"] {
        std::fs::create_dir_all(here.path().join(folder)).unwrap();
    }
    std::fs::write(here.path().join("suites/theirs/notes.txt"), "nothing of ours\n").unwrap();
    here.told("mine", &["new", "suite", "homework"]);
    assert!(here.path().join("mine/suites/homework.toml").is_file());
    std::fs::create_dir(here.path().join("mine/build")).unwrap();
    here.told("mine/build", &["new", "suite", "exam"]);
    assert!(here.path().join("mine/suites/exam.toml").is_file(), "one above is of ours");
}

#[test]
fn a_new_core_in_cpp_passes_as_its_commands_say() {
    let here = Elsewhere::new();
    let told = here.told(".", &["new", "core", "--lang", "cpp", "mine"]);
    let compile = told.lines().find(|line| line.contains("c++ ")).unwrap();
    here.shell("mine", &compile.replace("c++ ", &format!("{} ", cpp_compiler())));
    let told = here.told("mine", &["run", "shape/", "camera/", "--core", "./libpathtracer.so"]);
    assert!(!told.contains("FAIL"), "{told}");
    let again = here.furnace(&["new", "core", "--lang", "cpp", "mine"]);
    assert_eq!(again.status.code(), Some(2), "nothing is overwritten");
}

#[test]
fn a_new_core_in_rust_passes_as_its_commands_say() {
    let here = Elsewhere::new();
    let told = here.told(".", &["new", "core", "--lang", "rust"]);
    here.shell("mine", told.lines().find(|line| line.contains("rustc ")).unwrap());
    let told = here.told("mine", &["run", "1", "--core", "./libcore.so"]);
    assert!(told.contains("PASS") && !told.contains("FAIL"), "{told}");
}

#[test]
fn a_new_core_in_python_answers_beside_its_reports() {
    let numpy = Command::new("python3").args(["-c", "import numpy"]).output();
    if !numpy.is_ok_and(|output| output.status.success()) {
        return eprintln!("skipped: `python3` has no numpy");
    }
    let here = Elsewhere::new();
    here.told(".", &["new", "core", "--lang", "python", "py"]);
    let core = "exec: python3 numpy_core.py";
    here.told("py", &["run", "shape/ray-sphere-hits", "--core", core]);
    // By now what is hidden from cores lies beside it.
    assert!(here.path().join("py/reports/runs").is_dir());
    here.told("py", &["doctor", "--core", core]);
}

#[test]
fn every_other_kind_of_core_is_written_with_all_that_its_commands_name() {
    let here = Elsewhere::new();
    for (kind, files) in [
        ("python", &["numpy_core.py", "bvh.py", "furnace_core/core.py"][..]),
        ("command", &["renderer.toml", "render_mitsuba.py", "furnace_scene.py"]),
        ("cs184", &["adapters/cs184/CMakeLists.txt", "include/furnace_core.h"]),
    ] {
        here.told(".", &["new", "core", "--lang", kind, kind]);
        files
            .iter()
            .for_each(|file| assert!(here.path().join(kind).join(file).is_file(), "{file}"));
    }
}

#[test]
fn a_new_autograder_has_all_that_its_scripts_name() {
    let here = Elsewhere::new();
    here.told(".", &["new", "suite", "mine"]);
    let told = here.told(".", &["new", "autograder", "--suite", "mine"]);
    assert!(told.contains("gradescope.zip"), "{told}");
    let gradescope = here.path().join("autograder/gradescope");
    for file in ["setup.sh", "run_autograder", "furnace", "salt", "suites/mine.toml"] {
        assert!(gradescope.join(file).is_file(), "{file}");
    }
    let salt = std::fs::read_to_string(gradescope.join("salt")).unwrap();
    assert_eq!(salt.trim().len(), 32, "{salt}");
    let github = here.path().join("autograder/github/.github");
    assert!(github.join("furnace/suites/mine.toml").is_file());
    let workflow = std::fs::read_to_string(github.join("workflows/furnace.yml")).unwrap();
    assert!(workflow.contains("--suite mine --submission ."), "{workflow}");
    let script = std::fs::read_to_string(gradescope.join("run_autograder")).unwrap();
    assert!(script.contains("--suite mine") && !script.contains("SUITE"), "{script}");
    let again = here.furnace(&["new", "autograder", "--suite", "mine"]);
    assert_eq!(again.status.code(), Some(2), "nothing is overwritten");
    let unknown = here.furnace(&["new", "autograder", "--suite", "yours", "other"]);
    assert_eq!(unknown.status.code(), Some(2), "a suite that is not there");
    here.told(".", &["new", "slurm", "--suite", "mine"]);
    for script in
        ["autograder/gradescope/setup.sh", "autograder/gradescope/run_autograder", "class.sbatch"]
    {
        here.shell(".", &format!("bash -n {script}"));
    }
}
