//! Several views of one core, each with one of its broken components and the bench's own in the place of the others: what
//! is told of each is told of that component alone.

use super::rank::Ranked;
use super::reproduction::{MadeIn, Sifted, proven, without_what_follows};
use super::{Diagnosis, Evidence, Headline, Planted};
use crate::contract::Components;
use std::collections::BTreeMap;

/// What a core does with one of its broken components.
pub(crate) struct View<'a> {
    pub(crate) evidence: Evidence<'a>,
    /// The component.
    pub(crate) own: Components,
    /// Components of the bench that have to stand beside it, or else it mends nothing.
    pub(crate) beside: Components,
    /// Failures of the first look that pass with the bench's own in the place of this component.
    pub(crate) mended: Vec<String>,
    /// Cases that ask about this component or are mended by it. Of others that fail in this view the component need not
    /// be wrong: what is wrong with them may not have been found.
    pub(crate) of_own: Vec<String>,
}

impl View<'_> {
    fn sifted<'a>(&'a self, planted: &'a dyn Planted) -> Sifted<'a> {
        Sifted::of(&self.evidence, planted, MadeIn::Mended(self.own))
    }

    fn shows(&self, case: &str) -> bool {
        self.is_of_own(case) && self.evidence.fails(case)
    }

    fn is_of_own(&self, case: &str) -> bool {
        self.of_own.iter().any(|own| own == case)
    }

    fn mends(&self, case: &str) -> bool {
        self.mended.iter().any(|mended| mended == case)
    }
}

