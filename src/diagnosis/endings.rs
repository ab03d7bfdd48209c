//! Refusals, crashes, and answers that did not come in time: equal endings of the same request are one headline.

use super::reproduction::Refuted;
use super::{Degree, Ending, Evidence, Headline, Observation};
use crate::case::{Part, Subject};
use crate::cause::{Cause, adaptive, bvh};
use crate::worker::overflow;
use std::collections::BTreeMap;

/// What endings of one mistake have in common.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Kind<'a> {
    /// `signal 11`, without what differs from case to case.
    how: &'a str,
    /// What such a signal means, where that is known: `memory that is not its own`.
    meaning: &'a str,
    way: Way,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Way {
    Refusal,
    Crash(Asked),
    Timeout(Asked),
}

/// Who was asked.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Asked {
    /// A function, as the core's header spells it.
    Function(String),
    /// A program that an adapter starts.
    Program(String),
}

impl<'a> Kind<'a> {
    fn of(ending: Ending<'a>) -> Self {
        let (how, way) = match ending {
            Ending::Refused { why } => (why, Way::Refusal),
            Ending::Crashed { how, during } => (how, Way::Crash(Asked::of(during))),
            Ending::TimedOut { during } => ("no answer in time", Way::Timeout(Asked::of(during))),
        };
        let meaning = meaning(how);
        // Whoever watches a core ends it for a reason, and then says how far it went.
        let how = how.strip_prefix("ended: ").unwrap_or(how);
        // Of a program its status is told, too.
        let ends: &[&str] = match way {
            Way::Crash(Asked::Program(_)) => &[";"],
            _ => &["(", ";", ": ", ", "],
        };
        let end = ends.iter().filter_map(|end| how.find(end)).min().unwrap_or(how.len());
        let how = how[..end].trim();
        Self { how, meaning, way }
    }

    fn asked(&self) -> Option<&Asked> {
        match &self.way {
            Way::Refusal => None,
            Way::Crash(asked) | Way::Timeout(asked) => Some(asked),
        }
    }

    fn is_of(&self, function: &str) -> bool {
        matches!(self.asked(), Some(Asked::Function(asked)) if asked == function)
    }

    /// Where nobody watches the stack, a segmentation fault may be an overflow: in some scenes it is, where others are built.
    fn is_endless_recursion(&self, builds_others: bool) -> bool {
        let may_be = !overflow::IS_WATCHED && self.how == "signal 11" && builds_others;
        self.how == "stack overflow" || may_be
    }

    fn mistake(&self) -> String {
        let Self { how, meaning, way } = self;
        match way {
            Way::Refusal => format!("the core gives no answer: {how}"),
            Way::Timeout(Asked::Function(asked)) => {
                format!("the core does not answer `{asked}` in time")
            }
            Way::Timeout(Asked::Program(name)) => {
                format!("the program `{name}` does not end in time")
            }
            Way::Crash(Asked::Program(name)) => format!("the program `{name}` fails: {how}"),
            Way::Crash(Asked::Function(asked)) if meaning.is_empty() => {
                format!("the core crashes in `{asked}`: {how}")
            }
            Way::Crash(Asked::Function(asked)) => {
                format!("the core crashes in `{asked}`: {meaning} ({how})")
            }
        }
    }

    fn place(&self) -> String {
        match self.asked() {
            Some(Asked::Function(asked)) => format!("`{asked}` in furnace_core.h"),
            Some(Asked::Program(name)) => {
                format!("the adapter's call of `{name}`, and the end of its output")
            }
            None => "the place in the core that gives up with these words".to_owned(),
        }
    }

    /// What helps where the cause is unknown, in a case that ends so.
    fn advice(&self, seen: &Observation<'_>) -> String {
        match (self.asked(), seen.ending) {
            (Some(Asked::Program(_)), _) => "Start the program by hand, with the adapter's `arguments`, on a scene that `furnace export` writes.".to_owned(),
            // What to do stands at its end, if it is said.
            (None, Some(Ending::Refused { why })) => format!("In its own words: {why}."),
            _ => format!(
                "`furnace debug {}` with the same `--core` prints the commands that stop a debugger there.",
                seen.case
            ),
        }
    }
}

impl Asked {
    /// From what was asked, and where in it: `intersect, ray 3 of 100`, or the name of a program, in quotes.
    fn of(during: &str) -> Self {
        match during.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
            Some((program, _)) => Self::Program(program.to_owned()),
            None => Self::Function(function(during)),
        }
    }
}

/// Behind a signal's name: `signal 11 (SIGSEGV: memory that is not its own)`.
fn meaning(how: &str) -> &str {
    let inside = how.split_once('(').and_then(|(_, rest)| rest.split_once(')'));
    let told = inside.and_then(|(inside, _)| inside.split_once(": "));
    told.filter(|(name, _)| name.starts_with("SIG")).map_or("", |(_, meaning)| meaning)
}

