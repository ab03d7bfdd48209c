//! With mistakes whose numbers are made up.

use super::*;
use crate::case::Foundation;
use crate::cause::{bsdf, bvh, contract, integrator, light};
use crate::diagnosis::testing::{Made, failing, mean, means, passing};
use crate::diagnosis::{Degree, Diagnosis, Ending, Headline, diagnose, diagnose_proven};
use crate::image::Channel;

const PI: Mistake = mistake("pi", &bsdf::WITHOUT_PI, "bsdf/a");
const DIVIDED: Mistake = mistake("divided", &light::DIVIDED_BY_LIGHTS, "light/b");
const COSINE: Mistake = mistake("cosine", &light::WORLD_COSINE, "light/b");
const AGAIN: Mistake = mistake("again", &integrator::EMISSION_AGAIN, "light/b");

const fn mistake(name: &'static str, cause: &'static Cause, caught_by: &'static str) -> Mistake {
    Mistake { name, cause, components: Components::BSDF, caught_by }
}

/// Mistakes, and the ratio to what is right that they give together in a case; 1 where nothing is said.
struct Bench<'a> {
    mistakes: &'a [Mistake],
    gives: &'a [(&'a [&'a str], &'a str, f64)],
}

impl Planted for Bench<'_> {
    fn mistakes(&self) -> &[Mistake] {
        self.mistakes
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let ratio = |question: &Question<'_>| {
            let names: Vec<_> = question.mistakes.iter().map(|one| one.name).collect();
            let of = |(set, case, _): &&(&[&str], &str, f64)| {
                let is_set = set.len() == names.len() && names.iter().all(|n| set.contains(n));
                is_set && *case == question.case
            };
            self.gives.iter().find(of).map_or(1.0, |(.., ratio)| *ratio)
        };
        questions.iter().map(|question| Some(light(ratio(question)))).collect()
    }
}

fn light(ratio: f64) -> Finding {
    means(vec![mean("bounce 1", Channel::Red, 0.5, ratio, 0.01)])
}

fn told(diagnosis: &Diagnosis) -> Vec<(&str, Degree, usize)> {
    let headlines = diagnosis.headlines.iter();
    headlines.map(|told| (&told.cause[..], told.degree, told.explains.len())).collect()
}

#[test]
fn what_the_planted_mistake_contradicts_is_not_told() {
    let brighter = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
    let made = Made::new().with("bsdf/a", brighter);
    assert_eq!(diagnose(&made.evidence()).headlines[0].cause, bsdf::WITHOUT_PI.name);
    for other in [1.0, 0.5] {
        let planted = Bench { mistakes: &[PI], gives: &[(&["pi"], "bsdf/a", other)] };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        assert_eq!(told(&diagnosis), [("", Degree::DiffersHere, 1)], "{other}");
    }
    let planted = Bench { mistakes: &[PI], gives: &[(&["pi"], "bsdf/a", 2.5)] };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let pi = bsdf::WITHOUT_PI.name;
    assert_eq!(told(&diagnosis), [(pi, Degree::LooksLike, 1)], "it is of another size");
}

#[test]
fn a_mistake_whose_own_case_passes_is_not_told_of_one_other() {
    let seen = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
    let planted =
        Bench { mistakes: &[PI], gives: &[(&["pi"], "bsdf/a", 3.0), (&["pi"], "bsdf/b", 2.0)] };
    let causes = |made: Made| {
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        diagnosis.headlines.into_iter().map(|told| told.cause).collect::<Vec<_>>()
    };
    let pi = bsdf::WITHOUT_PI.name;
    assert_eq!(causes(Made::new().with("bsdf/b", seen.clone())), [pi]);
    assert_eq!(causes(Made::new().with("bsdf/b", seen.clone()).with("bsdf/a", passing())), [""]);
}

