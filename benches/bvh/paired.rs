//! Speed-ups: passes of all structures interleaved in random order, so that whatever else the machine does falls
//! on all of them alike, and a bootstrap interval of the median ratio.

use crate::clock;
use crate::structures::{self, RULES, Rule};
use crate::subjects::Subject;
use furnace::contract::{BuiltScene, Hit, Ray};
use furnace::cores::builtin::Builtin;
use furnace::math::rng::{Seed, Stream, uniform};

/// Every structure is timed once a round.
const ROUNDS: usize = 11;
/// Brute force is timed on this many of the rays: it tests every triangle for each, so its cost scales.
pub const BRUTE_FORCE_RAYS: usize = 1000;
/// Shorter passes are repeated.
const SHORTEST_PASS: f64 = 0.01;
const RESAMPLES: usize = 2000;

/// One subject's part of the table.
pub struct Measured {
    pub subject: &'static str,
    pub triangles: usize,
    /// One row for each of [`RULES`].
    pub rows: Vec<Row>,
}

/// One structure's row of the table.
pub struct Row {
    pub rule: Rule,
    /// Median over the rounds.
    pub seconds_per_ray: f64,
    /// Brute force's seconds over this one's.
    pub speed_up: Interval,
    /// Triangles tested for a ray.
    pub tests_per_ray: f64,
    /// Boxes tested for a ray.
    pub boxes_per_ray: f64,
    /// CPU time on one thread.
    pub build_seconds: f64,
    /// Memory of the structure for a triangle.
    pub bytes_per_triangle: f64,
}

/// A median with its 95 % interval.
#[derive(Clone, Copy, Default)]
pub struct Interval {
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

/// Builds every structure over the subject, compares their hits, and times them against each other.
///
/// # Panics
/// If any structure finds other hits than brute force.
pub fn measure(subject: &Subject) -> Measured {
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    one_thread.install(|| measure_here(subject))
}

fn measure_here(subject: &Subject) -> Measured {
    let triangles = subject.scene.primitive_count();
    let mut cores = structures::cores();
    let pairs = RULES.iter().zip(&mut cores);
    let mut contestants: Vec<Contestant<'_>> =
        pairs.map(|(rule, core)| Contestant::new(*rule, core, subject)).collect();
    compare_hits(&contestants, subject.name);
    let mut stream = Seed::SUITE.child("rounds").child(subject.name).stream();
    for _ in 0..ROUNDS {
        for index in shuffled(contestants.len(), &mut stream) {
            contestants[index].take_a_turn();
        }
    }
    let brute_force = contestants[0].times.clone();
    let rows = contestants.into_iter().map(|one| one.finish(&brute_force, &mut stream)).collect();
    Measured { subject: subject.name, triangles, rows }
}

/// One structure in the race.
struct Contestant<'a> {
    /// Without what the race is for: its times.
    row: Row,
    built: Box<dyn BuiltScene + 'a>,
    rays: &'a [Ray],
    hits: Vec<Hit>,
    passes_a_turn: usize,
    /// Seconds per ray, one for each round.
    times: Vec<f64>,
}

impl<'a> Contestant<'a> {
    fn new(rule: Rule, core: &'a mut Builtin, subject: &'a Subject) -> Self {
        let start = clock::now();
        let mut built = structures::build(core, &subject.scene, rule);
        let build_seconds = (clock::now() - start).as_secs_f64();
        let bytes_per_triangle =
            built.stats().bytes as f64 / subject.scene.primitive_count() as f64;
        let count = if rule.is_brute_force() { BRUTE_FORCE_RAYS } else { subject.rays.len() };
        let rays = &subject.rays[..count];
        let mut hits = structures::no_hits(count);
        let stats = structures::trace(built.as_mut(), rays, &mut hits);
        let pass = clock::seconds(|| {
            structures::trace(built.as_mut(), rays, &mut hits);
        });
        let row = Row {
            rule,
            seconds_per_ray: f64::NAN,
            speed_up: Interval::default(),
            tests_per_ray: stats.primitive_tests as f64 / stats.rays as f64,
            boxes_per_ray: stats.box_tests as f64 / stats.rays as f64,
            build_seconds,
            bytes_per_triangle,
        };
        let passes_a_turn = (SHORTEST_PASS / pass).ceil().clamp(1.0, 1000.0) as usize;
        Self { row, built, rays, hits, passes_a_turn, times: Vec::with_capacity(ROUNDS) }
    }

    fn take_a_turn(&mut self) {
        let passes = self.passes_a_turn;
        let seconds = clock::seconds(|| {
            for _ in 0..passes {
                structures::trace(self.built.as_mut(), self.rays, &mut self.hits);
            }
        });
        self.times.push(seconds / (passes * self.rays.len()) as f64);
    }

    fn finish(self, brute_force: &[f64], stream: &mut Stream) -> Row {
        let ratios: Vec<f64> =
            brute_force.iter().zip(&self.times).map(|(slow, fast)| slow / fast).collect();
        let seconds_per_ray = median(&mut self.times.clone());
        Row { seconds_per_ray, speed_up: bootstrap(&ratios, stream), ..self.row }
    }
}

fn compare_hits(contestants: &[Contestant<'_>], subject: &str) {
    let brute_force = &contestants[0].hits;
    assert!(brute_force.iter().any(Hit::is_hit), "no ray meets {subject}");
    for other in &contestants[1..] {
        let differs = brute_force.iter().zip(&other.hits).position(|(right, hit)| right != hit);
        if let Some(ray) = differs {
            panic!("{subject}: {} and brute force differ at ray {ray}", other.row.rule.name);
        }
    }
}

/// The numbers below `count` in random order (Fisher and Yates).
fn shuffled(count: usize, stream: &mut Stream) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, below(last + 1, stream));
    }
    order
}

fn below(count: usize, stream: &mut Stream) -> usize {
    (uniform(stream) * count as f64) as usize
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median, and the middle 95 % of the medians of resamples (Efron 1979).
fn bootstrap(values: &[f64], stream: &mut Stream) -> Interval {
    let mut resampled_median = || {
        let mut resample: Vec<f64> =
            (0..values.len()).map(|_| values[below(values.len(), stream)]).collect();
        median(&mut resample)
    };
    let mut medians: Vec<f64> = (0..RESAMPLES).map(|_| resampled_median()).collect();
    medians.sort_unstable_by(f64::total_cmp);
    let tail = RESAMPLES / 40;
    let (low, high) = (medians[tail], medians[RESAMPLES - 1 - tail]);
    Interval { low, median: median(&mut values.to_vec()), high }
}
