//! The summary as people see it.

use super::*;
use crate::cause::bvh;
use crate::checks::Finding;
use crate::report::example::{Example, FAILING, trial};
use crate::run::Outcome;

fn plain(example: Example) -> String {
    summary(&example.tree(), Style::PLAIN)
}

fn uncoloured(text: &str) -> String {
    let mut pieces = text.split('\x1b');
    let first = pieces.next().unwrap_or_default().to_owned();
    first + &pieces.map(|piece| piece.split_once('m').unwrap().1).collect::<String>()
}

fn told_at_length(example: Example) -> String {
    summary(&example.tree(), Style { detail: Detail::Everything, ..Style::PLAIN })
}

/// What the last block says: from its verdict on.
fn end(text: &str) -> &str {
    let start = text.rmatch_indices("\n\n  ").map(|(place, _)| place).nth(1).unwrap();
    &text[start + 2..]
}

#[test]
fn a_green_run_fits_on_a_screen() {
    let expected = "
  builtin and textbook, 12 cases, seed 1, budget default

  builtin 0.1.0 (f32)
    1 rays and intersections    ###       3 of 3 pass     4.9 s
    2 BVH                       ##        2 of 2 pass     4.0 s
    3 direct light              ###       3 of 3 pass     3.1 s
    4 global illumination       ##        2 of 2 pass     9.8 s
    5 adaptive sampling         #         1 of 1 pass     0.6 s
    6 images against Mitsuba    #         1 of 1 pass     10 ms

  textbook 0.1.0 (f64)
    1 rays and intersections    ###       3 of 3 pass     2.4 s
    2 BVH                       ##        2 of 2 pass     0.1 s
    3 direct light              ###       3 of 3 pass     9.5 s
    4 global illumination       ##        2 of 2 pass    10.3 s
    5 adaptive sampling         #         1 of 1 pass     10 ms
    6 images against Mitsuba    #         1 of 1 pass     2.2 s

  PASS  all that was asked

  24 trials in 71.3 s: 24 pass
";
    assert_eq!(plain(Example::green()), expected);
    assert_eq!(end(expected), "  PASS  all that was asked\n\n  24 trials in 71.3 s: 24 pass\n");
}

