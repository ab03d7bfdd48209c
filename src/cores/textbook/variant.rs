//! Copies of the plain core that do some steps otherwise: `textbook:NAME`, or `textbook:ONE+OTHER`.

use super::different::{DIFFERENT, NOTHING};
use super::steps::Steps;
use super::{Textbook, fault, single};
use crate::contract::{Conventions, Core, CoreInfo, Precision};

/// What joins the names of changes that are on together.
pub(crate) const AND: char = '+';

/// Why there is no copy with these changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoVariant<'a> {
    #[error("no fault and no choice is called `{0}`")]
    Unknown(&'a str),
    #[error("`{first}` and `{second}` both replace the step `{step}` of the lesson")]
    Clash { first: &'static str, second: &'static str, step: &'static str },
}

/// One change: a fault, or a choice.
struct Change {
    name: &'static str,
    steps: &'static Steps,
    declares: fn(&mut CoreInfo),
    is_right: bool,
}

fn changes() -> impl Iterator<Item = Change> {
    let faults = fault::all().map(|fault| Change {
        name: fault.name,
        steps: &fault.steps,
        declares: NOTHING,
        is_right: false,
    });
    let choices = DIFFERENT.iter().map(|choice| Change {
        name: choice.name,
        steps: &choice.steps,
        declares: choice.declares,
        is_right: true,
    });
    faults.chain(choices)
}

/// The names of all changes: the words that may follow `textbook:`.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    changes().map(|change| change.name)
}

/// The core with the changes of these names, joined by `+`.
///
/// # Errors
/// For a name that nothing has, and for two changes of one step.
pub(crate) fn core(joined: &str) -> Result<Box<dyn Core>, NoVariant<'_>> {
    let core = textbook(joined)?;
    Ok(match core.info.precision {
        Precision::Single => Box::new(single::Single(core)),
        _ => Box::new(core),
    })
}

fn textbook(joined: &str) -> Result<Textbook, NoVariant<'_>> {
    let mut core = Textbook::new();
    let mut on: Vec<Change> = Vec::new();
    for name in joined.split(AND) {
        let change = changes().find(|change| change.name == name);
        let change = change.ok_or(NoVariant::Unknown(name))?;
        core.own = core.own.and(change.steps).map_err(|step| clash(&on, &change, step))?;
        if change.is_right {
            // No step of its own is taken already, or that had been a clash.
            core.right = core.right.and(change.steps).unwrap_or(core.right);
        }
        (change.declares)(&mut core.info);
        on.push(change);
    }
    core.steps = core.own;
    core.info.name = format!("textbook:{joined}");
    Ok(core)
}

/// The core that is right and has chosen so.
pub(crate) fn following(conventions: Conventions) -> Textbook {
    let mut core = Textbook::new();
    let plain = core.info.clone();
    for choice in DIFFERENT {
        let declared = |conventions| {
            let mut info = CoreInfo { conventions, ..plain.clone() };
            (choice.declares)(&mut info);
            info.conventions
        };
        let says_something = declared(plain.conventions) != plain.conventions;
        if says_something && declared(conventions) == conventions {
            // What is declared by a field of its own replaces steps of its own.
            core.steps = core.steps.and(&choice.steps).unwrap_or(core.steps);
        }
    }
    core.info.conventions = conventions;
    core
}

