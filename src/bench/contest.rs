//! Structures of several cores over one mesh, timed against each other.

use super::Subject;
use crate::contract::validate::Validated;
use crate::contract::{
    Acceleration, Breach, Built, Capabilities, Core, CoreError, Hit, Precision, Ray, Split,
    TraversalStats,
};
use crate::cores::{CoreSpec, HostError, Hosted, Hosting};
use crate::math::rng::{Seed, Stream, uniform};
use crate::stats::timing::{SpeedUp, median, speed_up};
use crate::worker::CpuClock;
use std::time::Instant;

/// Brute force is timed on so many rays that it tests about this many triangles in a pass,
const BRUTE_FORCE_TESTS: usize = 16_000_000;
/// but not on fewer or more than so many.
const BRUTE_FORCE_RAYS: [usize; 2] = [64, 1000];
/// Shorter passes are repeated.
const SHORTEST_PASS: f64 = 0.02;
/// How far apart the distances of two cores to one hit may be, as a share.
const SAME_HIT: f64 = 1e-4;
/// Rays that pass an edge of a mesh on the other side in another core's arithmetic, as a share.
const AT_EDGES: f64 = 0.01;

/// A way to be traced.
#[derive(Clone, Copy, Debug)]
struct Structure {
    name: &'static str,
    acceleration: Acceleration,
}

impl Structure {
    const BRUTE_FORCE: Self = Self { name: "brute-force", acceleration: Acceleration::BruteForce };
    const OWN: Self = Self::bvh("its own BVH", Split::CoresChoice);
    const RULES: [Self; 4] = [
        Self::bvh("median", Split::Median),
        Self::bvh("mean-of-centroids", Split::MeanOfCentroids),
        Self::bvh("midpoint", Split::Midpoint),
        Self::bvh("surface-area", Split::SurfaceArea),
    ];

    const fn bvh(name: &'static str, split: Split) -> Self {
        Self { name, acceleration: Acceleration::Bvh { split, max_leaf_size: 4 } }
    }

    /// All that a core can build: without split rules, one BVH of its own choice.
    fn of(capabilities: Capabilities) -> Vec<Self> {
        let brute_force =
            capabilities.contains(Capabilities::BRUTE_FORCE).then_some(Self::BRUTE_FORCE);
        let has_rules = capabilities.contains(Capabilities::SPLIT_RULES);
        let bvhs = if has_rules { Self::RULES.to_vec() } else { vec![Self::OWN] };
        brute_force.into_iter().chain(bvhs).collect()
    }

    fn is_brute_force(&self) -> bool {
        self.acceleration == Acceleration::BruteForce
    }

    /// On which it is timed.
    fn rays<'a>(&self, subject: &'a Subject) -> &'a [Ray] {
        let [few, many] = BRUTE_FORCE_RAYS;
        let few = (BRUTE_FORCE_TESTS / subject.scene.primitive_count()).clamp(few, many);
        let count = if self.is_brute_force() { few } else { subject.rays.len() };
        &subject.rays[..count]
    }
}

/// Who is timed, and how.
#[derive(Clone, Debug)]
pub struct Bench {
    /// The first is whose brute force the others are compared with, or the first that has one.
    pub cores: Vec<CoreSpec>,
    /// Where they live: every structure has a process of its own.
    pub hosting: Hosting,
    /// Every structure is timed once a round.
    pub rounds: usize,
}

/// One subject's part of the table.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The subject.
    pub(super) subject: String,
    /// Of its meshes.
    pub(super) triangles: usize,
    /// One for each structure of each core; the one that all are compared with first.
    pub(super) rows: Vec<Row>,
}

/// One structure's row of the table.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) core: String,
    pub(super) structure: &'static str,
    pub(super) is_brute_force: bool,
    /// On how many rays it was timed.
    pub(super) rays: usize,
    /// Median over the rounds.
    pub(super) seconds_per_ray: f64,
    /// Time of the first row's brute force over this one's; none without brute force.
    pub(super) speed_up: Option<SpeedUp>,
    /// Primitives and boxes tested for a ray; none where the core does not count.
    pub(super) tests: Option<[f64; 2]>,
    pub(super) build_seconds: f64,
    /// Of the structure, for a triangle; none where the core does not say.
    pub(super) bytes_per_triangle: Option<f64>,
    /// Rays whose hits are not those of the first row, and of how many.
    pub(super) different: [usize; 2],
    /// Whether so many are too many.
    pub(super) is_wrong: bool,
    /// What its hits lack of the contract's form; what was meant took its place.
    pub(super) breach: Option<Breach>,
    /// Whether the core's process told no CPU time, so that this is wall time, with the channel in it.
    pub(super) by_the_wall: bool,
}

