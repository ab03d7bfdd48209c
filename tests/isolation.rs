//! Cores that crash, hang, lie, flood, hoard and attack: each ends as an outcome of its own name, the other trials of
//! the same run are unharmed, and no process is left.
//!
//! `tests/fixtures/hostile` has the cores: one C++ library whose deed is in its file's name, one Python program whose
//! deed is its argument. Where there is no C++ compiler or no python3, nothing is shown, and the test says so.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use furnace::case;
use furnace::cores::Hosting;
use furnace::project::Project;
use furnace::run::{Outcome, Plan, Request, RunError, Status, TrialRecord, record, run_in_memory};
use furnace::stats::Budget;
use furnace::worker::Limits;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock, PoisonError};
use support::{compile_core, cpp_compiler};
use tempfile::TempDir;

/// Where a hostile core strikes, and where it behaves.
const STRUCK: &str = "shape/ray-triangle-hits-are-right";
const SPARED: &str = "camera/rays-pass-through-their-film-points";

/// One at a time: each test looks for processes that are left.
static ALONE: Mutex<()> = Mutex::new(());

/// How a trial has to end: a status, and words of its statement.
type Ending = (Status, &'static str);

/// Where nothing watches the stack, a segmentation fault may be anything.
const OVERFLOW: &str = match cfg!(target_os = "linux") {
    true => "stack overflow (SIGSEGV",
    false => "a stack that overflowed",
};

/// What each C++ core comes to.
const LIBRARIES: &[(&str, Ending)] = &[
    ("segfault", (Status::Crashed, "SIGSEGV")),
    ("raise", (Status::Crashed, "SIGSEGV")),
    ("overflow", (Status::Crashed, OVERFLOW)),
    ("divide", (Status::Crashed, "SIGFPE")),
    ("abort", (Status::Crashed, "SIGABRT")),
    ("exit", (Status::Crashed, "exit code 0 without an answer")),
    ("quick", (Status::Crashed, "exit code 7 without an answer")),
    ("throw", (Status::Fail, "the core refused: I do not like triangles")),
    ("throwint", (Status::Fail, "an exception that is no std::exception")),
    ("letout", (Status::Crashed, "SIGABRT")),
    ("unsupported", (Status::Skipped, "triangles")),
    ("hang", (Status::TimedOut, "no answer in 2 s during intersect-triangle")),
    ("sleep", (Status::TimedOut, "no answer in 2 s during intersect-triangle")),
    ("flood", (Status::TimedOut, "no answer in 2 s during intersect-triangle")),
    ("chatter", (Status::Pass, "")),
    ("hoard", (Status::Fail, "out of memory")),
    ("hoardsilently", (Status::Crashed, "SIGABRT")),
    ("hoardshared", (Status::Crashed, "out of memory")),
    ("hoardfiles", (Status::Crashed, "out of scratch space")),
    ("threads", (Status::Fail, "Resource temporarily unavailable")),
    ("longfile", (Status::Crashed, "SIGXFSZ")),
    ("hangup", (Status::Crashed, "closed its channel and went on running")),
    ("forge", (Status::Fail, "begins with \"everything passes")),
    ("leave", (Status::Fail, "left untouched")),
    ("half", (Status::Fail, "hit 4 of 9: primitive was left untouched")),
    ("nan", (Status::Fail, "t is NaN")),
    ("infinite", (Status::Fail, "t is infinite")),
    ("ghost", (Status::Fail, "shape 0 has no primitive 7")),
    ("longnormal", (Status::Fail, "geometric_normal has length 2, not 1")),
    ("status", (Status::Fail, "unknown status 42")),
];

/// What those come to that only a sandboxed worker stops.
const SANDBOXED_LIBRARIES: &[(&str, Ending)] = &[
    ("fork", (Status::Fail, "fork: Operation not permitted")),
    ("exec", (Status::Fail, "exec: Operation not permitted")),
    ("kill", (Status::Fail, "kill: Operation not permitted")),
    ("connect", (Status::Fail, "socket: Operation not permitted")),
    ("read", (Status::Fail, "reading: Permission denied")),
    ("write", (Status::Fail, "writing: Permission denied")),
    ("lock", (Status::Fail, "chmod: Operation not permitted")),
    ("hoardunlinked", (Status::Crashed, "out of scratch space")),
    ("segment", (Status::Fail, "shmget: Operation not permitted")),
    ("semaphore", (Status::Fail, "semget: Operation not permitted")),
    ("message", (Status::Fail, "msgget: Operation not permitted")),
    ("queue", (Status::Fail, "mq_open: Operation not permitted")),
    ("memfd", (Status::Fail, "memfd_create: Operation not permitted")),
    ("sendfile", (Status::Fail, "sendmsg: Operation not permitted")),
    ("hide", (Status::Fail, "prctl: Operation not permitted")),
];

/// A case that believes counts.
const COUNTED: &str = "bvh/triangle-soup-tests-per-ray-grow-slowly";

/// What those come to that meddle with the counts.
const MISCOUNTING: &[(&str, Ending)] = &[
    ("setback", (Status::Fail, "the counters of the counted tests were set by somebody else")),
    ("restored", (Status::Fail, "answers were found without the counted tests")),
    ("behind", (Status::Fail, "answers were found without the counted tests")),
];

/// What each program comes to.
const PROGRAMS: &[(&str, Ending)] = &[
    ("fewer", (Status::Fail, "answered `hits`, 8 of hit; asked for was `hits`, 9 of hit")),
    ("othername", (Status::Fail, "answered `hints`")),
    ("otherelement", (Status::Fail, "9 of f64; asked for was `hits`, 9 of hit")),
    ("shortbody", (Status::Fail, "its answer has 1 arrays in 728 bytes")),
    ("othernumber", (Status::Fail, "it answered request 3, and was asked 2")),
    ("otheranswer", (Status::Fail, "which does not match the request")),
    ("noanswer", (Status::Fail, "unknown variant `forty-two`")),
    ("nojson", (Status::Fail, "its header says")),
    ("hugeheader", (Status::Fail, "a header of 4294967295 bytes")),
    ("halfaframe", (Status::TimedOut, "no answer in 2 s during intersect-triangle")),
    ("text", (Status::Fail, "it begins with \"Building BVH")),
    ("bomb", (Status::Crashed, "it had started")),
    ("bombofhangs", (Status::Crashed, "it had started")),
    ("hoard", (Status::Crashed, "out of memory")),
    ("sharedhoard", (Status::Crashed, "out of memory")),
    ("filehoard", (Status::Crashed, "out of scratch space")),
    ("daemon", (Status::Fail, "")),
    ("crash", (Status::Crashed, "exit code 1 without an answer")),
    ("hangup", (Status::Crashed, "closed its channel and went on running")),
];

/// What those come to that only a sandboxed worker stops.
const SANDBOXED_PROGRAMS: &[(&str, Ending)] = &[
    ("read", (Status::Fail, "PermissionError: Permission denied")),
    ("shell", (Status::Crashed, "exit code 1 without an answer")),
    ("connect", (Status::Fail, "PermissionError: Operation not permitted")),
    ("memfd", (Status::Fail, "PermissionError: Operation not permitted")),
];

/// A picture that is asked for.
const PICTURE: &str = "image/point-light-plane-matches-mitsuba";

/// What each program that makes pictures comes to.
const RENDERERS: &[(&str, Ending)] = &[
    ("behave", (Status::Fail, "of the light it should have")),
    ("behave.png", (Status::Fail, "in codes (sRGB, rounded): the picture has ")),
    ("crash", (Status::Crashed, "SIGABRT")),
    ("exit", (Status::Fail, "exited successfully without writing picture.pfm")),
    ("hang", (Status::TimedOut, "no answer in 2 s")),
    ("hoard", (Status::Crashed, "MemoryError")),
    ("multiply", (Status::Crashed, "it had started")),
];

/// What those come to that only a sandboxed worker stops.
const SANDBOXED_RENDERERS: &[(&str, Ending)] = &[
    ("read", (Status::Crashed, "PermissionError: [Errno 13]")),
    ("write", (Status::Crashed, "PermissionError: [Errno 13]")),
    ("connect", (Status::Crashed, "PermissionError: [Errno 1]")),
    ("escape", (Status::Crashed, "PermissionError: [Errno 1]")),
];

/// A folder with hostile cores, and with what they are to attack.
struct Lair {
    folder: TempDir,
    project: Project,
}

impl Lair {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let project = Project::at(env!("CARGO_MANIFEST_DIR"));
        let lair = Self { folder, project };
        fs::create_dir(lair.runs()).unwrap();
        fs::write(lair.result(), "as it was").unwrap();
        let secret = lair.project.references().join("recipes.toml");
        fs::create_dir(lair.den()).unwrap();
        let targets = format!("{}\n{}\n", secret.display(), lair.result().display());
        fs::write(lair.den().join("targets"), targets).unwrap();
        lair
    }

    /// Where the cores are.
    fn den(&self) -> PathBuf {
        self.folder.path().join("den")
    }

    fn runs(&self) -> PathBuf {
        self.folder.path().join("runs")
    }

    /// A result that nobody may touch.
    fn result(&self) -> PathBuf {
        self.runs().join("run.json")
    }

    /// A copy of the library under the name of its deed.
    fn core_of(&self, library: &Path, deed: &str) -> String {
        let path = self.den().join(format!("lib{deed}.so"));
        fs::copy(library, &path).unwrap();
        path.to_string_lossy().into_owned()
    }

    fn program(&self, deed: &str) -> String {
        let script = self.den().join("hostile.py");
        fs::copy(fixture("hostile.py"), &script).unwrap();
        let python = python().expect("every test asks for it first");
        format!("exec: '{python}' '{}' {deed} '{}'", script.display(), script.display())
    }

    /// A file that says how a renderer is called.
    fn renderer(&self, deed: &str) -> String {
        fs::copy(fixture("renderer.py"), self.den().join("renderer.py")).unwrap();
        let secret = self.project.references().join("recipes.toml");
        let (deed, ending, encoding) = match deed.strip_suffix(".png") {
            Some(deed) => (deed, "png", "srgb"),
            None => (deed, "pfm", "linear"),
        };
        let text = format!(
            r#"
            name = "{deed}"
            version = "1"
            about = "Does what it should not"
            scene = "mitsuba"
            program = {{ variable = "FURNACE_HOSTILE_PYTHON", default = '{}', needs = "a Python" }}
            arguments = ["{{adapter}}/renderer.py", "{{output}}", '{}', '{}', "{deed}"]
            environment = {{ SEED = "{{seed}}" }}
            output = {{ file = "picture.{ending}", encoding = "{encoding}" }}
            time-limit = 2
            runs = {{ seed-bits = 31 }}
            "#,
            python().expect("every test asks for it first"),
            secret.display(),
            self.result().display(),
        );
        let path = self.den().join(format!("{deed}-{ending}.toml"));
        fs::write(&path, text).unwrap();
        path.to_string_lossy().into_owned()
    }

    fn plan(&self, cores: &[String], filters: &[&str]) -> Plan {
        let cases = case::load_all(&self.project.cases()).unwrap();
        let request = Request {
            cores: cores.iter().map(|core| core.parse().unwrap()).collect(),
            filters: filters.iter().map(ToString::to_string).collect(),
            budget: Budget::Quick,
            jobs: 2,
            ..Request::default()
        };
        let limits = Limits {
            seconds: Some(2.0),
            memory: Some(512 << 20),
            file: 16 << 20,
            scratch: 64 << 20,
            processes: 16,
        };
        Plan::new(self.project.clone(), request, &cases).unwrap().hosted(Hosting {
            program: env!("CARGO_BIN_EXE_furnace").into(),
            limits,
            hidden: vec![self.runs()],
            ..Hosting::default()
        })
    }

    fn run(&self, cores: &[String], filters: &[&str]) -> Result<Vec<TrialRecord>, RunError> {
        let folder = furnace::run::run(&self.plan(cores, filters), &self.runs(), &mut |_| {})?;
        let sidecars = walkdir::WalkDir::new(folder).into_iter().map(|entry| entry.unwrap());
        let sidecars = sidecars
            .filter(|entry| entry.path().extension().is_some_and(|e| e == "json"))
            .filter(|entry| entry.file_name() != "run.json");
        Ok(sidecars.map(|entry| record::read_json(entry.path()).unwrap()).collect())
    }
}

