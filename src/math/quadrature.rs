//! Adaptive Gauss-Kronrod quadrature, on the line and over rectangles, with an estimate of its own
//! error.
//!
//! Over rectangles the integrand answers whole batches of points, because it may live behind a
//! process boundary. Both converge fast where the integrand is smooth: split panels where it is
//! known to have kinks.
//!
//! Source of rule and error estimate: Piessens et al., QUADPACK (1983), routine QK15.

use glam::DVec2;

/// Non-negative nodes of the 15-point Kronrod rule on [−1, 1], their weights, and those of the 7-point Gauss rule, whose
/// nodes are every second one.
const RULE: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4),
];
/// Nodes of the full rule.
const POINTS: usize = 15;
/// A panel is halved at most this often.
const MOST_HALVINGS: u32 = 40;
/// Rectangles evaluated in one batch.
const BATCH: usize = 64;

/// The value of an integral, and how far it may be from the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Integral {
    pub(crate) value: f64,
    /// Bound on its error, as far as the rule can tell.
    pub(crate) error: f64,
}

impl std::ops::AddAssign for Integral {
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error;
    }
}

/// Node `index` of the full rule on [−1, 1], with its Kronrod and its Gauss weight.
fn node(index: usize) -> (f64, f64, f64) {
    let (at, kronrod, gauss) = RULE[index.min(POINTS - 1 - index)];
    let side = if index < 7 { -1.0 } else { 1.0 };
    (side * at, kronrod, gauss)
}

/// QUADPACK's rescaling: the difference of the two rules, pessimistic where they nearly agree.
/// `spread` is the integral of |f − mean f|.
fn rescaled_error(difference: f64, spread: f64) -> f64 {
    if spread == 0.0 || difference == 0.0 {
        return difference;
    }
    spread * (200.0 * difference / spread).powf(1.5).min(1.0)
}

/// The integral of `f` over the pieces between successive `breaks`, each to an absolute error of
/// `tolerance`. Put a break at every kink.
pub(crate) fn integrate(breaks: &[f64], tolerance: f64, mut f: impl FnMut(f64) -> f64) -> Integral {
    let mut whole = Integral::default();
    for piece in breaks.windows(2) {
        whole += integrate_piece(piece[0], piece[1], tolerance, 0, &mut f);
    }
    whole
}

fn integrate_piece(
    from: f64,
    to: f64,
    tolerance: f64,
    halvings: u32,
    f: &mut impl FnMut(f64) -> f64,
) -> Integral {
    let estimate = kronrod(from, to, f);
    if estimate.error <= tolerance || halvings == MOST_HALVINGS {
        return estimate;
    }
    let middle = 0.5 * (from + to);
    let mut sum = integrate_piece(from, middle, 0.5 * tolerance, halvings + 1, f);
    sum += integrate_piece(middle, to, 0.5 * tolerance, halvings + 1, f);
    sum
}

fn kronrod(from: f64, to: f64, f: &mut impl FnMut(f64) -> f64) -> Integral {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let values: [f64; POINTS] = std::array::from_fn(|i| f(centre + half * node(i).0));
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for (i, value) in values.into_iter().enumerate() {
        let (_, kronrod_weight, gauss_weight) = node(i);
        kronrod += kronrod_weight * value;
        gauss += gauss_weight * value;
    }
    let mean = 0.5 * kronrod;
    let spread: f64 =
        values.into_iter().enumerate().map(|(i, v)| node(i).1 * (v - mean).abs()).sum();
    let error = rescaled_error((kronrod - gauss).abs() * half, spread * half);
    Integral { value: kronrod * half, error }
}

/// An axis-parallel rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
}

impl Rectangle {
    fn halves(self, along_x: bool) -> [Rectangle; 2] {
        let middle = 0.5 * (self.low + self.high);
        let (mut left, mut right) = (self, self);
        if along_x {
            (left.high.x, right.low.x) = (middle.x, middle.x);
        } else {
            (left.high.y, right.low.y) = (middle.y, middle.y);
        }
        [left, right]
    }
}

/// Writes its values at many points of the plane.
pub(crate) type BatchIntegrand<'a, E> = dyn FnMut(&[DVec2], &mut [f64]) -> Result<(), E> + 'a;

/// How hard [`integrate_rectangles`] tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Diligence {
    /// Absolute error wanted of each rectangle.
    pub(crate) tolerance: f64,
    /// Evaluations of the integrand over all rectangles; when they are spent, the errors stay what they
    /// are.
    pub(crate) most_evaluations: usize,
}

impl Diligence {
    /// For pdfs with kinks along curves, at which no rectangle can be cut.
    pub(crate) const KINKED: Self = Self { tolerance: 1e-6, most_evaluations: 2_500_000 };
}

