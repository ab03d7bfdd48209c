//! The write-up as Markdown, with its images beside it.

use super::page::{Line, Page, Section, Shown, Table};
use std::fmt::Write;

/// Figures in a row.
const COLUMNS: usize = 4;

pub(super) fn text(page: &Page) -> String {
    let mut text = format!("# {}\n", page.title);
    for fact in &page.facts {
        text += &format!("\n- {fact}");
    }
    text += "\n";
    page.sections.iter().for_each(|section| text += &of_section(section));
    text
}

fn of_section(section: &Section) -> String {
    let mut text = format!("\n## {}\n\n{}\n", section.title, section.says);
    for row in section.figures.chunks(COLUMNS) {
        text += &images(row);
    }
    text + &table(&section.table) + &commands(&section.table)
}

fn images(figures: &[Shown]) -> String {
    let cells = figures.iter().map(|figure| {
        let image = |address: &str| format!("![{}]({address})", figure.label);
        let images = figure.images.iter().map(|image_| image(&image_.address));
        images.collect::<Vec<_>>().join(" ")
    });
    let captions = figures.iter().map(|figure| format!("**{}**: {}", figure.label, figure.facts));
    let head = cells.map(|cell| escaped(&cell)).collect::<Vec<_>>();
    let rule = vec![":-:"; head.len()];
    let captions: Vec<_> = captions.map(|caption| escaped(&caption)).collect();
    format!("\n{}{}{}", row(&head), row(&rule), row(&captions))
}

fn table(table: &Table) -> String {
    let mut text = format!("\n{}{}", row(table.head), row(&vec!["---"; table.head.len()]));
    table.rows.iter().for_each(|line| text += &of_line(line, table.head.len()));
    text
}

fn of_line(line: &Line, columns: usize) -> String {
    let mut cells = vec![escaped(&line.label)];
    match &line.cells {
        Ok(values) => cells.extend(values.iter().map(|value| escaped(value))),
        Err(why) => cells.push(escaped(&format!("not made: {}", one_line(why)))),
    }
    cells.resize(columns, String::new());
    row(&cells)
}

/// Folded away: they are long, and are copied rather than read.
fn commands(table: &Table) -> String {
    let lines: Vec<_> = table.commands().collect();
    let head = "<details><summary>The commands that make these figures</summary>";
    format!("\n{head}\n\n```sh\n{}\n```\n\n</details>\n", lines.join("\n"))
}

fn one_line(words: &str) -> String {
    words.lines().map(str::trim).collect::<Vec<_>>().join("; ")
}

fn row(cells: &[impl AsRef<str>]) -> String {
    let mut text = String::from("|");
    for cell in cells {
        let _ = write!(text, " {} |", cell.as_ref());
    }
    text + "\n"
}

/// What would end a cell.
fn escaped(words: &str) -> String {
    words.replace('|', "\\|").replace('<', "&lt;").replace('\n', " ")
}