/// The function of a request, which may be followed by where in it: `intersect, ray 3 of 100`.
fn function(during: &str) -> String {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let mut words = during.split(|c| !is_part(c)).filter(|word| !word.is_empty());
    let word = words.next().unwrap_or("a request").replace('-', "_");
    match word.as_str() {
        "build_scene" => "build".to_owned(),
        "render_codes" => "render".to_owned(),
        _ => word,
    }
}

/// A headline for each kind of ending, the earliest part first.
pub(super) fn headlines(evidence: &Evidence<'_>, refuted: &Refuted) -> Vec<Headline> {
    let mut kinds: BTreeMap<Kind<'_>, Vec<&Observation<'_>>> = BTreeMap::new();
    for seen in evidence.failures() {
        if let Some(ending) = seen.ending {
            kinds.entry(Kind::of(ending)).or_default().push(seen);
        }
    }
    // The same cases ask for nearest hits before they ask for shadows.
    let shadows_alone = !kinds.keys().any(|kind| kind.is_of("intersect"));
    let builds_others = evidence.has_lit_a_scene();
    let told = |(kind, cases): (&Kind<'_>, &Vec<_>)| {
        let refutes = |cause: &Cause, seen: &Observation<'_>| {
            refuted.contains(&(cause.name, seen.case.to_owned()))
        };
        let cause = cause(kind, cases, shadows_alone, builds_others);
        let cause = cause.filter(|cause| !cases.iter().any(|seen| refutes(cause, seen)));
        headline(evidence, kind, cases, cause)
    };
    let mut headlines: Vec<_> = kinds.iter().map(told).collect();
    headlines.sort_by_key(|headline| headline.explains.first().map(|case| Part::position(case)));
    headlines
}

fn cause(
    kind: &Kind<'_>,
    cases: &[&Observation<'_>],
    shadows_alone: bool,
    builds_others: bool,
) -> Option<&'static Cause> {
    let is_adaptive = || cases.iter().all(|seen| seen.is_about(Subject::Adaptive));
    match kind.way {
        Way::Timeout(_) if kind.is_of("adaptive_mean") || is_adaptive() => {
            Some(&adaptive::LOOP_ENDLESS)
        }
        Way::Crash(_) if kind.is_of("build") && kind.is_endless_recursion(builds_others) => {
            Some(&bvh::RECURSION_ENDLESS)
        }
        Way::Crash(_) if kind.is_of("occluded") && shadows_alone => Some(&bvh::ANY_HIT_CRASHES),
        _ => None,
    }
}

