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
/// Passes are repeated for so many seconds,
const SHORTEST_TURN: f64 = 0.02;
/// and a structure takes so many turns a round, of which the fastest counts.
const TURNS: usize = 3;
/// How wide an interval may be, as a share of its speed-up.
const WIDEST_INTERVAL: f64 = 0.1;
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
        Self { name, acceleration: Acceleration::Bvh { split, max_leaf_size: 4, counted: true } }
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
    /// Every structure is built anew and timed once a round; there are as many again of subjects that were noisy.
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
    /// Seconds a ray, one for each round.
    pub(super) times: Vec<f64>,
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

impl Row {
    /// Median over the rounds.
    pub(super) fn seconds_per_ray(&self) -> f64 {
        median(&self.times)
    }
}

impl Measured {
    /// Whether some structure finds other hits than it should.
    pub fn is_wrong(&self) -> bool {
        self.rows.iter().any(|row| row.is_wrong)
    }

    /// Time of the first row's brute force over that of a row; none without a BVH.
    pub(super) fn speed_up(&self, row: &Row) -> Option<SpeedUp> {
        let times = self.rows[0].times.iter().copied().zip(row.times.iter().copied());
        (!row.is_brute_force).then(|| speed_up(&times.collect::<Vec<_>>()))
    }

    fn is_noisy(&self) -> bool {
        self.rows.iter().filter_map(|row| self.speed_up(row)).any(|one| is_noisy(&one))
    }
}

/// Such a speed-up is not printed.
pub(super) fn is_noisy(SpeedUp { ratio, interval: [low, high], .. }: &SpeedUp) -> bool {
    high - low > WIDEST_INTERVAL * ratio
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
    /// Builds every structure over every subject, compares their hits, and times them against each other. A round goes
    /// over all subjects, so that those of one subject are spread over the whole time; `tell` hears how many are done,
    /// and of how many subjects the last was.
    ///
    /// # Errors
    /// If a core fails to start, or to answer.
    pub fn measure(
        &self,
        subjects: &[Subject],
        tell: impl Fn(usize, usize),
    ) -> Result<Vec<Measured>, Box<dyn std::error::Error>> {
        Ok(self.measured(subjects, tell)?)
    }

    fn measured(
        &self,
        subjects: &[Subject],
        tell: impl Fn(usize, usize),
    ) -> Result<Vec<Measured>, NotMeasured> {
        let entries = self.entries()?;
        let looked_at = subjects.iter().map(|subject| self.look(&entries, subject));
        let mut measured = looked_at.collect::<Result<Vec<_>, _>>()?;
        let mut stream = Seed::SUITE.child("rounds").stream();
        let mut asked: Vec<_> = subjects.iter().zip(&mut measured).collect();
        let mut done = 0;
        // As many again where it was noisy. That is looked at once: who stops as soon as an interval is narrow stops at
        // those that are narrow by chance.
        for _ in 0..2 {
            for _ in 0..if asked.is_empty() { 0 } else { self.rounds } {
                for (subject, measured) in &mut asked {
                    let times = self.round(&entries, subject, &mut stream)?;
                    let rows = measured.rows.iter_mut().zip(times);
                    rows.for_each(|(row, time)| row.times.push(time));
                }
                done += 1;
                tell(done, asked.len());
            }
            asked.retain(|(_, measured)| measured.is_noisy());
        }
        Ok(measured)
    }

    /// What is timed; the brute force that all are compared with comes first.
    fn entries(&self) -> Result<Vec<Entry<'_>>, NotMeasured> {
        let mut entries: Vec<Entry<'_>> = Vec::new();
        for core in &self.cores {
            for structure in Structure::of(self.host(core)?.core_mut().info().capabilities) {
                // One brute force is enough: the other cores are compared with it too.
                let has_brute_force = entries.iter().any(|entry| entry.structure.is_brute_force());
                if !(structure.is_brute_force() && has_brute_force) {
                    entries.push(Entry { core, structure });
                }
            }
        }
        let first = entries.iter().position(|entry| entry.structure.is_brute_force());
        entries[..=first.ok_or(NotMeasured::NoBruteForce)?].rotate_right(1);
        Ok(entries)
    }

    fn host(&self, core: &CoreSpec) -> Result<Hosted, NotMeasured> {
        let hosting = Hosting { isolates_own: true, ..self.hosting.clone() };
        hosting.host(core).map_err(|error| NotMeasured::Host(core.clone(), error.into()))
    }

    /// Everything but times.
    fn look(&self, entries: &[Entry<'_>], subject: &Subject) -> Result<Measured, NotMeasured> {
        let mut looks = Vec::new();
        for entry in entries {
            looks.push(entry.look(&mut self.host(entry.core)?, subject)?);
        }
        let (first, hits) = (looks[0].row.core.clone(), looks[0].hits.clone());
        let rows = looks.into_iter().map(|look| look.beside(&first, &hits)).collect();
        let triangles = subject.scene.primitive_count();
        Ok(Measured { subject: subject.name.clone(), triangles, rows })
    }

    /// Seconds a ray of every structure, in processes of this round alone: how fast a process is depends on where its
    /// memory lies, too.
    fn round(
        &self,
        entries: &[Entry<'_>],
        subject: &Subject,
        stream: &mut Stream,
    ) -> Result<Vec<f64>, NotMeasured> {
        let hosted = entries.iter().map(|entry| self.host(entry.core));
        let mut hosted = hosted.collect::<Result<Vec<_>, _>>()?;
        let clocks: Vec<_> = hosted.iter().map(Hosted::clock).collect();
        let mut cores: Vec<_> =
            hosted.iter_mut().map(|one| Validated::mending(one.core_mut())).collect();
        let contestants = entries.iter().zip(&mut cores).zip(clocks);
        let contestants =
            contestants.map(|((entry, core), clock)| Contestant::new(*entry, core, clock, subject));
        let mut contestants = contestants.collect::<Result<Vec<_>, _>>()?;
        for _ in 0..TURNS {
            for index in shuffled(contestants.len(), stream) {
                contestants[index].take_a_turn()?;
            }
        }
        Ok(contestants.into_iter().map(|one| one.fastest).collect())
    }
}

/// A structure of a core.
#[derive(Clone, Copy)]
struct Entry<'a> {
    core: &'a CoreSpec,
    structure: Structure,
}

