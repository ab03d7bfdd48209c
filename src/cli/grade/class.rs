//! `furnace grade --submissions`: a whole class. What has been graded once is taken from disk, so that a class that was cut
//! off goes on where it was.

mod progress;

use super::{Desk, GradeArguments, put, suite_failure};
use crate::cli::interrupt::end_with;
use crate::cli::run::salt;
use crate::cli::say::{complain, say_line};
use crate::cli::{Answer, ExitCode, Failure};
use crate::cores::CoreSpec;
use crate::grade::class::{Class, Row, page, table};
use crate::grade::{Built, Grade, NoCore, SALT_VARIABLE, Submission};
use crate::report::{self, RunTree};
use crate::run::record::{read_json, write_json};
use crate::run::{self, Event, RunError};
use crate::text::number::count;
use crate::text::{fingerprint, program};
use progress::{News, Progress, Step};
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};

/// Letters of the word by which a submission without a name is called.
const ALIAS: usize = 8;

/// Grades every submission of a folder.
pub(super) fn grade(arguments: &GradeArguments, desk: &Desk, folder: &Path) -> Answer {
    let unreadable = |error| Failure::request(format!("cannot read {}: {error}", folder.display()));
    let submissions = Submission::all(folder).map_err(unreadable)?;
    if submissions.is_empty() {
        return Err(Failure::nothing(format!("{} holds no submission", folder.display())));
    }
    // A build stands elsewhere.
    let home = match &arguments.report {
        Some(folder) => std::path::absolute(folder).map_err(Failure::request)?,
        None => desk.project.class(&desk.suite.name),
    };
    let conditions = desk.conditions()?;
    let keys: Vec<_> = submissions.iter().map(|one| one.key(&conditions)).collect();
    let graded = all_of(arguments, desk, &home, turns(arguments, &submissions, &keys))?;
    let mut rows = Vec::new();
    for (submission, key) in submissions.iter().zip(&keys) {
        let Some(grade) = graded.get(key) else { continue };
        let called = if arguments.names { &submission.name } else { &key[..ALIAS] };
        let report = newest(&home.join("runs").join(key)).map(|run| {
            let inside = run.strip_prefix(&home).unwrap_or(&run).join("index.html");
            inside.to_string_lossy().into_owned()
        });
        rows.push(Row { called: called.to_owned(), grade: grade.clone(), report });
    }
    let title = format!("{} ({} {})", desk.suite.title, desk.suite.name, desk.suite.version);
    let conditions = fingerprint(conditions.as_bytes());
    let class = Class::new(title, conditions, arguments.shard, rows);
    write_json(&home.join(class.file()), &class).map_err(Failure::broken)?;
    let files = write(&class, &home, arguments.outputs.csv.as_deref())?;
    if arguments.json {
        let grades: Vec<_> = class.rows.iter().map(|row| &row.grade).collect();
        say_line!("{}", serde_json::to_string_pretty(&grades).map_err(Failure::broken)?);
        return Ok(ExitCode::Good);
    }
    tell(&class, &files);
    Ok(ExitCode::Good)
}

/// A submission that is to be graded.
struct Turn<'a> {
    key: &'a str,
    submission: &'a Submission,
    /// As it is called while that goes on.
    called: String,
}

/// Those of our share. Of equal ones only one is tried.
fn turns<'a>(
    arguments: &GradeArguments,
    submissions: &'a [Submission],
    keys: &'a [String],
) -> Vec<Turn<'a>> {
    let first: BTreeMap<_, _> = keys.iter().zip(submissions).rev().collect();
    let is_ours = |place: usize| arguments.shard.is_none_or(|shard| shard.has(place));
    let ours = first.into_iter().enumerate().filter(|(place, _)| is_ours(*place));
    let ours: Vec<_> = ours.map(|(_, turn)| turn).collect();
    let of = ours.len();
    let turn = |(place, (key, submission)): (usize, (&'a String, &'a Submission))| {
        let called = match arguments.names {
            true => submission.name.clone(),
            false => format!("submission {} of {of} ({})", place + 1, &key[..ALIAS]),
        };
        Turn { key, submission, called }
    };
    ours.into_iter().enumerate().map(turn).collect()
}

