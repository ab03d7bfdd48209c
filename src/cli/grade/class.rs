//! `furnace grade --submissions`: a whole class. What has been graded once is taken from disk, so that a class that was cut
//! off goes on where it was.

use super::{Desk, GradeArguments, put, suite_failure};
use crate::cli::say::{complain, say_line};
use crate::cli::{Answer, ExitCode, Failure};
use crate::cores::CoreSpec;
use crate::grade::class::{Class, Row, page, table};
use crate::grade::{Grade, Submission};
use crate::report::{self, RunTree};
use crate::run::record::{read_json, write_json};
use crate::run::{self, RunError};
use crate::text::fingerprint;
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Letters of the word by which a submission without a name is called.
const ALIAS: usize = 8;

/// Grades every submission of a folder.
pub(super) fn grade(arguments: &GradeArguments, desk: &Desk, folder: &Path) -> Answer {
    let unreadable = |error| Failure::request(format!("cannot read {}: {error}", folder.display()));
    let submissions = Submission::all(folder).map_err(unreadable)?;
    if submissions.is_empty() {
        return Err(Failure::nothing(format!("{} holds no submission", folder.display())));
    }
    let home = desk.project.class(&desk.suite.name);
    let conditions = desk.conditions()?;
    let keys: Vec<_> = submissions.iter().map(|one| one.key(&conditions)).collect();
    // Of equal ones only one is tried.
    let first: BTreeMap<_, _> = keys.iter().zip(&submissions).rev().collect();
    let shares = first.into_iter().enumerate();
    let is_ours = |place: usize| arguments.shard.is_none_or(|shard| shard.has(place));
    let ours = shares.filter(|(place, _)| is_ours(*place));
    let todo: Vec<_> = ours.map(|(_, submission)| submission).collect();
    let graded = Mutex::new(BTreeMap::new());
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some((key, submission)) = todo.get(next.fetch_add(1, Ordering::Relaxed)) {
            let grade = of_one(arguments, desk, submission, &home, key);
            let mut graded = graded.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            graded.insert((*key).clone(), grade);
            complain(format_args!("  {} of {}  {}", graded.len(), todo.len(), &key[..ALIAS]));
        }
    };
    let workers = arguments.jobs.map_or_else(
        || std::thread::available_parallelism().map_or(1, NonZeroUsize::get),
        NonZeroUsize::get,
    );
    std::thread::scope(|threads| (0..workers).for_each(|_| _ = threads.spawn(work)));
    let graded = graded.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let graded: BTreeMap<_, _> =
        graded.into_iter().map(|(key, grade)| Ok((key, grade?))).collect::<Result<_, Failure>>()?;
    let mut rows = Vec::new();
    for (submission, key) in submissions.iter().zip(&keys) {
        let Some(grade) = graded.get(key) else { continue };
        let called =
            if arguments.names { submission.name.clone() } else { key[..ALIAS].to_owned() };
        let report = newest(&home.join("runs").join(key)).map(|run| {
            let inside = run.strip_prefix(&home).unwrap_or(&run).join("index.html");
            inside.to_string_lossy().into_owned()
        });
        rows.push(Row { called, grade: grade.clone(), report });
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
    submission: &Submission,
    home: &Path,
    key: &str,
) -> Result<Grade, Failure> {
    let runs = home.join("runs").join(key);
    let known = runs.join("grade.json");
    if let Ok(grade) = read_json::<Grade>(&known) {
        return Ok(grade);
    }
    let builds = home.join("builds").join(key);
    let mut grade = match submission.core(&desk.workshop(arguments), &builds) {
        Ok(core) => of_core(arguments, desk, &core, &runs)?,
        Err(problem) => Grade::absent(&desk.suite, "", &problem),
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
) -> Result<Grade, Failure> {
    let word = file.to_string_lossy();
    let core: CoreSpec = match word.parse() {
        Ok(core) => core,
        Err(unknown) => return Ok(Grade::absent(&desk.suite, "", &format!("{unknown}"))),
    };
    // As many submissions at a time as there are threads: each has one.
    let plan = desk.plan(core, 1)?.hosted(arguments.hosting.hosting(runs));
    let ran = match newest(runs) {
        Some(folder) => run::resume(&plan, &folder, &mut |_| ()).map(|()| folder),
        None => run::run(&plan, runs, &mut |_| ()),
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
