//! How much faster than brute force a BVH is, by mesh and by split rule: `cargo bench`.
//!
//! Criterion times each structure by itself and keeps baselines. The table at the end is our own: speed-ups are
//! ratios of passes that were interleaved in random order, on the same rays, in the same thread, by its CPU time,
//! with an interval; and every hit of every rule is compared with brute force in the same run, because a fast
//! wrong answer is worth nothing.
//!
//! `cargo bench --bench bvh -- teapot` takes the subjects whose name contains `teapot`.

mod clock;
mod paired;
mod structures;
mod subjects;
mod table;

use clock::ThreadTime;
use criterion::{Criterion, SamplingMode, Throughput};
use furnace::cores::builtin::Builtin;
use std::time::Duration;
use structures::RULES;
use subjects::Subject;

/// Brute force is timed on so many rays in a criterion pass that it tests about this many triangles.
const BRUTE_FORCE_TESTS: usize = 4_000_000;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let filter = arguments.iter().find(|argument| !argument.starts_with('-'));
    let is_wanted = |name: &str| filter.is_none_or(|filter| name.contains(filter.as_str()));
    let is_measuring = arguments.iter().any(|argument| argument == "--bench");
    let mut criterion = Criterion::default()
        .with_measurement(ThreadTime)
        .sample_size(10)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(400))
        .noise_threshold(0.05)
        .without_plots()
        .configure_from_args();
    let mut rows = Vec::new();
    for (name, make) in subjects::ALL.iter().filter(|(name, _)| is_wanted(name)) {
        let subject = Subject::new(name, make());
        time_alone(&mut criterion, &subject);
        if is_measuring {
            rows.push(paired::measure(&subject));
        }
    }
    criterion.final_summary();
    table::print(&rows);
}

/// The criterion group of one subject.
fn time_alone(criterion: &mut Criterion<ThreadTime>, subject: &Subject) {
    let mut group = criterion.benchmark_group(format!("bvh/{}", subject.name));
    group.sampling_mode(SamplingMode::Flat);
    for rule in RULES {
        let all = subject.rays.len();
        let few = (BRUTE_FORCE_TESTS / subject.scene.primitive_count()).clamp(1, all);
        let count = if rule.is_brute_force() { few } else { all };
        let rays = &subject.rays[..count];
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(rule.name, |bencher| {
            let mut core = Builtin::new();
            let mut built = structures::build(&mut core, &subject.scene, rule);
            let mut hits = structures::no_hits(count);
            bencher.iter(|| structures::trace(built.as_mut(), rays, &mut hits));
        });
    }
    group.finish();
}
