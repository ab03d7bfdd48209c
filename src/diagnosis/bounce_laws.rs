//! What mistakes make of the energy of bounces in a furnace, where bounce k is emission · albedo^k.

use crate::cause::{Cause, integrator};
use std::f64::consts::PI;

/// The last bounce that rows of a furnace ask for.
const LAST: u32 = 40;

/// Emission and albedo of one channel, as the case expects them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    pub emission: f64,
    pub albedo: f64,
    /// Luminance of the three albedos.
    luminance: f64,
    /// Their mean.
    mean: f64,
}

impl Channel {
    pub(crate) fn of(emission: f64, albedo: f64, all: [f64; 3]) -> Self {
        let luminance = 0.2126 * all[0] + 0.7152 * all[1] + 0.0722 * all[2];
        Self { emission, albedo, luminance, mean: all.iter().sum::<f64>() / 3.0 }
    }

    /// Light that was scattered `bounce` times.
    pub(crate) fn bounce(&self, bounce: u32) -> f64 {
        self.emission * self.albedo.powi(bounce.cast_signed())
    }

    /// The sum over bounces of `weight(bounce)` times what is right.
    pub(crate) fn sum(&self, [first, last]: [u32; 2], weight: impl Fn(u32) -> f64) -> f64 {
        (first..=last.min(LAST)).map(|bounce| weight(bounce) * self.bounce(bounce)).sum()
    }
}

/// A mistake, and what it makes of the sum of bounces `first..=last`.
pub(crate) struct Law {
    pub(crate) cause: &'static Cause,
    /// What is wrong, in a sentence with k.
    pub(crate) words: &'static str,
    /// The sum of these bounces as the mistake makes it.
    pub(crate) predict: fn(&Channel, [u32; 2]) -> f64,
    /// What it makes of light that is scattered once, over what is right.
    pub(crate) direct: f64,
}

impl Law {
    const fn new(
        cause: &'static Cause,
        words: &'static str,
        predict: fn(&Channel, [u32; 2]) -> f64,
    ) -> Self {
        Self { cause, words, predict, direct: 1.0 }
    }

    const fn with_direct(self, direct: f64) -> Self {
        Self { direct, ..self }
    }
}

/// Indirect bounces: those that need the path to go on.
pub(crate) fn indirect(bounce: u32) -> i32 {
    bounce.saturating_sub(1).cast_signed()
}

/// What a bounce is multiplied by if it is weighted with f cos θ · pdf, cosine-distributed: the integral of
/// cos³ θ/π³ over the hemisphere.
const TIMES_PDF: f64 = 1.0 / (2.0 * PI * PI);

/// How a core comes by isolated bounces, where its sums are wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Isolation {
    /// As a sum of one bounce.
    Counted,
    /// What they add to the sum before; emission and single scattering have functions of their own.
    ByDifference,
    /// By functions of their own.
    Apart,
}

impl Isolation {
    pub(super) const ALL: [Self; 3] = [Self::Counted, Self::ByDifference, Self::Apart];

    /// The sum of these bounces as a mistake makes it.
    pub(super) fn read(self, law: &Law, channel: &Channel, [first, last]: [u32; 2]) -> f64 {
        let right = || channel.sum([first, last], |_| 1.0);
        let up_to = |last: u32| (law.predict)(channel, [0, last]);
        match (self, first, last) {
            (Self::Counted, ..) => (law.predict)(channel, [first, last]),
            (_, 0, 0) | (_, 1, 1) => right(),
            (_, 0, _) => up_to(last),
            (_, 1, _) => up_to(last) - channel.bounce(0),
            (Self::ByDifference, ..) => up_to(last) - up_to(first - 1),
            (Self::Apart, ..) => right(),
        }
    }
}

