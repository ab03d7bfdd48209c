//! A class: the grades of all submissions, as a table and as a page. Without names unless they are asked for.

use super::{Grade, Standing, Told, csv, hundredths, warning};
use crate::diagnosis::Degree;
use crate::report::html::with_code;
use crate::text::number::count;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

/// Cases and causes that the page tells of.
const MOST: usize = 25;

/// All that were handed in, or a share of them, in the order of what they are called.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Class {
    pub(crate) title: String,
    /// Of everything but the submissions that the grades depend on: shares of one class have the same.
    conditions: String,
    shard: Option<Shard>,
    pub(crate) rows: Vec<Row>,
}

/// One of equal shares of a class, `2/8`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Shard {
    /// From 1.
    number: usize,
    of: usize,
}

impl Shard {
    /// Whether it is given the submission at this place, counted from 0.
    pub(crate) const fn has(self, place: usize) -> bool {
        place % self.of == self.number - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let numbers =
            word.split_once('/').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err("must be a share such as 2/8: the second of eight".to_owned()),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl Class {
    pub(crate) fn new(
        title: String,
        conditions: String,
        shard: Option<Shard>,
        mut rows: Vec<Row>,
    ) -> Self {
        rows.sort_by(|a, b| a.called.cmp(&b.called));
        Self { title, conditions, shard, rows }
    }

    /// What its files are called: `class`, or `class-2-of-8`.
    pub(crate) fn name(&self) -> String {
        match self.shard {
            Some(Shard { number, of }) => format!("class-{number}-of-{of}"),
            None => "class".to_owned(),
        }
    }

    /// The file that it is merged from.
    pub(crate) fn file(&self) -> String {
        format!("{}.json", self.name())
    }

    /// A whole class of its shares.
    ///
    /// # Errors
    /// If they are not the shares of one class, or not all of them.
    pub(crate) fn merged(shares: Vec<Self>) -> Result<Self, String> {
        let Some(first) = shares.first() else { return Err("there is no share to merge".into()) };
        let (title, conditions) = (first.title.clone(), first.conditions.clone());
        if let Some(other) = shares.iter().find(|share| share.conditions != conditions) {
            return Err(format!(
                "`{title}` and `{}` were graded under different conditions\n\
                 hint: suite, salt, cases and program have to be the same for all shares",
                other.title
            ));
        }
        let numbers: BTreeSet<_> = shares.iter().filter_map(|share| share.shard).collect();
        let of = numbers.first().map_or(0, |shard| shard.of);
        if numbers.len() != shares.len() || numbers.iter().any(|shard| shard.of != of) {
            return Err("these are not different shares of one class".to_owned());
        }
        let missing = (1..=of).map(|number| Shard { number, of });
        let missing = missing.filter(|shard| !numbers.contains(shard));
        let missing: Vec<_> = missing.map(|shard| shard.to_string()).collect();
        if !missing.is_empty() {
            return Err(format!(
                "a share is missing: {}\nhint: `furnace grade --submissions … --shard {}` grades it",
                missing.join(", "),
                missing[0]
            ));
        }
        let rows = shares.into_iter().flat_map(|share| share.rows).collect();
        Ok(Self::new(title, conditions, None, rows))
    }
}

/// One submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Row {
    /// Its name, or else a word that nobody can tell it by.
    pub(crate) called: String,
    pub(crate) grade: Grade,
    /// Where its own report is, from the page; none where nothing could be run.
    pub(crate) report: Option<String>,
}

/// A spreadsheet with a row a submission.
pub(crate) fn table(class: &Class) -> String {
    let parts = class.rows.first().map(|row| &row.grade.parts).into_iter().flatten();
    let head = ["submission", "earned", "of", "open"].map(str::to_owned).into_iter();
    let head = head.chain(parts.map(|part| part.name.clone()));
    let ends = ["problem", "causes", "looks like", "differs"].map(str::to_owned);
    let head: Vec<_> = head.chain(ends).collect();
    let row = |row: &Row| {
        let points = row.grade.points;
        let numbers = [points.earned, points.of, points.open].map(|p| hundredths(p).to_string());
        let parts = row.grade.parts.iter().map(|part| hundredths(part.points.earned).to_string());
        let told =
            |degree: Degree| told(&row.grade, degree).map(named).collect::<Vec<_>>().join("; ");
        let problem = row.grade.problem.clone().unwrap_or_default();
        let surest_first = [Degree::Named, Degree::LooksLike, Degree::DiffersHere];
        let cells = [row.called.clone()].into_iter().chain(numbers).chain(parts);
        let cells = cells.chain([problem]).chain(surest_first.map(told));
        csv::line(&cells.collect::<Vec<_>>())
    };
    csv::line(&head) + &class.rows.iter().map(row).collect::<String>()
}

/// What is told of a submission, and how surely.
fn told(grade: &Grade, degree: Degree) -> impl Iterator<Item = &Told> {
    grade.causes.iter().filter(move |told| told.degree == degree)
}

/// By its name in the glossary, if it has one.
fn named(told: &Told) -> &str {
    if told.cause.is_empty() { &told.mistake } else { &told.cause }
}

const STYLE: &str = "
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif }
body { max-width: 70rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; width: 100%; margin-bottom: 2rem }
th, td { text-align: left; padding: .25rem .75rem .25rem 0; border-bottom: 1px solid #8884; vertical-align: top }
pre { max-width: 30rem; overflow-x: auto; font-size: .8rem }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums }
";

