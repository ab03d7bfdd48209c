//! Plots: SVG with the words beside it, drawn here, so that they need no script, print, and follow the colours of the
//! page. A kind of plot is a file here; what it shows comes from the series and measures of a sidecar.

mod bvh;
mod chart;
mod convergence;
mod energy;
mod figure;
pub(super) mod history;
pub(super) mod p_values;
mod scale;
mod sphere;
mod stops;

use crate::checks::Finding;
use crate::checks::series::Series;
use figure::Figure;

/// The plots of a trial.
pub(super) fn of_finding(finding: &Finding) -> Vec<Figure> {
    let mut plots: Vec<_> = energy::plot(finding)
        .into_iter()
        .chain(finding.series.iter().filter_map(of_series))
        .collect();
    tell_once(&mut plots);
    plots
}

/// What one should see is told by the first of several plots of a kind.
pub(super) fn tell_once(plots: &mut [Figure]) {
    for later in (1..plots.len()).rev() {
        if plots[later].should == plots[later - 1].should {
            plots[later].should = "";
        }
    }
}

/// The first plot by bounces, which says where light goes wrong; or else the first of those that show what fails. Maps of
/// directions are heavy: they are for `large` places.
pub(super) fn most_telling(findings: &[&Finding], large: bool) -> Option<Figure> {
    let tells = |series: &&Series| match series {
        Series::Directions(counts) => large && counts.chi_square > counts.critical,
        // An error that falls as noise does says nothing of a cause.
        Series::Convergence(errors) => errors.is_wrong(),
        _ => true,
    };
    let mut series = findings.iter().flat_map(|finding| &finding.series).filter(tells);
    let mut wrong = findings.iter().filter(|finding| energy::is_wrong(finding));
    let by_bounce = wrong.find_map(|finding| energy::plot(finding));
    by_bounce.or_else(|| series.find_map(of_series))
}

fn of_series(series: &Series) -> Option<Figure> {
    match series {
        Series::Directions(counts) => sphere::plot(counts),
        Series::Convergence(errors) => convergence::plot(errors),
        Series::TestsBySize(tests) => bvh::tests(tests),
        Series::SpeedUp(times) => bvh::speed_up(times),
        Series::Stops(counts) => stops::counts(counts),
        Series::Survival(survival) => stops::survival(survival),
    }
}