fn fixture(name: &str) -> PathBuf {
    support::root().join("tests/fixtures/hostile").join(name)
}

/// A core of the fixtures, compiled once.
fn compiled(name: &str) -> PathBuf {
    static COMPILED: Mutex<BTreeMap<String, PathBuf>> = Mutex::new(BTreeMap::new());
    let compiler = cpp_compiler();
    let mut compiled = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
    let library = compiled.entry(name.to_owned()).or_insert_with(|| {
        let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("hostile-{name}.so"));
        compile_core(&compiler, &[], &fixture(&format!("{name}.cpp")), &library);
        library
    });
    library.clone()
}

/// The interpreter itself, not a script that looks for it. Says so where there is none.
fn python() -> Option<&'static str> {
    static FOUND: OnceLock<Option<String>> = OnceLock::new();
    let found = FOUND.get_or_init(|| {
        let ask = ["-c", "import sys; print(sys.executable)"];
        let output = Command::new("python3").args(ask).output().ok()?;
        let path = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        output.status.success().then_some(path)
    });
    if found.is_none() {
        eprintln!("skipped: there is no python3");
    }
    found.as_deref()
}

/// Whether a worker is sandboxed here; says so where it is not.
fn is_sandboxed() -> bool {
    let program = env!("CARGO_BIN_EXE_furnace").into();
    let hosting = Hosting { program, isolates_own: true, ..Hosting::default() };
    let hosted = hosting.host(&"textbook".parse().unwrap()).unwrap();
    let is_sandboxed =
        cfg!(target_os = "linux") && hosted.confinement().unwrap().lacking.is_empty();
    if !is_sandboxed {
        eprintln!("skipped: this system cannot sandbox a worker");
    }
    is_sandboxed
}

