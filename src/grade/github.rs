//! What GitHub shows of a job: annotations by workflow commands, and the summary of a step.

use super::{Grade, hundredths, markdown};

/// Errors that GitHub shows of a step, and warnings.
const MOST: usize = 10;

/// Workflow commands, a line each: the causes, or else the cases that lose points; and what the compiler warned of, which
/// GitHub shows beside the line, where what was handed in is the whole repository.
pub(crate) fn annotations(grade: &Grade) -> String {
    let problem =
        grade.problem.iter().map(|problem| ("fails to start".to_owned(), problem.clone()));
    let causes = grade.causes.iter().map(|told| {
        let seen = told.evidence.first().map_or("", String::as_str);
        (told.in_words(), format!("{seen}\n{}\n{}", told.fix, told.command))
    });
    let lost = grade.cases().filter(|(_, case)| case.points.are_lost() && !case.hidden);
    let told = |case: &str| grade.causes.iter().any(|told| told.explains.iter().any(|c| c == case));
    let cases = lost.filter(|(_, case)| !told(&case.case));
    let cases = cases.map(|(_, case)| (case.case.clone(), case.statement.clone()));
    let all = problem.chain(causes).chain(cases);
    let line = |(title, message): (String, String)| {
        format!("::error title={}::{}\n", property(&title), data(&message))
    };
    let warnings = grade.warnings.iter().map(|warning| {
        let (file, message) = (property(&warning.file), data(&warning.message));
        format!("::warning file={file},line={}::{message}\n", warning.line)
    });
    all.take(MOST).map(line).chain(warnings.take(MOST)).collect()
}

/// Markdown for `$GITHUB_STEP_SUMMARY`.
pub(crate) fn summary(grade: &Grade) -> String {
    let [earned, of] = [grade.points.earned, grade.points.of].map(hundredths);
    let (table, causes) = (markdown::table(grade), markdown::causes(grade));
    format!("## {}: {earned} of {of}\n\n{table}\n{causes}\n", grade.title)
}

/// As the runner's toolkit escapes the message of a command.
fn data(words: &str) -> String {
    words.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// As it escapes a property.
fn property(words: &str) -> String {
    data(words).replace(':', "%3A").replace(',', "%2C")
}