impl Default for Diligence {
    /// 1e-6 of probability a cell costs a χ² test of millions of samples nothing.
    fn default() -> Self {
        Self { tolerance: 1e-6, most_evaluations: 8_000_000 }
    }
}

#[derive(Clone, Copy)]
struct Part {
    owner: usize,
    area: Rectangle,
    halvings: u32,
}

/// The estimate over a part, and which halving would help more.
struct Estimate {
    part: Part,
    integral: Integral,
    split_x: bool,
    is_zero: bool,
}

/// The integral of `f` over each rectangle. `f` writes the values at the points it is given; it is
/// asked for many points at a time.
///
/// Of each rectangle whose parts together are not known well enough, those are halved that have more
/// than their share of the error. So a kink along a curve costs as many parts as lie on it.
pub(crate) fn integrate_rectangles<E>(
    rectangles: &[Rectangle],
    diligence: Diligence,
    f: &mut BatchIntegrand<'_, E>,
) -> Result<Vec<Integral>, E> {
    let whole = |(owner, &area)| Part { owner, area, halvings: 0 };
    let mut open: Vec<Part> = rectangles.iter().enumerate().map(whole).collect();
    let mut known: Vec<Vec<Estimate>> = rectangles.iter().map(|_| Vec::new()).collect();
    let mut evaluations = 0;
    while !open.is_empty() {
        evaluations += open.len() * POINTS * POINTS;
        for batch in open.chunks(BATCH) {
            evaluate(batch, f)?.into_iter().for_each(|one| known[one.part.owner].push(one));
        }
        let affordable = diligence.most_evaluations.saturating_sub(evaluations);
        open = halved(&mut known, diligence.tolerance, affordable / (POINTS * POINTS));
    }
    let sum = |parts: Vec<Estimate>| {
        let mut sum = Integral::default();
        parts.iter().for_each(|part| sum += part.integral);
        sum
    };
    Ok(known.into_iter().map(sum).collect())
}

/// Takes out what is not known well enough, in halves; nothing if there are more of them than are
/// `affordable`.
fn halved(known: &mut [Vec<Estimate>], tolerance: f64, affordable: usize) -> Vec<Part> {
    let is_open = |parts: &[Estimate]| {
        let errors = parts.iter().map(|part| part.integral.error).filter(|error| !error.is_nan());
        let share = if errors.sum::<f64>() > tolerance {
            tolerance / parts.len() as f64
        } else {
            f64::INFINITY
        };
        parts.iter().map(|part| part.is_open(share)).collect::<Vec<_>>()
    };
    let marks: Vec<Vec<bool>> = known.iter().map(|parts| is_open(parts)).collect();
    if 2 * marks.iter().flatten().filter(|is_open| **is_open).count() > affordable {
        return Vec::new();
    }
    let mut halves = Vec::new();
    for (parts, marks) in known.iter_mut().zip(marks) {
        let mut marks = marks.into_iter();
        parts.retain(|part| {
            let is_kept = !marks.next().unwrap_or(false);
            if !is_kept {
                halves.extend(part.halves());
            }
            is_kept
        });
    }
    halves
}

impl Estimate {
    /// Whether halving may help: it does not against NaN, which goes into the sum. Zero at all nodes is
    /// believed only of small parts, for a narrow lobe may stand between them.
    fn is_open(&self, share_of_error: f64) -> bool {
        let is_doubtful = self.is_zero && self.part.halvings < 3;
        (self.integral.error > share_of_error || is_doubtful) && self.part.halvings < MOST_HALVINGS
    }

    fn halves(&self) -> impl Iterator<Item = Part> {
        let Part { owner, area, halvings } = self.part;
        let halvings = halvings + 1;
        area.halves(self.split_x).into_iter().map(move |area| Part { owner, area, halvings })
    }
}

fn evaluate<E>(parts: &[Part], f: &mut BatchIntegrand<'_, E>) -> Result<Vec<Estimate>, E> {
    let mut points = Vec::with_capacity(parts.len() * POINTS * POINTS);
    for part in parts {
        let centre = 0.5 * (part.area.low + part.area.high);
        let half = 0.5 * (part.area.high - part.area.low);
        for row in 0..POINTS {
            points.extend((0..POINTS).map(|i| centre + half * DVec2::new(node(i).0, node(row).0)));
        }
    }
    let mut values = vec![f64::NAN; points.len()];
    f(&points, &mut values)?;
    let values = values.chunks_exact(POINTS * POINTS);
    Ok(parts.iter().zip(values).map(|(part, values)| estimate(*part, values)).collect())
}

