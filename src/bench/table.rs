//! The tables, as text.

use super::contest::is_noisy;
use super::growth::growths;
use super::{Measured, Row};
use crate::stats::timing::SpeedUp;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Everything that was measured.
pub fn table(subjects: &[Measured]) -> String {
    let mut text = String::new();
    // Writing into a string does not fail.
    let _ = write_all(&mut text, subjects);
    text
}

fn write_all(text: &mut String, subjects: &[Measured]) -> std::fmt::Result {
    if subjects.is_empty() {
        return Ok(());
    }
    writeln!(
        text,
        "speed-up over brute force, CPU time of each core's process; half camera rays, half chords\n"
    )?;
    writeln!(
        text,
        "{:<18}{:>10}  {:<38}{:>9}{:>10}  {:<17}{:>9}{:>10}{:>8}{:>10}{:>7}",
        "subject",
        "triangles",
        "core, structure",
        "s/Mray",
        "speed-up",
        "95 % interval",
        "x fastest",
        "tests/ray",
        "boxes",
        "build ms",
        "B/tri"
    )?;
    for measured @ Measured { subject, triangles, rows } in subjects {
        let times = rows.iter().map(Row::seconds_per_ray);
        let fastest = times.min_by(f64::total_cmp).unwrap_or(f64::NAN);
        for (index, row) in rows.iter().enumerate() {
            if index == 0 {
                write!(text, "{subject:<18}{triangles:>10}  ")?;
            } else {
                write!(text, "{:<30}", "")?;
            }
            writeln!(text, "{}", line(row, measured.speed_up(row).as_ref(), fastest))?;
        }
    }
    notes(text, subjects)?;
    cost_against_size(text, subjects)
}

fn line(row: &Row, speed_up: Option<&SpeedUp>, fastest: f64) -> String {
    let (speed_up, interval) = speed_up.map(in_words).unwrap_or_default();
    let number = |value: Option<f64>, decimals: usize| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"))
    };
    let who = format!("{}, {}", short(&row.core), row.structure);
    let [tests, boxes] = [0, 1].map(|kind| number(row.tests.map(|tests| tests[kind]), 1));
    let wall = if row.by_the_wall { " (wall time)" } else { "" };
    format!(
        "{who:<38}{:>9}{speed_up:>10}  {interval:<17}{:>9}{tests:>10}{boxes:>8}{:>10.1}{:>7}{wall}",
        three_digits(1e6 * row.seconds_per_ray()),
        three_digits(row.seconds_per_ray() / fastest),
        1e3 * row.build_seconds,
        number(row.bytes_per_triangle, 0),
    )
}

/// A library is called by its file.
fn short(core: &str) -> &str {
    core.rsplit(['/', '\\']).next().unwrap_or(core)
}

fn in_words(speed_up: &SpeedUp) -> (String, String) {
    let [low, high] = speed_up.interval.map(three_digits);
    let ratio = format!("x{}", three_digits(speed_up.ratio));
    let told = if is_noisy(speed_up) { "too noisy".to_owned() } else { ratio };
    (told, format!("{low} .. {high}"))
}

fn three_digits(number: f64) -> String {
    let decimals = [10.0, 100.0].iter().filter(|limit| number < **limit).count();
    format!("{number:.decimals$}")
}

fn notes(text: &mut String, subjects: &[Measured]) -> std::fmt::Result {
    writeln!(text)?;
    for Measured { subject, rows, .. } in subjects {
        if let Some(first) = rows.first() {
            let (core, rays) = (short(&first.core), first.rays);
            writeln!(text, "{subject}: brute force is {core}'s, on the first {rays} rays")?;
        }
        for row in rows.iter().filter(|row| row.different[0] > 0) {
            let [different, all] = row.different;
            let verdict = if row.is_wrong { "WRONG" } else { "as rounding at edges may have it" };
            let (core, structure) = (short(&row.core), row.structure);
            writeln!(text, "  {core}, {structure}: {different} of {all} hits differ: {verdict}")?;
        }
    }
    let rows = subjects.iter().flat_map(|one| &one.rows);
    // Said once, though the same mistake is in every structure and mesh of a core.
    let breaches: BTreeMap<_, _> =
        rows.filter_map(|row| Some((short(&row.core), row.breach.as_ref()?))).collect();
    for (core, breach) in breaches {
        writeln!(text, "{core}: {breach}; made unit, and timed as it is")?;
    }
    let all_equal = subjects.iter().flat_map(|one| &one.rows).all(|row| row.different[0] == 0);
    if all_equal {
        writeln!(text, "All hits that were compared are equal.")?;
    }
    writeln!(
        text,
        "Another run's figure lies in the interval 19 times of 20, if the machine is as busy then."
    )?;
    Ok(())
}

fn cost_against_size(text: &mut String, subjects: &[Measured]) -> std::fmt::Result {
    let growths = growths(subjects);
    if let Some(first) = growths.first() {
        let [few, many] = first.triangles;
        writeln!(
            text,
            "\ncost of a ray from {few} to {many} triangles of one shape, as a power of their number\n"
        )?;
        writeln!(text, "{:<38}{:>8}{:>8}", "core, structure", "time", "tests")?;
    }
    for growth in growths {
        let who = format!("{}, {}", short(&growth.row.core), growth.row.structure);
        let tests = growth.of_tests.map_or_else(|| "-".to_owned(), |power| format!("{power:.2}"));
        writeln!(text, "{who:<38}{:>8.2}{tests:>8}", growth.of_time)?;
    }
    Ok(())
}
