//! The pages of the book as Markdown.

use regex_lite::Regex;
use std::fs;
use std::path::{Path, PathBuf};
use walkdir::WalkDir;

/// Where the pages stand.
pub fn book() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/book/src")
}

/// Every page at or below a path, in the order of their names.
pub fn pages_below(path: &Path) -> Vec<PathBuf> {
    let files = WalkDir::new(path).sort_by_file_name().into_iter().map(Result::unwrap);
    let files = files.map(walkdir::DirEntry::into_path);
    files.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect()
}

/// A path below a folder, with forward slashes.
pub fn below(path: &Path, folder: &Path) -> String {
    path.strip_prefix(folder).unwrap().to_string_lossy().replace('\\', "/")
}

/// The text of a page with what it includes, as mdBook puts it in.
///
/// # Errors
/// The file that is not there.
pub fn expanded(path: &Path) -> Result<String, String> {
    let text = fs::read_to_string(path).unwrap();
    let include = Regex::new(r"\{\{#include ([^}:]+)[^}]*\}\}").unwrap();
    let mut whole = String::new();
    let mut end = 0;
    for found in include.captures_iter(&text) {
        let file = path.parent().unwrap().join(&found[1]);
        let included = fs::read_to_string(&file).map_err(|_| found[1].to_owned())?;
        whole.push_str(&text[end..found.get(0).unwrap().start()]);
        // Of sources it is enough that they are there.
        if file.extension().is_some_and(|ending| ending == "md") {
            whole.push_str(&included);
        }
        end = found.get(0).unwrap().end();
    }
    Ok(whole + &text[end..])
}

/// The lines outside fenced blocks, without what is code in them.
pub fn prose(text: &str) -> String {
    let mut is_code = false;
    let mut prose = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        } else if !is_code {
            prose.extend(line.split('`').step_by(2));
            prose.push('\n');
        }
    }
    prose
}