fn headline(
    evidence: &Evidence<'_>,
    kind: &Kind<'_>,
    cases: &[&Observation<'_>],
    cause: Option<&'static Cause>,
) -> Headline {
    let explains = cases.iter().map(|seen| seen.case.to_owned()).collect();
    let place = kind.place();
    // Equal endings: one is told.
    let sentences = cases.iter().find_map(|seen| sentence(seen)).into_iter().collect();
    let told = Headline { is_ending: true, ..Headline::of(evidence, explains, sentences) };
    match cause {
        None => {
            let fix = cases.first().map_or_else(String::new, |seen| kind.advice(seen));
            Headline { mistake: kind.mistake(), look_at: place, fix, ..told }
        }
        Some(cause) => Headline {
            degree: Degree::LooksLike,
            look_at: format!("{}: {place}", cause.look_at),
            ..told.because(cause)
        },
    }
}

fn sentence(seen: &Observation<'_>) -> Option<String> {
    Some(match seen.ending? {
        Ending::Refused { why } => format!("{}: {why}", seen.case),
        Ending::Crashed { how, during } => format!("{}: {how} during {during}", seen.case),
        Ending::TimedOut { during } => format!("{}: no answer in time during {during}", seen.case),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{bsdf, find};
    use crate::diagnosis::testing::{Made, failing, passing};
    use crate::diagnosis::{Diagnosis, diagnose};

    const SEGMENTATION: &str = "signal 11 (SIGSEGV: memory that is not its own)";

    fn crash(during: &'static str) -> Ending<'static> {
        Ending::Crashed { how: SEGMENTATION, during }
    }

    fn causes(diagnosis: &Diagnosis) -> Vec<&str> {
        diagnosis.headlines.iter().map(|headline| headline.cause.as_str()).collect()
    }

    #[test]
    fn equal_crashes_are_one_headline_above_everything_else() {
        let made = Made::new()
            .with("camera/a", failing("a").because(&bsdf::WITHOUT_PI, "x"))
            .ended("bvh/b", crash("intersect, ray 3 of 100"))
            .ended("light/c", crash("intersect"))
            .ended("light/d", crash("radiance"));
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(causes(&diagnosis), ["", "", bsdf::WITHOUT_PI.name]);
        let first = &diagnosis.headlines[0];
        assert_eq!(first.explains, ["bvh/b", "light/c"]);
        assert_eq!(
            first.mistake,
            "the core crashes in `intersect`: memory that is not its own (signal 11)"
        );
        assert_eq!((first.degree, first.is_ending), (Degree::DiffersHere, true));
        assert!(first.fix.starts_with("`furnace debug bvh/b` with the"), "{}", first.fix);
        assert_eq!(diagnosis.first(), Some(&bsdf::WITHOUT_PI));
    }

    #[test]
    fn a_program_that_fails_or_refuses_is_no_function_that_crashes() {
        let (how, during) = ("exit status: 2; the end of its output: usage", "`lantern`");
        let why = "`lantern` cannot be started (no such file); set LANTERN to a build of it";
        let made = Made::new()
            .ended("image/a", Ending::Crashed { how, during })
            .ended("image/b", Ending::Crashed { how, during })
            .ended("image/c", Ending::TimedOut { during })
            .ended("image/d", Ending::Refused { why });
        let headlines = diagnose(&made.evidence()).headlines;
        let told = |case: &str| {
            let explains = |headline: &&Headline| headline.explains.iter().any(|one| one == case);
            headlines.iter().find(explains).unwrap()
        };
        assert_eq!(told("image/a").mistake, "the program `lantern` fails: exit status: 2");
        assert_eq!(told("image/a").explains.len(), 2);
        assert!(!told("image/a").fix.contains("debug"), "{}", told("image/a").fix);
        assert_eq!(told("image/c").mistake, "the program `lantern` does not end in time");
        assert_eq!(
            told("image/d").mistake,
            "the core gives no answer: `lantern` cannot be started"
        );
        assert!(told("image/d").fix.ends_with("set LANTERN to a build of it."));
    }

    #[test]
    fn what_was_ended_for_a_reason_says_the_reason() {
        let how = "ended: out of memory, 4098 MiB in all its processes";
        let made =
            Made::new().ended("adaptive/a", Ending::Crashed { how, during: "adaptive-mean" });
        let mistake = &diagnose(&made.evidence()).headlines[0].mistake;
        assert_eq!(mistake, "the core crashes in `adaptive_mean`: out of memory");
    }

    #[test]
    fn a_build_that_overflows_the_stack_looks_like_endless_recursion() {
        let everywhere =
            Made::new().ended("bvh/a", crash("build")).ended("light/b", crash("build"));
        assert_eq!(causes(&diagnose(&everywhere.evidence())), [""], "no scene is built");
        let elsewhere = diagnose(&everywhere.with("light/c", passing()).evidence());
        let endless = if overflow::IS_WATCHED { "" } else { bvh::RECURSION_ENDLESS.name };
        assert_eq!(causes(&elsewhere), [endless]);
        let how = "stack overflow (SIGSEGV)";
        let overflow = Made::new().ended("bvh/a", Ending::Crashed { how, during: "build" });
        let diagnosis = diagnose(&overflow.evidence());
        assert_eq!(causes(&diagnosis), [bvh::RECURSION_ENDLESS.name]);
        assert_eq!(diagnosis.headlines[0].degree, Degree::LooksLike);
        assert!(diagnosis.headlines[0].look_at.ends_with("`build` in furnace_core.h"));
    }

    #[test]
    fn only_crashes_of_shadow_rays_alone_are_of_the_any_hit_function() {
        let alone = Made::new().ended("bvh/a", crash("occluded"));
        assert_eq!(causes(&diagnose(&alone.evidence())), [bvh::ANY_HIT_CRASHES.name]);
        let besides = alone.ended("bvh/b", crash("build"));
        assert!(causes(&diagnose(&besides.evidence())).contains(&bvh::ANY_HIT_CRASHES.name));
        let both = besides.ended("bvh/c", crash("intersect"));
        assert!(!causes(&diagnose(&both.evidence())).contains(&bvh::ANY_HIT_CRASHES.name));
    }

    #[test]
    fn an_adaptive_stream_without_an_answer_is_a_loop_that_never_ends() {
        let made = Made::new()
            .ended("adaptive/a", Ending::TimedOut { during: "adaptive-mean" })
            .ended("light/b", Ending::TimedOut { during: "radiance" });
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(causes(&diagnosis), ["", adaptive::LOOP_ENDLESS.name]);
        assert!(find(adaptive::LOOP_ENDLESS.name).is_some());
    }
}
