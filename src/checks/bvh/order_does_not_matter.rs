//! The order of triangles in their mesh is nobody's business: shuffled, they are hit at the same t, but for rounding.
//!
//! Needs no loop to compare with, and so sees what a loop over a wrong range would not: a triangle
//! that is lost wherever it stands last.

use super::order::{Answers, Difference, Order, rounding};
use super::question::{generic_rays, segments};
use crate::cause::{Cause, bvh};
use crate::checks::phrase::{one_in, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::scene::Aabb;
use crate::text::Count;
use glam::DVec3;

/// Orders beside the one of the scene.
const ORDERS: usize = 3;

check! {
    /// Hits do not depend on the order of triangles.
    pub(crate) struct OrderDoesNotMatter {
        /// Rays, and as many segments.
        rays: Count,
    }
    name: "order-does-not-matter",
    summary: "shuffled triangles are hit at the same t",
    needs: BUILD_SCENE | INTERSECT | OCCLUDED,
}

impl Check for OrderDoesNotMatter {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let bounds = scene.bounds().unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ONE });
        let count = usize::try_from(self.rays.0).unwrap_or(usize::MAX);
        let rays = generic_rays(bounds, count, &mut context.seed.child("rays").stream());
        let first = Answers::of(context, &scene, &rays, None)?;
        let stream = &mut context.seed.child("segments").stream();
        let segments = segments(&rays, &first.hits, bounds, stream);
        let first = Answers::of(context, &scene, &rays, Some(&segments))?;
        let rounding = rounding(context.info.precision, (bounds.max - bounds.min).length());
        let mut differences = Vec::new();
        for number in 0..ORDERS {
            let stream = &mut context.seed.child("order").child(number).stream();
            let order = Order::shuffled(&scene, stream);
            let answers = Answers::of(context, &order.scene, &rays, Some(&segments))?;
            differences.push(Difference::between(&first, &answers, &order, rounding));
        }
        Ok(finding(&differences, rays.len() + segments.len()))
    }
}

fn finding(differences: &[Difference], asked: usize) -> Finding {
    let measures = |(number, difference): (u32, &Difference)| {
        [
            Measure::none("closest hits that differ", difference.hits),
            Measure::none("any hits that differ", difference.occlusions),
        ]
        .map(|measure| measure.of_row(format!("order {number}")))
    };
    let measures = (1..).zip(differences).flat_map(measures).collect();
    let worst = differences.iter().map(Difference::total).max().filter(|total| *total > 0);
    let complaint = worst.map(|total| {
        format!("{} another when the triangles are shuffled", some_are(total, asked, "answers"))
    });
    let right = format!("{asked} answers are the same in {} orders", differences.len() + 1);
    let rare = one_in(asked * differences.len());
    Finding::of(right, format!("would have caught one answer in {rare}"), measures)
        .complaining(complaint)
        .because_of(lost_place(differences))
}

/// What is lost always stands at the same place of its order.
fn lost_place(differences: &[Difference]) -> Option<(&'static Cause, String)> {
    let lost: Vec<_> = differences.iter().flat_map(|difference| &difference.lost).collect();
    let (place, triangles) = **lost.first()?;
    let is_same = lost.iter().all(|(other, _)| *other == place);
    (is_same && lost.len() > 1).then(|| {
        let evidence = format!(
            "all {} hits that one order loses are of one triangle of {triangles}, by its place in that order",
            lost.len()
        );
        (&bvh::PRIMITIVES_LOST, evidence)
    })
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeCore, Slip};
    use super::super::question::scene_of;
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, try_judge};
    use crate::scene::procedural::bumpy_sphere;

    fn found(slip: Slip) -> Finding {
        let check: OrderDoesNotMatter = check_of("[expect]\nrays = \"3 k\"");
        try_judge(&check, &mut FakeCore(slip), Some(scene_of(bumpy_sphere(2)))).unwrap()
    }

    #[test]
    fn a_bvh_without_mistakes_passes() {
        assert_passes(&found(Slip::None));
    }

    #[test]
    fn a_triangle_that_is_lost_where_it_stands_last_is_named() {
        let finding = found(Slip::LosesTheLast);
        assert!(failure(&finding).ends_with("another when the triangles are shuffled"));
        assert_eq!(causes(&finding), ["primitives-lost"]);
        assert!(finding.clues[0].evidence.contains("of one triangle of 320"), "{finding:?}");
    }

    #[test]
    fn the_first_hit_depends_on_the_order_and_has_no_name() {
        assert!(causes(&found(Slip::KeepsTheFirstHit)).is_empty());
    }
}