impl Entry<'_> {
    fn not_answered(&self, error: CoreError) -> NotMeasured {
        let (core, structure) = (self.core.to_string(), self.structure.name);
        NotMeasured::Core { core, structure, error: error.into() }
    }

    fn look(&self, hosted: &mut Hosted, subject: &Subject) -> Result<Look, NotMeasured> {
        let breach = self.breach(hosted, subject)?;
        let (clock, triangles) = (hosted.clock(), subject.scene.primitive_count());
        let info = hosted.core_mut().info();
        let rays = self.structure.rays(subject);
        let mut hits = vec![Hit::MISS; rays.len()];
        let mut core = Validated::mending(hosted.core_mut());
        let (built, build) =
            clock.time(|| core.build_scene(&subject.scene, self.structure.acceleration));
        let mut built = built.map_err(|error| self.not_answered(error))?;
        let (stats, pass) = clock.time(|| built.intersect(rays, &mut hits));
        let stats = stats.map_err(|error| self.not_answered(error))?;
        let bytes = built.stats().bytes as f64 / triangles as f64;
        let counts = info.capabilities.contains(Capabilities::TRAVERSAL_STATS);
        let row = Row {
            core: self.core.to_string(),
            structure: self.structure.name,
            is_brute_force: self.structure.is_brute_force(),
            rays: rays.len(),
            times: Vec::new(),
            tests: counts.then(|| tests(stats, rays.len())),
            build_seconds: build.seconds,
            bytes_per_triangle: (bytes > 0.0).then_some(bytes),
            different: [0, rays.len()],
            is_wrong: false,
            breach,
            by_the_wall: pass.by_the_wall,
        };
        Ok(Look { row, precision: info.precision, hits })
    }

    /// What its hits lack of the contract's form; after this they are mended.
    fn breach(
        &self,
        hosted: &mut Hosted,
        subject: &Subject,
    ) -> Result<Option<Breach>, NotMeasured> {
        let rays = self.structure.rays(subject);
        let mut hits = vec![Hit::MISS; rays.len()];
        let answered = Validated::new(hosted.core_mut())
            .build_scene(&subject.scene, self.structure.acceleration)
            .and_then(|mut built| built.intersect(rays, &mut hits));
        match answered {
            Ok(_) => Ok(None),
            Err(CoreError::BrokeContract(breach)) if breach.can_be_mended() => Ok(Some(*breach)),
            Err(error) => Err(self.not_answered(error)),
        }
    }
}

/// What there is to know of a structure before it is timed.
struct Look {
    row: Row,
    precision: Precision,
    hits: Vec<Hit>,
}

impl Look {
    /// Its row, beside the hits of the first one, which is of the core `first`.
    fn beside(self, first: &str, hits: &[Hit]) -> Row {
        // The same arithmetic finds the same hits, in double precision to the last bit.
        let is_own = self.row.core == first;
        let to_the_bit = is_own && self.precision == Precision::Double;
        let compared = hits.iter().zip(&self.hits);
        let different = compared.filter(|(right, hit)| !is_same(right, hit, to_the_bit)).count();
        let allowed = if is_own { 0.0 } else { AT_EDGES * hits.len() as f64 };
        let is_wrong = different as f64 > allowed;
        Row { different: [different, hits.len()], is_wrong, ..self.row }
    }
}

/// One structure in a round.
struct Contestant<'a> {
    entry: Entry<'a>,
    built: Built<'a>,
    clock: CpuClock,
    rays: &'a [Ray],
    hits: Vec<Hit>,
    passes_a_turn: usize,
    /// Seconds a ray of the fastest turn: what else a machine does only adds to a time.
    fastest: f64,
}

impl<'a> Contestant<'a> {
    fn new(
        entry: Entry<'a>,
        core: &'a mut Validated<'_>,
        clock: CpuClock,
        subject: &'a Subject,
    ) -> Result<Self, NotMeasured> {
        let rays = entry.structure.rays(subject);
        let mut hits = vec![Hit::MISS; rays.len()];
        let built = core.build_scene(&subject.scene, entry.structure.acceleration);
        let mut built = built.map_err(|error| entry.not_answered(error))?;
        // The first pass is slower: nothing is cached.
        let (answered, pass) = clock.time(|| built.intersect(rays, &mut hits));
        answered.map_err(|error| entry.not_answered(error))?;
        let passes_a_turn = (SHORTEST_TURN / pass.seconds).ceil().clamp(1.0, 1000.0) as usize;
        Ok(Self { entry, built, clock, rays, hits, passes_a_turn, fastest: f64::INFINITY })
    }

    fn take_a_turn(&mut self) -> Result<(), NotMeasured> {
        let Self { built, rays, hits, passes_a_turn, .. } = self;
        let (answered, took) = self
            .clock
            .time(|| (0..*passes_a_turn).try_for_each(|_| built.intersect(rays, hits).map(drop)));
        answered.map_err(|error| self.entry.not_answered(error))?;
        let seconds = took.seconds / (self.passes_a_turn * self.rays.len()) as f64;
        self.fastest = self.fastest.min(seconds);
        Ok(())
    }
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