impl Measured {
    /// Whether some structure finds other hits than it should.
    pub fn is_wrong(&self) -> bool {
        self.rows.iter().any(|row| row.is_wrong)
    }
}

/// Why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotMeasured {
    #[error("{0} fails to start: {1}")]
    Host(CoreSpec, Box<HostError>),
    #[error("{core}, {structure}: {error}")]
    Core { core: String, structure: &'static str, error: Box<CoreError> },
    #[error("none of these cores has brute force: add `--core builtin`")]
    NoBruteForce,
}

impl Bench {
    /// Builds every structure over the subject, compares their hits, and times them against each other.
    ///
    /// # Errors
    /// If a core fails to start, or to answer.
    pub fn measure(&self, subject: &Subject) -> Result<Measured, Box<dyn std::error::Error>> {
        Ok(self.measured(subject)?)
    }

    fn measured(&self, subject: &Subject) -> Result<Measured, NotMeasured> {
        let mut hosted = self.hosted()?;
        let entries = hosted.iter_mut().map(|one| Entry::of(one, subject));
        let mut entries = entries.collect::<Result<Vec<_>, _>>()?;
        let contestants = entries.iter_mut().map(|entry| Contestant::new(entry, subject));
        let mut contestants = contestants.collect::<Result<Vec<_>, _>>()?;
        let mut stream = Seed::SUITE.child("rounds").child(&subject.name).stream();
        for _ in 0..self.rounds {
            for index in shuffled(contestants.len(), &mut stream) {
                contestants[index].take_a_turn()?;
            }
        }
        let first = (contestants[0].times.clone(), contestants[0].hits.clone());
        let core = contestants[0].row.core.clone();
        let rows = contestants.into_iter().map(|one| one.finish(&core, &first)).collect();
        let triangles = subject.scene.primitive_count();
        Ok(Measured { subject: subject.name.clone(), triangles, rows })
    }

    /// A process for each structure; that of the brute force that all are compared with comes first.
    fn hosted(&self) -> Result<Vec<(String, Structure, Hosted)>, NotMeasured> {
        let hosting = Hosting { isolates_own: true, ..self.hosting.clone() };
        let mut hosted: Vec<(String, Structure, Hosted)> = Vec::new();
        let mut has_brute_force = false;
        for spec in &self.cores {
            let host = || {
                hosting.host(spec).map_err(|error| NotMeasured::Host(spec.clone(), error.into()))
            };
            for structure in Structure::of(host()?.core_mut().info().capabilities) {
                // One brute force is enough: the other cores are compared with it too.
                if structure.is_brute_force() && std::mem::replace(&mut has_brute_force, true) {
                    continue;
                }
                hosted.push((spec.to_string(), structure, host()?));
            }
        }
        let first = hosted.iter().position(|(_, structure, _)| structure.is_brute_force());
        hosted[..=first.ok_or(NotMeasured::NoBruteForce)?].rotate_right(1);
        Ok(hosted)
    }
}

/// A core that is to build one structure.
struct Entry<'a> {
    core: String,
    structure: Structure,
    clock: CpuClock,
    breach: Option<Breach>,
    validated: Validated<'a>,
}

impl<'a> Entry<'a> {
    /// Looks once at what its hits lack of the contract's form; from then on they are mended.
    fn of(
        (core, structure, hosted): &'a mut (String, Structure, Hosted),
        subject: &Subject,
    ) -> Result<Self, NotMeasured> {
        let (core, structure, clock) = (core.clone(), *structure, hosted.clock());
        let mut hits = vec![Hit::MISS; structure.rays(subject).len()];
        let answered = Validated::new(hosted.core_mut())
            .build_scene(&subject.scene, structure.acceleration)
            .and_then(|mut built| built.intersect(structure.rays(subject), &mut hits));
        let breach = match answered {
            Ok(_) => None,
            Err(CoreError::BrokeContract(breach)) if breach.can_be_mended() => Some(*breach),
            Err(error) => return Err(not_answered(&core, structure.name, error)),
        };
        let validated = Validated::mending(hosted.core_mut());
        Ok(Self { core, structure, clock, breach, validated })
    }
}

/// One structure in the race.
struct Contestant<'a> {
    /// Without what the race is for: its times.
    row: Row,
    precision: Precision,
    built: Built<'a>,
    clock: CpuClock,
    rays: &'a [Ray],
    hits: Vec<Hit>,
    passes_a_turn: usize,
    /// Seconds per ray, one for each round.
    times: Vec<f64>,
}

