//! What a BVH saves: tests a ray against the number of triangles, beside brute force; and the speed-up by the clock.

use super::chart::{Axis, Chart};
use super::figure::{Figure, Mark, Shape};
use super::scale::Scale;
use crate::checks::series::{SpeedUps, TestsBySize};
use crate::text::number::figure;

const CLOSEST: Mark = Mark::new("line-a", Shape::Circle);
const ANY: Mark = Mark::new("line-b", Shape::Square);
const BOXES: Mark = Mark::new("line-c", Shape::Triangle);

const FEW_TESTS: &str = "Tests a ray grow about as the log n guide, next to those of a plain median BVH, far below brute force. Tests that run along brute force: the \
    BVH is not used. Any hit above closest hit: shadow rays search on after the first hit. Boxes that grow faster than the guide: the tree is a list.";
const FASTER: &str = "All pairs of times are to the right of what is asked, and close together: the same rays, in turn with and without the BVH. \
    A wide spread is a busy machine. A clock informs, and fails nobody.";

pub(super) fn tests(tests: &TestsBySize) -> Option<Figure> {
    let chart = tests_chart(tests)?;
    let (title, found) =
        ("Tests a ray against the size of the mesh".to_owned(), tests_found(tests));
    let mut legend = vec![
        (CLOSEST, "triangles, closest hit".to_owned()),
        (ANY, "triangles, any hit".to_owned()),
    ];
    if counts_boxes(tests) {
        legend.push((BOXES, "boxes, closest hit".to_owned()));
    }
    legend.extend([
        (Mark::new("fit", Shape::Line), "triangles of a plain median BVH".to_owned()),
        (Mark::new("wrong", Shape::Line), "brute force".to_owned()),
        (Mark::new("guide", Shape::Line), "log n from the first".to_owned()),
    ]);
    let drawing = chart.svg(&title, &found);
    Some(Figure { title, drawing, legend, found, should: FEW_TESTS, left_out: chart.left_out })
}

fn counts_boxes(tests: &TestsBySize) -> bool {
    tests.boxes.iter().any(|boxes| *boxes > 0.0)
}

fn tests_chart(tests: &TestsBySize) -> Option<Chart> {
    let sizes: Vec<_> = tests.triangles.iter().map(|triangles| *triangles as f64).collect();
    let along =
        |values: &[f64]| -> Vec<_> { sizes.iter().zip(values).map(|(x, y)| [*x, *y]).collect() };
    let kinds = [&tests.closest, &tests.any, &tests.plain, &tests.boxes];
    let values = kinds.iter().flat_map(|kind| kind.iter().copied()).chain(sizes.iter().copied());
    let (x, y) = (Scale::log(sizes.iter().copied())?, Scale::log(values)?);
    let mut chart = Chart::new(
        Axis::new("triangles", x.with_room(0.05)),
        Axis::new("tests a ray", y.with_room(0.05)),
    );
    chart.line("wrong", along(&sizes));
    chart.line("fit", along(&tests.plain));
    chart.line("guide", guide(&sizes, *tests.closest.first()?));
    let of_boxes = counts_boxes(tests).then_some((BOXES, &tests.boxes));
    for (mark, kind) in [(CLOSEST, &tests.closest), (ANY, &tests.any)].into_iter().chain(of_boxes) {
        chart.line(mark.class, along(kind));
        for [size, count] in along(kind) {
            chart.point(mark, [size, count], &format!("{size} triangles: {} a ray", figure(count)));
        }
    }
    Some(chart)
}

/// Tests that grow as log n from those of the first size.
fn guide(sizes: &[f64], first: f64) -> Vec<[f64; 2]> {
    let log = |size: &f64| size.ln() / sizes[0].ln();
    sizes.iter().map(|size| [*size, first * log(size)]).collect()
}

fn tests_found(tests: &TestsBySize) -> String {
    let largest =
        (tests.triangles.last(), tests.closest.last(), tests.any.last(), tests.plain.last());
    let (Some(size), Some(closest), Some(any), Some(plain)) = largest else { return String::new() };
    format!(
        "Of {size} triangles {} are tested a ray for the closest hit, {} for any hit; a plain median BVH tests {}, brute force \
         {} times as many as the core.",
        figure(*closest),
        figure(*any),
        figure(*plain),
        figure(*size as f64 / closest)
    )
}

