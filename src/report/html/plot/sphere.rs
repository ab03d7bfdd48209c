//! Samples in cells of the sphere, as χ² counts them: observed, expected and residual, each an equal-area map with the
//! pole in its centre. What is below the horizon is a ring around it, or a map of its own where samples belong there.

use super::figure::{Figure, Mark, Shape, px, svg};
use crate::checks::series::SphereCounts;
use crate::text::number::{figure, percent};
use maud::{Markup, html};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Radius of the map of a hemisphere.
const RADIUS: f64 = 74.0;
/// The ring of all that is below the horizon, around that.
const BELOW: [f64; 2] = [77.0, 84.0];
/// Sides of a map with the words below it.
const SIDE: f64 = 2.0 * BELOW[1] + 4.0;
/// A residual of so many standard deviations has the full colour, where none is larger.
const FULL: f64 = 4.0;
/// A cell that fewer samples are expected in is no more certain than one with so many.
const FEWEST: f64 = 1.0;

const SHOULD: &str = "Observed and expected look the same, and residuals are pale, of both signs, without a pattern. \
    Rings of one sign: the polar angle θ follows another pdf. Sectors: the azimuth φ does, or the frame is rotated. \
    One sign nearly everywhere, or a ring below the horizon: the pdf is not normalised, or samples are not where it is defined.";

/// A cell: where it is, and what fell there.
struct Cell {
    /// Its ring and its sector, of so many.
    place: [usize; 2],
    sectors: usize,
    /// Range of cos θ, and of φ.
    z: [f64; 2],
    phi: [f64; 2],
    observed: f64,
    expected: f64,
    is_rejected: bool,
}

impl Cell {
    /// (O − E)/√E: NaN where the pdf is.
    fn residual(&self) -> f64 {
        (self.observed - self.expected) / self.expected.max(FEWEST).sqrt()
    }

    /// In the map around the normal, and not in that around its opposite.
    fn is_around_normal(&self) -> bool {
        self.z[1] > 0.0 || self.z == [-1.0, 0.0]
    }

    /// Inner and outer radius in the map of its hemisphere.
    fn radii(&self) -> [f64; 2] {
        match self.z {
            [-1.0, 0.0] => BELOW,
            [low, high] if high > 0.0 => [high, low].map(|z| RADIUS * (1.0 - z).max(0.0).sqrt()),
            z => z.map(|z| RADIUS * (1.0 + z).max(0.0).sqrt()),
        }
    }

    /// The outline, as a path.
    fn path(&self) -> String {
        let [inner, outer] = self.radii();
        let [from, to] = self.phi;
        let back = match inner > 0.5 {
            true => format!("L{}{}", at(inner, to), arc(inner, from, 1)),
            false => "L0 0".to_owned(),
        };
        format!("M{}{}{back}z", at(outer, from), arc(outer, to, 0))
    }

    /// The sides at which another cell of these does not go on the same way: inner, outer, from, to.
    fn edges(&self, goes_on: [bool; 4]) -> String {
        let ([inner, outer], [from, to]) = (self.radii(), self.phi);
        let along = |radius: f64| format!("M{}{}", at(radius, from), arc(radius, to, 0));
        let across = |phi: f64| format!("M{}L{}", at(inner, phi), at(outer, phi));
        let edges = [along(inner), along(outer), across(from), across(to)];
        let open = edges.into_iter().zip(goes_on).filter(|(_, goes_on)| !goes_on);
        open.map(|(edge, _)| edge).collect()
    }

    /// The places at its sides: inner, outer, from, to.
    fn beside(&self) -> [[usize; 2]; 4] {
        let ([ring, sector], all) = (self.place, self.sectors);
        let (above, below) = (ring + 1, ring.wrapping_sub(1));
        let [inner, outer] = if self.is_around_normal() { [above, below] } else { [below, above] };
        let sides = [(sector + all - 1) % all, (sector + 1) % all].map(|sector| [ring, sector]);
        [[inner, sector], [outer, sector], sides[0], sides[1]]
    }

    /// Whether a sign within it can be read.
    fn has_room(&self) -> bool {
        let [inner, outer] = self.radii();
        outer - inner > 6.0 && 0.5 * (inner + outer) * (self.phi[1] - self.phi[0]) > 6.0
    }

    fn words(&self) -> String {
        let [far, near] = self.z.map(|z| z.clamp(-1.0, 1.0).acos().to_degrees());
        let [from, to] = self.phi.map(|phi| phi.to_degrees().rem_euclid(360.0));
        format!(
            "θ {near:.0}° to {far:.0}°, φ {from:.0}° to {to:.0}°: {} observed, {} expected, {} standard deviations",
            figure(self.observed),
            figure(self.expected),
            signed(self.residual())
        )
    }
}

