//! The speed-up table.

use crate::paired::{BRUTE_FORCE_RAYS, Interval, Measured, Row};

/// A speed-up whose interval is wider than this share of it is not printed.
const WIDEST_INTERVAL: f64 = 0.1;

/// Prints the table, if anything was measured.
pub fn print(subjects: &[Measured]) {
    if subjects.is_empty() {
        return;
    }
    println!("\nspeed-up over brute force, one thread, CPU time; half camera rays, half chords\n");
    println!(
        "{:<18}{:>10}  {:<18}{:>10}{:>10}  {:<17}{:>10}{:>8}{:>10}{:>7}",
        "subject",
        "triangles",
        "rule",
        "s/Mray",
        "speed-up",
        "95 % interval",
        "tests/ray",
        "boxes",
        "build ms",
        "B/tri"
    );
    for Measured { subject, triangles, rows } in subjects {
        for (index, row) in rows.iter().enumerate() {
            if index == 0 {
                print!("{subject:<18}{triangles:>10}  ");
            } else {
                print!("{:<30}", "");
            }
            print_row(row);
        }
    }
    println!(
        "\nBrute force was timed on the first {BRUTE_FORCE_RAYS} rays. All structures run the same"
    );
    println!("triangle test, and all their hits were found equal to those of brute force.");
}

fn print_row(row: &Row) {
    let (speed_up, interval) = if row.rule.is_brute_force() {
        (String::new(), String::new())
    } else {
        in_words(row.speed_up)
    };
    println!(
        "{:<18}{:>10}{:>10}  {:<17}{:>10.1}{:>8.1}{:>10.1}{:>7.0}",
        row.rule.name,
        three_digits(1e6 * row.seconds_per_ray),
        speed_up,
        interval,
        row.tests_per_ray,
        row.boxes_per_ray,
        1e3 * row.build_seconds,
        row.bytes_per_triangle,
    );
}

fn in_words(Interval { low, median, high }: Interval) -> (String, String) {
    let interval = format!("{} .. {}", three_digits(low), three_digits(high));
    if high - low <= WIDEST_INTERVAL * median {
        (format!("x{}", three_digits(median)), interval)
    } else {
        ("too noisy".to_owned(), interval)
    }
}

fn three_digits(number: f64) -> String {
    let decimals = [10.0, 100.0].iter().filter(|limit| number < **limit).count();
    format!("{number:.decimals$}")
}
