//! One case on one core: brought up, asked behind validation, and what came of it. Nothing is written here.

use super::bench::Bench;
use super::outcome::{Outcome, Status};
use super::plan::Trial;
use super::record::{self, SceneStamp, TrialRecord, TrialTiming};
use super::schedule::Transplant;
use crate::case::{Case, Subject, Tier, asked_about};
use crate::cause::bvh;
use crate::checks::breach::{failure_alone, failure_beside};
use crate::checks::law::{RIGHT_BUT_ROUNDED, ROUNDED};
use crate::checks::{CheckError, Context, Finding, Picture};
use crate::contract::turned::Turned;
use crate::contract::validate::Validated;
use crate::contract::{Capabilities, Circumstances, Components, Core, CoreError, CoreInfo, Work};
use crate::cores::HostError;
use crate::math::Precision;
use crate::math::rng::Seed;
use crate::scene::SceneDescription;
use crate::scene::hash::content_hash;
use crate::scene::motion::Motion;
use crate::stats::{Budget, Verdict};
use crate::text::program;
use crate::worker::StartError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Instant;

/// A trial that has ended, before anything is written.
pub struct Ended {
    /// What its sidecar will say; `pictures` is still empty.
    pub record: TrialRecord,
    /// What the check wants people to see.
    pub pictures: Vec<Picture>,
}

/// Runs one trial, whatever it rests on. Nothing is written.
pub fn run_trial(bench: &Bench, trial: &Trial) -> Ended {
    run_with(bench, trial, Components::empty())
}

/// Runs one trial with components of the bench in place of what is broken; as it is if the core cannot take them.
pub(crate) fn run_transplanted(bench: &Bench, trial: &Trial, transplant: Transplant) -> Ended {
    let Transplant { with, by, or_as_it_is } = transplant;
    let takes = bench.info(&trial.core).map_or(Components::empty(), |core| core.components);
    match with.within(takes) {
        Some(with) if !asked_about(&trial.case).intersects(with) => {
            let (ended, own) = run_taking(bench, trial, with);
            if own.is_empty() { ended } else { with_own_below(bench, trial, ended, by) }
        }
        _ if or_as_it_is => run_on_what_is_broken(bench, trial, with.intersection(takes), by),
        _ => untried(bench, trial, by),
    }
}

/// Runs one trial though some of what it rests on is broken and stays, `with` the rest from the bench.
fn run_on_what_is_broken(bench: &Bench, trial: &Trial, with: Components, by: String) -> Ended {
    let ended = run_with(bench, trial, with - asked_about(&trial.case));
    with_own_below(bench, trial, ended, by)
}

/// What came of a trial on something of the core's own that is broken. What passes all the same is right; what does not may
/// have failed for what is broken, and is blocked.
fn with_own_below(bench: &Bench, trial: &Trial, ended: Ended, by: String) -> Ended {
    let outcome = &ended.record.outcome;
    let counts = match outcome.status() {
        Status::Pass => !outcome.finding().is_some_and(Finding::is_of_darkness),
        Status::Skipped | Status::Broken => true,
        _ => false,
    };
    if counts {
        return ended;
    }
    let blocked = untried(bench, trial, by);
    Ended { record: TrialRecord { timing: ended.record.timing, ..blocked.record }, ..blocked }
}

/// Runs one trial with components of the bench.
pub(crate) fn run_with(bench: &Bench, trial: &Trial, with: Components) -> Ended {
    run_taking(bench, trial, with).0
}

/// The same; and where that failed, what it rests on that the core was told to take and never asked for. It may have failed
/// for its own.
pub(super) fn run_taking(bench: &Bench, trial: &Trial, with: Components) -> (Ended, Components) {
    let started = Instant::now();
    let Tried { mut attempt, printed, unasked } = attempt_hosted(bench, trial, with);
    if counts_what_is_lent(&attempt.outcome, with) {
        attempt.outcome =
            Outcome::of(Err(CoreError::Unsupported(Capabilities::TRAVERSAL_STATS).into()));
    }
    let mut record = record_of(bench, trial, attempt.outcome);
    record.work = attempt.work.done();
    record.circumstances = attempt.work.circumstances();
    record.tier = attempt.tier;
    record.with = with;
    let asked = with.intersection(may_be_asked(&trial.case));
    if !asked.is_empty() && trial.core.command().is_none() {
        record.rerun += &format!(" --with {}", asked.names().join(","));
    }
    record.scene = attempt.scene;
    record.keep_printed(&printed);
    record.timing.seconds = started.elapsed().as_secs_f64();
    let rests_on = record.rests_on.iter().map(|foundation| foundation.components()).collect();
    let own = if record.outcome.status() == Status::Pass { Components::empty() } else { rests_on };
    (Ended { record, pictures: attempt.pictures }, own.intersection(unasked))
}

