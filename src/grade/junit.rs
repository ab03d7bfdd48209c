//! JUnit's XML, in the dialect that Jenkins' schema describes (`junit-10.xsd`): one suite a part, one test a case.

use super::{CaseGrade, Grade, PartGrade, Standing};
use quick_xml::Writer;
use quick_xml::events::BytesText;
use std::io;

/// The file.
///
/// # Errors
/// Never in practice: it is written to memory.
pub(crate) fn report(grade: &Grade) -> io::Result<String> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let root = writer.create_element("testsuites");
    let name = clean(&format!("{} on {}", grade.suite, grade.core));
    root.with_attributes([("name", name.as_str())]).write_inner_content(|writer| {
        grade.parts.iter().try_for_each(|part| suite(writer, grade, part))
    })?;
    let text = String::from_utf8_lossy(&writer.into_inner()).into_owned();
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{text}\n"))
}

fn suite(writer: &mut Writer<Vec<u8>>, grade: &Grade, part: &PartGrade) -> io::Result<()> {
    let count = |kinds: fn(Standing) -> Kind, kind| {
        part.cases.iter().filter(|case| kinds(case.standing) == kind).count().to_string()
    };
    let seconds = part.cases.iter().map(|case| case.seconds).sum::<f64>();
    let is_absent = grade.problem.is_some() && part.cases.is_empty();
    let (tests, errors) = match is_absent {
        true => ("1".to_owned(), "1".to_owned()),
        false => (part.cases.len().to_string(), count(kind, Kind::Error)),
    };
    let attributes = [
        ("name", clean(&part.name)),
        ("tests", tests),
        ("failures", count(kind, Kind::Failure)),
        ("errors", errors),
        ("skipped", count(kind, Kind::Skipped)),
        ("time", format!("{seconds:.3}")),
    ];
    let element = writer.create_element("testsuite").with_attributes(pairs(&attributes));
    element.write_inner_content(|writer| match (is_absent, &grade.problem) {
        (true, Some(problem)) => absent(writer, part, problem),
        _ => part.cases.iter().try_for_each(|case| test(writer, case)),
    })?;
    Ok(())
}

/// A core that was never asked has failed each part.
fn absent(writer: &mut Writer<Vec<u8>>, part: &PartGrade, problem: &str) -> io::Result<()> {
    let attributes = [("classname", clean(&part.name)), ("name", "starts".to_owned())];
    let element = writer.create_element("testcase").with_attributes(pairs(&attributes));
    element.write_inner_content(|writer| {
        let error = writer.create_element("error").with_attributes([("message", "no core")]);
        error.write_text_content(BytesText::new(&clean(problem))).map(|_| ())
    })?;
    Ok(())
}

#[derive(PartialEq, Eq)]
enum Kind {
    Pass,
    Failure,
    Error,
    Skipped,
}

/// What is not decided is skipped: JUnit has no other word for it.
const fn kind(standing: Standing) -> Kind {
    match standing {
        Standing::Pass => Kind::Pass,
        Standing::Fail | Standing::Missing => Kind::Failure,
        Standing::Crashed | Standing::TimedOut | Standing::Broken => Kind::Error,
        Standing::Inconclusive | Standing::LeftOut | Standing::Blocked | Standing::NotTried => {
            Kind::Skipped
        }
    }
}

fn test(writer: &mut Writer<Vec<u8>>, case: &CaseGrade) -> io::Result<()> {
    let (folder, claim) = case.case.split_once('/').unwrap_or(("", &case.case));
    let attributes = [
        ("classname", folder.to_owned()),
        ("name", claim.to_owned()),
        ("time", format!("{:.3}", case.seconds)),
    ];
    let element = writer.create_element("testcase").with_attributes(pairs(&attributes));
    let name = match kind(case.standing) {
        Kind::Pass => return element.write_empty().map(|_| ()),
        Kind::Failure => "failure",
        Kind::Error => "error",
        Kind::Skipped => "skipped",
    };
    element.write_inner_content(|writer| {
        let first = case.statement.lines().next().unwrap_or_default();
        let message = clean(&format!("{}: {first}", case.standing.word()));
        let told = writer.create_element(name).with_attributes([("message", message.as_str())]);
        let body = clean(&format!("{}\n{}\n{}", case.statement, case.teaches, case.rerun));
        told.write_text_content(BytesText::new(&body)).map(|_| ())
    })?;
    Ok(())
}

fn pairs<'a, const N: usize>(
    attributes: &'a [(&'static str, String); N],
) -> impl Iterator<Item = (&'a str, &'a str)> {
    attributes.iter().map(|(name, value)| (*name, value.as_str()))
}

/// Without what no XML may hold: control characters that a core has printed.
fn clean(words: &str) -> String {
    let may_stand = |letter: &char| match letter {
        '\n' | '\t' => true,
        '\u{fffe}' | '\u{ffff}' => false,
        letter => !letter.is_control(),
    };
    words.chars().filter(may_stand).collect()
}
