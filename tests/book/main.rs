//! The book under `docs/book` is true: its reference is what the code says, its links lead somewhere, and what its pages
//! tell people to type has been run. `FURNACE_BLESS=1` writes the generated pages again.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod blocks;
mod generated;
mod keys;
mod links;
mod text;

use std::fs;
use std::path::Path;

#[test]
fn the_reference_is_what_the_code_says() {
    let source = text::book();
    let is_blessed = std::env::var_os("FURNACE_BLESS").is_some();
    let mut stale = Vec::new();
    for (name, page) in generated::pages() {
        let path = source.join(&name);
        if is_blessed {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, &page).unwrap();
        } else if fs::read_to_string(&path).ok().as_ref() != Some(&page) {
            stale.push(name);
        }
    }
    assert!(stale.is_empty(), "`FURNACE_BLESS=1 cargo test --test book` writes again: {stale:?}");
}

#[test]
fn every_page_has_its_line_in_the_table_of_contents() {
    let contents = fs::read_to_string(text::book().join("SUMMARY.md")).unwrap();
    let listed: Vec<_> = links::of(&contents).collect();
    for link in &listed {
        assert!(text::book().join(link).is_file(), "SUMMARY.md lists {link}, which is not there");
    }
    for page in text::pages_below(&text::book()) {
        let name = text::below(&page, &text::book());
        let is_a_piece = name.starts_with("pieces/") || name == "SUMMARY.md";
        assert!(is_a_piece || listed.contains(&name.as_str()), "SUMMARY.md does not list {name}");
    }
}

#[test]
fn links_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let tops = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"];
    let folders = ["docs", "reports", "adapters", "examples"];
    let pages = tops.iter().chain(&folders).flat_map(|top| text::pages_below(&root.join(top)));
    let dead: Vec<_> = pages.flat_map(|page| links::dead(&page)).collect();
    assert!(dead.is_empty(), "\n{}", dead.join("\n"));
}

#[test]
fn a_dead_link_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.md");
    fs::write(
        &page,
        "# A page\n[a](page.md#a-page) [b](page.md#b) [c](gone.md)\n{{#include gone.rs}}\n`[d](d)`\n```\n[e](e)\n```\n",
    )
    .unwrap();
    let dead = links::dead(&page);
    assert_eq!(dead.len(), 3, "{dead:?}");
}

/// On Windows there is no shell to type into.
#[cfg(unix)]
#[test]
fn what_pages_tell_people_to_type_works() {
    let pages = text::pages_below(&text::book());
    let pages: Vec<_> = pages.into_iter().filter(|page| !page.ends_with("SUMMARY.md")).collect();
    let next = std::sync::atomic::AtomicUsize::new(0);
    let complaints = std::sync::Mutex::new(Vec::new());
    let work = || {
        while let Some(page) = pages.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            complaints.lock().unwrap().extend(blocks::complaint_about(page));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(work);
        }
    });
    let complaints = complaints.into_inner().unwrap();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n\n"));
}
