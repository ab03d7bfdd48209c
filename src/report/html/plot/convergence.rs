//! Error against samples per pixel: what falls as 1/√n, and what stays.

use super::chart::{Axis, Chart};
use super::figure::{Figure, Mark, Shape};
use super::scale::Scale;
use crate::checks::series::Convergence;
use crate::text::number::{count, figure, percent};

const SHOULD: &str = "The error falls along the 1/√n guide, to a quarter with sixteen times the samples, and its marks stand on those of the noise. \
    Where the error stays above the noise and flattens, the plateau is bias, unless it is as low as the noise of the reference. \
    Marks beside the guide that do not fall at all: samples repeat.";

/// Standard errors on each side of a 99.9 % interval.
const THREE_NINES: f64 = 3.29;

/// An error so many times the 1/√n guide has not fallen as it should.
const STUCK: f64 = 2.0;

const ERROR: Mark = Mark::new("line-a", Shape::Circle);
const NOISE: Mark = Mark::new("line-b", Shape::Frame);

impl Convergence {
    fn places(&self) -> impl Iterator<Item = (f64, [f64; 3])> {
        let values = self.error.iter().zip(self.uncertainty.iter()).zip(self.noise.iter());
        let values = values.map(|((error, uncertainty), noise)| [*error, *uncertainty, *noise]);
        self.samples.iter().map(|samples| *samples as f64).zip(values)
    }

    /// What the error of the most samples has beside its noise and that of the reference.
    fn plateau(&self) -> Option<f64> {
        let (_, [error, _, noise]) = self.places().last()?;
        let square = error.powi(2) - noise.powi(2) - self.reference_noise.powi(2);
        square.is_finite().then(|| square.max(0.0).sqrt())
    }

    /// Whether something is left that samples do not take away: bias, or noise that does not fall.
    pub(super) fn is_wrong(&self) -> bool {
        let ends = (guide(self).pop(), self.places().last());
        let (Some([_, fallen]), Some((_, [error, ..]))) = ends else { return false };
        self.bias().is_some() || error > STUCK * fallen
    }

    /// The plateau, where it is more than the noise of one picture can bring.
    fn bias(&self) -> Option<f64> {
        let (_, [error, _, noise]) = self.places().last()?;
        self.plateau().filter(|_| error > 1.2 * noise.hypot(self.reference_noise))
    }
}

pub(super) fn plot(errors: &Convergence) -> Option<Figure> {
    let chart = chart(errors)?;
    let (title, found) = ("Error against samples per pixel".to_owned(), found(errors));
    let mut legend = vec![
        (ERROR, "error, root mean square, with its 99.9 % interval".to_owned()),
        (NOISE, "noise: how much pictures differ from each other".to_owned()),
        (Mark::new("guide", Shape::Line), "1/√n from the first".to_owned()),
    ];
    if errors.reference_noise > 0.0 {
        legend.push((Mark::new("line-c", Shape::Line), "noise of the reference".to_owned()));
    }
    if errors.bias().is_some() {
        legend.push((Mark::new("wrong", Shape::Line), "plateau: bias".to_owned()));
    }
    let drawing = chart.svg(&title, &found);
    Some(Figure { title, drawing, legend, found, should: SHOULD, left_out: chart.left_out })
}

fn chart(errors: &Convergence) -> Option<Chart> {
    let x = Scale::log(errors.samples.iter().map(|samples| *samples as f64))?;
    let floors = [errors.reference_noise, errors.bias().unwrap_or(0.0)];
    let guide = guide(errors);
    let values = errors.places().flat_map(|(_, [error, _, noise])| [error, noise]);
    let y = Scale::log(values.chain(floors).chain(guide.iter().map(|[_, error]| *error)))?;
    let mut chart = Chart::new(
        Axis::new("samples per pixel", x.with_room(0.04)),
        Axis::new("error / mean luminance", y.with_room(0.06)),
    );
    let ends = [errors.samples.first()?, errors.samples.last()?].map(|samples| *samples as f64);
    chart.line("guide", guide);
    for (class, floor) in
        ["line-c", "wrong"].into_iter().zip(floors).filter(|(_, floor)| *floor > 0.0)
    {
        chart.line(class, ends.map(|samples| [samples, floor]));
    }
    for (samples, [error, uncertainty, noise]) in errors.places() {
        let title =
            format!("{samples} samples: error {}, noise {}", percent(error), percent(noise));
        chart.point(NOISE, [samples, noise], "");
        if uncertainty.is_finite() {
            let half = THREE_NINES * uncertainty;
            chart.interval(ERROR.class, samples, [error - half, error + half]);
        }
        chart.point(ERROR, [samples, error], &title);
    }
    Some(chart)
}