impl<'a> Contestant<'a> {
    fn new(entry: &'a mut Entry<'_>, subject: &'a Subject) -> Result<Self, NotMeasured> {
        let Entry { core, structure, clock, breach, validated } = entry;
        let failed = |error| not_answered(core, structure.name, error);
        let info = validated.info();
        let triangles = subject.scene.primitive_count();
        let rays = structure.rays(subject);
        let count = rays.len();
        let mut hits = vec![Hit::MISS; count];
        let how = structure.acceleration;
        let (built, build) =
            clock.time(|| validated.build_scene(&subject.scene, how).map_err(failed));
        let mut built = built?;
        let (stats, _) = clock.time(|| built.intersect(rays, &mut hits).map_err(failed));
        let stats = stats?;
        // The first pass is slower: nothing is cached.
        let (again, pass) = clock.time(|| built.intersect(rays, &mut hits).map_err(failed));
        again?;
        let bytes = built.stats().bytes as f64 / triangles as f64;
        let counts = info.capabilities.contains(Capabilities::TRAVERSAL_STATS);
        let row = Row {
            core: core.clone(),
            structure: structure.name,
            is_brute_force: structure.is_brute_force(),
            rays: count,
            seconds_per_ray: f64::NAN,
            speed_up: None,
            tests: counts.then(|| tests(stats, count)),
            build_seconds: build.seconds,
            bytes_per_triangle: (bytes > 0.0).then_some(bytes),
            different: [0, count],
            is_wrong: false,
            breach: breach.clone(),
            by_the_wall: pass.by_the_wall,
        };
        let passes_a_turn = (SHORTEST_PASS / pass.seconds).ceil().clamp(1.0, 1000.0) as usize;
        let (precision, clock) = (info.precision, clock.clone());
        Ok(Self { row, precision, built, clock, rays, hits, passes_a_turn, times: Vec::new() })
    }

    fn take_a_turn(&mut self) -> Result<(), NotMeasured> {
        let Self { built, rays, hits, passes_a_turn, .. } = self;
        let (answered, took) = self
            .clock
            .time(|| (0..*passes_a_turn).try_for_each(|_| built.intersect(rays, hits).map(drop)));
        answered.map_err(|error| not_answered(&self.row.core, self.row.structure, error))?;
        self.times.push(took.seconds / (self.passes_a_turn * self.rays.len()) as f64);
        Ok(())
    }

    /// Its row, beside the times and the hits of the first one, which is of `core`.
    fn finish(self, core: &str, (brute_force, hits): &(Vec<f64>, Vec<Hit>)) -> Row {
        let pairs: Vec<_> = brute_force.iter().copied().zip(self.times.iter().copied()).collect();
        // The same arithmetic finds the same hits, in double precision to the last bit.
        let is_own = self.row.core == core;
        let to_the_bit = is_own && self.precision == Precision::Double;
        let compared = hits.iter().zip(&self.hits);
        let different = compared.filter(|(right, hit)| !is_same(right, hit, to_the_bit)).count();
        let allowed = if is_own { 0.0 } else { AT_EDGES * hits.len() as f64 };
        Row {
            seconds_per_ray: median(&self.times),
            speed_up: (!self.row.is_brute_force).then(|| speed_up(&pairs)),
            different: [different, hits.len()],
            is_wrong: different as f64 > allowed,
            ..self.row
        }
    }
}

fn not_answered(core: &str, structure: &'static str, error: CoreError) -> NotMeasured {
    NotMeasured::Core { core: core.to_owned(), structure, error: error.into() }
}

fn is_same(right: &Hit, hit: &Hit, to_the_bit: bool) -> bool {
    match (right.is_hit(), hit.is_hit()) {
        (true, true) if to_the_bit => right.t.to_bits() == hit.t.to_bits(),
        (true, true) => (right.t - hit.t).abs() <= SAME_HIT * right.t.abs(),
        (one, other) => one == other,
    }
}

fn tests(stats: TraversalStats, rays: usize) -> [f64; 2] {
    [stats.primitive_tests, stats.box_tests].map(|tests| tests as f64 / rays as f64)
}

/// The numbers below `count` in random order (Fisher and Yates).
fn shuffled(count: usize, stream: &mut Stream) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, (uniform(stream) * (last + 1) as f64) as usize);
    }
    order
}

/// What something took.
struct Took {
    seconds: f64,
    by_the_wall: bool,
}

impl CpuClock {
    /// Runs something that asks the core of this clock.
    fn time<T>(&self, work: impl FnOnce() -> T) -> (T, Took) {
        let (before, begun) = (self.seconds(), Instant::now());
        let done = work();
        let seconds = self.seconds() - before;
        let by_the_wall = seconds <= 0.0;
        let seconds = if by_the_wall { begun.elapsed().as_secs_f64() } else { seconds };
        (done, Took { seconds, by_the_wall })
    }
}
