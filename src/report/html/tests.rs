//! The page as a browser gets it. How it looks is for eyes: `FURNACE_EXAMPLES=DIR cargo test --lib
//! report::html` leaves two runs with their pages in DIR.

use super::assets::EARLY_SCRIPT;
use super::*;
use crate::case::Tier;
use crate::checks::Finding;
use crate::report::example::{Example, HOSTILE, trial};
use crate::run::record::{Number, Score, read_json, write_json};
use crate::run::{Counts, Outcome, RunRecord, Status};
use std::collections::{BTreeMap, BTreeSet};

mod browser;

/// The index of a run whose pictures are missing.
fn page(example: Example) -> String {
    index(&example.tree(), Path::new("."))
}

/// Every page of a run whose pictures are missing, by its name.
fn all_pages(example: Example) -> BTreeMap<String, String> {
    let (tree, folder) = (example.tree(), Path::new("."));
    let index = ("index.html".to_owned(), index(&tree, folder));
    pages(&tree, folder).chain([index]).collect()
}

/// Where an address on a page leads: a file, and an anchor on it.
fn target(page: &str, address: &str) -> (String, String) {
    let (file, anchor) = address.split_once('#').unwrap_or((address, ""));
    let folder = page.rsplit_once('/').map_or("", |(folder, _)| folder);
    let (mut place, file): (Vec<_>, _) =
        (folder.split('/').collect(), file.trim_start_matches("./"));
    for step in file.split('/').filter(|step| *step == "..") {
        assert_eq!(step, "..");
        place.pop();
    }
    place.extend(file.split('/').filter(|step| *step != ".."));
    let path: Vec<_> = place.into_iter().filter(|step| !step.is_empty()).collect();
    let path = if file.is_empty() { page.to_owned() } else { path.join("/") };
    (path, anchor.to_owned())
}

/// A page whose commands are not in pieces.
fn commands(page: &str) -> String {
    page.replace("<span>", "").replace("</span>", "")
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
    assert!(title(Example::green()).starts_with("All 24 trials pass · builtin"));
    let mut cut_off = Example::green();
    cut_off.trials.truncate(5);
    assert!(title(cut_off).starts_with("Unfinished at 5 of 24 trials: none fails so far"));
}

#[test]
fn the_page_counts_every_trial_once_as_the_terminal_does() {
    let mut example = Example::mixed();
    example.trials[0].tier = Tier::Informational;
    let counts = Counts::of(24, &example.trials);
    let page = page(example);
    let score = page.split("class=\"card score\"").nth(1).unwrap();
    let score = score.split("</ul>").next().unwrap();
    let numbers = score.split("class=\"number\">").skip(1);
    let mut numbers: Vec<usize> =
        numbers.map(|rest| rest.split('<').next().unwrap().parse().unwrap()).collect();
    assert_eq!(numbers.pop(), Some(counts.planned));
    let passes = counts.graded.count(Status::Pass);
    assert!(score.contains(&format!("<b>{passes}</b> pass")), "{score}");
    assert_eq!(passes + numbers.iter().sum::<usize>(), 24, "{score}");
    assert_eq!(numbers.last(), Some(&counts.ungraded));
}

#[test]
fn what_a_core_says_stays_text() {
    for (name, page) in all_pages(Example::mixed()) {
        assert!(!page.contains(HOSTILE), "{name}");
        assert!(!page.chars().any(|c| c.is_control() && c != '\n'), "{name}");
    }
    let page = page(Example::mixed());
    assert!(page.contains("&lt;script&gt;alert('pass')&lt;/script&gt; &amp;"));
    assert_eq!(page.matches("<script>").count(), 2);
}

#[test]
fn our_own_script_and_style_cannot_end_early() {
    let ours = [STYLE, EARLY_SCRIPT, &pages_script(), &viewer_script()].map(str::to_owned);
    assert!(ours.iter().all(|text| !text.contains("</")));
}