/// The causes of what failed at `first`, from the views of it; what no view shows is told as it was seen first. `unmended`
/// fails with any component of the bench.
pub(crate) fn diagnose_apart(
    first: &Evidence<'_>,
    views: &[View<'_>],
    unmended: &[String],
    planted: &dyn Planted,
) -> Diagnosis {
    let shown = |case: &&str| views.iter().any(|view| view.shows(case));
    let hidden = first.all_failures().map(|seen| seen.case).filter(|case| !shown(case));
    let (of_views, left): (Vec<_>, Vec<_>) =
        hidden.partition(|case| views.iter().any(|view| view.mends(case)));
    let for_the_rest = usize::from(!of_views.is_empty() || !left.is_empty());
    let left = first.with_failures_of(&left);
    let broken: Components = views.iter().map(|view| view.own).collect();
    let made_in = match broken.is_empty() {
        true => MadeIn::Unknown,
        false => MadeIn::Likely(broken),
    };
    // What is suspected of any is proven before the search for what is wrong with one, which may take all the time. A view
    // with many failures may take it, too: those with few come first.
    let mut order: Vec<_> = (0..views.len()).collect();
    order.sort_by_key(|number| views[*number].evidence.failures().count());
    let sifted = order.iter().map(|number| views[*number].sifted(planted));
    let sifted: Vec<_> = sifted.map(|sifted| sifted.asking_of_darkness(first)).collect();
    let left = Sifted::of(&left, planted, made_in);
    let searched = order.iter().zip(sifted).enumerate().map(|(done, (number, sifted))| {
        planted.keep_for(order.len() - 1 - done + for_the_rest);
        (number, sifted.and_searched())
    });
    let searched: BTreeMap<_, _> = searched.collect();
    planted.keep_for(0);
    let mut told = Ranked::default();
    for (view, of_view) in views.iter().zip(searched.into_values()) {
        let of_view = of_view.differing_in(&view.evidence, |case| view.is_of_own(case));
        let mut of_view = of_view.of_component([view.own, view.beside], first);
        let unseen: Vec<_> = of_views
            .iter()
            .filter(|case| view.mends(case) && !of_view.followed_by(case))
            .copied()
            .collect();
        told = told.and(of_view);
        // What one component mends, though its own view shows nothing of it, is of that component all the same.
        if !unseen.is_empty() {
            let unseen = first.with_failures_of(&unseen);
            let made_in = MadeIn::Mended(view.own);
            told = told.and(
                proven(&unseen, planted, made_in).of_component([view.own, view.beside], first),
            );
        }
    }
    let is_tried = |case: &str| unmended.iter().any(|other| other == case);
    let mut told = told.and(left.and_searched().unless_below(broken, is_tried));
    told.tell_beside(|headline| !is_refuted_where_graded(headline, first, views));
    without_what_follows(told, first, planted).told()
}

/// Whether a graded case showed the same as this one, which counts nothing and is not tried again, until a component of the
/// bench mended it: then that component is told.
fn is_refuted_where_graded(beside: &Headline, first: &Evidence<'_>, views: &[View<'_>]) -> bool {
    let mended = first.failures().filter(|seen| views.iter().any(|view| view.mends(seen.case)));
    let mut clues = mended.filter_map(|seen| seen.finding).flat_map(|found| &found.clues);
    clues.any(|clue| clue.cause == beside.cause)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Foundation;
    use crate::cause::{bsdf, bvh, shape};
    use crate::diagnosis::testing::{Made, Nothing, failing, passing};
    use crate::diagnosis::{Degree, Ending, diagnose};

    /// A view of one component that mends these cases, which ask about it.
    fn view<'a>(made: &'a Made, own: Components, cases: &[&str]) -> View<'a> {
        let mended: Vec<_> = cases.iter().map(|case| (*case).to_owned()).collect();
        let beside = Components::empty();
        View { evidence: made.evidence(), own, beside, of_own: mended.clone(), mended }
    }

    #[test]
    fn what_was_not_tried_may_be_only_what_it_is_made_of() {
        let made = Made::new().with("shape/a", failing("a")).with("bvh/b", failing("b"));
        let triangles = Made::new().with("shape/a", failing("a"));
        let told = |unmended: &[String]| {
            let view = view(&triangles, Components::TRIANGLE_TEST, &["shape/a"]);
            let told = diagnose_apart(&made.evidence(), &[view], unmended, &Nothing);
            told.headlines.into_iter().last().unwrap().mistake
        };
        assert_eq!(told(&[]), "the BVH or its box test differs, or only the core's triangle test");
        assert_eq!(told(&["bvh/b".to_owned()]), "the BVH or its box test differs");
    }

    fn without_pi() -> crate::checks::Finding {
        failing("a").because(&bsdf::WITHOUT_PI, "x")
    }

    #[test]
    fn each_component_is_told_from_its_own_view_and_the_earlier_part_first() {
        let both = Made::new()
            .with("shape/a", failing("a"))
            .with("bsdf/b", failing("b"))
            .with("light/c", failing("c"));
        let surface = Made::new().with("bsdf/b", without_pi()).with("shape/a", passing());
        let sphere = failing("a").because(&shape::FAR_ROOT_TAKEN, "x");
        let sphere = Made::new().with("shape/a", sphere).with("bsdf/b", passing());
        let views = [(&surface, vec!["bsdf/b", "light/c"]), (&sphere, vec!["shape/a"])];
        let views = views.map(|(made, cases)| view(made, Components::BSDF, &cases));
        let told = diagnose_apart(&both.evidence(), &views, &[], &Nothing);
        let [first, second] = &told.headlines[..] else { panic!("{told:?}") };
        assert_eq!((&first.cause[..], first.degree), (shape::FAR_ROOT_TAKEN.name, Degree::Named));
        assert_eq!(second.cause, bsdf::WITHOUT_PI.name);
        assert_eq!(second.may_follow, ["light/c"]);
        assert!(told.unexplained.is_empty());
    }

    #[test]
    fn what_one_component_mends_and_has_no_cause_is_one_difference() {
        let made = Made::new()
            .with("bsdf/a", failing("a"))
            .with("light/b", failing("b"))
            .with("adaptive/c", failing("c"));
        let told = |beside: Components| {
            let view = view(&made, Components::BSDF, &["bsdf/a", "light/b", "adaptive/c"]);
            let view = View { beside, ..view };
            diagnose_apart(&made.evidence(), &[view], &[], &Nothing)
        };
        let alone = told(Components::empty());
        let [only] = &alone.headlines[..] else { panic!("{alone:?}") };
        assert_eq!((only.degree, only.explains.len()), (Degree::DiffersHere, 3));
        assert_eq!(only.mistake, "what differs is the core's BSDF");
        assert_eq!(alone.unexplained, only.explains);
        let together = told(Components::DIRECT_LIGHTING);
        let both = "what differs is the core's BSDF and direct lighting";
        assert_eq!(together.headlines[0].mistake, both);
    }

    #[test]
    fn what_one_component_mends_and_its_view_does_not_show_is_of_that_component() {
        let made = Made::new().with("bsdf/a", failing("a")).with("light/b", failing("b"));
        let shows_nothing = Made::new().with("bsdf/a", passing());
        let view = view(&shows_nothing, Components::TRAVERSAL, &["bsdf/a", "light/b"]);
        let told = diagnose_apart(&made.evidence(), &[view], &[], &Nothing);
        let [only] = &told.headlines[..] else { panic!("{told:?}") };
        assert_eq!((only.degree, only.explains.len()), (Degree::DiffersHere, 2));
        assert_eq!(only.mistake, "what differs is the core's BVH");
    }

    #[test]
    fn what_passes_its_own_cases_may_be_called_wrongly() {
        let made = |boxes| {
            let made = Made::new().with("bvh/boxes", boxes).with("bvh/a", failing("a"));
            let made = made.proving("bvh/boxes", &[Foundation::Boxes]);
            let again = Made::new().with("bvh/a", failing("a"));
            let view = view(&again, Components::BOX_TEST, &["bvh/a"]);
            let told = diagnose_apart(&made.evidence(), &[view], &[], &Nothing);
            let mistakes = told.headlines.into_iter().map(|headline| headline.mistake);
            mistakes.collect::<Vec<_>>().join(", ")
        };
        assert_eq!(
            made(passing()),
            "the core's box test passes its own cases, and what rests on it does not"
        );
        assert!(made(failing("b")).contains("what differs is the core's box test"));
    }

    #[test]
    fn a_shape_whose_nearest_hit_is_right_may_be_wrong_itself() {
        let made = Made::new().with("shape/alone", passing()).with("bvh/a", failing("a"));
        let made = made.proving("shape/alone", &[Foundation::Spheres]);
        let view = view(&made, Components::SPHERE_TEST, &["bvh/a"]);
        let told = diagnose_apart(&made.evidence(), &[view], &[], &Nothing);
        let [only] = &told.headlines[..] else { panic!("{told:?}") };
        assert!(!only.mistake.contains("what calls it"), "{}", only.mistake);
        assert!(only.look_at.contains("any-hit function"), "{}", only.look_at);
    }

    #[test]
    fn what_fails_cases_about_itself_is_not_called_wrongly() {
        let made = Made::new()
            .with("integrator/furnace", passing())
            .proving("integrator/furnace", &[Foundation::Bounces])
            .with("integrator/a", failing("a"));
        let view = view(&made, Components::PATH, &["integrator/a"]);
        let told = diagnose_apart(&made.evidence(), &[view], &[], &Nothing);
        assert_eq!(told.headlines[0].mistake, "what differs is the core's path");
    }

    #[test]
    fn what_a_component_neither_mends_nor_is_asked_by_is_no_difference_of_it() {
        let made = Made::new().with("shape/a", failing("a")).with("light/b", failing("b"));
        let view = view(&made, Components::TRIANGLE_TEST, &["shape/a"]);
        let unmended = ["light/b".to_owned()];
        let told = diagnose_apart(&made.evidence(), &[view], &unmended, &Nothing);
        let mistakes: Vec<_> = told.headlines.iter().map(|h| h.mistake.as_str()).collect();
        assert_eq!(mistakes, ["what differs is the core's triangle test", "direct light differs"]);
    }

    #[test]
    fn an_ending_that_two_views_tell_is_told_once() {
        let crash = Ending::Crashed { how: "signal 11", during: "build-scene" };
        let made = Made::new().ended("bvh/a", crash).ended("integrator/b", crash);
        let views = [("bvh/a", Components::TRAVERSAL), ("integrator/b", Components::PATH)];
        let views = views.map(|(case, own)| view(&made, own, &[case]));
        let told = diagnose_apart(&made.evidence(), &views, &[], &Nothing);
        let [only] = &told.headlines[..] else { panic!("{told:?}") };
        assert_eq!(only.explains, ["bvh/a", "integrator/b"]);
    }

    #[test]
    fn what_a_component_refutes_of_a_graded_case_is_not_told_of_another() {
        let slow = || failing("slow").because(&bvh::SEGMENT_NOT_SHORTENED, "x");
        let told = |graded: crate::checks::Finding| {
            let made = Made::new().with("shape/a", failing("a")).with("bvh/graded", graded);
            let made = made.with("bvh/beside", slow()).beside_the_grade("bvh/beside");
            let triangles = Made::new().with("shape/a", failing("a"));
            let of_triangles = ["shape/a", "bvh/graded"];
            let view = view(&triangles, Components::TRIANGLE_TEST, &of_triangles);
            let told = diagnose_apart(&made.evidence(), &[view], &[], &Nothing);
            told.headlines.into_iter().any(|one| one.cause == bvh::SEGMENT_NOT_SHORTENED.name)
        };
        assert!(told(failing("b")), "nothing graded showed it");
        assert!(!told(slow()), "the triangle test mended what showed it");
    }

    #[test]
    fn what_no_view_shows_is_told_as_it_was_seen_first() {
        let made = Made::new().with("bsdf/b", without_pi()).with("adaptive/d", failing("d"));
        let told = diagnose_apart(&made.evidence(), &[], &[], &Nothing);
        assert_eq!(told, diagnose(&made.evidence()));
    }

    #[test]
    fn other_failures_of_the_one_component_that_is_not_the_benchs_follow_from_its_only_cause() {
        let made = Made::new().with("bsdf/b", without_pi()).with("bsdf/c", failing("c"));
        let view = view(&made, Components::BSDF, &["bsdf/b", "bsdf/c"]);
        let told = diagnose_apart(&made.evidence(), &[view], &[], &Nothing);
        let [only] = &told.headlines[..] else { panic!("{told:?}") };
        assert_eq!(
            (only.degree, &only.may_follow[..]),
            (Degree::Named, &["bsdf/c".to_owned()][..])
        );
    }
}
