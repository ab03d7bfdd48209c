//! Plots: SVG with the words beside it, drawn here, so that they need no script, print, and follow the colours of the
//! page. A kind of plot is a file here; what it shows comes from the series and measures of a sidecar.

mod figure;
mod sphere;

use crate::checks::Finding;
use crate::checks::series::Series;
use maud::Markup;

/// The plots of a trial.
pub(super) fn of_finding(finding: &Finding) -> Vec<Markup> {
    finding.series.iter().filter_map(of_series).collect()
}

fn of_series(series: &Series) -> Option<Markup> {
    match series {
        Series::Directions(counts) => sphere::plot(counts),
    }
}
