//! A picture of four colours, one in each quarter: where they come out says which way the picture
//! is stored.

use crate::cause::{Cause, image};
use crate::checks::phrase::{figure, some_are};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Film};
use crate::stats::{Compared, Tolerance, Verdict, judge_exact};
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
        if width == height || width.min(height) < 4 {
            return Err("`size` needs two different numbers above 3".to_owned());
        }
        Ok(())
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
        let Size([width, height]) = self.size;
        let all = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        all.filter(|at| self.is_clear(*at))
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

    fn found_at(film: &Film, [x, y]: [u32; 2]) -> [f64; 3] {
        film.pixels[(y * film.width + x) as usize].map(f64::from)
    }

    fn judge(&self, film: &Film, allowed: f64) -> Finding {
        let compared = |at: [u32; 2]| {
            let (found, right) = (Self::found_at(film, at), self.colour_at(at));
            (0..3).map(move |c| Compared::relative(found[c], right[c], allowed))
        };
        let report = judge_exact(self.clear_pixels().flat_map(compared));
        let measures = vec![Measure::worst("channel of a pixel inside a quarter", &report)];
        let all = self.clear_pixels().count();
        let is_wrong = |at: &[u32; 2]| compared(*at).any(|c| !c.agrees());
        let wrong: Vec<_> = self.clear_pixels().filter(is_wrong).collect();
        let statement = match wrong.first() {
            None => format!("all {all} pixels inside the four quarters have their colour"),
            Some(first) => {
                let [found, right] = [Self::found_at(film, *first), self.colour_at(*first)]
                    .map(|colour| colour.map(figure).join(", "));
                let some = some_are(wrong.len(), all, "pixels");
                let [x, y] = first;
                format!("{some} wrong; ({x}, {y}) is ({found}) instead of ({right})")
            }
        };
        let finding = Finding::of(statement, "would have caught one pixel elsewhere", measures);
        if finding.verdict == Verdict::Fail {
            self.explain(finding, film, allowed)
        } else {
            finding
        }
    }

    fn explain(&self, mut finding: Finding, film: &Film, allowed: f64) -> Finding {
        let is_like = |at, expected: [f64; 3]| {
            let found = Self::found_at(film, at);
            (0..3).all(|c| Compared::relative(found[c], expected[c], allowed).agrees())
        };
        let moved = |mistake: &&Displacement| {
            let comes_from = |at| (mistake.source)(at, self.size.0);
            let told = self.clear_pixels().filter(|at| self.is_clear(comes_from(*at)));
            told.into_iter().all(|at| is_like(at, self.colour_at(comes_from(at))))
        };
        for mistake in DISPLACEMENTS.iter().filter(moved) {
            finding = finding.because(mistake.cause, "predicts the colour of every pixel");
        }
        let swapped = |at| {
            let [red, green, blue] = self.colour_at(at);
            is_like(at, [blue, green, red])
        };
        if self.clear_pixels().all(swapped) {
            let evidence = "predicts the colour of every pixel";
            finding = finding.because(&image::CHANNELS_SWAPPED, evidence);
        }
        finding
    }
}

/// A way to store or to see a picture that puts pixels elsewhere.
struct Displacement {
    cause: &'static Cause,
    /// Which pixel of the right picture appears at this one, in a film of this size.
    source: fn([u32; 2], [u32; 2]) -> [u32; 2],
}

const DISPLACEMENTS: &[Displacement] = &[
    Displacement { cause: &image::UPSIDE_DOWN, source: |[x, y], [_, height]| [x, height - 1 - y] },
    Displacement { cause: &image::MIRRORED, source: |[x, y], [width, _]| [width - 1 - x, y] },
    Displacement {
        cause: &image::TURNED,
        source: |[x, y], [width, height]| [width - 1 - x, height - 1 - y],
    },
    // Stored at x · height + y.
    Displacement {
        cause: &image::TRANSPOSED,
        source: |[x, y], [width, height]| {
            let index = y * width + x;
            [index / height, index % height]
        },
    },
    // Seen through (y, x) of the film: from its bottom left, and from its top left.
    Displacement {
        cause: &image::TRANSPOSED,
        source: |[x, y], [width, height]| {
            [(height - 1 - y) * width / height, (width - 1 - x) * height / width]
        },
    },
    Displacement {
        cause: &image::TRANSPOSED,
        source: |[x, y], [width, height]| [y * width / height, x * height / width],
    },
];

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeFilm, Index};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::scene::SceneDescription;
    use glam::DVec2;

    fn check() -> PictureOrientation {
        check_of(include_str!("../../../cases/camera/image-is-upright-and-not-mirrored.toml"))
    }

    fn found(core: FakeFilm) -> Finding {
        let check = check();
        let painted = check.clone();
        let colour = move |at: DVec2, _: DVec2| painted.colour_at([at.x as u32, at.y as u32]);
        let core = FakeFilm { radiance: Box::new(colour), ..core };
        let scene = SceneDescription { camera: Some(FakeFilm::camera()), ..Default::default() };
        try_judge(&check, &mut core.core(), Some(scene)).unwrap()
    }

    fn causes(finding: &Finding) -> Vec<&str> {
        failure(finding);
        finding.clues.iter().map(|clue| clue.cause.as_str()).collect()
    }

    #[test]
    fn the_right_way_up_passes() {
        assert_passes(&found(FakeFilm::default()));
    }

    #[test]
    fn every_way_to_turn_a_picture_has_its_name() {
        let stored = |index| causes(&found(FakeFilm { index, ..FakeFilm::default() })).join(" ");
        let cases: [(Index, &str); 4] = [
            (|[x, y], [w, h]| ((h - 1 - y) * w + x) as usize, "picture-upside-down"),
            (|[x, y], [w, _]| (y * w + w - 1 - x) as usize, "picture-mirrored"),
            (|[x, y], [w, h]| ((h - 1 - y) * w + w - 1 - x) as usize, "picture-turned-round"),
            (|[x, y], [_, h]| (x * h + y) as usize, "picture-transposed"),
        ];
        for (index, name) in cases {
            assert_eq!(stored(index), name);
        }
    }

    #[test]
    fn swapped_channels_are_not_taken_for_a_turned_picture() {
        let develop = |[r, g, b]: [f64; 3], _| [b, g, r];
        let finding = found(FakeFilm { develop, ..FakeFilm::default() });
        assert_eq!(causes(&finding), ["channels-swapped"]);
    }

    #[test]
    fn a_black_picture_has_no_name() {
        let finding = found(FakeFilm { develop: |_, _| [0.0; 3], ..FakeFilm::default() });
        assert!(causes(&finding).is_empty());
        assert!(finding.statement.contains("instead of (4, 2, 1)"), "{}", finding.statement);
    }
}