#[test]
fn three_mistakes_that_only_together_give_all_numbers_are_named() {
    const ALONE: [(&str, [f64; 6]); 3] = [
        ("pi", [2.0, 2.5, 1.0, 1.0, 4.0, 1.0]),
        ("cosine", [1.0, 1.5, 7.0, 5.0, 1.0, 3.0]),
        ("again", [3.0, 1.0, 1.0, 8.0, 5.0, 9.0]),
    ];
    let cases = ["bsdf/a", "light/b", "light/c", "light/d", "light/e", "light/f"];
    let ratio = |set: &[usize], case: usize| -> f64 {
        set.iter().map(|mistake| ALONE[*mistake].1[case]).product()
    };
    let made = (0..6)
        .fold(Made::new(), |made, case| made.with(cases[case], light(ratio(&[0, 1, 2], case))));
    let sets: [(&[usize], &[&str]); 7] = [
        (&[0], &["pi"]),
        (&[1], &["cosine"]),
        (&[2], &["again"]),
        (&[0, 1], &["pi", "cosine"]),
        (&[0, 2], &["pi", "again"]),
        (&[1, 2], &["cosine", "again"]),
        (&[0, 1, 2], &["pi", "cosine", "again"]),
    ];
    let given = sets
        .iter()
        .flat_map(|(set, names)| (0..6).map(move |case| (*names, cases[case], ratio(set, case))));
    let gives: Vec<_> = given.collect();
    let planted = Bench { mistakes: &[PI, COSINE, AGAIN], gives: &gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let mut named = told(&diagnosis);
    named.sort_unstable();
    let name = |cause: &'static Cause, cases| (cause.name, Degree::Named, cases);
    let mut expected = [
        name(&light::WORLD_COSINE, 4),
        name(&integrator::EMISSION_AGAIN, 4),
        name(&bsdf::WITHOUT_PI, 3),
    ];
    expected.sort_unstable();
    assert_eq!(named, expected);
}

#[test]
fn of_two_mistakes_of_a_cause_the_one_that_is_there_stands_beside_the_next() {
    const MORE: Mistake = mistake("more", &bsdf::WITHOUT_PI, "bsdf/a");
    const LESS: Mistake = mistake("less", &bsdf::WITHOUT_PI, "bsdf/a");
    let seen = light(4.0).because(&bsdf::WITHOUT_PI, "x");
    let made = Made::new().with("bsdf/a", seen).with("light/b", light(20.0));
    let gives: [(&[&str], &str, f64); 6] = [
        (&["more"], "bsdf/a", 2.0),
        (&["less"], "bsdf/a", 4.0),
        (&["less"], "light/b", 1.5),
        (&["cosine"], "light/b", 3.0),
        (&["more", "cosine"], "light/b", 7.0),
        (&["less", "cosine"], "light/b", 20.0),
    ];
    let planted = Bench { mistakes: &[MORE, LESS, COSINE], gives: &gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let causes: Vec<_> = told(&diagnosis).into_iter().map(|(cause, ..)| cause).collect();
    assert_eq!(causes, [bsdf::WITHOUT_PI.name, light::WORLD_COSINE.name]);
}

#[test]
fn weak_light_is_not_told_among_much_that_is_dark_and_right_with_its_mistake() {
    let of_core = [("light/b", 0.5), ("light/c", 0.25)].into_iter();
    let of_core = of_core.chain(["light/d", "light/e", "light/f", "light/g"].map(|c| (c, 0.0)));
    let made = of_core.fold(Made::new(), |made, (case, ratio)| made.with(case, light(ratio)));
    let causes = |of_dark: f64| {
        let dark: [(&[&str], &str, f64); 4] =
            ["light/d", "light/e", "light/f", "light/g"].map(|c| (&["cosine"][..], c, of_dark));
        let own: [(&[&str], &str, f64); 2] =
            [(&["cosine"], "light/b", 0.5), (&["cosine"], "light/c", 0.25)];
        let gives = [&own[..], &dark].concat();
        let planted = Bench { mistakes: &[COSINE], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        told(&diagnosis).into_iter().map(|(cause, ..)| cause.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(causes(1.0), [""]);
    assert!(causes(0.0).contains(&light::WORLD_COSINE.name.to_owned()));
}

#[test]
fn a_mistake_is_named_in_its_own_places_beside_one_that_nobody_knows() {
    let of_core = [("light/b", 2.0), ("light/c", 3.0), ("light/d", 5.0), ("light/e", 7.0)];
    let of_core = of_core.into_iter().chain([("light/f", 11.0)]);
    let made = of_core.fold(Made::new(), |made, (case, ratio)| made.with(case, light(ratio)));
    let causes = |of_d: f64, of_again: f64| {
        let gives: [(&[&str], &str, f64); 5] = [
            (&["cosine"], "light/b", 2.0),
            (&["cosine"], "light/c", 3.0),
            (&["cosine"], "light/d", of_d),
            (&["again"], "light/b", of_again),
            (&["again"], "light/c", 3.0),
        ];
        let planted = Bench { mistakes: &[COSINE, AGAIN], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        told(&diagnosis).into_iter().map(|(cause, ..)| cause.to_owned()).collect::<Vec<_>>()
    };
    let cosine = light::WORLD_COSINE.name.to_owned();
    assert!(causes(1.0, 1.0).contains(&cosine));
    assert_eq!(causes(4.0, 1.0), [""], "what it fails otherwise is not its own");
    assert_eq!(causes(1.0, 2.0), [""], "two may be what is seen there");
}

#[test]
fn a_cause_whose_numbers_all_others_give_together_is_not_told() {
    let seen = |ratio, cause: &Cause| light(ratio).because(cause, "x");
    let made = Made::new()
        .with("bsdf/a", seen(2.0, &bsdf::WITHOUT_PI))
        .with("light/b", seen(3.0, &light::WORLD_COSINE))
        .with("integrator/c", seen(5.0, &integrator::ROULETTE_NOT_PLAYED));
    let pi = bsdf::WITHOUT_PI.name;
    let names = |gives: &[(&[&str], &str, f64)]| -> Vec<String> {
        let planted = Bench { mistakes: &[PI, COSINE], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        diagnosis.headlines.into_iter().map(|told| told.cause).collect()
    };
    let apart: [(&[&str], &str, f64); 4] = [
        (&["pi"], "bsdf/a", 2.0),
        (&["cosine"], "light/b", 3.0),
        (&["pi", "cosine"], "bsdf/a", 2.0),
        (&["pi", "cosine"], "light/b", 3.0),
    ];
    let roulette = integrator::ROULETTE_NOT_PLAYED.name;
    assert!(names(&apart).contains(&roulette.to_owned()));
    let together = [&apart[..], &[(&["pi", "cosine"], "integrator/c", 5.0)]].concat();
    let told = names(&together);
    assert!(told.contains(&pi.to_owned()) && !told.contains(&roulette.to_owned()), "{told:?}");
}

#[test]
fn a_cause_of_darkness_that_all_others_leave_dark_is_not_told() {
    let seen = |ratio, cause: &Cause| light(ratio).because(cause, "x");
    let made = Made::new()
        .with("bsdf/a", seen(2.0, &bsdf::WITHOUT_PI))
        .with("light/b", seen(3.0, &light::WORLD_COSINE))
        .with("integrator/c", seen(0.0, &integrator::ROULETTE_NOT_PLAYED));
    let names = |dark: f64| -> Vec<String> {
        let gives: [(&[&str], &str, f64); 5] = [
            (&["pi"], "bsdf/a", 2.0),
            (&["cosine"], "light/b", 3.0),
            (&["pi", "cosine"], "bsdf/a", 2.0),
            (&["pi", "cosine"], "light/b", 3.0),
            (&["pi", "cosine"], "integrator/c", dark),
        ];
        let planted = Bench { mistakes: &[PI, COSINE], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        diagnosis.headlines.into_iter().map(|told| told.cause).collect()
    };
    let roulette = integrator::ROULETTE_NOT_PLAYED.name.to_owned();
    assert!(names(1.0).contains(&roulette) && !names(0.0).contains(&roulette));
}

#[test]
fn a_mistake_that_would_change_what_another_name_explains_is_not_told() {
    const BY_PI: [(&str, f64); 4] =
        [("light/c", 2.0), ("light/d", 5.0), ("light/e", 9.0), ("light/f", 0.2)];
    let made = Made::new().with("light/b", light(3.0).because(&light::WORLD_COSINE, "too bright"));
    let made = made.with("bsdf/a", light(3.0));
    let made = BY_PI.into_iter().fold(made, |made, (case, of)| made.with(case, light(of)));
    let names = |of_both: f64| {
        let mut gives: Vec<(&[&str], &str, f64)> = vec![
            (&["cosine"], "light/b", 3.0),
            (&["pi", "cosine"], "light/b", 3.0),
            (&["cosine"], "bsdf/a", 3.0),
            (&["pi"], "bsdf/a", 0.4),
            (&["pi", "cosine"], "bsdf/a", of_both),
        ];
        gives.extend(BY_PI.map(|(case, of)| (&["pi"][..], case, of)));
        gives.extend(BY_PI.map(|(case, of)| (&["pi", "cosine"][..], case, of)));
        let planted = Bench { mistakes: &[PI, COSINE], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        diagnosis.headlines.into_iter().map(|told| told.cause).collect::<Vec<_>>()
    };
    let pi = bsdf::WITHOUT_PI.name.to_owned();
    assert!(names(3.0).contains(&pi), "beside the other it changes nothing there");
    assert!(!names(0.4).contains(&pi), "its own case would come out otherwise");
}

#[test]
fn what_functions_answer_is_not_lost_in_light_that_does_not_arrive() {
    let dark_beside = |others: [&'static str; 2]| {
        let seen = light(0.0).because(&bsdf::WITHOUT_PI, "no answer");
        let made = Made::new().with("bsdf/a", seen);
        let made = others.into_iter().fold(made, |made, case| made.with(case, light(0.0)));
        let [b, c] = others;
        let gives: [(&[&str], &str, f64); 3] =
            [(&["pi"], "bsdf/a", 0.0), (&["pi"], b, 1.0), (&["pi"], c, 1.0)];
        let diagnosis =
            diagnose_proven(&made.evidence(), &Bench { mistakes: &[PI], gives: &gives });
        let told = diagnosis.headlines.into_iter().find(|told| told.explains == ["bsdf/a"]);
        told.map(|told| (told.cause, told.degree))
    };
    let named = Some((bsdf::WITHOUT_PI.name.to_owned(), Degree::Named));
    assert_eq!(dark_beside(["light/b", "integrator/c"]), named);
    assert_ne!(dark_beside(["bsdf/b", "bsdf/c"]), named, "functions are a crowd for functions");
}

#[test]
fn what_a_named_mistake_leaves_dark_as_it_is_follows_from_it() {
    let gives: [(&[&str], &str, f64); 3] =
        [(&["pi"], "bsdf/a", 2.0), (&["pi"], "light/b", 0.0), (&["cosine"], "light/b", 0.0)];
    let planted = Bench { mistakes: &[PI, COSINE], gives: &gives };
    let unexplained = |of_b: Finding| {
        let seen = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
        let made = Made::new().with("bsdf/a", seen).with("light/b", of_b);
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        assert_eq!(diagnosis.headlines[0].cause, bsdf::WITHOUT_PI.name);
        diagnosis.unexplained
    };
    assert!(unexplained(light(0.0)).is_empty());
    assert_eq!(unexplained(failing("no answer")), ["light/b"], "that is no darkness");
}

#[test]
fn darkness_is_named_where_one_mistake_alone_leaves_it_and_its_neighbours_light() {
    const OTHER: Mistake = mistake("other", &light::WORLD_COSINE, "light/c");
    let causes = |by_other: f64, neighbours: usize| {
        let mut made = Made::new().with("light/b", light(0.0)).with("light/c", light(0.0));
        for name in &["light/d", "light/e", "light/f", "light/g"][..neighbours] {
            made = made.with(*name, light(1.0));
        }
        let gives: [(&[&str], &str, f64); 4] = [
            (&["divided"], "light/b", 0.0),
            (&["divided"], "light/c", 0.0),
            (&["other"], "light/b", by_other),
            (&["other"], "light/c", 0.0),
        ];
        let planted = Bench { mistakes: &[DIVIDED, OTHER], gives: &gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let told = diagnosis.headlines.into_iter().map(|told| (told.cause, told.degree));
        told.collect::<Vec<_>>()
    };
    let nothing = [(String::new(), Degree::DiffersHere)];
    let divided = light::DIVIDED_BY_LIGHTS.name.to_owned();
    assert_eq!(causes(0.5, 4), [(divided, Degree::Named)]);
    assert_eq!(causes(0.0, 4), nothing, "another leaves it dark, too");
    assert_eq!(causes(0.5, 1), nothing, "too little was asked beside it");
}

/// A bench whose time is up.
struct Late;

impl Planted for Late {
    fn mistakes(&self) -> &[Mistake] {
        &[PI]
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        vec![None; questions.len()]
    }
}

/// Mistakes that are called by what they multiply by, and which of them were asked not only roughly.
struct Factors {
    mistakes: Vec<Mistake>,
    asked: std::sync::Mutex<BTreeSet<&'static str>>,
}

impl Planted for Factors {
    fn mistakes(&self) -> &[Mistake] {
        &self.mistakes
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let answer = |question: &Question<'_>| {
            let name = question.mistakes[0].name;
            if !question.roughly {
                self.asked.lock().unwrap().insert(name);
            }
            Some(light(name.parse().unwrap()))
        };
        questions.iter().map(answer).collect()
    }
}

#[test]
fn a_first_look_leaves_few_mistakes_for_the_second() {
    let made = Made::new().with("light/b", light(1.8));
    let of = |name| mistake(name, &bsdf::WITHOUT_PI, "light/b");
    let mistakes = ["1.2", "1.4", "1.6", "1.8", "2.0", "2.2"].map(of).to_vec();
    let bench = Factors { mistakes, asked: Default::default() };
    let diagnosis = diagnose_proven(&made.evidence(), &bench);
    assert_eq!(diagnosis.headlines[0].cause, bsdf::WITHOUT_PI.name);
    assert_eq!(bench.asked.into_inner().unwrap(), BTreeSet::from(["1.8"]));
}

/// The same, and which of them were asked in a case that takes more than others.
struct Dear {
    factors: Factors,
    case: &'static str,
}

impl Planted for Dear {
    fn mistakes(&self) -> &[Mistake] {
        &self.factors.mistakes
    }

    fn price(&self, question: &Question<'_>) -> u64 {
        if question.case == self.case { 2 } else { 1 }
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let of_case = questions.iter().filter(|question| question.case == self.case);
        self.factors.asked.lock().unwrap().extend(of_case.map(|one| one.mistakes[0].name));
        questions.iter().map(|one| Some(light(one.mistakes[0].name.parse().unwrap()))).collect()
    }
}

#[test]
fn a_dear_case_is_asked_of_what_a_cheaper_one_leaves() {
    let of = |name| mistake(name, &bsdf::WITHOUT_PI, "light/b");
    let names = ["1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7", "1.8", "1.9", "2.0", "2.1"];
    for case in ["light/b", "light/c"] {
        let made = Made::new().with("light/b", light(1.8)).with("light/c", light(1.8));
        let factors = Factors { mistakes: names.map(of).to_vec(), asked: Default::default() };
        let bench = Dear { factors, case };
        let diagnosis = diagnose_proven(&made.evidence(), &bench);
        assert_eq!(diagnosis.headlines[0].cause, bsdf::WITHOUT_PI.name);
        let asked = bench.factors.asked.into_inner().unwrap();
        assert!(asked.contains("1.8") && asked.len() < names.len() / 2, "{case}: {asked:?}");
    }
}

#[test]
fn every_case_is_priced_by_as_many_mistakes() {
    for count in CASES + 1..40 {
        let names: Vec<&str> = (0..count).map(|number| &*number.to_string().leak()).collect();
        let sets: Vec<_> =
            names.iter().map(|name| vec![mistake(name, &bsdf::WITHOUT_PI, "light/b")]).collect();
        for place in 0..20 {
            let some = asking::sample(&sets, place);
            let different: BTreeSet<_> = some.iter().map(|set| set[0].name).collect();
            assert_eq!(different.len(), asking::SAMPLED, "{place} of {count}");
        }
    }
}

/// Of one mistake in two places, one fails what the other passes, without a number.
struct InTwoPlaces;

impl Planted for InTwoPlaces {
    fn mistakes(&self) -> &[Mistake] {
        const HERE: Mistake = mistake("here", &bsdf::WITHOUT_PI, "bsdf/a");
        const THERE: Mistake = mistake("there", &bsdf::WITHOUT_PI, "bsdf/b");
        &[HERE, THERE]
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let is_here = |question: &Question<'_>| {
            (question.mistakes[0].name == "here") == (question.case == "bsdf/a")
        };
        let answer = |is_here| if is_here { failing("a breach") } else { passing() };
        questions.iter().map(|question| Some(answer(is_here(question)))).collect()
    }
}

#[test]
fn a_mistake_in_another_place_does_not_contradict_what_fails_without_a_number() {
    let breach = failing("a breach").because(&bsdf::WITHOUT_PI, "a breach");
    let made = Made::new().with("bsdf/a", breach);
    let diagnosis = diagnose_proven(&made.evidence(), &InTwoPlaces);
    assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::Named, 1)]);
}

#[test]
fn a_cause_that_there_is_no_time_to_ask_keeps_its_name() {
    let brighter = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
    let made = Made::new().with("bsdf/a", brighter);
    let diagnosis = diagnose_proven(&made.evidence(), &Late);
    assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::Named, 1)]);
}

#[test]
fn a_cause_is_put_to_the_proof_however_slow_the_core_is() {
    let brighter = light(2.0).because(&bsdf::WITHOUT_PI, "too bright");
    let made = Made::new().with("bsdf/a", brighter).taking(1 << 40);
    let planted = Bench { mistakes: &[PI], gives: &[] };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    assert_eq!(told(&diagnosis), [("", Degree::DiffersHere, 1)]);
}

#[test]
fn what_contradicts_one_cause_makes_room_for_the_next() {
    let finding =
        light(0.5).because(&bsdf::WITHOUT_PI, "x").because(&light::DIVIDED_BY_LIGHTS, "y");
    let made = Made::new().with("light/b", finding);
    let gives: &[(&[&str], _, _)] = &[(&["divided"], "light/b", 0.5)];
    let planted = Bench { mistakes: &[PI, DIVIDED], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let divided = light::DIVIDED_BY_LIGHTS.name;
    assert_eq!(told(&diagnosis), [(divided, Degree::Named, 1)]);
}

#[test]
fn what_no_rule_knows_is_named_by_the_one_mistake_that_gives_the_same_numbers() {
    let made = Made::new().with("light/b", light(0.5)).with("light/c", light(0.25));
    let gives: &[(&[&str], _, _)] = &[
        (&["divided"], "light/b", 0.5),
        (&["divided"], "light/c", 0.25),
        (&["again"], "light/b", 0.5),
    ];
    let planted = Bench { mistakes: &[DIVIDED, AGAIN], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let divided = light::DIVIDED_BY_LIGHTS.name;
    assert_eq!(told(&diagnosis), [(divided, Degree::Named, 2)]);
}

#[test]
fn one_mistake_that_is_wrong_alike_everywhere_and_mostly_by_as_much_is_looked_like() {
    let made = Made::new().with("light/b", light(0.5)).with("light/c", light(0.25));
    let told_where = |ratio| {
        let gives: &[(&[&str], _, _)] =
            &[(&["divided"], "light/b", 0.5), (&["divided"], "light/c", ratio)];
        let planted = Bench { mistakes: &[DIVIDED, AGAIN], gives };
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        let (cause, degree, cases) = told(&diagnosis)[0];
        (cause.to_owned(), degree, cases)
    };
    let divided = light::DIVIDED_BY_LIGHTS.name.to_owned();
    assert_eq!(told_where(0.4), (divided, Degree::LooksLike, 2));
    assert_eq!(told_where(1.4).1, Degree::DiffersHere, "to the other side");
}

#[test]
fn two_mistakes_that_give_the_numbers_only_together_are_both_named() {
    let made = Made::new().with("bsdf/a", light(0.7)).with("light/b", light(0.4));
    let both: &[&str] = &["pi", "divided"];
    let gives = &[(both, "bsdf/a", 0.7), (both, "light/b", 0.4)];
    let planted = Bench { mistakes: &[PI, DIVIDED], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let names = [bsdf::WITHOUT_PI.name, light::DIVIDED_BY_LIGHTS.name];
    assert_eq!(told(&diagnosis), names.map(|name| (name, Degree::Named, 2)));
}

#[test]
fn a_mistake_that_gives_the_numbers_of_two_causes_is_all_there_is() {
    let made = Made::new()
        .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
        .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"));
    let gives: &[(&[&str], _, _)] =
        &[(&["pi"], "bsdf/a", 1.5), (&["pi"], "light/b", 0.5), (&["divided"], "light/b", 0.5)];
    let planted = Bench { mistakes: &[PI, DIVIDED], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::Named, 2)]);
}

#[test]
fn of_two_mistakes_that_give_the_numbers_of_a_cause_the_one_that_gives_more_is_told() {
    let made = Made::new()
        .with("light/b", light(1.5).because(&bsdf::WITHOUT_PI, "y"))
        .with("light/c", light(1.2));
    let gives: &[(&[&str], _, _)] =
        &[(&["pi"], "light/b", 1.5), (&["again"], "light/b", 1.5), (&["again"], "light/c", 1.2)];
    let planted = Bench { mistakes: &[PI, AGAIN], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let again = integrator::EMISSION_AGAIN.name;
    assert_eq!(told(&diagnosis), [(again, Degree::Named, 2)]);
}

#[test]
fn what_passes_with_a_named_mistake_does_not_follow_from_it() {
    let made = || {
        let pi = light(0.5).because(&bsdf::WITHOUT_PI, "x");
        let made = Made::new().with("bsdf/a", pi).with("light/b", light(0.9));
        let on = [Foundation::Diffuse];
        made.proving("bsdf/a", &on).resting("light/b", &on)
    };
    for (ratio, headlines) in [(0.7, 1), (1.0, 2)] {
        let gives: &[(&[&str], _, _)] = &[(&["pi"], "bsdf/a", 0.5), (&["pi"], "light/b", ratio)];
        let planted = Bench { mistakes: &[PI], gives };
        assert_eq!(diagnose_proven(&made().evidence(), &planted).headlines.len(), headlines);
    }
}

#[test]
fn what_only_informs_says_what_a_failure_looks_like() {
    let told_by = failing("the other way").because(&bsdf::WITHOUT_PI, "x");
    let made = Made::new().with("light/b", light(0.4)).with("bsdf/a", told_by).informing("bsdf/a");
    for (ratio, cause) in [(0.7, bsdf::WITHOUT_PI.name), (1.5, "")] {
        let gives: &[(&[&str], _, _)] = &[(&["pi"], "light/b", ratio)];
        let diagnosis = diagnose_proven(&made.evidence(), &Bench { mistakes: &[PI], gives });
        assert_eq!(told(&diagnosis)[0].0, cause);
        assert_ne!(told(&diagnosis)[0].1, Degree::Named);
    }
}

#[test]
fn what_all_that_is_told_gives_together_is_no_further_mistake() {
    let made = Made::new()
        .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
        .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"))
        .with("light/c", light(0.7));
    let told_both: &[&str] = &["pi", "divided"];
    let gives: &[(&[&str], _, _)] = &[
        (&["pi"], "bsdf/a", 1.5),
        (&["divided"], "light/b", 0.5),
        (told_both, "light/c", 0.7),
        (&["pi", "divided", "again"], "light/c", 0.7),
    ];
    let planted = Bench { mistakes: &[PI, DIVIDED, AGAIN], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let names = [bsdf::WITHOUT_PI.name, light::DIVIDED_BY_LIGHTS.name];
    assert_eq!(told(&diagnosis), names.map(|name| (name, Degree::Named, 2)));
}

/// Two mistakes, by which together, and by neither alone, an answer is negative.
struct NegativeTogether(bool);

impl Planted for NegativeTogether {
    fn mistakes(&self) -> &[Mistake] {
        &[PI, COSINE]
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let answer = |question: &Question<'_>| match self.0 && question.mistakes.len() == 2 {
            true => failing("-1").because(&contract::NEGATIVE, "-1"),
            false => passing(),
        };
        questions.iter().map(|question| Some(answer(question))).collect()
    }
}

#[test]
fn a_negative_number_that_all_that_is_named_gives_follows_from_it() {
    let made = Made::new()
        .with("bsdf/a", failing("a").because(&bsdf::WITHOUT_PI, "a"))
        .with("light/b", failing("b").because(&light::WORLD_COSINE, "b"))
        .with("integrator/c", failing("-1").because(&contract::NEGATIVE, "-1"));
    let evidence = made.evidence();
    let told = |bench| {
        let told = without_needless(&evidence, &bench);
        told.into_iter().map(|told| (told.cause, told.may_follow)).collect::<Vec<_>>()
    };
    let alone = |cause: &Cause| (cause.name.to_owned(), Vec::new());
    let named = (bsdf::WITHOUT_PI.name.to_owned(), vec!["integrator/c".to_owned()]);
    assert_eq!(told(NegativeTogether(true)), [named, alone(&light::WORLD_COSINE)]);
    let all = [&bsdf::WITHOUT_PI, &light::WORLD_COSINE, &contract::NEGATIVE];
    assert_eq!(told(NegativeTogether(false)), all.map(alone), "something else gives it");
}

/// Three failures, each with a cause of its own.
fn three_causes() -> Made {
    Made::new()
        .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
        .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"))
        .with("light/c", light(0.7).because(&light::WORLD_COSINE, "z"))
}

/// What rules suspect, without what the others make needless.
fn without_needless(evidence: &Evidence<'_>, bench: &dyn Planted) -> Vec<Headline> {
    let ranked = look_without(evidence, &Refuted::new(), Vec::new());
    without_what_follows(ranked, evidence, bench).told().headlines
}

#[test]
fn what_nothing_takes_beside_the_others_is_not_told_though_a_part_of_the_core_has_it() {
    let made = three_causes();
    let evidence = made.evidence();
    let told = |with_all: f64| {
        let gives: &[(&[&str], _, _)] = &[
            (&["pi", "divided"], "light/c", 0.7),
            (&["pi", "divided", "cosine"], "light/c", with_all),
        ];
        let bench = Bench { mistakes: &[PI, DIVIDED, COSINE], gives };
        let told = without_needless(&evidence, &bench);
        told.into_iter().map(|told| (told.cause, told.may_follow)).collect::<Vec<_>>()
    };
    let [pi, divided, cosine] =
        [&bsdf::WITHOUT_PI, &light::DIVIDED_BY_LIGHTS, &light::WORLD_COSINE].map(|c| c.name);
    let alone = |cause: &str| (cause.to_owned(), Vec::new());
    let first = (pi.to_owned(), vec!["light/c".to_owned()]);
    assert_eq!(told(1.2), [first, alone(divided)]);
    let all = [pi, cosine, divided].map(alone);
    assert_eq!(told(0.7), all, "it changes nothing there, and may be made elsewhere");
}

/// A bench in which a mistake goes with its component.
struct InOnePlace;

impl Planted for InOnePlace {
    fn mistakes(&self) -> &[Mistake] {
        &[PI]
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let of_case = |case: &str| if case == "bsdf/a" { 0.5 } else { 1.7 };
        let ratio = |question: &Question<'_>| match question.with.intersects(PI.components) {
            true => 1.0,
            false => of_case(question.case),
        };
        questions.iter().map(|question| Some(light(ratio(question)))).collect()
    }
}

#[test]
fn a_named_mistake_is_told_of_another_place_that_has_it_though_the_component_is_lent() {
    let explained = |ratio: f64| {
        let named = light(0.5).because(&bsdf::WITHOUT_PI, "x");
        let made = Made::new().with("bsdf/a", named).with("light/b", light(ratio));
        let made = made.lent_to("light/b", Components::BSDF);
        let headlines = without_needless(&made.evidence(), &InOnePlace);
        let of_cause = headlines.into_iter().find(|told| told.cause == bsdf::WITHOUT_PI.name);
        of_cause.expect("it is named").explains
    };
    assert_eq!(explained(1.7), ["bsdf/a", "light/b"]);
    assert_eq!(explained(0.7), ["bsdf/a"]);
}

#[test]
fn what_cannot_be_made_beside_the_others_that_give_its_numbers_is_not_told() {
    let made = Made::new()
        .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
        .with("light/b", light(0.5).because(&light::WORLD_COSINE, "y"));
    let evidence = made.evidence();
    let causes = |exclude_each_other: bool| {
        let gives: &[(&[&str], _, _)] =
            &[(&["pi"], "light/b", 0.5), (&["pi", "cosine"], "light/b", 0.5)];
        let of_both = Bench { mistakes: &[PI, COSINE], gives };
        let bench = Exclusive { of_both, exclude_each_other };
        let told = without_needless(&evidence, &bench);
        told.into_iter().map(|told| told.cause).collect::<Vec<_>>()
    };
    let [pi, cosine] = [&bsdf::WITHOUT_PI, &light::WORLD_COSINE].map(|cause| cause.name);
    assert_eq!(causes(true), [pi]);
    assert_eq!(causes(false), [pi, cosine]);
}

/// Mistakes that one core can make, or not.
struct Exclusive<'a> {
    of_both: Bench<'a>,
    exclude_each_other: bool,
}

impl Planted for Exclusive<'_> {
    fn mistakes(&self) -> &[Mistake] {
        self.of_both.mistakes()
    }

    fn may_be_together(&self, mistakes: &[Mistake]) -> bool {
        mistakes.len() < 2 || !self.exclude_each_other
    }

    fn ask(&self, questions: &[Question<'_>]) -> Vec<Option<Finding>> {
        let one = |question: &Question<'_>| {
            let answer = self.of_both.ask(std::slice::from_ref(question)).pop().flatten();
            answer.filter(|_| self.may_be_together(&question.mistakes))
        };
        questions.iter().map(one).collect()
    }
}

#[test]
fn whichever_mistake_of_a_cause_gives_the_numbers_beside_others_nothing_else_is_told_of_them() {
    const IN_FULL: Mistake = mistake("in-full", &bsdf::WITHOUT_PI, "bsdf/a");
    const EVERYWHERE: Mistake = mistake("everywhere", &bsdf::WITHOUT_PI, "bsdf/a");
    let made = three_causes();
    let evidence = made.evidence();
    let told = |with_all: f64| {
        let gives: &[(&[&str], _, _)] = &[
            (&["in-full", "divided"], "light/c", 0.9),
            (&["everywhere", "divided"], "light/c", 0.7),
            (&["everywhere", "divided", "cosine"], "light/c", with_all),
        ];
        let bench = Bench { mistakes: &[IN_FULL, EVERYWHERE, DIVIDED, COSINE], gives };
        let told = without_needless(&evidence, &bench);
        told.into_iter().map(|told| told.cause).collect::<Vec<_>>()
    };
    let all = [&bsdf::WITHOUT_PI, &light::WORLD_COSINE, &light::DIVIDED_BY_LIGHTS].map(|c| c.name);
    assert_eq!(told(1.2), [all[0], all[2]]);
    assert_eq!(told(0.7), all, "it changes nothing there, and may be made elsewhere");
}

#[test]
fn of_all_that_is_told_each_explains_what_it_is_needed_for() {
    let made = Made::new()
        .with("bsdf/a", light(1.5).because(&bsdf::WITHOUT_PI, "x"))
        .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y"))
        .with("light/c", light(0.7))
        .with("light/d", light(0.6));
    let gives: &[(&[&str], _, _)] = &[
        (&["pi"], "bsdf/a", 1.5),
        (&["divided"], "light/b", 0.5),
        (&["pi", "divided"], "light/c", 0.7),
        (&["pi", "divided"], "light/d", 0.6),
        (&["divided"], "light/d", 0.6),
    ];
    let planted = Bench { mistakes: &[PI, DIVIDED], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let names = [(light::DIVIDED_BY_LIGHTS.name, 3), (bsdf::WITHOUT_PI.name, 2)];
    assert_eq!(told(&diagnosis), names.map(|(name, cases)| (name, Degree::Named, cases)));
}

#[test]
fn in_the_dark_a_mistake_that_would_leave_light_elsewhere_is_not_told() {
    let dark = || light(0.0).because(&light::DIVIDED_BY_LIGHTS, "nothing arrives");
    let planted = |ratio| -> [(&[&str], _, f64); 3] {
        [
            (&["divided"], "light/b", 0.0),
            (&["divided"], "light/c", ratio),
            (&["divided"], "light/d", ratio),
        ]
    };
    let made = Made::new().with("light/b", dark()).with("light/c", light(0.0));
    let made = made.with("light/d", light(0.0));
    let of = |ratio| {
        let planted = Bench { mistakes: &[DIVIDED], gives: &planted(ratio) };
        told(&diagnose_proven(&made.evidence(), &planted))[0].0.to_owned()
    };
    assert_eq!(of(1.0), "");
    assert_eq!(of(0.0), light::DIVIDED_BY_LIGHTS.name, "dark there too");
}

#[test]
fn the_only_mistake_in_sight_that_darkens_its_own_case_is_named() {
    let dark = || light(0.0).because(&light::DIVIDED_BY_LIGHTS, "nothing arrives");
    let lit = |count: usize| {
        let cases = ["light/c", "light/d", "light/e", "light/f"].into_iter().take(count);
        cases.fold(Made::new().with("light/b", dark()), |made, case| made.with(case, passing()))
    };
    let of_one: &[(&[&str], _, _)] = &[(&["divided"], "light/b", 0.0)];
    let of_both: &[(&[&str], _, _)] = &[of_one[0], (&["again"], "light/b", 0.0)];
    let degree = |lit_beside, mistakes: &[Mistake], gives| {
        let planted = Bench { mistakes, gives };
        told(&diagnose_proven(&lit(lit_beside).evidence(), &planted))[0].1
    };
    assert_eq!(degree(4, &[DIVIDED], of_one), Degree::Named);
    assert_eq!(degree(4, &[DIVIDED, AGAIN], of_one), Degree::Named, "the other changes nothing");
    assert_eq!(degree(4, &[DIVIDED, AGAIN], of_both), Degree::LooksLike);
    assert_eq!(degree(1, &[DIVIDED], of_one), Degree::LooksLike, "who knows what else is dark");
}

#[test]
fn a_cause_whose_mistake_fails_more_that_passes_than_it_explains_is_not_told() {
    let halved = || light(0.5).because(&light::DIVIDED_BY_LIGHTS, "halved");
    let gives: &[(&[&str], _, _)] = &[
        (&["divided"], "light/b", 0.5),
        (&["divided"], "light/c", 0.5),
        (&["divided"], "light/d", 0.5),
        (&["divided"], "light/e", 0.5),
    ];
    let planted = Bench { mistakes: &[DIVIDED], gives };
    let others_are = |other: fn() -> Finding| {
        let made = Made::new().with("light/b", halved());
        let made = ["light/c", "light/d", "light/e"]
            .iter()
            .fold(made, |made, case| made.with(*case, other()));
        told(&diagnose_proven(&made.evidence(), &planted))[0].0.to_owned()
    };
    assert_eq!(others_are(passing), "");
    assert_eq!(others_are(|| light(1.5)), "");
    assert_eq!(others_are(|| light(0.5)), light::DIVIDED_BY_LIGHTS.name);
}

#[test]
fn what_looks_like_the_cause_of_one_of_many_failures_is_not_told() {
    let shared = light(0.5).because(&light::DIVIDED_BY_LIGHTS, "x");
    let shared = shared.because(&integrator::EMISSION_AGAIN, "y");
    let few = Made::new().with("light/a", shared);
    let planted = Bench { mistakes: &[], gives: &[] };
    let told_of = |made: &Made| told(&diagnose_proven(&made.evidence(), &planted))[0].1;
    assert_eq!(told_of(&few), Degree::LooksLike);
    let others = ["b", "c", "d", "e", "f", "g", "h", "i"].map(|name| format!("light/{name}"));
    let many = others.iter().fold(few, |made, name| made.with(&name[..], light(0.3)));
    assert_eq!(told_of(&many), Degree::DiffersHere);
}

#[test]
fn a_cause_above_what_is_wrong_by_itself_only_looks_like_it() {
    let halved = Mistake { components: Components::DIRECT_LIGHTING, ..DIVIDED };
    let sampler = Mistake {
        components: Components::LIGHT_SAMPLING,
        ..mistake("pdf", &light::LIGHT_PDF_PER_AREA, "light/samples")
    };
    let made = Made::new()
        .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "halved"))
        .with("light/samples", light(0.3));
    let gives: &[(&[&str], _, _)] = &[(&["divided"], "light/b", 0.5)];
    let degree = |mistakes: &[Mistake]| {
        let planted = Bench { mistakes, gives };
        told(&diagnose_proven(&made.evidence(), &planted))[0].1
    };
    assert_eq!(degree(&[halved]), Degree::Named);
    assert_eq!(degree(&[halved, sampler]), Degree::LooksLike);
}