/// The components that a case may reach. Single functions of shapes, directions and materials are what they are, whatever
/// stands in the place of others.
fn may_be_asked(case: &Case) -> Components {
    let calls = Capabilities::BUILD_SCENE | Capabilities::RENDER | Capabilities::ADAPTIVE_MEAN;
    if case.prepared.needs().intersects(calls) {
        return Components::all();
    }
    let below = case.proves.iter().chain(&case.rests_on).map(|foundation| foundation.components());
    below.fold(asked_about(case), Components::union)
}

/// Whether counts are not real because a core does not count the tests that it took from the bench.
fn counts_what_is_lent(outcome: &Outcome, with: Components) -> bool {
    let tests = Components::TRIANGLE_TEST | Components::SPHERE_TEST | Components::TRAVERSAL;
    let mut clues = outcome.finding().into_iter().flat_map(|finding| &finding.clues);
    with.intersects(tests) && clues.any(|clue| clue.cause == bvh::COUNTS_NOT_REAL.name)
}

/// A core that was brought up, and what came of it.
struct Tried {
    attempt: Attempt,
    /// What the core printed.
    printed: String,
    /// What it was told to take, and has never asked for.
    unasked: Components,
}

/// Brings up the core of a trial, and puts the case to it.
fn attempt_hosted(bench: &Bench, trial: &Trial, with: Components) -> Tried {
    let without_core = |error, printed| {
        let attempt = Attempt::without_core(&trial.case, error);
        Tried { attempt, printed, unasked: Components::empty() }
    };
    if let Some((error, printed)) = bench.unfit.get(trial.core.as_str()) {
        return without_core(CheckError::Core(error.clone()), printed.clone());
    }
    match bench.hosting.in_case(&trial.case.id).host(&trial.core) {
        Ok(mut hosted) => {
            let attempt = match take(hosted.core_mut(), with) {
                Ok(()) => {
                    let work = Work::within(hosted.time_limit(bench.hosting.limits));
                    attempt_counted(bench, &trial.case, hosted.core_mut(), work)
                }
                Err(error) => Attempt::without_core(&trial.case, CheckError::Core(error)),
            };
            Tried { attempt, printed: hosted.printed(), unasked: hosted.unasked() }
        }
        Err(HostError::Start(StartError::Core { error, printed })) => {
            without_core(CheckError::Core(error), printed)
        }
        Err(error) => without_core(CheckError::Broken(error.to_string()), String::new()),
    }
}

/// Puts components of the bench into the core; one that takes none is not even asked.
fn take(core: &mut dyn Core, with: Components) -> Result<(), CoreError> {
    if with.is_empty() {
        return Ok(());
    }
    let missing = with.difference(core.info().components);
    Validated::new(core).take_components(with).map_err(|error| match error {
        CoreError::Unsupported(_) => {
            CoreError::Beyond(format!("the bench's {}", missing.in_words()))
        }
        other => other,
    })
}

/// A trial that was not tried, since `by` failed. What a core lacks is not broken: then it is skipped, whatever failed.
pub(crate) fn untried(bench: &Bench, trial: &Trial, by: String) -> Ended {
    let case = &trial.case;
    let can = bench.info(&trial.core).map(|core| core.capabilities);
    let missing = can.map(|can| case.prepared.missing(can)).filter(|missing| !missing.is_empty());
    let outcome = match missing {
        Some(missing) => Outcome::of(Err(CoreError::Unsupported(missing).into())),
        None => Outcome::Blocked { by },
    };
    let mut record = record_of(bench, trial, outcome);
    record.tier = can.map_or(case.tier, |can| case.tier_on(can));
    Ended { record, pictures: Vec::new() }
}

fn record_of(bench: &Bench, trial: &Trial, outcome: Outcome) -> TrialRecord {
    let case = &trial.case;
    TrialRecord {
        version: record::VERSION,
        case: case.id.clone(),
        core: trial.core.to_string(),
        title: case.title.clone(),
        teaches: case.teaches.clone(),
        source: case.source.clone(),
        check: case.check.name.to_owned(),
        tier: case.tier,
        role: case.role,
        rests_on: super::schedule::of_case(bench, case).into_iter().collect(),
        proves: case.proves.clone(),
        case_hash: case.hash.clone(),
        scene: None,
        with: Components::empty(),
        budget: bench.allowance.budget,
        seed: bench.seed_of(case).0,
        outcome,
        work: 0,
        circumstances: Circumstances::empty(),
        pictures: Vec::new(),
        printed: String::new(),
        rerun: rerun_command(bench, trial),
        timing: TrialTiming { seconds: 0.0 },
    }
}