/// Grades by key, while they come in.
type Grades = BTreeMap<String, Result<Grade, Failure>>;

/// Grades as many at a time as there are threads.
fn all_of(
    arguments: &GradeArguments,
    desk: &Desk,
    home: &Path,
    turns: Vec<Turn<'_>>,
) -> Result<BTreeMap<String, Grade>, Failure> {
    let graded = Arc::new(Mutex::new(Grades::new()));
    let (so_far, of, folder) = (Arc::clone(&graded), turns.len(), home.to_owned());
    end_with(move || interrupted(lock(&so_far).len(), of, &folder));
    let (sender, news) = mpsc::channel();
    let next = AtomicUsize::new(0);
    let work = |sender: mpsc::Sender<News>| {
        while let Some(turn) = turns.get(next.fetch_add(1, Ordering::Relaxed)) {
            // Nobody listens any more where showing it has failed.
            let tell = |step| drop(sender.send(News { who: turn.called.clone(), step }));
            let grade = of_one(arguments, desk, turn, home, &tell);
            tell(Step::Graded(in_words(&grade)));
            lock(&graded).insert(turn.key.to_owned(), grade);
        }
    };
    let workers = arguments.jobs.map_or_else(
        || std::thread::available_parallelism().map_or(1, NonZeroUsize::get),
        NonZeroUsize::get,
    );
    std::thread::scope(|threads| {
        for _ in 0..workers.min(turns.len()) {
            let sender = sender.clone();
            threads.spawn(|| work(sender));
        }
        drop(sender);
        Progress::new(turns.len(), home).follow(&news);
    });
    let graded = std::mem::take(&mut *lock(&graded));
    graded.into_iter().map(|(key, grade)| Ok((key, grade?))).collect()
}

fn lock(grades: &Mutex<Grades>) -> MutexGuard<'_, Grades> {
    grades.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a submission has come to, in a few words.
fn in_words(grade: &Result<Grade, Failure>) -> String {
    match grade {
        Ok(Grade { problem: Some(problem), .. }) => {
            problem.lines().next().unwrap_or_default().to_owned()
        }
        Ok(grade) => grade.points.words(),
        Err(failure) => failure.message.clone(),
    }
}

/// What is kept of a class at ctrl-c, and how to go on.
fn interrupted(graded: usize, of: usize, home: &Path) {
    let command = shell_words::join(std::env::args().skip(1));
    complain(format_args!(
        "\n  INTERRUPTED: {graded} of {} graded\n\
         \x20 kept    {}: these grades, and every trial that had ended of the others\n\
         \x20 resume  {} {command}",
        count(of, "submission"),
        home.display(),
        program()
    ));
    if !salt().is_empty() {
        complain(format_args!("          with the same {SALT_VARIABLE}"));
    }
}

/// Writes the table and the page of a class, or of a share of it, and answers where they are.
pub(in crate::cli) fn write(
    class: &Class,
    home: &Path,
    csv: Option<&Path>,
) -> Result<[PathBuf; 2], Failure> {
    let named = class.name();
    let csv = csv.map_or_else(|| home.join(format!("{named}.csv")), Path::to_owned);
    put(&csv, &table(class))?;
    let html = home.join(format!("{named}.html"));
    put(&html, &page(class))?;
    Ok([csv, html])
}

/// Says the points of each submission, and where more is.
pub(in crate::cli) fn tell(class: &Class, [csv, html]: &[PathBuf; 2]) {
    say_line!("\n  {}\n", class.title);
    let width = class.rows.iter().map(|row| row.called.chars().count()).max().unwrap_or(0);
    for row in &class.rows {
        let problem = row.grade.problem.iter().filter_map(|problem| problem.lines().next());
        let words: String = problem.map(|line| format!("  {line}")).collect();
        say_line!("    {:width$}  {:<22}{words}", row.called, row.grade.points.words());
    }
    say_line!("\n  table   {}", csv.display());
    say_line!("  page    {}", crate::cli::report::address(html));
}

