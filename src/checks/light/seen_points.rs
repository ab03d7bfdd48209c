//! Points of diffuse surfaces that the camera sees, lit from where it stands.

use crate::cause::{Cause, bsdf, light as cause};
use crate::checks::Measure;
use crate::checks::phrase::{figure, some_are};
use crate::contract::Falloff;
use crate::image::CHANNELS;
use crate::scene::Rgb;
use crate::stats::{Compared, judge_exact};
use std::f64::consts::{FRAC_1_PI, PI};

/// Of the light, in general position.
pub(super) const INTENSITY: Rgb = [2.0, 3.0, 5.0];

/// A mistake may magnify rounding, but not a hundredfold.
const LIKENESS: f64 = 100.0;

/// A point of a diffuse surface that the camera sees.
#[derive(Clone, Copy)]
pub(super) struct Point {
    /// From the camera.
    pub(super) distance: f64,
    /// Between view and shading normal.
    pub(super) cosine: f64,
    /// The same, if all surfaces faced +z.
    pub(super) world_cosine: f64,
    pub(super) reflectance: Rgb,
    pub(super) falloff: Falloff,
    /// What the core says it sends to the camera.
    pub(super) radiance: Rgb,
}

/// The points that are seen in one scene.
pub(super) struct Seen<'a> {
    pub(super) scene: &'a str,
    pub(super) points: Vec<Point>,
}

/// The radiance of a point as a share of what is right.
pub(super) type Mistake = fn(&Point) -> f64;

pub(super) const MISTAKES: &[(&Cause, Mistake)] = &[
    (&bsdf::WITHOUT_PI, |_| PI),
    (&cause::COSINE_FORGOTTEN, |point| point.cosine.recip()),
    (&cause::COSINE_TWICE, |point| point.cosine),
    (&cause::WORLD_COSINE, |point| point.world_cosine / point.cosine),
    (&cause::FADES_WITH_DISTANCE, |point| point.distance),
];

impl Point {
    /// albedo/π · intensity · cos/d².
    pub(super) fn right(&self, channel: usize) -> f64 {
        let falloff = match self.falloff {
            Falloff::InverseSquare => self.distance.powi(-2),
            Falloff::None => 1.0,
        };
        self.reflectance[channel] * FRAC_1_PI * INTENSITY[channel] * self.cosine * falloff
    }

    /// Small angles to the surface magnify the rounding of its normal.
    pub(super) fn compared(&self, channel: usize, share: f64, tolerance: f64) -> Compared {
        let expected = share * self.right(channel);
        Compared::relative(self.radiance[channel], expected, tolerance / self.cosine)
    }

    pub(super) fn is_dark(&self) -> bool {
        (0..3).all(|channel| self.radiance[channel] == 0.0)
    }

    pub(super) fn is_by(&self, mistake: Mistake, tolerance: f64) -> bool {
        self.is_times(mistake(self), tolerance)
    }

    /// Whether it is so many times as bright as it should be.
    pub(super) fn is_times(&self, factor: f64, tolerance: f64) -> bool {
        let compare = |channel| self.compared(channel, factor, LIKENESS * tolerance);
        (0..3).all(|channel| compare(channel).agrees())
    }
}

impl Seen<'_> {
    pub(super) fn dark(&self) -> usize {
        self.points.iter().filter(|point| point.is_dark()).count()
    }

    /// How bright the points are that are not dark.
    pub(super) fn measures(&self, tolerance: f64) -> impl Iterator<Item = Measure> {
        let of_channel = move |channel: usize| {
            let lit = self.points.iter().filter(|point| !point.is_dark());
            let compared = lit.map(|point| point.compared(channel, 1.0, tolerance));
            Measure::worst("radiance", &judge_exact(compared))
                .of_row(self.scene)
                .of_channel(CHANNELS[channel])
        };
        (0..3).map(of_channel)
    }

    pub(super) fn darkness(&self) -> Option<String> {
        let (dark, all) = (self.dark(), self.points.len());
        let some = some_are(dark, all, "points that the camera sees");
        (dark > 0).then(|| format!("{}: {some} dark, with a point light at the camera", self.scene))
    }

    pub(super) fn complaint(&self, tolerance: f64) -> Option<String> {
        let all = self.points.len();
        let off = |point: &Point| {
            !point.is_dark() && !(0..3).all(|c| point.compared(c, 1.0, tolerance).agrees())
        };
        let wrong = self.points.iter().filter(|point| off(point)).count();
        let worst = self.points.iter().find(|point| off(point))?;
        let some = some_are(wrong, all, "points");
        let (is, should) = (figure(worst.radiance[0]), figure(worst.right(0)));
        Some(format!(
            "{}: {some} not as bright as they should be, one {is} instead of {should}",
            self.scene
        ))
    }
}