/// What came of putting one case to one core.
#[derive(Debug)]
pub struct Attempt {
    /// How it ended.
    pub outcome: Outcome,
    /// What it counts for on this core.
    pub tier: Tier,
    pub(crate) scene: Option<SceneStamp>,
    pub(crate) pictures: Vec<Picture>,
    /// How much the core was asked.
    pub(crate) work: Work,
}

impl Attempt {
    /// Of a core that did not start.
    fn without_core(case: &Case, error: CheckError) -> Self {
        let outcome = Outcome::of(Err(error));
        Self { outcome, tier: case.tier, scene: None, pictures: Vec::new(), work: Work::default() }
    }
}

/// Puts one case to one core, whoever made it.
pub fn attempt(bench: &Bench, case: &Case, core: &mut dyn Core) -> Attempt {
    attempt_counted(bench, case, core, Work::default())
}

fn attempt_counted(bench: &Bench, case: &Case, core: &mut dyn Core, work: Work) -> Attempt {
    let mut pictures = Vec::new();
    let mut scene = None;
    let tier = case.tier_on(core.info().capabilities);
    let result = load_scene(bench, case).and_then(|loaded| {
        scene = loaded.as_deref().map(|scene| stamp(scene, &bench.motion_of(case)));
        judge(bench, case, core, &work, loaded, &mut pictures)
    });
    Attempt { outcome: Outcome::of(result), tier, scene, pictures, work }
}

fn load_scene(bench: &Bench, case: &Case) -> Result<Option<Arc<SceneDescription>>, CheckError> {
    let Some(scene) = &case.scene else { return Ok(None) };
    let loaded = scene.load(&bench.scenes);
    loaded.map(Some).map_err(|error| CheckError::Broken(error.to_string()))
}

fn stamp(scene: &SceneDescription, motion: &Motion) -> SceneStamp {
    let is_specular = scene.materials.iter().any(|material| material.surface.is_specular());
    SceneStamp {
        name: scene.name.clone(),
        hash: content_hash(scene),
        shown: motion.to_string(),
        is_specular,
    }
}

/// Puts the case to the core; once more where directions are not unit, with those that were meant, and where a `float` among
/// the doubles may be all that is wrong.
fn judge(
    bench: &Bench,
    case: &Case,
    core: &mut dyn Core,
    work: &Work,
    scene: Option<Arc<SceneDescription>>,
    pictures: &mut Vec<Picture>,
) -> Result<Finding, CheckError> {
    let mut core = Turned::new(core, bench.motion_of(case));
    let mut strict = Validated::new(&mut core).counted(work);
    let precision = strict.info().precision;
    let found = run_check(bench, case, &mut strict, scene.clone(), pictures, precision);
    match found {
        Err(CheckError::Core(CoreError::BrokeContract(breach))) if breach.can_be_mended() => {
            let mut mending = Validated::mending(&mut core).counted(work);
            let mended = run_check(bench, case, &mut mending, scene.clone(), pictures, precision);
            let has_failed = mended.as_ref().is_ok_and(Finding::failed);
            let mut again = Validated::mending(&mut core);
            Ok(match has_failed && is_only_rounded(bench, case, &mut again, scene) {
                true => failure_alone(&breach, RIGHT_BUT_ROUNDED),
                false => failure_beside(&breach, mended),
            })
        }
        Ok(found) if found.failed() && found.clues.is_empty() => {
            let mut again = Validated::new(&mut core);
            let is_rounded = is_only_rounded(bench, case, &mut again, scene);
            Ok(found.by_law(is_rounded.then(|| ROUNDED.to_owned())))
        }
        found => found,
    }
}

/// Whether rays and hits of a core in double precision are right to single precision, as where some of its variables are.
/// What it is asked for that is no work of the case.
fn is_only_rounded(
    bench: &Bench,
    case: &Case,
    core: &mut Validated<'_>,
    scene: Option<Arc<SceneDescription>>,
) -> bool {
    let subject = Subject::of_case(&case.id);
    let is_of_rays = matches!(subject, Some(Subject::Camera | Subject::Shape))
        && !case.prepared.needs().intersects(Capabilities::RENDER);
    let is_double = core.info().precision == Precision::Double;
    let mut roughly =
        || run_check(bench, case, core, scene.clone(), &mut Vec::new(), Precision::Single);
    is_of_rays && is_double && roughly().is_ok_and(|found| found.verdict == Verdict::Pass)
}

