//! How the cost of a ray grows with the number of triangles.

use super::{Measured, Row};

/// The subjects that are one shape at several sizes.
const FAMILY: &str = "bumpy-sphere";

/// How one structure's cost grows from the smallest to the largest of the family.
pub(super) struct Growth<'a> {
    pub(super) row: &'a Row,
    /// Triangles of both.
    pub(super) triangles: [usize; 2],
    /// Cost is proportional to n to this power.
    pub(super) of_time: f64,
    pub(super) of_tests: Option<f64>,
}

pub(super) fn growths(subjects: &[Measured]) -> Vec<Growth<'_>> {
    let mut family = subjects.iter().filter(|one| one.subject.starts_with(FAMILY));
    let (Some(small), Some(large)) = (family.next(), family.next_back()) else {
        return Vec::new();
    };
    let triangles = [small.triangles, large.triangles];
    let power =
        |few: f64, many: f64| (many / few).ln() / (triangles[1] as f64 / triangles[0] as f64).ln();
    let growth = |(few, many): (&Row, &Row)| grown(few, many, power);
    let grown: Vec<_> = small.rows.iter().zip(&large.rows).map(growth).collect();
    let rows = large.rows.iter().zip(grown);
    rows.map(|(row, (of_time, of_tests))| Growth { row, triangles, of_time, of_tests }).collect()
}

fn grown(few: &Row, many: &Row, power: impl Fn(f64, f64) -> f64) -> (f64, Option<f64>) {
    let tests = few.tests.zip(many.tests).map(|([few, _], [many, _])| power(few, many));
    (power(few.seconds_per_ray(), many.seconds_per_ray()), tests)
}
