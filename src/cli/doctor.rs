//! `furnace doctor`: does a core start, what can it do, what sandboxes it, and what is worth doing next.

use super::hosting::HostingArguments;
use super::say::say_line;
use super::{Answer, ExitCode, Failure, ProjectArguments};
use crate::case::{self, Case, next_steps};
use crate::contract::question::QUESTIONS;
use crate::contract::{Capabilities, Conventions, CoreError, CoreInfo, Precision};
use crate::cores::{CORES, CoreSpec, HostError, Hosted, Hosting};
use crate::worker::StartError;
use clap::Args;
use std::sync::Arc;
use std::time::Instant;

/// Steps that are told; who has done one asks again.
const STEPS: usize = 5;

/// What `furnace doctor` understands.
#[derive(Clone, Debug, Args)]
pub(crate) struct DoctorArguments {
    /// The core to examine; may be repeated [default: every core of our own].
    #[arg(long = "core", value_name = "CORE")]
    cores: Vec<CoreSpec>,
    #[command(flatten)]
    hosting: HostingArguments,
    #[command(flatten)]
    project: ProjectArguments,
}

pub(crate) fn doctor(arguments: &DoctorArguments) -> Answer {
    let project = arguments.project.find()?;
    let cases = case::load_project(&project).map_err(Failure::request)?;
    let hosting = arguments.hosting.hosting(&project.runs()).hiding(project.secrets());
    let own = || CORES.iter().filter_map(|kind| kind.name.parse().ok()).collect();
    let cores = if arguments.cores.is_empty() { own() } else { arguments.cores.clone() };
    let mut code = ExitCode::Good;
    for spec in &cores {
        let begun = Instant::now();
        say_line!("core     {spec}");
        match hosting.host(spec) {
            Ok(mut hosted) => {
                let milliseconds = begun.elapsed().as_millis();
                say_line!("         starts in {milliseconds} ms, {}", place(&hosted));
                let info = hosted.core_mut().info();
                introduce(&info);
                tell_walls(&hosted, &hosting);
                tell_next_steps(&cases, info.capabilities);
            }
            Err(error) => code = tell_failure(error),
        }
        say_line!();
    }
    Ok(code)
}

fn place(hosted: &Hosted) -> &'static str {
    match hosted {
        Hosted::Here(_) => "in this process",
        Hosted::Away(_) => "in a process of its own",
    }
}

fn introduce(info: &CoreInfo) {
    let precision = match info.precision {
        Precision::Single => "single",
        Precision::Double => "double",
    };
    say_line!("         {} {}, {precision} precision", info.name, info.version);
    tell_abilities(info.capabilities);
    tell("takes", &info.components.names());
    tell("chose", &conventions(info.conventions));
}

/// What is only said is no ability: a core that does not promise it is free to do otherwise.
fn tell_abilities(has: Capabilities) {
    let promises = Capabilities::PROMISES - Capabilities::SPLIT_RULES;
    let able = Capabilities::all() - promises;
    tell("can", &(has & able).names());
    tell("cannot", &(able - has).names());
    tell("promises", &(has & promises).names());
    tell("free in", &(promises - has).names());
}

/// What the core has chosen, as a file would say it.
fn conventions(conventions: Conventions) -> Vec<String> {
    let Ok(serde_json::Value::Object(choices)) = serde_json::to_value(conventions) else {
        return Vec::new();
    };
    let choice = |(name, choice): (&String, &serde_json::Value)| {
        format!("{name} = {}", choice.as_str().unwrap_or_default())
    };
    choices.iter().map(choice).collect()
}

fn tell_walls(hosted: &Hosted, hosting: &Hosting) {
    let Some(confinement) = hosted.confinement() else { return };
    tell("holds", &confinement.in_force);
    tell("lacks", &confinement.lacking);
    let readable: Vec<_> = hosting.readable.iter().map(|path| path.display().to_string()).collect();
    tell("opened", &readable);
}

fn tell_next_steps(cases: &[Arc<Case>], has: Capabilities) {
    let open = cases.iter().filter(|case| case.prepared.missing(has).is_empty()).count();
    say_line!("tried    on {open} of {} cases", cases.len());
    for (number, step) in next_steps(cases, has).iter().take(STEPS).enumerate() {
        let label = if number == 0 { "next" } else { "then" };
        let names = step.missing.names().join(", ");
        say_line!("{label:<9}{names}: {} more cases, as {}", step.cases.len(), step.cases[0]);
        for one in step.missing.iter() {
            say_line!("           {}", advice(one));
        }
    }
}

fn tell(label: &str, lines: &[String]) {
    for (number, line) in lines.iter().enumerate() {
        say_line!("{:<9}{line}", if number == 0 { label } else { "" });
    }
}

/// A core that dies has failed; what is no core at all is a wrong request.
fn tell_failure(error: HostError) -> ExitCode {
    say_line!("         fails to start: {error}");
    match error {
        HostError::Start(StartError::Core { error, printed }) => {
            for line in printed.lines() {
                say_line!("printed  {line}");
            }
            match error {
                CoreError::Crashed { .. } | CoreError::TimedOut { .. } => ExitCode::Failed,
                _ => ExitCode::BadRequest,
            }
        }
        HostError::Start(StartError::Bench { .. }) => ExitCode::Broken,
        HostError::Load(_) => ExitCode::BadRequest,
    }
}