fn clash(on: &[Change], change: &Change, step: &'static str) -> NoVariant<'static> {
    let replaces_it = |earlier: &&Change| earlier.steps.and(change.steps).err() == Some(step);
    let first = on.iter().find(replaces_it).map_or(change.name, |earlier| earlier.name);
    NoVariant::Clash { first, second: change.name, step }
}

#[cfg(test)]
mod tests {
    use super::super::steps::LESSON;
    use super::*;
    use crate::contract::{
        AdaptiveMean, AdaptiveSettings, BsdfQuery, BsdfValue, Components, Ray, Sampler,
    };
    use crate::scene::{Camera, Material, Surface};
    use glam::{DVec2, DVec3};
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_of_lower_case_words() {
        let mut seen = BTreeSet::new();
        for name in names() {
            assert!(seen.insert(name), "{name} stands there twice");
            let proper = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(name.chars().all(proper), "{name}");
        }
    }

    #[test]
    fn every_step_is_replaced_by_something_and_every_fault_replaces_one() {
        let mut replaced = BTreeSet::new();
        for change in changes() {
            let (steps, _) = change.steps.replaced();
            let declares_alone = ["single-precision", "images-alone"].contains(&change.name);
            assert!(!steps.is_empty() || declares_alone, "{}", change.name);
            replaced.extend(steps);
        }
        assert_eq!(replaced.len(), LESSON.replaced().1, "what nothing replaces is no step");
    }

    #[test]
    fn two_changes_are_on_together_unless_they_replace_one_step() {
        for first in changes() {
            for second in changes() {
                let steps = |change: &Change| BTreeSet::from_iter(change.steps.replaced().0);
                let shared = steps(&first).intersection(&steps(&second)).count();
                let joined = format!("{}+{}", first.name, second.name);
                match textbook(&joined) {
                    Ok(both) => {
                        let together = steps(&first).len() + steps(&second).len();
                        assert_eq!((shared, both.steps.replaced().0.len()), (0, together));
                        assert_eq!(both.info.name, format!("textbook:{joined}"));
                    }
                    Err(NoVariant::Clash { first: a, second: b, step }) => {
                        assert_eq!((a, b), (first.name, second.name));
                        assert!(shared > 0 && steps(&second).contains(step), "{joined}: {step}");
                    }
                    Err(unknown) => panic!("{joined}: {unknown}"),
                }
            }
        }
    }

    #[test]
    fn a_clash_names_both_changes_and_their_step() {
        let clash = core("fov-in-degrees+brdf-without-pi+fov-not-halved").err();
        let expected = "`fov-in-degrees` and `fov-not-halved` both replace the step `half_size` of \
                        the lesson";
        assert_eq!(clash.map(|clash| clash.to_string()), Some(expected.to_owned()));
        assert_eq!(core("fov-in-degrees+").err(), Some(NoVariant::Unknown("")));
    }

    #[test]
    fn a_core_that_follows_conventions_has_the_steps_of_each() {
        let declaring = "schlick-glass-outside+correlated-smith+no-falloff+unscaled-glass";
        let chosen = textbook(declaring).expect("they replace different steps");
        let following = following(chosen.info.conventions);
        assert_eq!(following.steps.replaced(), chosen.steps.replaced());
        assert_eq!(super::following(Conventions::default()).steps.replaced().0.len(), 0);
    }

    #[test]
    fn a_fault_goes_with_its_component_and_a_choice_stays() {
        let mut core =
            textbook("brdf-without-pi+sphere-far-root+schlick-glass").expect("it exists");
        let mut replaced_with = |components| {
            core.take_components(components).expect("it takes all");
            core.steps.replaced().0
        };
        assert_eq!(replaced_with(Components::BSDF).len(), 2, "a choice and the far root");
        assert_eq!(replaced_with(Components::all()), ["fresnel"]);
        assert_eq!(replaced_with(Components::empty()).len(), 3);
    }

    /// What a core says to a question of each part.
    fn answers(joined: &str) -> (Ray, f64, BsdfValue, AdaptiveMean) {
        let mut core = core(joined).expect("it exists");
        let camera = Camera::look_at(DVec3::X, DVec3::ZERO, DVec3::Z, 1.0, [20, 14]);
        let mut rays = [Ray::new(DVec3::ZERO, DVec3::Z)];
        core.generate_rays(&camera, &[DVec2::new(0.1, 0.7)], &mut rays).expect("it answers");
        let wi = DVec3::new(0.6, 0.0, 0.8);
        let mut pdf = [0.0];
        core.direction_pdf(Sampler::UniformHemisphere, &[wi], &mut pdf).expect("it answers");
        let surface = Surface::Diffuse { reflectance: [0.2, 0.4, 0.8] };
        let material = Material { name: String::new(), surface, emission: None };
        let mut values = [BsdfValue { f: [0.0; 3], pdf: 0.0 }];
        let query = BsdfQuery { wo: DVec3::Z, wi };
        core.eval_bsdf(&material, &[query], &mut values).expect("it answers");
        let settings = AdaptiveSettings { samples_per_batch: 2, max_tolerance: 0.5 };
        let stream: Vec<f64> = [1.0, 3.0, 0.5, 1.0, 1.0].repeat(8);
        let mut means = [AdaptiveMean { mean: 0.0, used: 0, reserved: 0 }];
        core.adaptive_mean(settings, &[&stream], &mut means).expect("it answers");
        (rays[0], pdf[0], values[0], means[0])
    }

    #[test]
    fn many_at_once_have_the_effect_of_each() {
        let faults = ["film-y-down", "uniform-pdf-doubled", "albedo-averaged", "without-1-96"];
        let [camera, sampler, surface, rule] = faults.map(answers);
        let together = answers(&faults.join("+"));
        assert_eq!(together, (camera.0, sampler.1, surface.2, rule.3));
        assert_ne!((camera.0, sampler.1), (rule.0, rule.1));
        assert_ne!((surface.2, rule.3), (camera.2, camera.3));
    }
}