/// Asks whether the core can, and lets the check run.
fn run_check(
    bench: &Bench,
    case: &Case,
    core: &mut Validated<'_>,
    scene: Option<Arc<SceneDescription>>,
    pictures: &mut Vec<Picture>,
    precision: Precision,
) -> Result<Finding, CheckError> {
    let info = CoreInfo { precision, ..core.info() };
    let missing = case.prepared.missing(info.capabilities);
    if missing != Capabilities::empty() {
        return Err(CoreError::Unsupported(missing).into());
    }
    let mut context = Context {
        core,
        info,
        scene,
        scenes: &bench.scenes,
        references: &bench.references,
        seed: bench.seed_of(case),
        budget: bench.allowance,
        pictures: Vec::new(),
    };
    let run = AssertUnwindSafe(|| case.prepared.run(&mut context));
    let result = catch_unwind(run).unwrap_or_else(|_| {
        // The core's own panics were stopped by the validation: this one is ours.
        Err(CheckError::Broken("furnace itself panicked; please report this case".to_owned()))
    });
    *pictures = context.pictures;
    result
}

/// The command that tries this again, at full length: a run that stops at the first failure measures
/// gross errors less precisely.
fn rerun_command(bench: &Bench, trial: &Trial) -> String {
    if let Some(command) = trial.core.command() {
        return format!("{command} {}", trial.case.id);
    }
    let core = shell_words::quote(trial.core.as_str());
    let mut command = format!("{} run {} --core {core}", program(), trial.case.id);
    let budget = bench.allowance.budget;
    if budget != Budget::default() {
        command += &format!(" --budget {budget}");
    }
    if bench.seed != Seed::SUITE {
        command += &format!(" --seed {}", bench.seed.0);
    }
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case;
    use crate::contract::{Acceleration, Built, Hit, Primitive, Ray, Result};
    use crate::cores::textbook::Textbook;
    use crate::project::Project;
    use crate::run::{Plan, Request};
    use std::path::Path;

    /// The textbook core, with this done to the shading normal of each hit of a primitive.
    struct Shading(Box<dyn Core>, fn(&mut Hit));

    impl Core for Shading {
        fn info(&self) -> CoreInfo {
            self.0.info()
        }

        fn build_scene(
            &mut self,
            scene: &SceneDescription,
            how: Acceleration,
        ) -> Result<Built<'_>> {
            self.0.build_scene(scene, how)
        }

        fn intersect_primitive(
            &mut self,
            primitive: &Primitive,
            rays: &[Ray],
            hits: &mut [Hit],
        ) -> Result<()> {
            self.0.intersect_primitive(primitive, rays, hits)?;
            hits.iter_mut().filter(|hit| hit.is_hit()).for_each(self.1);
            Ok(())
        }
    }

    fn found(normals: fn(&mut Hit)) -> Finding {
        const CASE: &str = "shape/shading-normals-are-interpolated";
        let project = Project::at(Path::new(env!("CARGO_MANIFEST_DIR")));
        let cases = case::load_all(&project.cases()).unwrap();
        let (cores, filters) = (vec!["textbook".parse().unwrap()], vec![CASE.to_owned()]);
        let request = Request { cores, filters, ..Request::default() };
        let bench = Plan::new(project, request, &cases).unwrap().bench();
        let case = cases.iter().find(|case| case.id == CASE).unwrap();
        let mut core = Shading(Box::new(Textbook::new()), normals);
        attempt(&bench, case, &mut core).outcome.finding().unwrap().clone()
    }

    #[test]
    fn a_float_among_doubles_is_told_and_hides_no_missing_normalisation() {
        let rounded = |hit: &mut Hit| {
            hit.shading_normal = hit.shading_normal.as_vec3().as_dvec3();
        };
        let finding = found(rounded);
        assert!(finding.failed() && finding.statement.ends_with(ROUNDED), "{}", finding.statement);
        let wrong = found(|hit| hit.shading_normal = -hit.shading_normal);
        assert!(wrong.failed() && !wrong.statement.ends_with(ROUNDED), "{}", wrong.statement);
        let short = found(|hit| {
            hit.shading_normal = (0.9 * hit.shading_normal.as_vec3()).as_dvec3();
        });
        assert_eq!(short.clues[0].cause, "normal-not-unit");
        assert!(
            short.clues[0].evidence.ends_with(RIGHT_BUT_ROUNDED),
            "{}",
            short.clues[0].evidence
        );
    }
}