/// How a capability is written in furnace_core.hpp.
fn advice(one: Capabilities) -> String {
    let special = ADVICE.iter().find(|(of, _)| *of == one).map(|(_, advice)| (*advice).to_owned());
    let functions = || QUESTIONS.iter().filter(|q| q.capability == one).flat_map(|q| q.in_c);
    special.unwrap_or_else(|| functions().copied().collect::<Vec<_>>().join(", "))
}

/// Where the names of its functions do not say it.
const ADVICE: &[(Capabilities, &str)] = &[
    (Capabilities::GENERATE_RAYS, "generate_ray(camera, film)"),
    (
        Capabilities::INTERSECT_PRIMITIVE,
        "intersect_triangle(positions, normals, ray), intersect_sphere(centre, radius, ray)",
    ),
    (Capabilities::INTERSECT_BOX, "intersect_box(min, max, ray)"),
    (
        Capabilities::SAMPLE_DIRECTION,
        "sample_direction(sampler, random), direction_pdf(sampler, direction)",
    ),
    (Capabilities::EVAL_BSDF, "eval_bsdf(material, wo, wi)"),
    (Capabilities::SAMPLE_BSDF, "sample_bsdf(material, wo, random)"),
    (Capabilities::ADAPTIVE_MEAN, "adaptive_mean(rule, luminances, count)"),
    (
        Capabilities::BUILD_SCENE,
        "build(scene, settings), which answers a std::unique_ptr to a type of yours",
    ),
    (Capabilities::INTERSECT, "of that type: intersect(ray, stats)"),
    (Capabilities::OCCLUDED, "of that type: occluded(ray, stats)"),
    (Capabilities::SAMPLE_LIGHT, "of that type: sample_light(light, from, random)"),
    (Capabilities::RADIANCE, "of that type: radiance(ray, settings, index)"),
    (Capabilities::RENDER, "of that type: render(camera, settings, pixels, sample_counts)"),
    (
        Capabilities::RENDER_CODES,
        "nothing: programs that write 8 bits are described by an adapter, see docs/book/src/adapters.md",
    ),
    (Capabilities::BRUTE_FORCE, "honour settings.accelerate == 0, and say FURNACE_BRUTE_FORCE"),
    (Capabilities::SPLIT_RULES, "honour settings.split, and say FURNACE_SPLIT_RULES"),
    (
        Capabilities::TRAVERSAL_STATS,
        "count tests, and say FURNACE_COUNTS_TRAVERSAL; or use the bench's own with FURNACE_COUNTED_TESTS | FURNACE_OWN_TESTS",
    ),
    (
        Capabilities::HEMISPHERE_SAMPLING,
        "honour settings.by_hemisphere, and say FURNACE_HEMISPHERE_SAMPLING",
    ),
    (
        Capabilities::ISOLATED_BOUNCES,
        "honour settings.first_bounce, and say FURNACE_ISOLATED_BOUNCES",
    ),
    (
        Capabilities::DEPTH_LIMIT,
        "honour settings.by_depth where paths end at a maximum depth, and say FURNACE_DEPTH_LIMIT",
    ),
    (Capabilities::ROULETTE, "honour settings.roulette_stop, and say FURNACE_ROULETTE"),
    (
        Capabilities::ADAPTIVE_SAMPLING,
        "honour settings.adaptive in render, and say FURNACE_ADAPTIVE_SAMPLING",
    ),
    (
        Capabilities::ROUGH_GLASS,
        "know materials of kind FURNACE_ROUGH_GLASS, and say FURNACE_KNOWS_ROUGH_GLASS",
    ),
    (
        Capabilities::REPORTED_VARIANCE,
        "fill settings.variances in render, and say FURNACE_REPORTED_VARIANCE",
    ),
    (
        Capabilities::STRATIFIED_PIXELS,
        "honour settings.stratified in render, and say FURNACE_STRATIFIED_PIXELS",
    ),
    (
        Capabilities::CALLERS_RANDOMNESS,
        "draw with random.point and random.lobe alone, and say FURNACE_CALLERS_RANDOMNESS",
    ),
    (
        Capabilities::DETERMINISTIC,
        "give the same bits for the same seed, and say FURNACE_DETERMINISTIC",
    ),
    (
        Capabilities::INDEPENDENT_PIXELS,
        "if each pixel draws random numbers of its own, say FURNACE_INDEPENDENT_PIXELS",
    ),
    (
        Capabilities::INDEPENDENT_SAMPLES,
        "if samples are drawn one independently of the other, say FURNACE_INDEPENDENT_SAMPLES",
    ),
    (
        Capabilities::PLAIN_ESTIMATORS,
        "if directions and points on lights are uniform and roulette is as told, say FURNACE_PLAIN_ESTIMATORS",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_advice_for_every_capability() {
        assert!(Capabilities::all().iter().all(|one| !advice(one).is_empty()));
        assert!(ADVICE.iter().all(|(one, _)| one.iter().count() == 1));
    }
}