fn signed(value: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{}", figure((value * 10.0).round() / 10.0))
}

/// A place in a map.
fn at(radius: f64, phi: f64) -> String {
    format!("{} {}", px(radius * phi.cos()), px(-radius * phi.sin()))
}

/// An arc from where the pen is to `phi`.
fn arc(radius: f64, phi: f64, sweep: u8) -> String {
    format!("A{0} {0} 0 0 {sweep} {1}", px(radius), at(radius, phi))
}

/// The cells; none if the series does not fit together.
fn cells(counts: &SphereCounts) -> Option<Vec<Cell>> {
    let all = counts.rings.len().checked_sub(1)? * counts.sectors;
    let fits = counts.sectors >= 3 && counts.observed.len() == all && counts.expected.len() == all;
    let width = std::f64::consts::TAU / counts.sectors as f64;
    let cell = |number: usize| {
        let (ring, sector) = (number / counts.sectors, number % counts.sectors);
        let from = counts.offset + sector as f64 * width;
        Cell {
            place: [ring, sector],
            sectors: counts.sectors,
            z: [counts.rings[ring], counts.rings[ring + 1]],
            phi: [from, from + width],
            observed: counts.observed[number] as f64,
            expected: counts.expected[number],
            is_rejected: counts.rejected.contains(&number),
        }
    };
    (fits && all > 0).then(|| (0..all).map(cell).collect())
}

/// How a cell is coloured: by which class, how strongly.
type Shade<'a> = dyn Fn(&Cell) -> (&'static str, f64) + 'a;

pub(super) fn plot(counts: &SphereCounts) -> Option<Figure> {
    let cells = cells(counts)?;
    let finite = |values: &dyn Fn(&Cell) -> f64| {
        cells.iter().map(values).map(f64::abs).filter(|value| value.is_finite()).fold(0.0, f64::max)
    };
    let most = finite(&|cell| cell.observed).max(finite(&|cell| cell.expected));
    let full = finite(&Cell::residual).max(FULL);
    let strength = |value: f64| if most > 0.0 { (value / most).max(0.0).sqrt() } else { 0.0 };
    let residual = |cell: &Cell| {
        let residual = cell.residual();
        (if residual > 0.0 { "more" } else { "less" }, residual.abs() / full)
    };
    let drawing = html! {
        div.maps {
            (map("observed", &cells, &|cell| ("data", strength(cell.observed)), counts, false))
            (map("expected", &cells, &|cell| ("data", strength(cell.expected)), counts, false))
            (map("residual", &cells, &residual, counts, true))
        }
        (scales(most, full, !counts.rejected.is_empty()))
    };
    let figure = Figure {
        title: format!("Samples of {} by direction", counts.of),
        drawing,
        legend: Vec::new(),
        found: found(counts, &cells),
        should: SHOULD,
        left_out: cells.iter().filter(|cell| !cell.residual().is_finite()).count(),
    };
    Some(figure)
}

/// One map: of the hemisphere around the normal, and below it of the other one where samples belong there.
fn map(
    name: &str,
    cells: &[Cell],
    shade: &Shade<'_>,
    counts: &SphereCounts,
    is_residual: bool,
) -> Markup {
    let has_lower = cells.iter().any(|cell| !cell.is_around_normal());
    let height = if has_lower { 2.0 * SIDE + 26.0 } else { SIDE };
    let description = format!(
        "Equal-area map of the {name} of {} cells, the normal in the centre, the horizon at the rim.",
        cells.len()
    );
    let (upper, lower): (Vec<_>, Vec<_>) = cells.iter().partition(|cell| cell.is_around_normal());
    let marks = html! {
        (disc(&upper, shade, SIDE / 2.0, is_residual))
        @if has_lower {
            text x=(px(SIDE / 2.0)) y=(px(SIDE + 16.0)) text-anchor="middle" { "below the surface" }
            (disc(&lower, shade, 1.5 * SIDE + 24.0, is_residual))
        }
    };
    let title = format!("{name} of {}", counts.of);
    html! {
        div.map {
            p.map-name { (name) }
            (svg([SIDE, height], &title, &description, &marks))
        }
    }
}