/// Every core ends as it should where it strikes, and passes where it does not, if that is asked.
fn assert_endings(
    endings: &[(&str, Ending)],
    core: impl Fn(&Lair, &str) -> String,
    cases: &[&str],
) {
    let lair = Lair::new();
    let specs: Vec<_> = endings.iter().map(|(deed, _)| core(&lair, deed)).collect();
    assert_ended(&lair, endings, &specs, cases, &lair.run(&specs, cases).unwrap());
}

/// What [`assert_endings`] says, of trials that ended.
fn assert_ended(
    lair: &Lair,
    endings: &[(&str, Ending)],
    specs: &[String],
    cases: &[&str],
    trials: &[TrialRecord],
) {
    for (spec, (deed, (status, words))) in specs.iter().zip(endings) {
        for case in cases {
            let found = trials.iter().find(|trial| trial.core == *spec && trial.case == *case);
            let trial = found.unwrap_or_else(|| panic!("no trial of {case} on {spec}"));
            let is_spared = *case == SPARED;
            let (status, words) = if is_spared { (Status::Pass, "") } else { (*status, *words) };
            let statement = trial.outcome.statement();
            assert_eq!(trial.outcome.status(), status, "{deed}: {statement}\n{}", trial.printed);
            assert!(statement.contains(words), "{deed}: `{words}` is not in: {statement}");
        }
    }
    assert_eq!(fs::read_to_string(lair.result()).unwrap(), "as it was");
    assert_nobody_is_left(lair);
}

