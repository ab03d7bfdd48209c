//! `furnace merge`: the shares of a class, graded one by one or on several machines, become one table.

use super::grade::class;
use super::{Answer, ExitCode, Failure};
use crate::grade::class::Class;
use crate::run::record::{read_json, write_json};
use clap::Args;
use std::path::{Path, PathBuf};

/// What `furnace merge` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct MergeArguments {
    /// What `furnace grade --shard` has written: files `class-K-of-N.json`, or folders that hold them.
    #[arg(required = true, value_name = "SHARE")]
    shares: Vec<PathBuf>,
    /// Where the table and the page of the whole class go [default: the folder of the first share].
    #[arg(long, value_name = "DIR")]
    into: Option<PathBuf>,
}

/// Reads all shares, and writes the class.
pub(crate) fn merge(arguments: &MergeArguments) -> Answer {
    let mut files = Vec::new();
    for path in &arguments.shares {
        files.extend(shares_at(path)?);
    }
    let shares = files.iter().map(|file| {
        let share = read_json::<Class>(file);
        share.map_err(|error| Failure::request(format!("{}: {error}", file.display())))
    });
    let mut shares = shares.collect::<Result<Vec<_>, _>>()?;
    let first = files.first().and_then(|file| file.parent()).unwrap_or(Path::new("."));
    let home = arguments.into.as_deref().unwrap_or(first);
    for (share, file) in shares.iter_mut().zip(&files) {
        lead_from(home, file, share);
    }
    let class = Class::merged(shares).map_err(Failure::request)?;
    write_json(&home.join(class.file()), &class).map_err(Failure::broken)?;
    class::tell(&class, &class::write(&class, home, None)?);
    Ok(ExitCode::Good)
}

/// The file itself, or the shares of a folder.
fn shares_at(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let unreadable = |error| Failure::request(format!("cannot read {}: {error}", path.display()));
    let entries = std::fs::read_dir(path).map_err(unreadable)?.flatten().map(|entry| entry.path());
    let is_share = |file: &PathBuf| {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("class-") && name.ends_with(".json")
    };
    let mut files: Vec<_> = entries.filter(is_share).collect();
    files.sort();
    if files.is_empty() {
        return Err(Failure::request(format!("{} holds no share of a class", path.display())));
    }
    Ok(files)
}

/// Links of a share are from its own folder; a page elsewhere has to take another way to them.
fn lead_from(home: &Path, file: &Path, share: &mut Class) {
    let folder = file.parent().unwrap_or(Path::new("."));
    let is_same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    };
    if is_same(folder, home) {
        return;
    }
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    for row in &mut share.rows {
        row.report =
            row.report.take().map(|report| whole.join(report).to_string_lossy().into_owned());
    }
}
