//! The slab test of the textbook, and the ways in which people write it wrongly.

use crate::cause::{Cause, bvh};
use crate::checks::Finding;
use crate::contract::Ray;
use crate::scene::Aabb;
use glam::DVec3;

/// The parameters at which a line crosses the planes of a box, as the textbook divides them.
pub(crate) struct Slabs {
    lower: DVec3,
    upper: DVec3,
}

impl Slabs {
    /// Those of a ray.
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
    /// The largest of the entries.
    pub(crate) enters: f64,
    /// The smallest of the exits.
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

/// A wrong way to put the crossings of the planes together.
struct Crossing {
    cause: &'static Cause,
    span: fn(Slabs) -> Span,
}

/// A wrong conclusion from them.
struct Conclusion {
    cause: &'static Cause,
    hits: fn(Span, &Ray) -> bool,
}

const CROSSINGS: &[Crossing] = &[
    Crossing { cause: &bvh::PLANES_NOT_SWAPPED, span: |slabs| slabs.span_not_swapped() },
    Crossing {
        cause: &bvh::PARALLEL_AXES_SKIPPED,
        span: |slabs| slabs.without_parallel_axes().span(),
    },
    Crossing { cause: &bvh::BOX_WITHOUT_Z, span: |slabs| slabs.without_axis(2).span() },
    Crossing { cause: &bvh::BOX_WITHOUT_Y, span: |slabs| slabs.without_axis(1).span() },
    Crossing { cause: &bvh::BOX_WITHOUT_X, span: |slabs| slabs.without_axis(0).span() },
];

const CONCLUSIONS: &[Conclusion] = &[
    Conclusion { cause: &bvh::BOX_SEGMENT_IGNORED, hits: |span, _| span.is_proper() },
    Conclusion {
        cause: &bvh::BOX_START_IGNORED,
        hits: |span, ray| span.is_proper() && span.enters <= ray.t_max,
    },
    Conclusion {
        cause: &bvh::BOX_END_IGNORED,
        hits: |span, ray| span.is_proper() && span.exits >= ray.t_min,
    },
    Conclusion {
        cause: &bvh::BOX_MISSED_FROM_INSIDE,
        hits: |span, ray| span.hits(ray) && span.enters >= ray.t_min,
    },
    Conclusion {
        cause: &bvh::BOX_MISSED_BY_END_INSIDE,
        hits: |span, ray| span.hits(ray) && span.exits <= ray.t_max,
    },
    Conclusion {
        cause: &bvh::FLAT_BOX_MISSED,
        hits: |span, ray| span.hits(ray) && span.enters < span.exits,
    },
];

/// An implementation that people write instead: one mistake, or one of each kind.
pub(crate) struct Wrong {
    span: fn(Slabs) -> Span,
    hits: fn(Span, &Ray) -> bool,
    /// What is wrong with it, in the glossary.
    pub(crate) cause: &'static Cause,
    /// What is wrong besides.
    pub(crate) besides: Option<&'static Cause>,
}

impl Wrong {
    /// Whether it hits.
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
    let crossings = CROSSINGS.iter().map(|crossing| Wrong {
        span: crossing.span,
        hits: Span::hits,
        cause: crossing.cause,
        besides: None,
    });
    let conclusions = CONCLUSIONS.iter().map(|conclusion| Wrong {
        span: |slabs| slabs.span(),
        hits: conclusion.hits,
        cause: conclusion.cause,
        besides: None,
    });
    crossings.chain(conclusions)
}

/// Every mistake of one kind with every one of the other.
pub(crate) fn pairs_of_mistakes() -> impl Iterator<Item = Wrong> {
    let with = |conclusion: &'static Conclusion| {
        CROSSINGS.iter().map(|crossing| Wrong {
            span: crossing.span,
            hits: conclusion.hits,
            cause: conclusion.cause,
            besides: Some(crossing.cause),
        })
    };
    CONCLUSIONS.iter().flat_map(with)
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
pub(crate) fn hitting(
    hits: impl Fn(Slabs, &Ray) -> bool + Send + 'static,
) -> crate::checks::fake::Fake {
    let bounds = move |bounds: &Aabb, ray: &Ray| {
        let slabs = Slabs::new(bounds, ray);
        let Span { enters: t_enter, exits: t_exit } = slabs.span();
        crate::contract::BoxHit { t_enter, t_exit, hit: hits(slabs, ray).into(), reserved: 0 }
    };
    crate::checks::fake::Fake { bounds: Box::new(bounds), ..Default::default() }
}