/// The page.
pub(crate) fn page(class: &Class) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (class.title) ", " (count(class.rows.len(), "submission")) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (class.title) }
                p { (count(class.rows.len(), "submission")) ". " (middle(class)) }
                (by_cause(class))
                (by_place(class))
                (by_case(class))
                (submissions(class))
            }
        }
    };
    page.into_string()
}

/// `Half of them have 71 of 100 points or more.`
fn middle(class: &Class) -> String {
    let mut earned: Vec<_> = class.rows.iter().map(|row| row.grade.points.earned).collect();
    earned.sort_by(f64::total_cmp);
    let of = class.rows.first().map_or(0.0, |row| row.grade.points.of);
    earned.get(earned.len() / 2).map_or(String::new(), |middle| {
        format!("Half of them have {} of {of} points or more.", hundredths(*middle))
    })
}

/// Who made a mistake surely, and who perhaps.
#[derive(Default)]
struct Cluster<'a> {
    mistake: &'a str,
    named: Vec<&'a str>,
    looks_like: Vec<&'a str>,
}

/// Those that have made the same mistake.
fn by_cause(class: &Class) -> Markup {
    let mut clusters: BTreeMap<&str, Cluster<'_>> = BTreeMap::new();
    for row in &class.rows {
        for cause in row.grade.causes.iter().filter(|told| told.degree > Degree::DiffersHere) {
            let cluster = clusters.entry(named(cause)).or_default();
            cluster.mistake = &cause.mistake;
            let is_sure = cause.degree == Degree::Named;
            let who = if is_sure { &mut cluster.named } else { &mut cluster.looks_like };
            who.push(&row.called);
        }
    }
    let count = |cluster: &Cluster<'_>| cluster.named.len() + cluster.looks_like.len();
    let rows = most_first(clusters, count);
    html! {
        h2 { "Mistakes" }
        @if rows.is_empty() { p { "None that has a name." } } @else {
            table {
                tr { th { "mistake" } th.number { "submissions" } th { "made it" } th { "look like it" } }
                @for (cause, cluster) in &rows {
                    tr {
                        td { (cluster.mistake) " " code { (cause) } }
                        td.number { (count(cluster)) }
                        td { (cluster.named.join(", ")) }
                        td { (cluster.looks_like.join(", ")) }
                    }
                }
            }
        }
    }
}

/// Those that differ in the same place, and nobody knows why: that is no mistake that they share.
fn by_place(class: &Class) -> Markup {
    let mut who: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for row in &class.rows {
        let places = told(&row.grade, Degree::DiffersHere);
        places.for_each(|told| who.entry(&told.mistake).or_default().push(&row.called));
    }
    let rows = most_first(who, Vec::len);
    html! {
        @if !rows.is_empty() {
            h2 { "Places where they differ, without a known cause" }
            table {
                tr { th { "what is seen" } th.number { "submissions" } th { "which" } }
                @for (place, who) in rows {
                    tr { td { (with_code(place)) } td.number { (who.len()) } td { (who.join(", ")) } }
                }
            }
        }
    }
}

/// Which cases cost most of them points.
fn by_case(class: &Class) -> Markup {
    let mut who: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for row in &class.rows {
        let lost = row.grade.cases().filter(|(_, case)| case.points.are_lost());
        lost.for_each(|(_, case)| who.entry(&case.case).or_default().push(&row.called));
    }
    html! {
        h2 { "Cases" }
        table {
            tr { th { "case" } th.number { "submissions that lose points" } }
            @for (case, who) in most_first(who, Vec::len) {
                tr { td { (case) } td.number { (who.len()) } }
            }
        }
    }
}

fn most_first<K: Ord, V>(all: BTreeMap<K, V>, count: impl Fn(&V) -> usize) -> Vec<(K, V)> {
    let mut rows: Vec<_> = all.into_iter().collect();
    rows.sort_by_key(|(_, one)| std::cmp::Reverse(count(one)));
    rows.truncate(MOST);
    rows
}

fn submissions(class: &Class) -> Markup {
    let parts = class.rows.first().map(|row| &row.grade.parts).into_iter().flatten();
    html! {
        h2 { "Submissions" }
        table {
            tr {
                th { "submission" } th.number { "points" } th.number { "open" }
                @for part in parts { th.number { (part.name) } }
                th { "passes" }
            }
            @for row in &class.rows {
                tr {
                    td {
                        @match &row.report {
                            Some(report) => { a href=(report) { (row.called) } }
                            None => { (row.called) }
                        }
                    }
                    td.number { (hundredths(row.grade.points.earned)) }
                    td.number { (hundredths(row.grade.points.open)) }
                    @for part in &row.grade.parts { td.number { (hundredths(part.points.earned)) } }
                    td { (outcome(&row.grade)) }
                }
            }
        }
    }
}

/// `41 of 60 cases`, or why there is none, where what a compiler says opens below.
fn outcome(grade: &Grade) -> Markup {
    let Some(problem) = &grade.problem else {
        let counting = grade.cases().count() - grade.count(Standing::LeftOut);
        return html! {
            (grade.count(Standing::Pass)) " of " (counting) " cases"
            @if !grade.warnings.is_empty() {
                details {
                    summary { (count(grade.warnings.len(), "warning")) " of the compiler" }
                    pre { (warning::shown(&grade.warnings).join("\n")) }
                }
            }
        };
    };
    match problem.split_once('\n') {
        Some((first, said)) => html! {
            details { summary { (with_code(first)) } pre { (said.trim()) } }
        },
        None => with_code(problem),
    }
}
