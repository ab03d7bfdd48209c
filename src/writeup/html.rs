//! The write-up as one page that holds its images, to be sent or handed in.

use super::page::{Line, Page, Section, Shown, Table};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("page.css");

pub(super) fn text(page: &Page) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width,initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (page.title) }
                style { (PreEscaped(STYLE)) }
            }
            body { main {
                h1 { (page.title) }
                ul.facts { @for fact in &page.facts { li { (fact.replace('`', "")) } } }
                nav { @for (number, section) in page.sections.iter().enumerate() {
                    a href={ "#" (number) } { (section.title) }
                } }
                @for (number, section) in page.sections.iter().enumerate() { (of_section(section, number)) }
            } }
        }
    };
    page.into_string()
}

fn of_section(section: &Section, number: usize) -> Markup {
    html! {
        section id=(number) {
            h2 { (section.title) }
            p { (section.says) }
            @if !section.figures.is_empty() {
                div.figures { @for figure in &section.figures { (of_figure(figure)) } }
            }
            div.wide role="group" aria-label=(section.title) tabindex="0" { (of_table(&section.table)) }
            details {
                summary { "The commands that make these figures" }
                @for command in section.table.commands() { code { (command) } }
            }
        }
    }
}

fn of_figure(figure: &Shown) -> Markup {
    html! {
        figure.two[figure.images.len() > 1] {
            div.images { @for image in &figure.images {
                img src={ "data:image/png;base64," (BASE64_STANDARD.encode(&image.png)) } alt=(figure.label);
            } }
            figcaption {
                b { (figure.label) }
                " " span { (figure.facts) }
            }
        }
    }
}

fn of_table(table: &Table) -> Markup {
    html! {
        table {
            thead { tr {
                @for name in table.head { th scope="col" { (name) } }
            } }
            tbody { @for line in &table.rows { (of_line(line, table.head.len())) } }
        }
    }
}

fn of_line(line: &Line, columns: usize) -> Markup {
    html! {
        tr {
            th scope="row" { (line.label) }
            @match &line.cells {
                Ok(cells) => { @for cell in cells { td { (cell) } } }
                Err(why) => { td.missing colspan=(columns - 1) { "not made: " (why.replace('`', "")) } }
            }
        }
    }
}