#[test]
fn nothing_is_fetched() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = &temporary.path().join("run");
    Example::mixed().write(folder);
    let tree = RunTree::load(folder).unwrap();
    let single = ("report.html".to_owned(), single(&tree, folder));
    let index = ("index.html".to_owned(), index(&tree, folder));
    let all: BTreeMap<_, _> = pages(&tree, folder).chain([index, single]).collect();
    for (name, page) in &all {
        assert!(!page.contains("url(") && !page.contains("@import"), "{name}");
        assert!(!page.contains("fetch(") && !page.contains("XMLHttpRequest"), "{name}");
        for address in values(page, "src") {
            let is_ours = all.contains_key(&target(name, address).0);
            assert!(address.starts_with("data:image/png;base64,") || is_ours, "{name}: {address}");
        }
    }
    let alone = &all["report.html"];
    let leads_out = |address: &&str| !address.starts_with(['#', 'd']) && !address.ends_with(".exr");
    assert_eq!(values(alone, "href").into_iter().find(leads_out), None);
}

#[test]
fn every_link_leads_somewhere() {
    let all = all_pages(Example::mixed());
    let anchors = |page: &str| -> BTreeSet<String> {
        values(page, "id").into_iter().map(str::to_owned).collect()
    };
    let anchors: BTreeMap<_, _> = all.iter().map(|(name, page)| (name, anchors(page))).collect();
    let mut links = 0;
    for (name, page) in all.iter().filter(|(name, _)| name.ends_with(".html")) {
        assert_eq!(anchors[name].len(), values(page, "id").len(), "an id occurs twice in {name}");
        for address in values(page, "href").into_iter().filter(|a| !a.starts_with("data:")) {
            let (file, anchor) = target(name, address);
            assert!(all.contains_key(&file), "{name}: {address} leads to {file}");
            assert!(anchor.is_empty() || anchors[&file].contains(&anchor), "{name}: {address}");
            links += 1;
        }
    }
    assert!(links > 100, "{links}");
}

#[test]
fn links_of_the_page_that_stands_alone_stay_on_it() {
    let page = single(&Example::mixed().tree(), Path::new("."));
    let anchors: BTreeSet<_> = values(&page, "id").into_iter().collect();
    assert_eq!(anchors.len(), values(&page, "id").len());
    let links = values(&page, "href").into_iter().filter_map(|address| address.strip_prefix('#'));
    let (known, unknown): (Vec<_>, Vec<_>) = links.partition(|link| anchors.contains(link));
    assert!(known.len() > 10);
    assert_eq!(unknown, Vec::<&str>::new());
}

#[test]
fn the_earliest_failure_is_where_to_start() {
    let page = page(Example::mixed());
    let card = page.split("Start here. ").nth(1).unwrap();
    let first = values(card, "href")[0];
    let trial = "shape/the-nearer-root-wins.html#shape/the-nearer-root-wins@textbook";
    assert_eq!(first, format!("case/{trial}"));
    let command = "cargo furnace run shape/the-nearer-root-wins --core textbook";
    assert!(commands(card).contains(command), "{card}");
}

#[test]
fn a_core_that_does_not_start_is_one_card() {
    let mut example = Example::mixed();
    example.run.cores[1].problem = Some("the core crashed during hello".to_owned());
    let page = page(example);
    let start = page.split("id=\"start\"").nth(1).unwrap().split("<section").next().unwrap();
    assert!(start.contains("textbook fails to start: no trial could run."), "{start}");
    assert!(start.contains("the core crashed during hello"), "{start}");
    assert!(commands(start).contains("cargo furnace doctor --core textbook"), "{start}");
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
    assert!(page.contains("<title>Unfinished at 0 of 24 trials"));
    assert!(!page.contains("Every trial passes."));
}

/// Two failures in one place.
fn off() -> Example {
    let mut example = Example::green();
    example.trials = [1, 2].map(|n| trial("builtin", &format!("camera/case-{n}"))).to_vec();
    for trial in &mut example.trials {
        trial.outcome = Outcome::Judged { finding: Finding::failure("off") };
    }
    example
}

#[test]
fn what_differs_without_a_cause_is_listed_once() {
    let page = page(off());
    assert!(page.contains("Failing here"), "{page}");
    assert!(!page.contains("No cause is known for these"), "{page}");
}

#[test]
fn a_failure_says_on_its_own_page_what_its_cause_is() {
    let page = &all_pages(off())["case/camera/case-1.html"];
    let judgement = page.split("</article>").next().unwrap();
    assert!(judgement.contains("<b>Differs here</b>"), "{judgement}");
    let all = "<a href=\"../../index.html#start\">2 failures in all.</a>";
    assert!(judgement.contains(all), "{judgement}");
}

