//! What other programs read is as they document it.

use super::*;
use serde_json::Value;

/// A grade with everything in it that is hard to write.
fn grade() -> Grade {
    let mut grade = graded("textbook:sphere-far-root", |trial| {
        if trial.case.contains("flat-boxes") {
            let how = "signal 11 ]]> <b>\u{1b}[31m\u{0}% \"quoted\",\nline".to_owned();
            trial.outcome = Outcome::Crashed { how, during: "``` intersect".to_owned() };
        }
        if trial.case.contains("triangle") {
            trial.outcome = blocked();
        }
    });
    let name = "tests a ray".to_owned();
    grade.leaderboard = vec![Entry { name, value: 4.5, more_is_better: false }];
    grade
}

/// A key, and of which kind its value has to be.
type Key<'a> = (&'a str, fn(&Value) -> bool);

/// Of an object, whether it has none but these.
fn assert_keys(value: &Value, known: &[Key<'_>]) {
    for (key, value) in value.as_object().unwrap() {
        let (_, is_right) =
            known.iter().find(|(name, _)| name == key).unwrap_or_else(|| panic!("{key}"));
        assert!(is_right(value), "{key}: {value}");
    }
}

fn is_visibility(value: &Value) -> bool {
    ["hidden", "after_due_date", "after_published", "visible"].iter().any(|word| value == word)
}

fn is_format(value: &Value) -> bool {
    ["text", "html", "simple_format", "md", "ansi"].iter().any(|word| value == word)
}

/// <https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format>
#[test]
fn gradescope_gets_what_its_specification_knows() {
    let grade = grade();
    let results: Value = serde_json::from_str(&gradescope::results(&grade).unwrap()).unwrap();
    assert_keys(
        &results,
        &[
            ("score", Value::is_number),
            ("execution_time", Value::is_number),
            ("output", Value::is_string),
            ("output_format", is_format),
            ("test_output_format", is_format),
            ("test_name_format", is_format),
            ("visibility", is_visibility),
            ("stdout_visibility", is_visibility),
            ("extra_data", Value::is_object),
            ("tests", Value::is_array),
            ("leaderboard", Value::is_array),
        ],
    );
    for test in results["tests"].as_array().unwrap() {
        assert_keys(
            test,
            &[
                ("score", Value::is_number),
                ("max_score", Value::is_number),
                ("status", |status| status == "passed" || status == "failed"),
                ("name", Value::is_string),
                ("name_format", is_format),
                ("number", Value::is_string),
                ("output", Value::is_string),
                ("output_format", is_format),
                ("tags", Value::is_array),
                ("visibility", is_visibility),
                ("extra_data", Value::is_object),
            ],
        );
    }
    for place in results["leaderboard"].as_array().unwrap() {
        let order = |order: &Value| order == "asc" || order == "desc";
        assert_keys(
            place,
            &[("name", Value::is_string), ("value", Value::is_number), ("order", order)],
        );
    }
    let hidden = results["tests"].as_array().unwrap().iter();
    assert_eq!(hidden.filter(|test| test["visibility"] == "after_published").count(), 1);
    assert_eq!(results["score"].as_f64().unwrap(), hundredths(grade.points.earned));
}

#[test]
fn a_core_that_never_started_has_valid_files_with_nothing_earned() {
    let grade = Grade::absent(&suite(SMALL).unwrap(), "./gone.so", "there is no file ./gone.so");
    let results: Value = serde_json::from_str(&gradescope::results(&grade).unwrap()).unwrap();
    assert_eq!(results["score"], 0.0);
    assert!(results["output"].as_str().unwrap().contains("no file ./gone.so"));
    assert!(junit::report(&grade).unwrap().contains("<error message=\"no core\">"));
    assert!(github::annotations(&grade).starts_with("::error title=fails to start::"));
}

type Words = &'static [&'static str];
type Element = (&'static str, Words, Words, Words);

/// As `junit-10.xsd` of the Jenkins xUnit plugin has them: attributes that must be there and may, and elements below.
const JUNIT: &[Element] = &[
    ("testsuites", &[], &["name", "time", "tests", "failures", "errors"], &["testsuite"]),
    (
        "testsuite",
        &["name", "tests"],
        &["failures", "errors", "skipped", "time", "timestamp", "hostname", "id", "package"],
        &["testcase", "properties", "system-out", "system-err"],
    ),
    (
        "testcase",
        &["name"],
        &["classname", "time", "assertions", "status"],
        &["skipped", "error", "failure", "system-out", "system-err"],
    ),
    ("failure", &[], &["type", "message"], &[]),
    ("error", &[], &["type", "message"], &[]),
    ("skipped", &[], &["type", "message"], &[]),
];

#[test]
fn junit_is_well_formed_and_of_its_schema() {
    let text = junit::report(&grade()).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        let name = node.tag_name().name();
        let row = JUNIT.iter().find(|row| row.0 == name).unwrap_or_else(|| panic!("{name}"));
        let has = |wanted: &&&str| node.attribute(**wanted).is_some();
        assert_eq!(row.1.iter().filter(has).count(), row.1.len(), "{name}");
        let known = |name: &str| row.1.contains(&name) || row.2.contains(&name);
        node.attributes().for_each(|one| assert!(known(one.name()), "{name}: {}", one.name()));
        let below = node.children().filter(roxmltree::Node::is_element);
        below.for_each(|below| assert!(row.3.contains(&below.tag_name().name()), "{name}"));
    }
    let suite = document.descendants().find(|node| node.has_tag_name("testsuite")).unwrap();
    let count = |name: &str| suite.descendants().filter(|node| node.has_tag_name(name)).count();
    for (attribute, element) in [
        ("tests", "testcase"),
        ("failures", "failure"),
        ("errors", "error"),
        ("skipped", "skipped"),
    ] {
        let said: usize = suite.attribute(attribute).unwrap().parse().unwrap();
        assert_eq!(said, count(element), "{attribute}");
    }
}