fn disc(cells: &[&Cell], shade: &Shade<'_>, y: f64, is_residual: bool) -> Markup {
    let (known, unknown): (Vec<_>, Vec<_>) =
        cells.iter().partition(|cell| cell.residual().is_finite());
    html! {
        g transform={ "translate(" (px(SIDE / 2.0)) " " (px(y)) ")" } {
            circle.rim r=(px(RADIUS)) {}
            @if is_residual {
                @for cell in known { (shaded(shade(cell), &cell.path(), &cell.words())) }
            } @else {
                @for (shade, path) in in_few_shades(&known, shade) { (shaded(shade, &path, "")) }
            }
            @for cell in unknown { path.nan d=(cell.path()) { title { (cell.words()) } } }
            @if is_residual { (outlines(cells)) }
        }
    }
}

fn shaded((class, strength): (&str, f64), path: &str, title: &str) -> Markup {
    html! {
        path class=(class) fill-opacity=(format!("{:.2}", strength.min(1.0))) d=(path) {
            @if !title.is_empty() { title { (title) } }
        }
    }
}

/// The cells of each of some fifty shades as one path: nobody points at a single one.
fn in_few_shades(cells: &[&Cell], shade: &Shade<'_>) -> Vec<((&'static str, f64), String)> {
    let mut paths = BTreeMap::<_, String>::new();
    for cell in cells {
        let (class, strength) = shade(cell);
        *paths.entry((class, (50.0 * strength) as u32)).or_default() += &cell.path();
    }
    let is_seen = |((_, shade), _): &((&str, u32), String)| *shade > 0;
    let paths = paths.into_iter().filter(is_seen);
    paths.map(|((class, shade), path)| ((class, f64::from(shade) / 50.0), path)).collect()
}

/// Around the cells that are rejected, regions of one sign as a whole.
fn outlines(cells: &[&Cell]) -> Markup {
    let kind = |cell: &Cell| cell.is_rejected.then(|| cell.residual() > 0.0);
    let known: BTreeMap<_, _> = cells.iter().map(|cell| (cell.place, kind(cell))).collect();
    let rejected = || cells.iter().filter(|cell| cell.is_rejected);
    let outline = |cell: &&Cell| {
        cell.edges(cell.beside().map(|place| known.get(&place) == Some(&kind(cell))))
    };
    let outlines: String = rejected().map(outline).collect();
    let signs: String = rejected().filter(|cell| cell.has_room()).map(|cell| sign(cell)).collect();
    html! {
        @if !outlines.is_empty() { path.rejected d=(outlines) {} path.sign d=(signs) {} }
    }
}

/// Plus or minus in the middle of a cell: colour is never alone.
fn sign(cell: &Cell) -> String {
    let [inner, outer] = cell.radii();
    let (radius, phi) = (0.5 * (inner + outer), 0.5 * (cell.phi[0] + cell.phi[1]));
    let (x, y) = (radius * phi.cos(), -radius * phi.sin());
    let mut path = format!("M{} {}h4", px(x - 2.0), px(y));
    if cell.residual() > 0.0 {
        let _ = write!(path, "M{} {}v4", px(x), px(y - 2.0));
    }
    path
}

/// What the strengths of the colours stand for.
fn scales(most: f64, full: f64, has_rejected: bool) -> Markup {
    let steps = |class: &'static str, strengths: [f64; 5]| {
        html! {
            svg.ramp viewBox="0 0 60 10" width="60" height="10" aria-hidden="true" {
                @for (number, strength) in strengths.iter().enumerate() {
                    rect class=(class) x=(12 * number) width="12" height="10"
                        fill-opacity=(format!("{strength:.2}")) {}
                }
            }
        }
    };
    let rising = [0.0, 0.25, 0.5, 0.75, 1.0];
    html! {
        ul.key {
            li { "0 " (steps("data", rising)) " " (figure(most)) " samples a cell, square-root scale" }
            li { "−" (figure(full)) " " (steps("less", [1.0, 0.75, 0.5, 0.25, 0.0])) (steps("more", rising)) " +"
                (figure(full)) " standard deviations, (O − E)/√E" }
            @if has_rejected {
                li {
                    svg viewBox="0 0 22 12" width="22" height="12" aria-hidden="true" {
                        (Mark::new("rejected", Shape::Outline).at(11.0, 6.0, ""))
                    }
                    "cell rejected for itself"
                }
            }
        }
    }
}

