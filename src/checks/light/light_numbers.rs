//! Samples of area lights follow from their own random numbers, use both, and survive those at the
//! ends of their range.

use crate::checks::numbers::Numbers;
use crate::checks::sampling::distribution::Drawn;
use crate::checks::sampling::extremes::{self, Extremes, Range};
use crate::checks::sampling::replay::{self, Replayed};
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::{Acceleration, Breach, BreachKind, BuiltScene, LightSample, Result};
use crate::math::rng::Seed;
use crate::scene::Light;
use crate::text::{Several, Vector};
use glam::DVec3;

/// A sample and its pdf come out of the same call: nothing else is evaluated.
const SAME: f64 = 0.0;

check! {
    /// Samples of every area light from some points that see its front.
    pub(crate) struct LightNumbers {
        from: Several<Vector>,
    }
    name: "light-numbers",
    summary: "samples of area lights follow from their numbers, the extreme ones too",
    needs: BUILD_SCENE | SAMPLE_LIGHT | CALLERS_RANDOMNESS,
}

impl Check for LightNumbers {
    fn run(&self, context: &mut Context<'_>) -> std::result::Result<Finding, CheckError> {
        let scene = context.scene()?;
        let numbers = Numbers::new(context.seed, replay::COUNT);
        let precision = context.info.precision;
        let area = (0..).zip(&scene.lights);
        let area = area.filter(|(_, light)| matches!(light, Light::Area { .. }));
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let (mut replayed, mut extremes) = (Vec::new(), Vec::new());
        for (light, _) in area {
            for (number, from) in self.from.iter().enumerate() {
                let name = format!("light {} from point {}", light + 1, number + 1);
                let mut asked = Asked { scene: built.as_mut(), light, from: from.0 };
                let ask = &mut |numbers: &Numbers| asked.samples(numbers);
                replayed.push(Replayed::of(name.clone(), &numbers, ask)?);
                let ask = &mut |numbers| asked.sample(numbers);
                extremes.push(Extremes::of(name, Range::Sphere, precision, SAME, ask)?);
            }
        }
        if replayed.is_empty() {
            return Err(CheckError::Broken(format!("scene `{}` has no area light", scene.name)));
        }
        Ok(together(&replayed, &extremes))
    }
}

/// A light, asked from one point.
struct Asked<'a> {
    scene: &'a mut dyn BuiltScene,
    light: u32,
    from: DVec3,
}

impl Asked<'_> {
    fn samples(&mut self, numbers: &Numbers) -> Result<Vec<Drawn>> {
        let from = vec![self.from; numbers.points.len()];
        let samples = numbers.sample_light(self.scene, self.light, &from)?;
        samples.iter().map(drawn).collect()
    }

    fn sample(&mut self, (point, lobe): extremes::Extreme) -> Result<(Drawn, f64)> {
        let number = Numbers { points: vec![point], lobes: vec![lobe], seed: Seed(0) };
        let drawn = self.samples(&number)?[0];
        Ok((drawn, drawn.pdf))
    }
}

/// A sample without its light: where it leads, if it leads anywhere.
fn drawn(sample: &LightSample) -> Result<Drawn> {
    let is_valid = sample.is_valid == 1;
    if is_valid && !(sample.distance > 0.0 && sample.distance.is_finite()) {
        let distance = sample.distance;
        let kind = match distance.is_infinite() {
            true => BreachKind::Infinite,
            false => BreachKind::OutOfRange(distance),
        };
        return Err(Breach::of("the distance to the light", kind).into());
    }
    Ok(Drawn { direction: is_valid.then_some(sample.wi), pdf: sample.pdf })
}

fn together(replayed: &[Replayed], extremes: &[Extremes]) -> Finding {
    let at_the_ends = extremes::finding(extremes);
    let complaints = replayed.iter().filter_map(Replayed::complaint);
    let statement = complaints.chain([at_the_ends.statement]).collect::<Vec<_>>().join("; ");
    let measures = replayed.iter().flat_map(Replayed::measures).chain(at_the_ends.measures);
    let finding = Finding::of(statement, "would have caught one wrong sample", measures.collect());
    let causes = replayed.iter().filter_map(Replayed::cause);
    let mut finding = finding.because_of(causes);
    finding.clues.extend(at_the_ends.clues);
    finding
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::scene::{Library, SceneDescription};
    use glam::DVec2;

    /// A light over the origin: a unit square at height 1, whose points are found by `place`.
    fn light(place: fn(DVec2) -> DVec2) -> Fake {
        let light = move |from: DVec3, point| {
            let to = place(point).extend(1.0) - from;
            let (wi, distance) = (to.normalize(), to.length());
            let pdf = distance * distance / wi.z;
            LightSample { wi, distance, radiance: [1.0; 3], pdf, is_delta: 0, is_valid: 1 }
        };
        Fake { light: Box::new(light), ..Fake::default() }
    }

    fn found(place: fn(DVec2) -> DVec2) -> Finding {
        let check: LightNumbers = check_of("[expect]\nfrom = [[0, 0, 0]]");
        let scene = Library::new("scenes").load("rectangle-light", &toml::Table::new()).unwrap();
        let scene = SceneDescription::clone(&scene);
        try_judge(&check, &mut light(place), Some(scene)).unwrap()
    }

    #[test]
    fn a_light_sampled_by_both_numbers_passes() {
        assert_passes(&found(|point| point - 0.5));
    }

    #[test]
    fn a_light_sampled_along_its_diagonal_is_named() {
        let finding = found(|point| DVec2::splat(point.x - 0.5));
        assert!(failure(&finding).contains("the second number moves 0 % of the samples"));
        assert_eq!(finding.clues[0].cause, "one-number-twice");
    }

    #[test]
    fn a_map_that_divides_by_a_number_breaks_at_its_end() {
        let finding = found(|point| point - 0.5 + 0.0 / point.x);
        let statement = failure(&finding);
        assert!(statement.contains("of the numbers 0, 0 and 0: "), "{statement}");
        assert_eq!(finding.clues[0].cause, "ends-of-range-forgotten");
    }
}