pub(super) fn speed_up(times: &SpeedUps) -> Option<Figure> {
    let chart = speed_up_chart(times)?;
    let title = "Speed-up over brute force, pair by pair".to_owned();
    let found = speed_up_found(times);
    let legend = vec![
        (CLOSEST, "a pair of times".to_owned()),
        (Mark::new("fit", Shape::Line), "median".to_owned()),
        (Mark::new("band", Shape::Area), "95 % interval of the median".to_owned()),
        (Mark::new("wrong", Shape::Line), "asked for".to_owned()),
    ];
    let drawing = chart.svg(&title, &found);
    Some(Figure { title, drawing, legend, found, should: FASTER, left_out: chart.left_out })
}

fn speed_up_chart(times: &SpeedUps) -> Option<Chart> {
    let ends = times.interval.into_iter().flatten();
    let x = Scale::log(times.ratios.iter().copied().chain(ends).chain([times.at_least, 1.0]))?;
    let last = times.ratios.len() as f64;
    let y = Scale::linear([0.0, last + 1.0])?;
    let axis = Axis::new("times as fast as brute force", x.with_room(0.05));
    let mut chart = Chart::new(axis, Axis::new("pair", y));
    if let Some(interval) = times.interval {
        chart.bar("band", interval, [0.0, last + 1.0], "");
    }
    let upright = |x: f64| [[x, 0.0], [x, last + 1.0]];
    chart.line("wrong", upright(times.at_least));
    chart.line("fit", upright(times.median));
    for (number, ratio) in (1..).zip(times.ratios.iter()) {
        let title = format!("pair {number}: {} times as fast", figure(*ratio));
        chart.point(CLOSEST, [*ratio, f64::from(number)], &title);
    }
    Some(chart)
}

fn speed_up_found(times: &SpeedUps) -> String {
    let interval = times.interval.map(|ends| ends.map(figure));
    let interval = interval
        .map_or_else(String::new, |[low, high]| format!(" (95 % interval {low} to {high})"));
    let above = times.ratios.iter().filter(|ratio| **ratio > times.at_least).count();
    format!(
        "{} times as fast{interval}, the median of {} pairs; {above} of them are above the {} asked for.",
        figure(times.median),
        times.ratios.len(),
        figure(times.at_least)
    )
}

#[cfg(test)]
mod tests_of_plots {
    use super::*;
    use crate::checks::series::OneLine;

    fn sizes(closest: [f64; 4]) -> TestsBySize {
        let line = |values: [f64; 4]| OneLine::rounded(values);
        TestsBySize {
            triangles: [512, 2048, 8192, 32_768].into_iter().collect(),
            closest: line(closest),
            any: line([8.0, 9.0, 10.0, 11.0]),
            boxes: line([0.0; 4]),
            plain: line([12.0, 14.0, 16.0, 18.0]),
        }
    }

    #[test]
    fn tests_stand_beside_brute_force_and_boxes_that_are_not_counted_are_left_out() {
        let page = tests(&sizes([12.0, 14.0, 16.0, 18.0])).unwrap().markup().into_string();
        assert!(page.contains("Of 32768 triangles 18 are tested a ray"), "{page}");
        assert!(page.contains("brute force 1820 times as many"), "{page}");
        assert!(page.contains("log n from the first") && !page.contains("boxes, closest hit"));
        assert_eq!(page.matches("<title>").count(), 1 + 8);
        assert!(!page.contains("not drawn"));
    }

    #[test]
    fn the_guide_doubles_where_the_size_is_squared() {
        assert_eq!(guide(&[100.0, 10_000.0], 7.0)[1], [10_000.0, 14.0]);
    }

    #[test]
    fn counts_of_nothing_are_said() {
        let page = tests(&sizes([f64::NAN, 0.0, 1.0, 1.0])).unwrap().markup().into_string();
        assert!(page.contains("2 values are not drawn"), "{page}");
    }

    #[test]
    fn a_speed_up_is_drawn_with_its_interval() {
        let times = SpeedUps {
            ratios: OneLine::rounded([28.0, 30.0, 31.0, 1.5]),
            median: 29.0,
            interval: Some([1.5, 31.0]),
            at_least: 2.0,
        };
        let page = speed_up(&times).unwrap().markup().into_string();
        assert!(
            page.contains(
                "29 times as fast (95 % interval 1.5 to 31), the median of 4 pairs; 3 of them"
            ),
            "{page}"
        );
        let stopped = SpeedUps {
            ratios: OneLine::rounded([f64::NAN; 2]),
            median: f64::NAN,
            interval: None,
            at_least: 2.0,
        };
        assert!(
            speed_up(&stopped).unwrap().markup().into_string().contains("2 values are not drawn")
        );
    }
}