#[test]
fn what_no_rule_explains_and_the_mistake_of_a_cause_gives_is_of_that_cause() {
    let made = Made::new()
        .with("light/b", light(0.5).because(&light::DIVIDED_BY_LIGHTS, "halved"))
        .with("light/c", light(0.7))
        .with("integrator/d", light(0.6));
    let gives: &[(&[&str], _, _)] =
        &[(&["divided"], "light/b", 0.5), (&["divided"], "integrator/d", 0.6)];
    let planted = Bench { mistakes: &[DIVIDED], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    let divided = light::DIVIDED_BY_LIGHTS.name;
    assert_eq!(told(&diagnosis)[0], (divided, Degree::Named, 2));
    assert_eq!(diagnosis.unexplained, ["light/c"]);
}

#[test]
fn of_many_mistakes_one_that_comes_to_a_single_number_only_looks_like_it() {
    let made = Made::new().with("bsdf/a", light(0.5)).with("light/b", light(0.5));
    let mistakes = [PI, DIVIDED, AGAIN];
    let gives: &[(&[&str], _, _)] = &[(&["pi"], "bsdf/a", 0.5), (&["pi"], "light/b", 0.5)];
    let planted = Bench { mistakes: &mistakes, gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    assert_eq!(told(&diagnosis), [(bsdf::WITHOUT_PI.name, Degree::LooksLike, 2)]);
}

#[test]
fn patterns_of_lost_hits_that_contradict_each_other_are_told_as_lost_hits() {
    let skipped = failing("a").because(&bvh::SECOND_CHILD_SKIPPED, "x");
    let overwritten = failing("b").because(&bvh::RANGE_OVERWRITTEN, "y");
    let one = Made::new().with("bvh/a", skipped);
    let planted = Bench { mistakes: &[], gives: &[] };
    let alone = diagnose_proven(&one.evidence(), &planted);
    assert_eq!(told(&alone), [(bvh::SECOND_CHILD_SKIPPED.name, Degree::Named, 1)]);
    let both = one.with("bvh/b", overwritten);
    let diagnosis = diagnose_proven(&both.evidence(), &planted);
    assert_eq!(told(&diagnosis), [(bvh::HITS_LOST.name, Degree::Named, 2)]);
}

#[test]
fn a_mistake_of_a_lower_component_that_alone_gives_the_numbers_is_looked_like() {
    let made = Made::new().with("bsdf/a", light(0.5)).with("bsdf/b", light(0.7));
    let gives: &[(&[&str], _, _)] = &[(&["pi"], "bsdf/a", 0.5), (&["pi"], "bsdf/b", 0.7)];
    let planted = Bench { mistakes: &[PI], gives };
    let ranked = proven(&made.evidence(), &planted, MadeIn::Mended(Components::PATH));
    let pi = bsdf::WITHOUT_PI.name;
    assert_eq!(told(&ranked.told()), [(pi, Degree::LooksLike, 2)]);
}

#[test]
fn a_mistake_of_the_path_that_direct_lighting_mends_is_looked_like_if_its_own_case_fails() {
    let of_path = |caught_by| Mistake {
        components: Components::PATH,
        ..mistake("pi", &bsdf::WITHOUT_PI, caught_by)
    };
    let made = Made::new().with("light/b", light(0.5)).with("light/c", light(0.7));
    let gives: &[(&[&str], _, _)] = &[(&["pi"], "light/b", 0.5), (&["pi"], "light/c", 0.7)];
    let degree = |mistake: Mistake, broken: Components| {
        let planted = Bench { mistakes: &[mistake], gives };
        let ranked = proven(&made.evidence(), &planted, MadeIn::Mended(broken));
        told(&ranked.told())[0].1
    };
    let direct = Components::DIRECT_LIGHTING;
    assert_eq!(degree(of_path("light/b"), direct), Degree::LooksLike);
    assert_eq!(degree(of_path("light/b"), Components::BSDF), Degree::DiffersHere);
}

#[test]
fn what_the_traversal_mends_is_no_mistake_of_a_pixel() {
    let pixel = Mistake { components: Components::PIXEL, ..PI };
    let finding = || light(0.5).because(&bsdf::WITHOUT_PI, "x");
    let made = Made::new().with("bsdf/a", finding());
    let planted = Bench { mistakes: &[pixel], gives: &[(&["pi"], "bsdf/a", 0.5)] };
    let of = |made_in| told(&proven(&made.evidence(), &planted, made_in).told())[0].1;
    assert_eq!(of(MadeIn::Mended(Components::TRAVERSAL)), Degree::DiffersHere);
    assert_eq!(of(MadeIn::Mended(Components::PIXEL)), Degree::Named);
}

#[test]
fn what_is_told_beside_a_build_that_stops_though_the_bench_finds_the_hits_is_looked_like() {
    let without_pi = || light(0.5).because(&bsdf::WITHOUT_PI, "x");
    let made = |ending| Made::new().with("light/a", without_pi()).ended("light/b", ending);
    let planted = Bench { mistakes: &[], gives: &[] };
    let degree = |made: &Made| {
        let diagnosis = diagnose_proven(&made.evidence(), &planted);
        told(&diagnosis).into_iter().find(|one| one.0 == bsdf::WITHOUT_PI.name).unwrap().1
    };
    let crash = Ending::Crashed { how: "signal 11", during: "build" };
    for ending in [crash, Ending::TimedOut { during: "build" }] {
        assert_eq!(degree(&made(ending)), Degree::Named);
        assert_eq!(degree(&made(ending).lent(Components::TRAVERSAL)), Degree::LooksLike);
    }
}

#[test]
fn hits_that_the_triangle_test_brings_back_are_not_lost_by_the_bvh() {
    let lost = failing("a").because(&bvh::HITS_LOST, "x");
    let made = Made::new().with("shape/a", lost);
    let planted = Bench { mistakes: &[], gives: &[] };
    let of = |made_in| told(&proven(&made.evidence(), &planted, made_in).told())[0].1;
    assert_eq!(of(MadeIn::Mended(Components::TRIANGLE_TEST)), Degree::DiffersHere);
    assert_eq!(of(MadeIn::Mended(Components::TRAVERSAL)), Degree::Named);
    assert_eq!(of(MadeIn::Mended(Components::BOX_TEST)), Degree::Named);
}

#[test]
fn what_cannot_be_planted_is_made_where_others_of_its_subject_are() {
    let backwards = light(0.2).because(&bsdf::GLASS_RADIANCE_SCALED_BACKWARDS, "x");
    let made = Made::new().with("integrator/a", backwards);
    let of = |planted: &[Mistake], broken: Components| {
        let planted = Bench { mistakes: planted, gives: &[] };
        told(&proven(&made.evidence(), &planted, MadeIn::Mended(broken)).told())[0].1
    };
    assert_eq!(of(&[PI], Components::TRAVERSAL), Degree::DiffersHere);
    assert_eq!(of(&[PI], Components::BSDF), Degree::Named);
    assert_eq!(of(&[], Components::TRAVERSAL), Degree::Named, "where BSDFs are is not known");
}

#[test]
fn a_factor_of_images_that_the_direct_light_mends_is_none_of_the_film() {
    use crate::cause::image;
    let factor = || Finding {
        measures: Vec::new(),
        ..light(0.5).because_in_size(&image::FACTOR, "half", Some([0.49, 0.51]))
    };
    let made = Made::new().with("image/a", factor()).with("image/b", factor());
    let planted = Bench { mistakes: &[], gives: &[] };
    let of = |made_in| told(&proven(&made.evidence(), &planted, made_in).told())[0].1;
    assert_eq!(of(MadeIn::Mended(Components::DIRECT_LIGHTING)), Degree::DiffersHere);
    assert_eq!(of(MadeIn::Mended(Components::PIXEL)), Degree::Named);
}

#[test]
fn a_mistake_whose_own_case_passes_is_not_there() {
    let made = Made::new().with("light/c", light(0.5)).with("light/b", passing());
    let gives: &[(&[&str], _, _)] = &[(&["divided"], "light/c", 0.5)];
    let planted = Bench { mistakes: &[DIVIDED], gives };
    let diagnosis = diagnose_proven(&made.evidence(), &planted);
    assert_eq!(told(&diagnosis), [("", Degree::DiffersHere, 1)]);
}

#[test]
fn a_mistake_of_another_component_than_the_one_that_mends_only_looks_like_it() {
    let finding = light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y");
    let made = Made::new().with("light/b", finding).with("light/c", light(0.25));
    let gives: &[(&[&str], _, _)] =
        &[(&["divided"], "light/b", 0.5), (&["divided"], "light/c", 0.25)];
    let planted = Bench { mistakes: &[DIVIDED], gives };
    let ranked = proven(&made.evidence(), &planted, MadeIn::Mended(Components::PATH));
    let divided = light::DIVIDED_BY_LIGHTS.name;
    assert_eq!(told(&ranked.told()), [(divided, Degree::LooksLike, 2)]);
}

#[test]
fn a_mistake_whose_own_case_breaks_the_contract_as_nothing_told_does_is_not_there() {
    let gives: &[(&[&str], _, _)] =
        &[(&["divided"], "light/b", 0.5), (&["divided"], "light/c", 0.5)];
    let planted = Bench { mistakes: &[DIVIDED], gives };
    let causes = |own: Finding| {
        let seen = light(0.5).because(&light::DIVIDED_BY_LIGHTS, "y");
        let made = Made::new().with("light/c", seen).with("light/b", own);
        let told = diagnose_proven(&made.evidence(), &planted).headlines.into_iter();
        told.map(|headline| headline.cause).collect::<Vec<_>>()
    };
    let not_a_number = failing("NaN").because(&contract::NOT_A_NUMBER, "NaN");
    assert!(!causes(not_a_number).contains(&light::DIVIDED_BY_LIGHTS.name.to_owned()));
    assert_eq!(causes(light(0.5)), [light::DIVIDED_BY_LIGHTS.name]);
}

#[test]
fn a_cause_of_one_nan_among_many_that_it_does_not_explain_is_not_told() {
    let nan = || failing("NaN").because(&contract::NOT_A_NUMBER, "NaN");
    let known = failing("NaN").because(&light::DIVIDED_BY_ZERO_LIGHTS, "no light");
    let known = known.because(&contract::NOT_A_NUMBER, "NaN");
    let planted = Bench { mistakes: &[], gives: &[] };
    let degree = |others: &[&'static str]| {
        let made = Made::new().with("light/a", known.clone());
        let made = others.iter().fold(made, |made, case| made.with(*case, nan()));
        let mut told = diagnose_proven(&made.evidence(), &planted).headlines.into_iter();
        let zero_lights = &light::DIVIDED_BY_ZERO_LIGHTS;
        told.find(|told| told.cause == zero_lights.name).map(|told| told.degree)
    };
    assert_eq!(degree(&[]), Some(Degree::Named), "that it is NaN is no rival");
    assert_eq!(degree(&["light/b", "light/c"]), Some(Degree::Named));
    let in_another_part = ["shape/b", "shape/c", "shape/d", "shape/e"];
    assert_eq!(degree(&in_another_part), Some(Degree::Named));
    assert_eq!(degree(&["light/b", "light/c", "light/d", "light/e"]), None);
}

#[test]
fn one_darkness_may_go_through_several_components() {
    const NO_INDIRECT: Mistake = mistake("no-indirect", &integrator::NO_INDIRECT, "integrator/a");
    let degree = |[own, others]: [f64; 2]| {
        let dark = light(own).because(&integrator::NO_INDIRECT, "nothing from bounce 2 on");
        let made = Made::new().with("integrator/a", dark);
        let made = ["light/b", "light/c"].into_iter().fold(made, |m, c| m.with(c, light(others)));
        let gives: &[(&[&str], _, _)] = &[(&["no-indirect"], "integrator/a", own)];
        let bench = Bench { mistakes: &[NO_INDIRECT], gives };
        let told = without_needless(&made.evidence(), &bench);
        told.into_iter().find(|told| told.cause == NO_INDIRECT.cause.name).map(|told| told.degree)
    };
    assert_eq!(degree([0.0, 0.0]), Some(Degree::LooksLike));
    assert_eq!(degree([0.3, 0.0]), Some(Degree::LooksLike), "some of it is left");
    assert_eq!(degree([0.0, 0.5]), Some(Degree::Named));
}

#[test]
fn nothing_is_lost_in_a_darkness_that_follows_from_what_is_named() {
    const NO_INDIRECT: Mistake = mistake("no-indirect", &integrator::NO_INDIRECT, "integrator/a");
    let dark = light(0.0).because(&integrator::NO_INDIRECT, "nothing from bounce 2 on");
    let box_test = failing("rays miss").because(&bvh::BOX_WITHOUT_Z, "x");
    let made = Made::new().with("bvh/boxes", box_test).with("integrator/a", dark);
    let made = made.with("light/b", light(0.0)).with("light/c", light(0.0));
    let gives: &[(&[&str], _, _)] = &[(&["no-indirect"], "integrator/a", 0.0)];
    let bench = Bench { mistakes: &[NO_INDIRECT], gives };
    let degree = |follows: &[&str]| {
        let evidence = made.evidence();
        let mut told = look_without(&evidence, &Refuted::new(), Vec::new());
        told.follow(&follows.iter().map(ToString::to_string).collect::<Vec<_>>());
        let told = without_what_follows(told, &evidence, &bench).told().headlines;
        let mut of_cause = told.into_iter().filter(|one| one.cause == NO_INDIRECT.cause.name);
        of_cause.next().map(|one| one.degree)
    };
    assert_eq!(degree(&[]), Some(Degree::LooksLike));
    assert_eq!(degree(&["light/b", "light/c"]), Some(Degree::Named));
}
