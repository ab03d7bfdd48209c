//! Gradescope's `results.json`, as its autograder documentation describes it: one test a case, feedback in Markdown.

use super::{CaseGrade, Entry, Grade, PartGrade, Standing, hundredths, markdown};
use serde::Serialize;

#[derive(Serialize)]
struct Results {
    /// Overrides the sum of the tests, whose points are rounded.
    score: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    execution_time: Option<f64>,
    output: String,
    output_format: &'static str,
    test_output_format: &'static str,
    test_name_format: &'static str,
    visibility: &'static str,
    /// What a core prints may tell of hidden cases.
    stdout_visibility: &'static str,
    tests: Vec<Test>,
    leaderboard: Vec<Place>,
}

#[derive(Serialize)]
struct Test {
    score: f64,
    max_score: f64,
    status: &'static str,
    name: String,
    number: String,
    output: String,
    tags: Vec<&'static str>,
    visibility: &'static str,
}

#[derive(Serialize)]
struct Place {
    name: String,
    value: f64,
    order: &'static str,
}

/// The file. Fails on numbers that JSON has not.
pub(crate) fn results(grade: &Grade) -> serde_json::Result<String> {
    let numbered = |(at, part): (usize, &PartGrade)| -> Vec<Test> {
        let counting = part.cases.iter().filter(|case| case.standing != Standing::LeftOut);
        counting.enumerate().map(|(n, case)| test(format!("{}.{}", at + 1, n + 1), case)).collect()
    };
    let results = Results {
        score: hundredths(grade.points.earned),
        execution_time: grade.seconds,
        output: format!("{}\n{}", markdown::table(grade), markdown::causes(grade)),
        output_format: "md",
        test_output_format: "md",
        test_name_format: "text",
        visibility: "visible",
        stdout_visibility: "hidden",
        tests: grade.parts.iter().enumerate().flat_map(numbered).collect(),
        leaderboard: grade.leaderboard.iter().map(place).collect(),
    };
    serde_json::to_string_pretty(&results)
}

fn test(number: String, case: &CaseGrade) -> Test {
    let is_whole = case.standing == Standing::Pass;
    Test {
        score: hundredths(case.points.earned),
        max_score: hundredths(case.points.of),
        status: if is_whole { "passed" } else { "failed" },
        name: case.title.clone(),
        number,
        output: if is_whole { String::new() } else { markdown::case(case) },
        tags: vec![case.standing.word()],
        visibility: if case.hidden { "after_published" } else { "visible" },
    }
}

fn place(entry: &Entry) -> Place {
    let order = if entry.more_is_better { "desc" } else { "asc" };
    Place { name: entry.name.clone(), value: entry.value, order }
}