/// No process of a core is left, neither ours nor one that got away.
fn assert_nobody_is_left(lair: &Lair) {
    let den = lair.den().to_string_lossy().into_owned();
    let left: Vec<_> = processes().filter(|command| command.contains(&den)).collect();
    assert!(left.is_empty(), "still there: {left:?}");
}

/// The command lines of all processes, on systems that tell.
fn processes() -> impl Iterator<Item = String> {
    let folders = fs::read_dir("/proc").into_iter().flatten().flatten();
    folders.filter_map(|entry| fs::read_to_string(entry.path().join("cmdline")).ok())
}

#[test]
fn a_library_can_harm_nothing_but_its_own_trial() {
    let _alone = ALONE.lock();
    let library = compiled("hostile");
    assert_endings(LIBRARIES, |lair, deed| lair.core_of(&library, deed), &[STRUCK, SPARED]);
}

#[test]
fn a_library_reaches_neither_secrets_nor_results_nor_anybody_else() {
    let _alone = ALONE.lock();
    let library = compiled("hostile");
    if is_sandboxed() {
        assert_endings(
            SANDBOXED_LIBRARIES,
            |lair, deed| lair.core_of(&library, deed),
            &[STRUCK, SPARED],
        );
    }
}

#[test]
fn a_core_that_sets_its_counts_back_or_tests_behind_them_is_found_out() {
    let _alone = ALONE.lock();
    let library = compiled("counting");
    assert_endings(MISCOUNTING, |lair, deed| lair.core_of(&library, deed), &[COUNTED]);
}

#[test]
fn a_program_can_harm_nothing_but_its_own_trial() {
    let _alone = ALONE.lock();
    if python().is_some() {
        assert_endings(PROGRAMS, Lair::program, &[STRUCK, SPARED]);
    }
}

#[test]
fn a_program_reaches_neither_secrets_nor_the_network() {
    let _alone = ALONE.lock();
    if python().is_some() && is_sandboxed() {
        assert_endings(SANDBOXED_PROGRAMS, Lair::program, &[STRUCK, SPARED]);
    }
}

/// Why the pictures of those that behave are wrong is not searched for here: every mistake would be put to them.
#[test]
fn a_renderer_can_harm_nothing_but_its_own_trial() {
    let _alone = ALONE.lock();
    if python().is_some() {
        let lair = Lair::new();
        let specs: Vec<_> = RENDERERS.iter().map(|(deed, _)| lair.renderer(deed)).collect();
        let trials = run_in_memory(&lair.plan(&specs, &[PICTURE]));
        assert_ended(&lair, RENDERERS, &specs, &[PICTURE], &trials);
    }
}

