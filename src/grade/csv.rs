//! A table for spreadsheets (RFC 4180): a row a case.

use super::{Grade, hundredths};

const COLUMNS: &str = "core,part,case,standing,earned,of,open,hidden,with,seconds,statement\r\n";

pub(crate) fn table(grade: &Grade) -> String {
    let row = |(part, case): (&super::PartGrade, &super::CaseGrade)| {
        let [earned, of, open] = [case.points.earned, case.points.of, case.points.open];
        let cells = [
            grade.core.clone(),
            part.name.clone(),
            case.case.clone(),
            case.standing.word().to_owned(),
            hundredths(earned).to_string(),
            hundredths(of).to_string(),
            hundredths(open).to_string(),
            case.hidden.to_string(),
            case.with.join(" "),
            format!("{:.3}", case.seconds),
            case.statement.clone(),
        ];
        line(&cells)
    };
    COLUMNS.to_owned() + &grade.cases().map(row).collect::<String>()
}

/// Cells as a line of the file.
pub(crate) fn line(cells: &[String]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| quoted(cell)).collect();
    cells.join(",") + "\r\n"
}

/// A cell. What a spreadsheet would take for a formula becomes text.
fn quoted(cell: &str) -> String {
    let is_formula = cell.starts_with(['=', '+', '@']) || cell.starts_with('-') && cell.len() > 1;
    let is_number = cell.parse::<f64>().is_ok();
    let cell = if is_formula && !is_number { format!("'{cell}") } else { cell.to_owned() };
    match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell,
    }
}