/// From the first error that can be drawn, down by 1/√n.
fn guide(errors: &Convergence) -> Vec<[f64; 2]> {
    let first = errors.places().find(|(_, [error, ..])| error.is_finite() && *error > 0.0);
    let Some((first, [error, ..])) = first else { return Vec::new() };
    errors.places().map(|(samples, _)| [samples, error * (first / samples).sqrt()]).collect()
}

fn found(errors: &Convergence) -> String {
    let (Some((first, [from, ..])), Some((last, [to, _, noise]))) =
        (errors.places().next(), errors.places().last())
    else {
        return String::new();
    };
    let fall = format!(
        "{} of the mean luminance at {}, {} at {last}: as n^{}; noise alone has {} there.",
        percent(from),
        per_pixel(first),
        percent(to),
        figure((to / from).ln() / (last / first).ln()),
        percent(noise)
    );
    let floor = match (errors.bias(), errors.reference_noise) {
        (Some(bias), _) => format!("{} is left that no sample takes away: bias.", percent(bias)),
        (None, noise) if noise > 0.0 => {
            format!("No plateau; the reference itself has a noise of {}.", percent(noise))
        }
        _ => "No plateau.".to_owned(),
    };
    format!("{fall} {floor}")
}

/// `1 sample per pixel`
fn per_pixel(samples: f64) -> String {
    format!("{} per pixel", count(samples as usize, "sample"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::series::OneLine;

    fn errors(bias: f64, reference_noise: f64) -> Convergence {
        let samples = [4_u64, 16, 64, 256, 1024];
        let noise = samples.map(|n| (n as f64).sqrt().recip());
        let error = noise.map(|noise| noise.hypot(bias).hypot(reference_noise));
        Convergence {
            samples: samples.into_iter().collect(),
            error: OneLine::rounded(error),
            uncertainty: OneLine::rounded(error.map(|error| 0.02 * error)),
            noise: OneLine::rounded(noise),
            reference_noise,
        }
    }

    fn drawn(errors: &Convergence) -> String {
        plot(errors).unwrap().markup().into_string()
    }

    #[test]
    fn an_error_that_falls_has_no_plateau() {
        let page = drawn(&errors(0.0, 0.0));
        assert!(
            page.contains(
                "50 % of the mean luminance at 4 samples per pixel, 3.12 % at 1024: as n^-0.5"
            ),
            "{page}"
        );
        assert!(page.contains("No plateau.") && !page.contains("plateau: bias"));
        assert_eq!(page.matches("<title>").count(), 1 + 5);
    }

    #[test]
    fn what_stays_is_bias_and_not_the_noise_of_the_reference() {
        let biased = drawn(&errors(0.1, 0.01));
        assert!(biased.contains("10 % is left that no sample takes away"), "{biased}");
        assert!(biased.contains("plateau: bias") && biased.contains("noise of the reference"));
        let noisy = drawn(&errors(0.0, 0.1));
        assert!(noisy.contains("the reference itself has a noise of 10 %"), "{noisy}");
        assert!(!noisy.contains("plateau: bias"));
    }

    #[test]
    fn an_error_that_falls_as_noise_does_shows_nothing_wrong() {
        assert!(!errors(0.0, 0.0).is_wrong());
        assert!(errors(0.1, 0.0).is_wrong());
        let mut repeated = errors(0.0, 0.0);
        repeated.noise = OneLine::rounded([0.5; 5]);
        repeated.error = repeated.noise.clone();
        assert!(repeated.bias().is_none() && repeated.is_wrong());
    }

    #[test]
    fn pictures_of_nan_are_said_and_without_any_number_nothing_is_drawn() {
        let mut values = errors(0.0, 0.0);
        values.error = OneLine::rounded([0.5, f64::NAN, 0.1, f64::INFINITY, 0.03]);
        assert!(drawn(&values).contains("2 values are not drawn"));
        values.error = OneLine::rounded([f64::NAN; 5]);
        values.noise = OneLine::rounded([f64::NAN; 5]);
        assert!(plot(&values).is_none());
    }
}