#[test]
fn a_renderer_reaches_neither_secrets_nor_results_nor_anybody_else() {
    let _alone = ALONE.lock();
    if python().is_some() && is_sandboxed() {
        assert_endings(SANDBOXED_RENDERERS, Lair::renderer, &[PICTURE]);
    }
}

#[test]
fn a_crash_is_narrowed_to_the_ray_it_comes_of() {
    let _alone = ALONE.lock();
    let library = compiled("hostile");
    let lair = Lair::new();
    let trials = lair.run(&[lair.core_of(&library, "segfault")], &[STRUCK]).unwrap();
    let Outcome::Crashed { during, .. } = &trials[0].outcome else { panic!("{trials:?}") };
    let place = "intersect-triangle, element 6 of 9: origin [0.25, 0.25, 1], direction [1, 0.5, 0]";
    assert!(during.starts_with(place), "{during}");
}

#[test]
fn what_a_core_prints_is_kept_with_its_crash() {
    let _alone = ALONE.lock();
    if python().is_none() {
        return;
    }
    let lair = Lair::new();
    let trials = lair.run(&[lair.program("crash")], &[STRUCK]).unwrap();
    assert!(trials[0].printed.ends_with("RuntimeError: I do not like triangles\n"));
}

#[test]
fn a_core_that_dies_of_being_loaded_is_one_line_and_not_the_end() {
    let _alone = ALONE.lock();
    let library = compiled("hostile");
    let lair = Lair::new();
    let crash = lair.core_of(&library, "loadcrash");
    let hang = lair.core_of(&library, "loadhang");
    let cores = [crash, hang, "textbook".to_owned()];
    let trials = lair.run(&cores, &[STRUCK]).unwrap();
    let endings = [Status::Crashed, Status::TimedOut, Status::Pass];
    for (core, status) in cores.iter().zip(endings) {
        let trial = trials.iter().find(|trial| trial.core == *core).unwrap();
        assert_eq!(trial.outcome.status(), status, "{core}");
    }
    assert_nobody_is_left(&lair);
}

#[test]
fn a_program_that_never_answers_or_leaves_is_one_line_too() {
    let _alone = ALONE.lock();
    if python().is_none() {
        return;
    }
    let lair = Lair::new();
    let endings = [
        ("silent", Status::TimedOut, "no answer in 2 s during hello"),
        ("leaves", Status::Crashed, "exit code 3 without an answer"),
    ];
    for (deed, status, words) in endings {
        let trials = lair.run(&[lair.program(deed)], &[STRUCK]).unwrap();
        assert_eq!(trials[0].outcome.status(), status, "{deed}");
        assert!(trials[0].outcome.statement().contains(words), "{:?}", trials[0].outcome);
    }
    assert_nobody_is_left(&lair);
}

#[test]
fn what_is_no_core_is_a_wrong_request() {
    let _alone = ALONE.lock();
    let library = compiled("hostile");
    let lair = Lair::new();
    let text = lair.den().join("text.so");
    fs::write(&text, "not a library").unwrap();
    let mut endings = vec![
        (lair.core_of(&library, "decline"), "does not support version 1"),
        (lair.core_of(&library, "otherabi"), "compiled with version 99"),
        (text.to_string_lossy().into_owned(), "cannot load "),
    ];
    if python().is_some() {
        endings.push((lair.program("telepathy"), "no capability `telepathy`"));
    }
    for (spec, words) in endings {
        let error = lair.run(&[spec], &[STRUCK]).unwrap_err().to_string();
        assert!(error.contains(words), "`{words}` is not in: {error}");
    }
}

#[test]
fn a_core_that_ignores_the_seed_is_found_out() {
    let _alone = ALONE.lock();
    let library = compiled("stubborn");
    let lair = Lair::new();
    let filters = ["integrator/seeds-and-pixels"];
    let trials = lair.run(&[lair.core_of(&library, "stubborn")], &filters).unwrap();
    assert_eq!(trials[0].outcome.status(), Status::Fail, "{:?}", trials[0].outcome);
}

#[test]
fn a_core_that_knows_published_answers_by_heart_is_found_out() {
    let _alone = ALONE.lock();
    let library = compiled("crib");
    let lair = Lair::new();
    let filters = ["light/rectangle-light-overhead-matches", "light/rectangle-light-off-axis"];
    let trials = lair.run(&[lair.core_of(&library, "crib")], &filters).unwrap();
    assert_eq!(trials.len(), 2);
    for trial in trials {
        assert_eq!(trial.outcome.status(), Status::Fail, "{}: {:?}", trial.case, trial.outcome);
    }
}
