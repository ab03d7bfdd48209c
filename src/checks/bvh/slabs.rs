//! The slab test of the textbook, and the ways in which people write it wrongly.

use crate::cause::{Cause, bvh};
use crate::checks::Finding;
#[cfg(test)]
use crate::checks::fake::Fake;
#[cfg(test)]
use crate::contract::BoxHit;
use crate::contract::Ray;
use crate::scene::Aabb;
use glam::DVec3;

/// The parameters at which a line crosses the planes of a box, as the textbook divides them.
pub(crate) struct Slabs {
    lower: DVec3,
    upper: DVec3,
}

impl Slabs {
    pub(crate) fn new(bounds: &Aabb, ray: &Ray) -> Self {
        Self {
            lower: (bounds.min - ray.origin) / ray.direction,
            upper: (bounds.max - ray.origin) / ray.direction,
        }
    }

    /// What the line has of the box.
    pub(crate) fn span(&self) -> Span {
        Span {
            enters: self.lower.min(self.upper).max_element(),
            exits: self.lower.max(self.upper).min_element(),
        }
    }

    /// Entry by the lower planes and exit by the upper ones, whichever the line crosses first.
    fn span_not_swapped(&self) -> Span {
        Span { enters: self.lower.max_element(), exits: self.upper.min_element() }
    }

    /// The box has no end along `axis`.
    fn without_axis(mut self, axis: usize) -> Self {
        (self.lower[axis], self.upper[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
        self
    }

    /// An axis that the line does not move along has no say.
    fn without_parallel_axes(self) -> Self {
        let crossings = self.lower;
        (0..3).filter(|axis| !crossings[*axis].is_finite()).fold(self, Self::without_axis)
    }
}

/// Where a line enters a box and where it leaves, in lengths of the ray's direction; the wrong way round where it
/// passes by.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub(crate) enters: f64,
    pub(crate) exits: f64,
}

impl Span {
    /// The right test, where no 0/0 occurs.
    pub(crate) fn hits(self, ray: &Ray) -> bool {
        self.is_proper() && self.exits >= ray.t_min && self.enters <= ray.t_max
    }

    fn is_proper(self) -> bool {
        self.enters <= self.exits
    }
}

/// What there is of a box between its planes.
type Crossing = fn(Slabs) -> Span;
/// Whether that is a hit of the ray's segment.
type Conclusion = fn(Span, &Ray) -> bool;

/// Wrong ways to put the crossings of the planes together.
const CROSSINGS: &[(&Cause, Crossing)] = &[
    (&bvh::PLANES_NOT_SWAPPED, |slabs| slabs.span_not_swapped()),
    (&bvh::PARALLEL_AXES_SKIPPED, |slabs| slabs.without_parallel_axes().span()),
    (&bvh::BOX_WITHOUT_Z, |slabs| slabs.without_axis(2).span()),
    (&bvh::BOX_WITHOUT_Y, |slabs| slabs.without_axis(1).span()),
    (&bvh::BOX_WITHOUT_X, |slabs| slabs.without_axis(0).span()),
];

/// Wrong conclusions from them.
const CONCLUSIONS: &[(&Cause, Conclusion)] = &[
    (&bvh::BOX_SEGMENT_IGNORED, |span, _| span.is_proper()),
    (&bvh::BOX_START_IGNORED, |span, ray| span.is_proper() && span.enters <= ray.t_max),
    (&bvh::BOX_END_IGNORED, |span, ray| span.is_proper() && span.exits >= ray.t_min),
    (&bvh::BOX_MISSED_FROM_INSIDE, |span, ray| span.hits(ray) && span.enters >= ray.t_min),
    (&bvh::BOX_MISSED_BY_END_INSIDE, |span, ray| span.hits(ray) && span.exits <= ray.t_max),
    (&bvh::FLAT_BOX_MISSED, |span, ray| span.hits(ray) && span.enters < span.exits),
];

/// An implementation that people write instead: one mistake, or one of each kind.
#[derive(Clone, Copy)]
pub(crate) struct Wrong {
    span: Crossing,
    hits: Conclusion,
    pub(crate) cause: &'static Cause,
    /// The second mistake.
    pub(crate) besides: Option<&'static Cause>,
}

impl Wrong {
    pub(crate) fn hits(&self, slabs: Slabs, ray: &Ray) -> bool {
        (self.hits)((self.span)(slabs), ray)
    }

    /// Its mistakes in words.
    pub(crate) fn words(&self) -> String {
        match self.besides {
            None => self.cause.headline.to_owned(),
            Some(other) => format!("{}, and {}", self.cause.headline, other.headline),
        }
    }

    /// What speaks for it, where it predicts so many answers.
    fn evidence(&self, predicted: &str) -> String {
        match self.besides {
            None => format!("predicts {predicted}"),
            Some(other) => format!("predicts {predicted}, if also {}", other.headline),
        }
    }
}

/// Every single mistake.
pub(crate) fn single_mistakes() -> impl Iterator<Item = Wrong> {
    let crossings = CROSSINGS.iter();
    let crossings = crossings.map(|(cause, span)| Wrong {
        span: *span,
        hits: Span::hits,
        cause,
        besides: None,
    });
    let conclusions = CONCLUSIONS.iter();
    let conclusions = conclusions.map(|(cause, hits)| Wrong {
        span: |slabs| slabs.span(),
        hits: *hits,
        cause,
        besides: None,
    });
    crossings.chain(conclusions)
}

/// Every mistake of one kind with every one of the other.
pub(crate) fn pairs_of_mistakes() -> impl Iterator<Item = Wrong> {
    CONCLUSIONS.iter().flat_map(|(cause, hits)| {
        CROSSINGS.iter().map(|(other, span)| {
            let besides = Some(*other);
            Wrong { span: *span, hits: *hits, cause, besides }
        })
    })
}

/// The one implementation that hits the boxes which a core hits, and no others; of one mistake if there is such. None
/// where several do: too little was asked to tell them apart.
pub(crate) fn wrong_as(answers: &[(Aabb, Ray, bool)]) -> Option<Wrong> {
    let predicts = |wrong: &Wrong| {
        answers.iter().all(|(bounds, ray, hit)| wrong.hits(Slabs::new(bounds, ray), ray) == *hit)
    };
    let single: Vec<_> = single_mistakes().filter(predicts).collect();
    let possible =
        if single.is_empty() { pairs_of_mistakes().filter(predicts).collect() } else { single };
    <[Wrong; 1]>::try_from(possible).ok().map(|[wrong]| wrong)
}

/// `finding`, with the mistake that predicts so many answers.
pub(crate) fn because(finding: Finding, wrong: Option<&Wrong>, predicted: &str) -> Finding {
    finding.because_of(wrong.map(|wrong| (wrong.cause, wrong.evidence(predicted))))
}

/// A core that hits boxes by a rule of its own.
#[cfg(test)]
pub(crate) fn hitting(hits: impl Fn(Slabs, &Ray) -> bool + Send + 'static) -> Fake {
    let bounds = move |bounds: &Aabb, ray: &Ray| {
        let slabs = Slabs::new(bounds, ray);
        let Span { enters: t_enter, exits: t_exit } = slabs.span();
        BoxHit { t_enter, t_exit, hit: hits(slabs, ray).into(), reserved: 0 }
    };
    Fake { bounds: Box::new(bounds), ..Fake::default() }
}
