//! The page as a browser gets it. How it looks is for eyes: `FURNACE_EXAMPLES=DIR cargo test --lib
//! report::html` leaves two runs with their pages in DIR.

use super::*;
use crate::report::example::{Example, HOSTILE};
use std::collections::BTreeSet;

/// The page of a run whose pictures are missing.
fn page(example: Example) -> String {
    render(&example.tree(), Path::new("."))
}

/// Every value of an attribute.
fn values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let start = format!(" {attribute}=\"");
    page.split(&start).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn the_title_carries_the_result() {
    let title = |example| page(example).split("<title>").nth(1).unwrap()[..60].to_owned();
    assert!(title(Example::mixed()).starts_with("5 of 24 trials fail · builtin and textbook"));
    assert!(title(Example::green()).starts_with("all 24 trials pass · builtin"));
    let mut cut_off = Example::green();
    cut_off.trials.truncate(5);
    assert!(title(cut_off).starts_with("unfinished at 5 of 24 trials: none fails so far"));
}

#[test]
fn what_a_core_says_stays_text() {
    let page = page(Example::mixed());
    assert!(page.contains("&lt;script&gt;alert('pass')&lt;/script&gt; &amp;"));
    assert_eq!(page.matches("<script>").count(), 2);
    assert!(!page.contains(HOSTILE));
    assert!(!page.chars().any(|c| c.is_control() && c != '\n'));
}

#[test]
fn our_own_script_and_style_cannot_end_early() {
    assert!([STYLE, SCRIPT, EARLY_SCRIPT].iter().all(|text| !text.contains("</")));
}

#[test]
fn nothing_is_fetched() {
    let folder = tempfile::tempdir().unwrap();
    Example::mixed().write(folder.path());
    let page = render(&RunTree::load(folder.path()).unwrap(), folder.path());
    assert!(
        values(&page, "src").iter().all(|address| address.starts_with("data:image/png;base64,"))
    );
    let addresses: BTreeSet<_> = values(&page, "href").into_iter().collect();
    let is_local = |address: &&str| {
        address.starts_with('#') || address.starts_with("data:") || address.ends_with(".exr")
    };
    assert!(addresses.iter().all(is_local), "{addresses:?}");
    assert!(!page.contains("url(") && !page.contains("@import") && !page.contains("fetch("));
}

#[test]
fn every_link_leads_somewhere_on_the_page() {
    let page = page(Example::mixed());
    let anchors: BTreeSet<_> = values(&page, "id").into_iter().collect();
    assert_eq!(anchors.len(), values(&page, "id").len(), "an id occurs twice");
    let links = values(&page, "href").into_iter().filter_map(|address| address.strip_prefix('#'));
    let (known, unknown): (Vec<_>, Vec<_>) = links.partition(|link| anchors.contains(link));
    assert!(known.len() > 100);
    assert_eq!(unknown, Vec::<&str>::new());
}

#[test]
fn the_earliest_failure_is_where_to_start() {
    let page = page(Example::mixed());
    let card = page.split("Start here. ").nth(1).unwrap();
    let first = values(card, "href")[0];
    assert_eq!(first, "#shape/the-nearer-root-wins@textbook");
    assert!(card.contains("cargo furnace run shape/the-nearer-root-wins --core textbook"));
}

#[test]
fn a_core_that_does_not_start_is_one_card() {
    let mut example = Example::mixed();
    example.run.cores[1].problem = Some("the core crashed during hello".to_owned());
    let page = page(example);
    let start = page.split("id=\"start\"").nth(1).unwrap().split("<section").next().unwrap();
    assert!(start.contains("textbook fails to start: no trial could run."), "{start}");
    assert!(start.contains("the core crashed during hello"), "{start}");
    assert!(start.contains("cargo furnace doctor --core textbook"), "{start}");
    assert!(start.contains("on <b>builtin</b>"), "{start}");
    assert!(!start.contains("@textbook"), "none of its trials says more: {start}");
}

#[test]
fn a_green_run_shows_what_is_weakest_and_slowest() {
    let page = page(Example::green());
    assert!(page.contains("Every trial passes."));
    assert!(page.contains("Weakest passes") && page.contains("Slowest trials"));
}

#[test]
fn a_run_that_was_cut_off_is_not_all_good() {
    let mut example = Example::green();
    example.trials.truncate(5);
    let page = page(example);
    assert!(page.contains("5 of 24 planned trials have a result"));
    assert!(!page.contains("Every trial passes."));
}

#[test]
fn a_run_without_results_has_a_page_too() {
    let mut example = Example::green();
    example.trials.clear();
    let page = page(example);
    assert!(page.contains("<title>unfinished at 0 of 24 trials"));
    assert!(!page.contains("Every trial passes."));
}

#[test]
fn pictures_that_are_gone_are_shown_as_gone() {
    let page = page(Example::mixed());
    assert_eq!(page.matches("This image cannot be shown").count(), 8);
    assert!(!page.contains("<img"));
}

#[test]
fn the_same_run_gives_the_same_page() {
    assert_eq!(page(Example::mixed()), page(Example::mixed()));
}

#[test]
fn sections_have_their_own_anchors_which_no_case_can_take() {
    let names: BTreeSet<_> = PAGES.iter().map(|page| page.id).collect();
    assert_eq!(names.len(), PAGES.len());
    assert!(names.iter().all(|name| !name.contains('/')));
}

#[test]
fn a_page_is_written_whole_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(&Example::green().tree(), &folder.path().join("new")).unwrap();
    let files: Vec<_> = std::fs::read_dir(path.parent().unwrap()).unwrap().collect();
    assert_eq!(files.len(), 1);
    assert!(std::fs::read_to_string(&path).unwrap().ends_with("</html>"));
}

#[test]
fn a_page_that_cannot_be_written_names_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let error = write(&Example::green().tree(), &file).unwrap_err().to_string();
    assert!(error.contains(&file.join("index.html").display().to_string()), "{error}");
}

#[test]
fn the_page_of_the_default_suite_stays_light() {
    let temporary = tempfile::tempdir().unwrap();
    let kept = std::env::var_os("FURNACE_EXAMPLES").map(PathBuf::from);
    let folder = kept.unwrap_or_else(|| temporary.path().to_owned());
    for (name, mut example) in [("green", Example::of_default_size()), ("mixed", Example::mixed())]
    {
        let folder = folder.join(name);
        example.picture_size = (256, 256);
        example.write(&folder);
        let page = write(&RunTree::load(&folder).unwrap(), &folder).unwrap();
        let bytes = std::fs::metadata(&page).unwrap().len();
        assert!(bytes < 3_000_000, "{name}: {bytes} bytes");
    }
}