/// What is there, in numbers.
fn found(counts: &SphereCounts, cells: &[Cell]) -> String {
    let samples: u64 = counts.observed.iter().sum();
    let tested = format!(
        "{samples} samples in {} cells of equal solid angle: χ² = {} with {} degrees of freedom, rejected above {}.",
        cells.len(),
        figure(counts.chi_square),
        counts.degrees_of_freedom,
        figure(counts.critical)
    );
    let far = |cell: &&Cell| cell.residual().is_finite();
    let worst =
        cells.iter().filter(far).max_by(|a, b| a.residual().abs().total_cmp(&b.residual().abs()));
    let worst = worst.map(|cell| format!(" Furthest off: {}.", cell.words())).unwrap_or_default();
    format!("{tested} {}{}{worst}", rejected(counts), failed(counts))
}

fn rejected(counts: &SphereCounts) -> String {
    match (counts.rejected.len(), counts.chi_square > counts.critical) {
        (0, false) => "No cell is rejected.".to_owned(),
        (0, true) => {
            "No cell is rejected for itself: the error is spread over all of them.".to_owned()
        }
        (1, _) => "1 cell is rejected for itself.".to_owned(),
        (many, _) => format!("{many} cells are rejected, each for itself."),
    }
}

/// Samples that failed, where some did or should have.
fn failed(counts: &SphereCounts) -> String {
    let all = counts.observed.iter().sum::<u64>() as f64;
    match counts.failed[..] {
        [observed, expected] if observed > 0.0 || expected > 1e-6 * all => format!(
            " {} of all samples failed, {} expected.",
            percent(observed / (all + observed)),
            percent(expected / (all + observed))
        ),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::series::OneLine;

    /// Two rings above the horizon and one below, four sectors.
    pub(crate) fn counts() -> SphereCounts {
        SphereCounts {
            of: "the <cosine> hemisphere".to_owned(),
            rings: OneLine::rounded([-1.0, 0.0, 0.5, 1.0]),
            sectors: 4,
            offset: 0.3,
            observed: [0, 0, 0, 0, 60, 70, 65, 66, 180, 190, 10, 188].into_iter().collect(),
            expected: OneLine::rounded([0.0; 4].into_iter().chain([65.0; 4]).chain([187.0; 4])),
            failed: OneLine::rounded([3.0, 0.0]),
            rejected: [10].into_iter().collect(),
            chi_square: 170.0,
            degrees_of_freedom: 7.0,
            critical: 26.0,
        }
    }

    fn drawn(counts: &SphereCounts) -> String {
        plot(counts).unwrap().markup().into_string()
    }

    #[test]
    fn every_cell_is_drawn_and_the_rejected_one_is_outlined_with_its_sign() {
        let page = drawn(&counts());
        assert_eq!(page.matches("<svg role=\"img\"").count(), 3);
        assert_eq!(page.matches("standard deviations</title>").count(), 12);
        assert_eq!(page.matches("class=\"rejected\"").count(), 1);
        assert!(
            page.contains("θ 0° to 60°, φ 197° to 287°: 10 observed, 187 expected, -12.9"),
            "{page}"
        );
        assert!(
            page.contains("1 cell is rejected for itself.") && page.contains("What one should see")
        );
        assert!(page.contains("0.361 % of all samples failed, 0 % expected"), "{page}");
        assert!(page.contains("&lt;cosine&gt;") && !page.contains("<cosine>"));
    }

    #[test]
    fn cells_of_equal_solid_angle_have_equal_areas() {
        let area = |cell: &Cell| {
            let [inner, outer] = cell.radii();
            (outer * outer - inner * inner) * (cell.phi[1] - cell.phi[0])
        };
        let cells = cells(&counts()).unwrap();
        assert!((area(&cells[4]) / area(&cells[8]) - 1.0).abs() < 1e-12);
        assert_eq!(cells[8].radii()[0], 0.0);
        assert!((cells[4].radii()[1] - RADIUS).abs() < 1e-12);
    }

    #[test]
    fn a_pdf_that_is_nan_is_said_and_not_coloured() {
        let mut values: Vec<_> = counts().expected.to_vec();
        values[5] = f64::NAN;
        let nan = SphereCounts { expected: OneLine::rounded(values), ..counts() };
        let page = drawn(&nan);
        assert!(page.contains("1 value is not drawn"), "{page}");
        assert_eq!(page.matches("class=\"nan\"").count(), 3);
        assert!(!page.contains("=\"NaN"), "{page}");
    }

    #[test]
    fn cells_that_do_not_fit_together_are_not_drawn() {
        assert!(plot(&SphereCounts { sectors: 5, ..counts() }).is_none());
        assert!(plot(&SphereCounts { rings: OneLine::rounded([]), ..counts() }).is_none());
    }
}