pub(crate) static LAWS: &[Law] = &[
    Law::new(
        &integrator::ONE_BOUNCE_SHORT,
        "bounce k holds what belongs to bounce k − 1, and sums end one bounce early",
        |c, [first, last]| match (first, last) {
            (0, last) => c.sum([0, last.saturating_sub(1)], |_| 1.0),
            (first, last) => c.sum([first - 1, last - 1], |_| 1.0),
        },
    )
    .with_direct(0.0),
    Law::new(
        &integrator::ONE_BOUNCE_SHORT,
        "the last bounce asked for is missing, from the second on",
        |c, [first, last]| match last {
            0 | 1 => c.sum([first, last], |_| 1.0),
            last => c.sum([first, last - 1], |_| 1.0),
        },
    ),
    Law::new(
        &integrator::ONE_BOUNCE_SHORT,
        "the last bounce asked for is missing",
        |c, [first, last]| match last {
            0 => c.bounce(0),
            last => c.sum([first, last - 1], |_| 1.0),
        },
    )
    .with_direct(0.0),
    Law::new(
        &integrator::ONE_BOUNCE_LONG,
        "bounce k holds what belongs to bounce k + 1",
        |c, [first, last]| match (first, last) {
            (0, 0) => c.bounce(0),
            (0, last) => c.sum([0, last + 1], |_| 1.0),
            (first, last) => c.sum([first + 1, last + 1], |_| 1.0),
        },
    ),
    Law::new(
        &integrator::ONE_BOUNCE_LONG,
        "every sum holds one bounce more than was asked for",
        |c, [first, last]| {
            if last == 0 { c.bounce(0) } else { c.sum([first, last + 1], |_| 1.0) }
        },
    ),
    Law::new(
        &integrator::DEPTH_IGNORED,
        "whatever bounce is the last asked for, all later ones are there too",
        |c, [first, _]| c.sum([first, LAST], |_| 1.0),
    ),
    Law::new(
        &integrator::DEPTH_IGNORED,
        "of two bounces and more, whichever is the last asked for, all later ones are there too",
        |c, [first, last]| c.sum([first, if last < 2 { last } else { LAST }], |_| 1.0),
    ),
    Law::new(
        &integrator::ZERO_DEPTH_LIT,
        "bounce 0 holds bounce 1 too, and bounce 1 alone is empty",
        |c, bounces| match bounces {
            [0, last] => c.sum([0, last.max(1)], |_| 1.0),
            [1, 1] => 0.0,
            rows => c.sum(rows, |_| 1.0),
        },
    )
    .with_direct(0.0),
    Law::new(&integrator::ZERO_DEPTH_LIT, "bounce 0 holds bounce 1 too", |c, [first, last]| {
        c.sum([first, if first == 0 { last.max(1) } else { last }], |_| 1.0)
    }),
    Law::new(
        &integrator::ISOLATION_IGNORED,
        "bounce k holds all bounces up to k",
        |c, [_, last]| c.sum([0, last], |_| 1.0),
    ),
    Law::new(
        &integrator::ISOLATION_IGNORED,
        "bounce k holds all bounces from 1 to k",
        |c, [first, last]| c.sum([first.min(1), last], |_| 1.0),
    ),
    Law::new(
        &integrator::ALBEDO_TWICE,
        "indirect bounce k is albedo^(k−1) of what it should be, in the colours of the surface",
        |c, rows| c.sum(rows, |bounce| c.albedo.powi(indirect(bounce))),
    ),
    Law::new(
        &integrator::ALBEDO_FORGOTTEN,
        "indirect bounce k is 1/albedo^(k−1) of what it should be, in the colours of the surface",
        |c, rows| c.sum(rows, |bounce| c.albedo.powi(-indirect(bounce))),
    ),
    Law::new(
        &integrator::WEIGHT_REPLACED,
        "from bounce 3 on the emission is weighted by albedo² alone",
        |c, rows| c.sum(rows, |bounce| c.albedo.powi(-indirect(bounce.saturating_sub(1)))),
    ),
    Law::new(
        &integrator::GREY_THROUGHPUT,
        "indirect bounce k is (luminance/albedo)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| (c.luminance / c.albedo).powi(indirect(bounce))),
    ),
    Law::new(
        &integrator::GREY_THROUGHPUT,
        "indirect bounce k is (mean albedo/albedo)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| (c.mean / c.albedo).powi(indirect(bounce))),
    ),
    Law::new(&integrator::EMISSION_AGAIN, "every bounce is there twice", |c, rows| {
        c.sum(rows, |bounce| if bounce == 0 { 1.0 } else { 2.0 })
    })
    .with_direct(2.0),
    Law::new(
        &integrator::EMISSION_AGAIN,
        "every bounce from the second on is there twice",
        |c, rows| c.sum(rows, |bounce| if bounce < 2 { 1.0 } else { 2.0 }),
    ),
    Law::new(
        &integrator::EMISSION_AGAIN,
        "every bounce but the last of a sum is there twice",
        |c, [first, last]| {
            c.sum([first, last], |bounce| if bounce == 0 || bounce == last { 1.0 } else { 2.0 })
        },
    ),
    Law::new(&integrator::NO_INDIRECT, "from bounce 2 on there is nothing", |c, rows| {
        c.sum(rows, |bounce| if bounce < 2 { 1.0 } else { 0.0 })
    }),
    Law::new(
        &integrator::INDIRECT_FOUR_THIRDS,
        "indirect bounce k is (4/3)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| (4.0_f64 / 3.0).powi(indirect(bounce))),
    ),
    Law::new(
        &integrator::BOUNCE_TIMES_PDF,
        "indirect bounce k is (1/2π²)^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| TIMES_PDF.powi(indirect(bounce))),
    ),
    Law::new(
        &integrator::BOUNCE_WITHOUT_COSINE,
        "indirect bounce k is 2^(k−1) of what it should be",
        |c, rows| c.sum(rows, |bounce| 2.0_f64.powi(indirect(bounce))),
    ),
    Law::new(&integrator::EMISSION_LOST, "sums lack bounce 0", |c, [first, last]| {
        if first == last { c.bounce(first) } else { c.sum([first.max(1), last], |_| 1.0) }
    }),
    Law::new(&integrator::LAST_BOUNCE_ONLY, "sums are their last bounce alone", |c, [_, last]| {
        c.bounce(last)
    }),
];