/// The product rule over one rectangle; `values` row by row.
fn estimate(part: Part, values: &[f64]) -> Estimate {
    let size = part.area.high - part.area.low;
    let scale = 0.25 * size.x * size.y;
    let (mut both, mut coarse_x, mut coarse_y) = (0.0, 0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let (_, fine_x, gauss_x) = node(i % POINTS);
        let (_, fine_y, gauss_y) = node(i / POINTS);
        both += fine_x * fine_y * value;
        coarse_x += gauss_x * fine_y * value;
        coarse_y += fine_x * gauss_y * value;
    }
    let mean = 0.25 * both;
    let weight = |i: usize| node(i % POINTS).1 * node(i / POINTS).1;
    let spread: f64 = values.iter().enumerate().map(|(i, v)| weight(i) * (v - mean).abs()).sum();
    let error_x = rescaled_error((both - coarse_x).abs() * scale, spread * scale);
    let error_y = rescaled_error((both - coarse_y).abs() * scale, spread * scale);
    Estimate {
        part,
        integral: Integral { value: both * scale, error: error_x + error_y },
        split_x: if error_x == error_y { size.x >= size.y } else { error_x > error_y },
        is_zero: values.iter().all(|&value| value == 0.0),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::convert::Infallible;
    use std::f64::consts::PI;

    fn monomial(power: i32) -> impl FnMut(f64) -> f64 {
        move |x| x.powi(power)
    }

    #[test]
    fn one_panel_is_exact_for_polynomials_of_degree_22() {
        for power in 0..=22 {
            let found = kronrod(-1.0, 2.0, &mut monomial(power)).value;
            let expected = (2f64.powi(power + 1) - (-1f64).powi(power + 1)) / f64::from(power + 1);
            assert!((found / expected - 1.0).abs() < 1e-13, "degree {power}: {found}");
        }
    }

    #[test]
    fn a_smooth_integral_is_right_to_rounding_and_a_kink_to_its_tolerance() {
        assert!((integrate(&[0.0, PI], 1e-12, f64::sin).value - 2.0).abs() < 1e-14);
        let kink = integrate(&[0.0, 1.0], 1e-9, |x| (x - 0.3).abs());
        assert!((kink.value - 0.29).abs() < 1e-9 && kink.error <= 1e-9);
        let declared = integrate(&[0.0, 0.3, 1.0], 1e-9, |x| (x - 0.3).abs());
        assert!((declared.value - 0.29).abs() < 1e-15);
    }

    const SQUARE: Rectangle = Rectangle { low: DVec2::ZERO, high: DVec2::ONE };

    /// The integral of a function that never fails.
    pub(crate) fn over(
        area: Rectangle,
        diligence: Diligence,
        mut f: impl FnMut(DVec2) -> f64,
    ) -> Integral {
        let mut batch = |points: &[DVec2], values: &mut [f64]| {
            points.iter().zip(values).for_each(|(p, v)| *v = f(*p));
            Ok::<_, Infallible>(())
        };
        let Ok(sums) = integrate_rectangles(&[area], diligence, &mut batch);
        sums[0]
    }

    #[test]
    fn a_rectangle_agrees_with_the_product_of_lines() {
        let found = over(SQUARE, Diligence::default(), |p| p.x.exp() * (3.0 * p.y).cos());
        let expected = (1f64.exp() - 1.0) * 3f64.sin() / 3.0;
        assert!((found.value - expected).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_narrow_lobe_between_the_nodes_is_found() {
        let lobe = |p: DVec2| (-(p - DVec2::new(0.71, 0.33)).length_squared() / 2e-4).exp();
        let found = over(SQUARE, Diligence::default(), lobe);
        assert!((found.value - 2e-4 * PI).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_kink_along_a_curve_costs_the_parts_that_lie_on_it() {
        let mut asked = 0;
        let found = over(SQUARE, Diligence::default(), |p| {
            asked += 1;
            (1.0 - p.length_squared()).abs()
        });
        let expected = PI / 4.0 - 1.0 / 3.0;
        assert!((found.value - expected).abs() < 1e-6 && found.error <= 1e-6, "{found:?}");
        assert!(asked < 1_000_000, "{asked}");
    }

    #[test]
    fn a_jump_that_costs_too_much_is_admitted_in_the_error() {
        let disk = |p: DVec2| f64::from(u8::from(p.length() < 1.0));
        let hurried = Diligence { tolerance: 1e-9, most_evaluations: 20_000 };
        let found = over(SQUARE, hurried, disk);
        assert!(found.error > 1e-9);
        assert!((found.value - PI / 4.0).abs() <= found.error, "{found:?}");
    }
}