#[test]
fn github_gets_a_line_a_command_with_nothing_left_to_escape() {
    let told = github::annotations(&grade());
    assert!(told.lines().count() >= 1);
    for line in told.lines() {
        let rest = line.strip_prefix("::error title=").unwrap();
        let (title, message) = rest.split_once("::").unwrap();
        assert!(!title.contains([':', ',']), "{line}");
        let is_escaped =
            |at: usize| ["%25", "%0D", "%0A", "%3A", "%2C"].contains(&&line[at..at + 3]);
        line.match_indices('%').for_each(|(at, _)| assert!(is_escaped(at), "{line}"));
        assert!(!message.is_empty());
    }
    let [file, message] = ["src/a,b.cpp", "50% lost"].map(str::to_owned);
    let warnings = vec![Warning { file, line: 7, message, function: String::new() }];
    let warned = github::annotations(&Grade { warnings, ..grade() });
    assert_eq!(warned, told + "::warning file=src/a%2Cb.cpp,line=7::50%25 lost\n");
    let summary = github::summary(&grade());
    assert!(summary.contains("| Rays | "), "{summary}");
    assert!(summary.len() < 1 << 20);
}

#[test]
fn a_spreadsheet_has_as_many_cells_in_every_row_and_no_formulas() {
    let text = csv::table(&grade());
    // None of these cells has a line break: a crash's words are one sentence of the statement.
    let header = text.lines().next().unwrap().split(',').count();
    let mut cells = 0;
    let mut quoted = false;
    for letter in text.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => cells += 1,
            '\n' if !quoted => {
                assert_eq!(cells + 1, header);
                cells = 0;
            }
            _ => {}
        }
    }
    assert!(!quoted);
    assert_eq!(csv::line(&["=1+1".to_owned(), "-3.5".to_owned()]), "'=1+1,-3.5\r\n");
}

#[test]
fn a_grade_is_read_as_it_was_written() {
    let grade = grade();
    let text = serde_json::to_string(&grade).unwrap();
    assert_eq!(serde_json::from_str::<Grade>(&text).unwrap(), grade);
}

#[test]
fn the_terminal_says_what_is_wrong_below_the_points() {
    let mut grade = grade();
    let [mistake, look_at, fix] =
        ["t is the farther root", "the root", "Take the nearer."].map(str::to_owned);
    let (cause, command) = Default::default();
    let (evidence, explains) = Default::default();
    let degree = Degree::LooksLike;
    grade.causes = vec![Told { cause, degree, mistake, evidence, look_at, fix, command, explains }];
    let table = text::table(&grade);
    let (_, wrong) = table.split_once("what is wrong\n").unwrap();
    assert_eq!(
        wrong,
        "    looks like: t is the farther root\n      where  the root\n      fix    Take the nearer.\n"
    );
    grade.causes.clear();
    assert!(!text::table(&grade).contains("what is wrong"));
}