/// The grade of one submission: as it was found before, or by building and running it.
fn of_one(
    arguments: &GradeArguments,
    desk: &Desk,
    Turn { key, submission, .. }: &Turn<'_>,
    home: &Path,
    tell: &dyn Fn(Step),
) -> Result<Grade, Failure> {
    let runs = home.join("runs").join(key);
    let known = runs.join("grade.json");
    if let Ok(grade) = read_json::<Grade>(&known) {
        return Ok(grade);
    }
    tell(Step::Builds);
    let builds = home.join("builds").join(key);
    let mut grade = match submission.core(&desk.workshop(arguments), &builds) {
        Ok(Built { core, warnings }) => {
            Grade { warnings, ..of_core(arguments, desk, &core, &runs, tell)? }
        }
        Err(NoCore::Authors(problem)) => Grade::absent(&desk.suite, "", &problem),
        // That is nobody's grade.
        Err(NoCore::Machines(problem)) => return Err(Failure::broken(problem)),
    };
    // Where it was built says whose it is.
    key[..ALIAS].clone_into(&mut grade.core);
    write_json(&known, &grade).map_err(Failure::broken)?;
    Ok(grade)
}

fn of_core(
    arguments: &GradeArguments,
    desk: &Desk,
    file: &Path,
    runs: &Path,
    tell: &dyn Fn(Step),
) -> Result<Grade, Failure> {
    let word = file.to_string_lossy();
    let core: CoreSpec = match word.parse() {
        Ok(core) => core,
        Err(unknown) => return Ok(Grade::absent(&desk.suite, "", &format!("{unknown}"))),
    };
    // As many submissions at a time as there are threads: each has one.
    let plan = desk.plan(core, 1)?.hosted(arguments.hosting.hosting(runs));
    let mut ended = 0;
    let mut hear = |event: Event<'_>| {
        match event {
            Event::Planned { earlier, .. } => ended = earlier.len(),
            Event::Ended { .. } => ended += 1,
            Event::Transplanting { .. } => return tell(Step::Searches),
            Event::Started { .. } => return,
        }
        tell(Step::Tries { ended, of: plan.trials.len() });
    };
    let ran = match newest(runs) {
        Some(folder) => run::resume(&plan, &folder, &mut hear).map(|()| folder),
        None => run::run(&plan, runs, &mut hear),
    };
    let folder = match ran {
        Ok(folder) => folder,
        Err(error @ RunError::NoCore { .. }) => {
            return Ok(Grade::absent(&desk.suite, "", &error.to_string()));
        }
        Err(error) => return Err(Failure::broken(error)),
    };
    let tree = RunTree::load(&folder).map_err(Failure::broken)?;
    report::html::write(&tree, &folder).map_err(Failure::broken)?;
    let selected = desk.suite.select(&desk.cases).map_err(suite_failure)?;
    Ok(Grade::of(&desk.suite, &selected, &desk.salt, &tree))
}

/// The last run of a folder, if one was begun.
fn newest(runs: &Path) -> Option<PathBuf> {
    let folders = std::fs::read_dir(runs).ok()?.flatten().map(|entry| entry.path());
    folders.filter(|path| path.join("run.json").is_file()).max()
}

impl Desk {
    /// Everything but the submission that a grade depends on.
    fn conditions(&self) -> Result<String, Failure> {
        let selected = self.suite.select(&self.cases).map_err(suite_failure)?;
        let hashes: BTreeSet<_> =
            selected.cases().iter().map(|case| format!("{} {}", case.id, case.hash)).collect();
        // A copy of the program on another machine is the same program.
        let program = std::env::current_exe().and_then(std::fs::read).map_err(Failure::broken)?;
        let hashes: Vec<_> = hashes.into_iter().collect();
        Ok(format!(
            "{} {}\n{}\n{}\n{}",
            env!("CARGO_PKG_VERSION"),
            fingerprint(&program),
            self.suite.hash,
            self.salt,
            hashes.join("\n")
        ))
    }
}
