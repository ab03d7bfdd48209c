//! Links between pages, and to headings of pages.

use crate::text::{book, expanded, prose};
use regex_lite::Regex;
use std::fs;
use std::path::Path;

/// What the links and images of a text point at.
pub fn of(text: &str) -> impl Iterator<Item = &str> {
    let link = Regex::new(r"\]\(([^)\s]+)\)").unwrap();
    let found: Vec<_> = link.captures_iter(text).map(|found| found.get(1).unwrap()).collect();
    found.into_iter().map(|target| target.as_str())
}

/// The complaints about the links of a page.
pub fn dead(page: &Path) -> Vec<String> {
    match expanded(page) {
        Ok(text) => dead_in(page, &text),
        Err(file) => {
            let mut complaints = dead_in(page, &fs::read_to_string(page).unwrap());
            complaints.push(format!("{}: includes {file}, which is not there", page.display()));
            complaints
        }
    }
}

fn dead_in(page: &Path, text: &str) -> Vec<String> {
    let text = prose(text);
    let inner =
        of(&text).filter(|target| !target.contains("://") && !target.starts_with("mailto:"));
    let complaints = inner.filter_map(|target| {
        Some(format!("{}: `{target}` {}", page.display(), complaint(page, target)?))
    });
    complaints.collect()
}

fn complaint(page: &Path, target: &str) -> Option<&'static str> {
    let (file, heading) = target.split_once('#').unwrap_or((target, ""));
    let path = if file.is_empty() { page.to_owned() } else { page.parent().unwrap().join(file) };
    if !path.exists() {
        return Some("is not there");
    }
    // What the built book cannot reach is there for readers of the sources alone.
    let is_inside =
        |path: &Path| path.canonicalize().unwrap().starts_with(book().canonicalize().unwrap());
    if is_inside(page) && !is_inside(&path) {
        return Some("is outside the book");
    }
    let is_heading = heading.is_empty() || headings(&path).iter().any(|known| known == heading);
    (!is_heading).then_some("names a heading that is not there")
}

/// The anchors of a page's headings, as mdBook and GitHub make them.
fn headings(page: &Path) -> Vec<String> {
    let text = expanded(page).unwrap_or_else(|_| fs::read_to_string(page).unwrap());
    let mut is_code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            is_code = !is_code;
        } else if !is_code && line.starts_with('#') {
            found.push(anchor(line.trim_start_matches('#').trim()));
        }
    }
    found
}

fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}