#[test]
fn the_ledger_is_told_who_asks_for_everything() {
    let text = told_at_length(Example::green());
    for line in [
        "\n  probability that a correct core fails any of them: at most 3.6e-8\n",
        "\n  72 hypotheses: 72 means 3.6e-8; none needed a second look\n",
        "\n  weakest pass: image/cornell-spheres on textbook would have caught an error of\n",
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
}

#[test]
fn a_failure_without_a_cause_says_numbers_verdict_size_and_next_command() {
    let text = plain(Example::mixed());
    let expected = "
  FAIL  integrator/roulette-leaves-every-mean-as-it-is on builtin; 4 more above
  found   bounce 2 is 0.70 times the expected value and bounce 3 0.49 times:
          every bounce after the first loses the same factor in all channels
  claim   Russian roulette leaves every mean unchanged (global illumination)
  theory  The throughput of a survivor of Russian roulette is divided by the
          survival probability.
  try     cargo furnace run integrator/roulette-leaves-every-mean-as-it-is --core builtin

  24 trials in 71.3 s: 15 pass, 3 fail, 1 inconclusive, 1 skipped, 1 blocked, 1
  crashed, 1 timed out, 1 broken
";
    assert!(text.ends_with(expected), "{text}");
    let table = "
  integrator/roulette-leaves-every-mean-as-it-is on builtin
                            measured   expected    allowed    off by
        x bounce 2, red     0.066899   0.095830    ±9.6e-5   -30.2 %
        x bounce 3, red     0.017324   0.035457    ±3.5e-5   -51.1 %
        x bounce 3, green    0.05086    0.10421   ±0.00010   -51.2 %
        x bounce 3, blue     0.12298    0.25054   ±0.00025   -50.9 %
          and 8 more, 2 of them wrong
";
    assert!(text.contains(table), "{text}");
}

#[test]
fn every_way_to_end_is_named_with_its_trial() {
    let text = plain(Example::mixed());
    let legend = "    x fail   ? inconclusive   ~ blocked   ! crashed   @ timed out   \
                  * broken\n";
    assert!(text.contains(legend), "{text}");
    for head in [
        "  FAIL  image/cornell-spheres on builtin\n",
        "  CRASHED  bvh/a-flat-box-is-hit on textbook\n",
        "  TIMED OUT  bvh/same-hits-as-brute-force on textbook\n",
        "  INCONCLUSIVE  integrator/furnace-bounce-by-bounce on textbook\n",
        "  BROKEN  image/cornell-spheres on textbook\n        references/cornell-spheres/mean.exr \
         is missing\n",
        "  BLOCKED  1 on textbook: integrator/furnace-bounce-by-bounce failed, and these\n\
         \x20       rest on it\n",
        "  SKIPPED  1 on textbook: the core has no adaptive-sampling\n",
    ] {
        assert!(text.contains(head), "{head} is not in {text}");
    }
}

#[test]
fn a_core_that_does_not_start_is_the_end() {
    let mut example = Example::mixed();
    example.run.cores[1].problem = Some("the core crashed during hello".to_owned());
    let text = plain(example);
    let told = end(&text);
    assert!(told.starts_with("  CRASHED  textbook fails to start: no trial could run\n"), "{text}");
    assert!(told.contains("  cause   the core crashed during hello\n"), "{text}");
    assert!(told.contains("  try     cargo furnace doctor --core textbook\n"), "{text}");
    assert!(!text.contains("a-flat-box-is-hit on textbook"), "{text}");
    assert!(text.contains("FAIL  image/cornell-spheres on builtin"), "{text}");
}

#[test]
fn nan_is_shown_as_nan() {
    let text = told_at_length(Example::mixed());
    assert!(text.contains("x t        NaN    1.00000   ±1.0e-6      NaN"), "{text}");
}

#[test]
fn nothing_proven_is_no_pass() {
    let mut example = Example::green();
    for trial in &mut example.trials {
        trial.outcome = Outcome::Skipped { missing: vec!["render".to_owned()] };
    }
    let text = plain(example);
    let expected = "  NOTHING PROVEN  no graded trial passes or fails
  cause   the core has no render
  try     cargo furnace doctor --core builtin

  24 trials in 71.3 s: 24 skipped
";
    assert_eq!(end(&text), expected, "{text}");
}

#[test]
fn who_passes_what_is_written_reads_what_to_write_next() {
    let mut example = Example::green();
    example.set("builtin", FAILING, Outcome::Skipped { missing: vec!["render".to_owned()] });
    let text = plain(example);
    let expected = "  PASS  all that was decided; of 1 nothing is known
  try     cargo furnace doctor --core builtin
";
    assert!(text.contains(expected), "{text}");
}

#[test]
fn who_wants_quiet_reads_the_counts() {
    let style = Style { detail: Detail::Counts, ..Style::PLAIN };
    let text = summary(&Example::green().tree(), style);
    assert_eq!(text, "  24 trials in 71.3 s: 24 pass\n");
}

#[test]
fn a_core_can_neither_steer_the_terminal_nor_forge_a_line() {
    let mut example = Example::green();
    let statement = "fine\r\x1b[1A  24 trials: 24 pass".to_owned();
    example.set("builtin", FAILING, Outcome::Crashed { how: statement, during: "render".into() });
    let text = plain(example);
    assert!(!text.contains(['\x1b', '\r']), "{text}");
    assert!(!text.contains("\n  24 trials: 24 pass"), "{text}");
}

#[test]
fn colours_add_nothing_but_colour() {
    let coloured = summary(&Example::mixed().tree(), Style { colour: true, ..Style::PLAIN });
    assert!(coloured.contains("\x1b[1;31mFAIL\x1b[0m"));
    assert_eq!(uncoloured(&coloured), plain(Example::mixed()));
}

#[test]
fn lines_fit_a_terminal_but_for_commands() {
    let mut example = Example::mixed();
    example.run.trials += 1;
    let tree = example.tree();
    for (columns, detail) in [(80, Detail::Everything), (60, Detail::Usual)] {
        let text = summary(&tree, Style { columns, detail, ..Style::PLAIN });
        // Tables of numbers have their own width.
        let is_table = |line: &str| line.contains('±') || line.contains(" measured ");
        let stays_whole = |line: &str| line.contains("cargo furnace run") || is_table(line);
        let long = text.lines().filter(|line| line.chars().count() > columns && !stays_whole(line));
        assert_eq!(long.collect::<Vec<_>>(), Vec::<&str>::new());
    }
}

#[test]
fn an_unfinished_run_says_so_and_how_to_go_on() {
    let mut example = Example::green();
    example.trials.truncate(7);
    example.run.timing.seconds = None;
    let text = plain(example);
    assert!(text.contains("  textbook 0.1.0 (f64)\n    no trial has a result\n"), "{text}");
    assert!(text.contains("\n  UNFINISHED: 17 of 24 trials have no result\n"), "{text}");
    assert!(text.contains("\n  7 of 24 trials: 7 pass\n"), "{text}");
    assert!(text.ends_with("\n  resume  cargo furnace run --resume no-such-folder\n"), "{text}");
    assert!(!text.contains("PASS"), "{text}");
}

#[test]
fn a_run_that_was_cut_off_in_its_search_misses_no_result() {
    let mut example = Example::green();
    example.run.timing.seconds = None;
    let text = plain(example);
    let says = "\n  24 trials: 24 pass\n  UNFINISHED: every trial has a result, and the search for \
                causes was cut off\n  resume  ";
    assert!(text.contains(says), "{text}");
}

#[test]
fn a_graded_run_whose_time_was_up_goes_on_with_its_suite() {
    let mut example = Example::green();
    example.run.suite = Some("small".to_owned());
    example.trials.truncate(20);
    let text = plain(example);
    assert!(text.contains("\n  NOT RUN: 4 of 24 trials, for the time was up\n"), "{text}");
    let resume = "\n  resume  cargo furnace grade --suite small --resume no-such-folder\n";
    assert!(text.ends_with(resume), "{text}");
}

#[test]
fn a_run_without_a_single_result_is_no_success() {
    let mut example = Example::green();
    example.trials.clear();
    let text = plain(example);
    assert!(text.contains("0 of 24 trials in 71.3 s: none\n  UNFINISHED: 24 of 24"), "{text}");
}

#[test]
fn asked_for_more_it_lists_what_every_case_would_have_caught() {
    let tree = Example::mixed().tree();
    let text = told_at_length(Example::mixed());
    let (_, list) = text.split_once("what each case would have caught\n").unwrap();
    for case in by_case(&tree) {
        assert!(list.contains(&format!("    {}\n      ", case.first().case)), "{list}");
    }
    assert!(list.contains("      textbook: nothing (crashed)\n"), "{list}");
}

#[test]
fn a_core_that_crashes_everywhere_is_told_once() {
    let mut example = Example::green();
    let cases: Vec<_> = example.trials.iter().map(|trial| trial.case.clone()).collect();
    for case in &cases[..12] {
        example.set(
            "builtin",
            case,
            Outcome::Crashed { how: "abort".into(), during: "render".into() },
        );
    }
    let text = plain(example);
    assert_eq!(text.matches("CRASHED").count(), 0, "{text}");
    let told = end(&text);
    assert!(told.starts_with("  FAIL  the core stops here: 12 failures on builtin"), "{text}");
    assert!(told.contains("  cause   The core crashes in `render`: abort."), "{text}");
    assert_eq!(text.matches("  try     ").count(), 1, "{text}");
}

#[test]
fn a_cause_is_the_end() {
    let mut example = Example::green();
    let cases: Vec<_> = example.trials.iter().map(|trial| trial.case.clone()).collect();
    for case in &cases[..9] {
        let finding = Finding::failure("every triangle is tested".to_owned())
            .because(&bvh::BVH_NOT_USED, "counts".to_owned());
        example.set("builtin", case, Outcome::Judged { finding });
    }
    let text = plain(example);
    let told = end(&text);
    assert!(told.starts_with("  FAIL  one cause explains 9 failures on builtin\n"), "{text}");
    assert!(told.contains("\n  cause   "), "{text}");
    assert!(told.contains("\n  where   ") && told.contains("\n  fix     "), "{text}");
    assert!(told.lines().count() < 12, "{text}");
}

#[test]
fn a_long_part_goes_on_below_itself() {
    let mut example = Example::green();
    example.trials = (0..40).map(|number| trial("builtin", &format!("bvh/{number:02}"))).collect();
    let text = plain(example);
    let bar = "#".repeat(20);
    let expected = format!("2 BVH                       {bar}     40 of 40 pass");
    assert!(text.contains(&expected), "{text}");
    assert!(text.contains(&format!("\n{:32}{bar}\n", "")), "{text}");
}

#[test]
fn text_counts_the_headlines_that_it_does_not_tell() {
    let mut example = Example::green();
    let subjects = ["camera", "shape", "bvh", "sampling", "bsdf", "light", "integrator"];
    let cases = subjects.iter().flat_map(|subject| [1, 2].map(|n| format!("{subject}/case-{n}")));
    example.trials = cases.map(|case| trial("builtin", &case)).collect();
    for trial in &mut example.trials {
        trial.outcome = Outcome::Judged { finding: Finding::failure("off") };
    }
    let text = plain(example);
    assert!(text.contains("\n  FAIL  1 more is in the report\n"), "{text}");
    assert_eq!(text.matches("  FAIL  differs here: 2 failures").count(), 6, "{text}");
    assert!(text.contains("; 6 more above\n"), "{text}");
}