#[test]
fn pictures_that_are_gone_are_shown_as_gone() {
    let page = &all_pages(Example::mixed())["case/image/cornell-spheres.html"];
    assert_eq!(page.matches("This image cannot be shown").count(), 8);
    assert!(!page.contains("<img") && !page.contains("application/json"));
}

#[test]
fn plots_stand_in_the_pages_without_scripts_and_are_told_in_words() {
    let pages = all_pages(Example::mixed());
    let energy = &pages["case/integrator/furnace-bounce-by-bounce.html"];
    let figure = energy.split("<figure class=\"plot\">").nth(1).unwrap();
    let figure = figure.split("</figure>").next().unwrap();
    for part in ["role=\"img\"", "<title>", "<desc>", "<figcaption>", "What one should see"] {
        assert!(figure.contains(part), "{part} is missing: {figure}");
    }
    assert!(!figure.contains("scripted") && !figure.contains("NaN"), "{figure}");
    let none = &pages["case/shape/rays-in-the-plane-miss.html"];
    assert!(none.contains("none: its numbers are all there is") && !none.contains("<figure"));
    assert!(pages["index.html"].contains("Too few p-values to draw"));
    assert!(pages["index.html"].contains("no earlier run with the same filters and budget"));
    let green = page(Example::of_default_size());
    assert_eq!(green.matches("p-values of").count(), 3, "a title, and one for each core");
}

#[test]
fn the_same_run_gives_the_same_pages() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = &temporary.path().join("run");
    Example::mixed().write(folder);
    let written = || {
        let tree = RunTree::load(folder).unwrap();
        let all: Vec<_> = pages(&tree, folder).collect();
        (all, index(&tree, folder), single(&tree, folder))
    };
    assert_eq!(written(), written());
}

#[test]
fn sections_have_their_own_anchors_which_no_case_can_take() {
    let names: BTreeSet<_> = SECTIONS.iter().map(|section| section.id).collect();
    assert_eq!(names.len(), SECTIONS.len());
    assert!(names.iter().all(|name| !name.contains('/')));
}

#[test]
fn the_index_is_written_last_and_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(&Example::green().tree(), &folder.path().join("new")).unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().ends_with("</html>"));
    assert!(path.with_file_name("case").join("bvh/a-flat-box-is-hit.html").is_file());
}

#[test]
fn a_page_that_cannot_be_written_names_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let error = write(&Example::green().tree(), &file).unwrap_err().to_string();
    assert!(error.contains(&file.display().to_string()), "{error}");
}

/// As many earlier runs as a history shows, beside a run of the same question.
fn write_earlier_runs(folder: &Path) {
    let mut run: RunRecord = read_json(&folder.join("run.json")).unwrap();
    let number = |number: usize| Number {
        case: format!("image/cornell-spheres-{number}"),
        what: "error / mean luminance, 256 samples per pixel".to_owned(),
        value: 0.123,
        more_is_better: false,
    };
    let numbers = (0..30).map(number).collect();
    let score = Score { passes: 187, graded: 190, seconds: 71.3, numbers };
    run.cores.iter_mut().for_each(|core| core.score = Some(score.clone()));
    write_json(&folder.join("run.json"), &run).unwrap();
    for day in 1..30 {
        run.timing.started -= 86_400;
        let name = format!("{}-{day}", folder.file_name().unwrap().to_string_lossy());
        write_json(&folder.with_file_name(name).join("run.json"), &run).unwrap();
    }
}

#[test]
fn the_pages_of_the_default_suite_stay_light() {
    let temporary = tempfile::tempdir().unwrap();
    let kept = std::env::var_os("FURNACE_EXAMPLES").map(PathBuf::from);
    let folder = kept.unwrap_or_else(|| temporary.path().to_owned());
    for (name, example) in [("green", Example::of_default_size()), ("mixed", Example::mixed())] {
        let folder = folder.join(name);
        example.write(&folder);
        write_earlier_runs(&folder);
        let tree = RunTree::load(&folder).unwrap();
        let page = write(&tree, &folder).unwrap();
        let bytes = std::fs::metadata(&page).unwrap().len();
        assert!(bytes < 400_000, "{name}: {bytes} bytes for {} trials", tree.trials.len());
        assert!(std::fs::read_to_string(&page).unwrap().contains("builtin over 24 runs"));
        write_single(&tree, &folder).unwrap();
    }
}
