//! A picture of four colours, one in each quarter: where they come out says which way the picture is stored.

use super::exposed::channels;
use crate::cause::{Cause, image};
use crate::checks::phrase::{figure, some_are};
use crate::checks::rendering::{Rendering, places};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Film};
use crate::stats::{Compared, Tolerance, judge_exact};
use crate::text::{Lit, Size};

check! {
    /// Four colours stand in their quarters of the picture.
    pub(crate) struct PictureOrientation {
        /// Columns and rows: different, so that they cannot be mistaken for each other.
        size: Size,
        top_left: Lit,
        top_right: Lit,
        bottom_left: Lit,
        bottom_right: Lit,
    }
    name: "picture-orientation",
    summary: "four colours come out in their quarters of the picture",
    needs: BUILD_SCENE | RENDER,
}

impl Check for PictureOrientation {
    fn validate(&self) -> Result<(), String> {
        let Size([width, height]) = self.size;
        let is_size = width != height && width.min(height) >= 4;
        is_size.then_some(()).ok_or("`size` needs two different numbers above 3".to_owned())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let rendering = Rendering::of(&scene, self.size.0, [0, 0], 1)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let film = rendering.film(built.as_mut(), seed.0, 0)?;
        drop(built);
        Ok(self.judge(&film, Tolerance::RADIANCE.of(context.info.precision)))
    }
}

impl PictureOrientation {
    /// Pixels that lie wholly in one quarter, with room for a sample that is a pixel off.
    fn clear_pixels(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        places(self.size.0).filter(|at| self.is_clear(*at))
    }

    fn is_clear(&self, at: [u32; 2]) -> bool {
        (0..2).all(|axis| (2 * at[axis] + 1).abs_diff(self.size.0[axis]) >= 3)
    }

    fn colour_at(&self, [x, y]: [u32; 2]) -> [f64; 3] {
        let is_right = 2 * x >= self.size.0[0];
        let is_low = 2 * y >= self.size.0[1];
        let Lit(colour) = match (is_right, is_low) {
            (false, false) => self.top_left,
            (true, false) => self.top_right,
            (false, true) => self.bottom_left,
            (true, true) => self.bottom_right,
        };
        colour
    }

    fn judge(&self, film: &Film, allowed: f64) -> Finding {
        let compared = |at| channels(found_at(film, at), self.colour_at(at), allowed);
        let report = judge_exact(self.clear_pixels().flat_map(compared));
        let measures = vec![Measure::worst("channel of a pixel inside a quarter", &report)];
        let all = self.clear_pixels().count();
        let is_wrong = |at: &[u32; 2]| compared(*at).iter().any(|c| !c.agrees());
        let wrong: Vec<_> = self.clear_pixels().filter(is_wrong).collect();
        let statement = match wrong.first() {
            None => format!("all {all} pixels inside the four quarters have their colour"),
            Some(first) => {
                let [found, right] = [found_at(film, *first), self.colour_at(*first)]
                    .map(|colour| colour.map(figure).join(", "));
                let some = some_are(wrong.len(), all, "pixels");
                let [x, y] = first;
                format!("{some} wrong; ({x}, {y}) is ({found}) instead of ({right})")
            }
        };
        let finding = Finding::of(statement, "would have caught one pixel elsewhere", measures);
        let causes = if finding.failed() { self.causes(film, allowed) } else { Vec::new() };
        finding.because_each(causes, "predicts the colour of every pixel")
    }

    fn causes(&self, film: &Film, allowed: f64) -> Vec<&'static Cause> {
        let is_like = |at, expected| {
            channels(found_at(film, at), expected, allowed).iter().all(Compared::agrees)
        };
        let is_moved = |source: Source| {
            let comes_from = |at| source(at, self.size.0);
            let mut told = self.clear_pixels().filter(|at| self.is_clear(comes_from(*at)));
            told.all(|at| is_like(at, self.colour_at(comes_from(at))))
        };
        let is_swapped = |at| {
            let [red, green, blue] = self.colour_at(at);
            is_like(at, [blue, green, red])
        };
        let moved = DISPLACEMENTS.iter().filter(|(_, source)| is_moved(*source));
        let swapped = self.clear_pixels().all(is_swapped).then_some(&image::CHANNELS_SWAPPED);
        moved.map(|(cause, _)| *cause).chain(swapped).collect()
    }
}

fn found_at(film: &Film, [x, y]: [u32; 2]) -> [f64; 3] {
    film.pixels[(y * film.width + x) as usize].map(f64::from)
}

/// Which pixel of the right picture appears at this one, in a film of this size.
type Source = fn([u32; 2], [u32; 2]) -> [u32; 2];

/// Ways to store or to see a picture that put pixels elsewhere.
const DISPLACEMENTS: &[(&Cause, Source)] = &[
    (&image::UPSIDE_DOWN, |[x, y], [_, height]| [x, height - 1 - y]),
    (&image::MIRRORED, |[x, y], [width, _]| [width - 1 - x, y]),
    (&image::TURNED, |[x, y], [width, height]| [width - 1 - x, height - 1 - y]),
    // Stored at x · height + y.
    (&image::TRANSPOSED, |[x, y], [width, height]| {
        let index = y * width + x;
        [index / height, index % height]
    }),
    // Seen through (y, x) of the film: from its bottom left, and from its top left.
    (&image::TRANSPOSED, |[x, y], [width, height]| {
        [(height - 1 - y) * width / height, (width - 1 - x) * height / width]
    }),
    (&image::TRANSPOSED, |[x, y], [width, height]| [y * width / height, x * height / width]),
];

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeFilm, Index};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of};
    use glam::DVec2;

    const CASE: &str = include_str!("../../../cases/camera/image-is-upright-and-not-mirrored.toml");

    fn found(core: FakeFilm) -> Finding {
        let check: PictureOrientation = check_of(CASE);
        let painted = check.clone();
        let colour = move |at: DVec2, _| painted.colour_at(at.to_array().map(|c| c as u32));
        FakeFilm { radiance: Box::new(colour), ..core }.judged_by(&check)
    }

    #[test]
    fn the_right_way_up_passes() {
        assert_passes(&found(FakeFilm::default()));
    }

    #[test]
    fn every_way_to_turn_a_picture_has_its_name() {
        let cases: [(Index, &str); 4] = [
            (|[x, y], [w, h]| ((h - 1 - y) * w + x) as usize, "picture-upside-down"),
            (|[x, y], [w, _]| (y * w + w - 1 - x) as usize, "picture-mirrored"),
            (|[x, y], [w, h]| ((h - 1 - y) * w + w - 1 - x) as usize, "picture-turned-round"),
            (|[x, y], [_, h]| (x * h + y) as usize, "picture-transposed"),
        ];
        for (index, name) in cases {
            let finding = found(FakeFilm { index, ..FakeFilm::default() });
            assert_eq!(causes(&finding), [name]);
        }
    }

    #[test]
    fn swapped_channels_are_not_taken_for_a_turned_picture() {
        let core = FakeFilm { develop: |[r, g, b], _| [b, g, r], ..FakeFilm::default() };
        assert_eq!(causes(&found(core)), ["channels-swapped"]);
    }

    #[test]
    fn a_black_picture_has_no_name() {
        let finding = found(FakeFilm { develop: |_, _| [0.0; 3], ..FakeFilm::default() });
        assert!(causes(&finding).is_empty());
        assert!(finding.statement.contains("instead of (4, 2, 1)"), "{}", finding.statement);
    }
}
