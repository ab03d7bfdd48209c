//! How much of a picture a light covers, and where: field of view, aspect and position, without any shading.

use crate::cause::image;
use crate::checks::phrase::{figure, percent};
use crate::checks::rendering::{Rendering, places};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Film};
use crate::stats::{Band, Claim, MeanReport, Verdict, judge_means};
use crate::text::{Count, Percent, Size};

/// Samples of a pixel in each run; more than one, since some cores send a lone sample through the centre.
const SAMPLES: u32 = 4;

check! {
    /// A light of radiance 1 before nothing covers a given share of the picture, around a given point of it.
    pub(crate) struct ViewCoverage {
        /// Columns and rows. Pixels stand for their centres, so that they should be small.
        size: Size,
        /// Of the picture.
        share: f64,
        /// In film coordinates, (0, 0) bottom left.
        centroid: [f64; 2],
        /// The smallest error, of the share or of the whole film's width, that must be seen.
        detects: Percent,
        /// Past this the verdict is inconclusive, never a pass.
        at_most: Count,
    }
    name: "view-coverage",
    summary: "how much of the picture a light covers, and where",
    needs: BUILD_SCENE | RENDER,
}

impl Check for ViewCoverage {
    fn validate(&self) -> Result<(), String> {
        let is_inside = |share: &f64| 0.0 < *share && *share < 1.0;
        let numbers = [self.share, self.centroid[0], self.centroid[1]];
        let are_inside = numbers.iter().all(is_inside);
        are_inside.then_some(()).ok_or("`share` and `centroid` lie between 0 and 1".to_owned())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let rendering = Rendering::of(&scene, self.size.0, [0, 0], SAMPLES)?;
        let of_a_film = u64::from(self.size.0[0]) * u64::from(self.size.0[1]) * u64::from(SAMPLES);
        let effort = context.effort(self.detects, self.at_most);
        let effort = effort.with_runs(32).in_steps_of(of_a_film);
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let reports = judge_means(&self.claims(), &effort, &mut |draw| {
            let films = draw.samples / of_a_film;
            let mut means = [0.0; 3];
            for number in 0..films {
                let film = rendering.film(built.as_mut(), draw.seed(seed).child(number).0, 0)?;
                let moments = moments(&film);
                means = std::array::from_fn(|i| means[i] + moments[i] / films as f64);
            }
            Ok::<_, CheckError>(means.to_vec())
        })?;
        Ok(self.finding(&reports))
    }
}

/// The mean of the picture, and of the picture times the film coordinates of its pixels.
fn moments(film: &Film) -> [f64; 3] {
    let [width, height] = [film.width, film.height].map(f64::from);
    let mut sums = [0.0; 3];
    for ([x, y], pixel) in places([film.width, film.height]).zip(&film.pixels) {
        let seen = f64::from(pixel[1]);
        sums[0] += seen;
        sums[1] += seen * (f64::from(x) + 0.5) / width;
        sums[2] += seen * (1.0 - (f64::from(y) + 0.5) / height);
    }
    sums.map(|sum| sum / (width * height))
}

impl ViewCoverage {
    /// Of the share itself and of its first moments; a moment's error counts relative to the share.
    fn claims(&self) -> [Claim; 3] {
        let moment =
            |at: f64| Claim { scale: self.share, ..Claim::value(self.share * at, Band::RADIANCE) };
        let [x, y] = self.centroid;
        [Claim::value(self.share, Band::RADIANCE), moment(x), moment(y)]
    }

    fn finding(&self, reports: &[MeanReport]) -> Finding {
        let names = ["share of the picture", "share times film x", "share times film y"];
        let measures = names.iter().zip(reports).map(|(name, report)| Measure::of(name, report));
        let share = reports[0].mean;
        let [x, y] = [reports[1].mean / share, reports[2].mean / share].map(figure);
        let covered =
            format!("the light covers {} of the picture, around ({x}, {y})", percent(share));
        let finding = Finding::measured(&covered, measures).in_terms(" of the share");
        if !finding.failed() {
            return finding;
        }
        let [x, y] = self.centroid.map(figure);
        let instead = format!("{covered}, instead of {} around ({x}, {y})", percent(self.share));
        self.explain(finding.complaining([instead]), reports)
    }

    /// A share that is right in a place that is mirrored.
    fn explain(&self, finding: Finding, reports: &[MeanReport]) -> Finding {
        if reports[0].verdict == Verdict::Fail {
            return finding;
        }
        let holds = |number: usize, at: f64| {
            let [low, high] = reports[number].interval;
            let slack = reports[number].band;
            (low - slack..=high + slack).contains(&(self.share * at))
        };
        let [x, y] = self.centroid;
        let tried = [
            (&image::UPSIDE_DOWN, [x, 1.0 - y]),
            (&image::MIRRORED, [1.0 - x, y]),
            (&image::TURNED, [1.0 - x, 1.0 - y]),
            (&image::TRANSPOSED, [y, x]),
        ];
        let found = tried.into_iter().find(|(_, [x, y])| holds(1, *x) && holds(2, *y));
        finding.because_of(found.map(|(cause, [x, y])| {
            (cause, format!("predicts its middle at ({}, {})", figure(x), figure(y)))
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeFilm, Radiance};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure};
    use glam::{DVec2, Vec2Swizzles};

    const CASE: &str = "[expect]\nsize = [32, 24]\nshare = 0.12\ncentroid = [0.35, 0.8]\n\
                        detects = \"3 %\"\nat-most = \"1 M\"";

    /// A light that covers [0.2, 0.5] × [0.6, 1] of the film.
    fn light(at: DVec2, size: DVec2) -> [f64; 3] {
        let film = DVec2::new(at.x / size.x, 1.0 - at.y / size.y);
        let covers = (0.2..0.5).contains(&film.x) && (0.6..=1.0).contains(&film.y);
        [f64::from(u8::from(covers)); 3]
    }

    fn seen(radiance: Radiance) -> Finding {
        let check: ViewCoverage = check_of(CASE);
        FakeFilm { radiance: Box::new(radiance), ..FakeFilm::default() }.judged_by(&check)
    }

    #[test]
    fn the_right_view_passes() {
        assert_passes(&seen(light));
    }

    #[test]
    fn a_view_that_is_too_wide_fails_with_both_numbers() {
        let finding = seen(|at, size| light(size / 2.0 + 1.1 * (at - size / 2.0), size));
        let statement = failure(&finding);
        assert!(statement.starts_with("the light covers 9.9"), "{statement}");
        assert!(statement.ends_with("instead of 12 % around (0.35, 0.8)"), "{statement}");
    }

    #[test]
    fn mirrored_pictures_are_named() {
        let cases: [(Radiance, &str); 4] = [
            (|at, size| light(DVec2::new(at.x, size.y - at.y), size), "picture-upside-down"),
            (|at, size| light(DVec2::new(size.x - at.x, at.y), size), "picture-mirrored"),
            (|at, size| light(size - at, size), "picture-turned-round"),
            (|at, size| light((1.0 - (at / size).yx()) * size, size), "picture-transposed"),
        ];
        for (radiance, name) in cases {
            let finding = seen(radiance);
            assert_eq!(causes(&finding), [name], "{}", finding.statement);
        }
    }

    #[test]
    fn a_light_a_pixel_further_right_fails() {
        failure(&seen(|at, size| light(at - DVec2::X, size)));
    }
}
