//! How much faster than brute force a BVH is, by mesh and by split rule: `cargo bench`, of another core
//! `FURNACE_CORE=path/to/lib.so cargo bench`.
//!
//! Criterion times each structure of `builtin` by itself and keeps baselines. The table at the end is that of
//! `furnace bench`: speed-ups are ratios of passes that were interleaved in random order, on the same rays, with an
//! interval; and hits are compared with brute force in the same run.
//!
//! `cargo bench --bench bvh -- teapot` takes the subjects whose name contains `teapot`.

mod clock;
mod structures;

use clock::ThreadTime;
use criterion::{Criterion, SamplingMode, Throughput};
use furnace::bench::{Bench, Subject, made_here, table};
use furnace::cores::builtin::Builtin;
use furnace::cores::{CoreSpec, Hosting};
use std::time::Duration;
use structures::RULES;

/// Brute force is timed on so many rays in a criterion pass that it tests about this many triangles.
const BRUTE_FORCE_TESTS: usize = 4_000_000;
/// Of each structure in the table.
const ROUNDS: usize = 9;

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
    let named = std::env::var("FURNACE_CORE").ok();
    let cores = named
        .as_deref()
        .into_iter()
        .chain(["builtin"].into_iter().filter(|builtin| named.as_deref() != Some(*builtin)));
    let cores: Result<Vec<CoreSpec>, _> = cores.map(str::parse).collect();
    let bench = Bench {
        cores: cores.expect("FURNACE_CORE names a core"),
        hosting: Hosting { program: env!("CARGO_BIN_EXE_furnace").into(), ..Hosting::default() },
        rounds: ROUNDS,
    };
    let subjects: Vec<Subject> = made_here(is_wanted).collect();
    for subject in subjects.iter().filter(|_| named.is_none()) {
        time_alone(&mut criterion, subject);
    }
    let asked = if is_measuring { &subjects[..] } else { &[] };
    let measured = bench.measure(asked, |_, _| ()).expect("the cores answer");
    criterion.final_summary();
    println!("{}", table(&measured));
    assert!(!measured.iter().any(|one| one.is_wrong()), "hits differ from those of brute force");
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
