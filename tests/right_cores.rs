//! Cores that are right, and not the same: choices of pbrt's, Mitsuba's and Cycles' in place of those of the textbook core
//! and of `examples/cpp`, each put to the suite with other random numbers. None may fail anything.
//!
//! ```sh
//! FURNACE_SEEDS=20 cargo test --test right_cores -- --ignored --nocapture
//! FURNACE_CORES=cpp,coarse ...              # only those with one of these in their names
//! FURNACE_CASES=bvh/,shape/ ...             # only these
//! FURNACE_CASES=image/ ...                  # images against references, which are left out otherwise
//! ```
//!
//! One seed of the textbook's own is part of `tests/faults.rs`, and one of the plain examples of `tests/worker.rs`.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use furnace::case;
use furnace::cores::Hosting;
use furnace::faults;
use furnace::math::rng::Seed;
use furnace::project::Project;
use furnace::run::{Plan, Request, Status, TrialRecord, run_in_memory};
use furnace::stats::Budget;
use std::path::Path;
use support::{compile_core, cpp_compiler, root};

/// A way to write `examples/cpp` that is as right: compiler flags, and texts in place of others of its files.
struct Build {
    name: &'static str,
    flags: &'static [&'static str],
    changes: &'static [Change],
}

struct Change {
    file: &'static str,
    from: &'static str,
    to: &'static str,
}

const fn change(file: &'static str, from: &'static str, to: &'static str) -> Change {
    Change { file, from, to }
}

const FUSED: &[&str] = &["-O3", "-march=native", "-ffast-math", "-fno-finite-math-only"];

/// Of an estimator that is not the one courses derive.
const NOT_PLAIN: Change = change("pathtracer.cpp", " | FURNACE_PLAIN_ESTIMATORS", "");

const BUILDS: &[Build] = &[
    Build { name: "cpp", flags: &[], changes: &[] },
    Build { name: "cpp-single", flags: &["-DREAL=float"], changes: &[] },
    Build {
        name: "cpp-single-fast-math",
        flags: &["-DREAL=float", "-ffast-math", "-fno-finite-math-only"],
        changes: &[],
    },
    // The largest double below 1 becomes 1.
    Build {
        name: "cpp-single-unclamped",
        flags: &["-DREAL=float"],
        changes: &[change("types.hpp", "std::min(Real(number), BELOW_ONE)", "Real(number)")],
    },
    Build {
        name: "cpp-least-distance",
        flags: &[],
        changes: &[
            change("scene.hpp", "return {beside(way), 0, way, INFINITE}", LEAST_DISTANCE),
            change("scene.hpp", "Vec whole = point + distance * way - beside(way);", ""),
            change(
                "scene.hpp",
                "return {beside(way), 0, whole, 1 - std::max(CLEARANCE, clearance / distance)}",
                SHORTENED,
            ),
        ],
    },
    Build {
        name: "cpp-power-heuristic",
        flags: &[],
        changes: &[change("scene.hpp", "own / (own + other)", POWER_HEURISTIC)],
    },
    Build {
        name: "cpp-concentric-disk",
        flags: &[],
        changes: &[
            change("numbers.hpp", "Real radius = std::sqrt(u.x);", CONCENTRIC),
            change(
                "numbers.hpp",
                "radius * std::cos(2 * PI * u.y), radius * std::sin(2 * PI * u.y), std::sqrt(1 - u.x)",
                ON_DISK,
            ),
        ],
    },
    Build {
        name: "cpp-all-microfacets",
        flags: &[],
        changes: &[
            change("surfaces.hpp", "* Rgb(m.reflectance), d * o / 4}", ALL_MICROFACETS_PDF),
            change("surfaces.hpp", "Vec view = unit({alpha * wo.x, alpha * wo.y, wo.z});", ""),
            change(
                "surfaces.hpp",
                "Vec stretched = view + below_pole(u.x * (1 + view.z), u.y);",
                ALL_MICROFACETS,
            ),
        ],
    },
    Build {
        name: "cpp-one-light",
        flags: &[],
        changes: &[
            change("scene.hpp", "Rgb      sum{0, 0, 0};\n      for (const Light", ONE_LIGHT),
            change("scene.hpp", "random.numbers(), glossy) / Real(count)", ONE_LIGHT_WEIGHT),
            NOT_PLAIN,
        ],
    },
    Build {
        name: "cpp-area-of-spheres",
        flags: &[],
        changes: &[change("lights.hpp", "bool fills_a_cone(Vec from) const {", NO_CONE), NOT_PLAIN],
    },
    Build {
        name: "cpp-equal-lobes",
        flags: &[],
        changes: &[
            change("surfaces.hpp", "lobe < reflected)", "lobe < probability(reflected))"),
            change(
                "surfaces.hpp",
                "Rgb(m.reflectance), reflected)",
                "Rgb(m.reflectance), probability(reflected))",
            ),
            change(
                "surfaces.hpp",
                "Rgb(m.transmittance), 1 - reflected)",
                "Rgb(m.transmittance), 1 - probability(reflected))",
            ),
            change("surfaces.hpp", "inline BsdfSample sample_glass(", EQUAL_LOBES),
        ],
    },
    Build {
        name: "cpp-own-roulette",
        flags: &[],
        changes: &[
            change("scene.hpp", "Real(settings.roulette_stop) : 1;", OWN_ROULETTE),
            NOT_PLAIN,
        ],
    },
    Build {
        name: "cpp-pcg",
        flags: &[],
        changes: &[change(
            "numbers.hpp",
            "return Real(mix(state += 0x9e3779b97f4a7c15) >> (64 - DIGITS))",
            PCG,
        )],
    },
    // Every product that can be is fused, sums are in any order.
    Build { name: "cpp-fused", flags: FUSED, changes: &[] },
    Build {
        name: "cpp-watertight",
        flags: &[],
        changes: &[
            change(
                "shapes.hpp",
                "Real determinant = -dot(ray.direction, cross_edges);",
                WATERTIGHT,
            ),
            change(
                "shapes.hpp",
                "if (!(std::abs(determinant) > parallel * length(ray.direction))) return false;",
                "",
            ),
            change(
                "shapes.hpp",
                "Vec    from = ray.origin - corner, turned = cross(from, ray.direction);",
                "",
            ),
            change(
                "shapes.hpp",
                "Real u = dot(edge2, turned) / determinant, v = -dot(edge1, turned) / determinant;",
                "",
            ),
            change("shapes.hpp", "Real t = dot(from, cross_edges) / determinant;", ""),
            change(
                "shapes.hpp",
                "if (!(u >= 0 && v >= 0 && u + v <= 1 && within(ray, t)))",
                "if (!within(ray, t))",
            ),
        ],
    },
    Build {
        name: "cpp-mis-everywhere",
        flags: &[],
        changes: &[
            change(
                "scene.hpp",
                "bool glossy = v.material->kind == FURNACE_CONDUCTOR &&",
                "bool glossy =",
            ),
            NOT_PLAIN,
        ],
    },
    Build {
        name: "cpp-one-sample-mis",
        flags: &[],
        changes: &[
            change("scene.hpp", "Rgb      sum{0, 0, 0};\n      for (const Light", ONE_SAMPLE),
            change("scene.hpp", "random.numbers(), glossy) / Real(count)", ONE_SAMPLE_OF_LIGHTS),
            change(
                "scene.hpp",
                "from_lobe(v, random.numbers()) / Real(samples)",
                ONE_SAMPLE_OF_LOBE,
            ),
            NOT_PLAIN,
        ],
    },
    Build {
        name: "cpp-sky-by-brightness",
        flags: &[],
        changes: &[
            change("lights.hpp", "if (light.kind != FURNACE_AREA) return;", SKY_TABLE_FILLED),
            change(
                "lights.hpp",
                "Vec wi = below_pole(2 * random.point.x, random.point.y);",
                SKY_SAMPLED,
            ),
            change("lights.hpp", "sky(wi), sky_pdf(), 0, 1", "sky(wi), sky_pdf(wi), 0, 1"),
            change(
                "lights.hpp",
                "Real sky_pdf() const { return is_sky() ? 1 / (4 * PI) : 0; }",
                SKY_PDF,
            ),
            change("lights.hpp", " private:\n   furnace_light         light;", SKY_TABLE),
            change("scene.hpp", "light.sky_pdf()", "light.sky_pdf(seen.direction)"),
            NOT_PLAIN,
        ],
    },
    Build {
        name: "cpp-stream-a-row",
        flags: &[],
        changes: &[
            change("pathtracer.cpp", "auto render_pixel = [&](uint32_t index) {", ROWS),
            change(
                "pathtracer.cpp",
                "Random  random(settings.integrator->seed, index, tally.count + 1);",
                "Random &random = rows[y];",
            ),
        ],
    },
    Build {
        name: "cpp-negative-estimates",
        flags: &[],
        changes: &[
            change("scene.hpp", "return trace(ray, settings, random);", NEGATIVE),
            NOT_PLAIN,
        ],
    },
    // Finite means, and variances that are not.
    Build {
        name: "cpp-infinite-variance",
        flags: &[],
        changes: &[
            change("scene.hpp", "throughput * direct_light(v, settings, random)", PARETO),
            NOT_PLAIN,
        ],
    },
    Build {
        name: "cpp-never-the-same",
        flags: &[],
        changes: &[
            change("numbers.hpp", "state(mix(mix(mix(seed) + stream) + sample))", FRESH),
            change("numbers.hpp", "#include <array>", "#include <array>\n#include <atomic>"),
            change("pathtracer.cpp", " | FURNACE_DETERMINISTIC", ""),
        ],
    },
];

const LEAST_DISTANCE: &str = "return {point, clearance, way, INFINITE}";
const SHORTENED: &str =
    "return {point, clearance, way, distance - std::max(CLEARANCE * distance, clearance)}";
const POWER_HEURISTIC: &str = "own * own / (own * own + other * other)";
/// Shirley and Chiu 1997.
const CONCENTRIC: &str = "
   Real a = 2 * u.x - 1, b = 2 * u.y - 1;
   bool wide = std::abs(a) > std::abs(b);
   Real radius = wide ? a : b, other = radius == 0 ? 0 : PI / 4 * (wide ? b / a : a / b);
   Real angle = wide ? other : PI / 2 - other;
   Real z = std::sqrt(std::max(Real(0), 1 - radius * radius));";
const ON_DISK: &str = "radius * std::cos(angle), radius * std::sin(angle), z";
/// Walter et al. 2007, equation 35.
const ALL_MICROFACETS: &str = "
   Real z2 = (1 - u.x) / (1 + (alpha * alpha - 1) * u.x), s = std::sqrt(std::max(Real(0), 1 - z2));
   Vec  stretched{s * std::cos(2 * PI * u.y) / alpha, s * std::sin(2 * PI * u.y) / alpha, std::sqrt(z2)};";
const ALL_MICROFACETS_PDF: &str =
    "* Rgb(m.reflectance), d * unit(wo + wi).z / (4 * dot(wo, unit(wo + wi)))}";
const ONE_LIGHT: &str = "Rgb      sum{0, 0, 0};
      const Light *chosen = lights.data() + size_t(random.number() * Real(lights.size()));
      for (const Light";
const ONE_LIGHT_WEIGHT: &str = "random.numbers(), glossy) *
                        (&light == chosen ? Real(lights.size()) / Real(count) : 0)";
const NO_CONE: &str = "bool fills_a_cone(Vec from) const {
      if (true) return false;";
const EQUAL_LOBES: &str =
    "inline Real probability(Real reflected) { return reflected < 1 ? Real(0.5) : 1; }
inline BsdfSample sample_glass(";
const OWN_ROULETTE: &str = "Real(settings.roulette_stop) : 1;
         if (settings.roulette_stop == 0)
            survival = std::min(Real(1), std::max({throughput.r, throughput.g, throughput.b, Real(0.1)}));";
/// O'Neill 2014, the output of PCG XSH RR, twice.
const PCG: &str = "auto half = [this] {
         uint64_t old = state;
         state = old * 6364136223846793005u + 1442695040888963407u;
         auto mixed = uint32_t(((old >> 18) ^ old) >> 27), turn = uint32_t(old >> 59);
         return uint64_t((mixed >> turn) | (mixed << (-turn & 31)));
      };
      uint64_t high = half() << 32;
      return Real((high | half()) >> (64 - DIGITS))";

/// Woop, Benthin and Wald 2013, as pbrt and Embree have it.
const WATERTIGHT: &str = "Vec  way = ray.direction, size{std::abs(way.x), std::abs(way.y), std::abs(way.z)};
      int  kz = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
      int  kx = (kz + 1) % 3, ky = (kz + 2) % 3;
      Real shear_x = at(way, kx) / at(way, kz), shear_y = at(way, ky) / at(way, kz);
      Real x[3], y[3], z[3];
      for (int i = 0; i < 3; ++i) {
         Vec from = positions[i] - ray.origin;
         z[i] = at(from, kz) / at(way, kz);
         x[i] = at(from, kx) - shear_x * at(from, kz), y[i] = at(from, ky) - shear_y * at(from, kz);
      }
      Real a = x[2] * y[1] - y[2] * x[1], b = x[0] * y[2] - y[0] * x[2], c = x[1] * y[0] - y[1] * x[0];
      if ((a < 0 || b < 0 || c < 0) && (a > 0 || b > 0 || c > 0)) return false;
      Real all = a + b + c;
      if (all == 0) return false;
      Real t = (a * z[0] + b * z[1] + c * z[2]) / all, u = b / all, v = c / all;";
/// Veach 1997, section 9.2.1: which of the techniques is chosen anew each time.
const ONE_SAMPLE: &str = "bool     by_lobe = random.number() < Real(0.5);
      Rgb      sum{0, 0, 0};
      for (const Light";
const ONE_SAMPLE_OF_LIGHTS: &str = "random.numbers(), glossy) *
                        (glossy && !light.is_delta() ? (by_lobe ? 0 : 2) / Real(count) : 1 / Real(count))";
const ONE_SAMPLE_OF_LOBE: &str =
    "from_lobe(v, random.numbers()) * ((by_lobe ? 2 : 0) / Real(samples))";
/// Bands of equal solid angle around the zenith, each chosen by the brightness of its middle.
const SKY_TABLE: &str = " private:
   static constexpr int BANDS = 16;
   std::array<Real, BANDS> shares{};
   Vec pole() const {
      Vec place(light.place);
      return dot(place, place) > 0 ? unit(place) : Vec{0, 0, 1};
   }
   furnace_light         light;";
const SKY_TABLE_FILLED: &str = "Real all = 0;
      for (int band = 0; is_sky() && band < BANDS; ++band) {
         Real depth = (Real(band) + Real(0.5)) * 2 / BANDS;
         all += shares[size_t(band)] = luminance(sky(Frame(pole()).to_world(below_pole(depth, 0))));
      }
      for (Real &share : shares) share = all > 0 ? share / all : Real(1) / BANDS;
      if (light.kind != FURNACE_AREA) return;";
const SKY_SAMPLED: &str = "Real   u = random.point.x;
         size_t band = 0;
         while (band + 1 < BANDS && u >= shares[band]) u -= shares[band++];
         Real depth = (Real(band) + std::min(u / shares[band], BELOW_ONE)) * 2 / BANDS;
         Vec  wi = Frame(pole()).to_world(below_pole(depth, random.point.y));";
const SKY_PDF: &str = "Real sky_pdf(Vec w) const {
      if (!is_sky()) return 0;
      int band = int((1 - dot(w, pole())) * BANDS / 2);
      return shares[size_t(std::min(std::max(band, 0), BANDS - 1))] * BANDS / (4 * PI);
   }";
/// One thread's numbers go on from pixel to pixel.
const ROWS: &str = "std::vector<Random> rows;
   for (uint32_t y = 0; y < settings.height; ++y) rows.emplace_back(settings.integrator->seed, y, 0);
   auto render_pixel = [&](uint32_t index) {";
/// A control variate that has nothing to do with the light.
const NEGATIVE: &str = "Rgb found = trace(ray, settings, random);
      return settings.first_bounce == 0 ? found : found * (6 * random.number() - 2);";
const PARETO: &str = "throughput * direct_light(v, settings, random) *
                              (std::pow(1 - random.number(), -1 / Real(1.2)) / 6)";
const FRESH: &str = "state(mix(mix(mix(seed) + stream) + sample)) {
      static std::atomic<uint64_t> count{0};
      state = mix(state + mix(++count));
   }
   Random(uint64_t start) : state(start)";

impl Build {
    /// Compiles it; answers how the command line would name it.
    fn core(&self) -> String {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("right-cores").join(self.name);
        std::fs::create_dir_all(&folder).unwrap();
        for entry in std::fs::read_dir(root().join("examples/cpp")).unwrap() {
            let path = entry.unwrap().path();
            let mut text = std::fs::read_to_string(&path).unwrap();
            for Change { file, from, to } in self.changes.iter().filter(|c| path.ends_with(c.file))
            {
                assert!(text.contains(from), "{file} has no `{from}`");
                text = text.replace(from, to);
            }
            std::fs::write(folder.join(path.file_name().unwrap()), text).unwrap();
        }
        let library = folder.join("core.so");
        let flags = [self.flags, &["-Wno-unused-parameter"]].concat();
        compile_core(&cpp_compiler(), &flags, &folder.join("pathtracer.cpp"), &library);
        library.to_string_lossy().into_owned()
    }
}

/// Names, and how the command line would name them; what is compiled is compiled now.
fn cores() -> Vec<(String, String)> {
    let asked = std::env::var("FURNACE_CORES").unwrap_or_default();
    let wanted = |name: &str| asked.split(',').any(|part| name.contains(part));
    let (_, different) = faults::select(&[]).unwrap();
    let own = different.into_iter().map(|core| format!("textbook:{}", core.name));
    let own = own.map(|name| (name.clone(), name));
    let builds = BUILDS.iter().filter(|build| wanted(build.name));
    let compiled = builds.map(|build| (build.name.to_owned(), build.core()));
    own.filter(|(name, _)| wanted(name)).chain(compiled).collect()
}

fn asked_for() -> Vec<String> {
    let asked = std::env::var("FURNACE_CASES").unwrap_or_default();
    let asked = asked.split(',').filter(|filter| !filter.is_empty());
    let images_too = asked.clone().any(|filter| filter.starts_with("image/"));
    let left_out = (!images_too).then_some("!image/");
    asked.chain(left_out).map(str::to_owned).collect()
}

fn tried(core: &str, seed: u32, filters: Vec<String>) -> Vec<TrialRecord> {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).unwrap();
    let request = Request {
        cores: vec![core.parse().unwrap()],
        filters,
        budget: Budget::Quick,
        seed: Seed::SUITE.child("right cores").child(seed),
        jobs: std::env::var("FURNACE_JOBS").map_or(0, |jobs| jobs.parse().unwrap()),
        ..Request::default()
    };
    let hosting = Hosting { program: env!("CARGO_BIN_EXE_furnace").into(), ..Hosting::default() };
    run_in_memory(&Plan::new(project, request, &cases).unwrap().hosted(hosting))
}

/// The graded trials that ended otherwise than they should, in words.
fn unlike(records: &[TrialRecord], fine: &[Status]) -> Vec<String> {
    let graded = records.iter().filter(|record| record.tier.is_graded());
    let unlike = graded.filter(|record| !fine.contains(&record.outcome.status()));
    unlike.map(|record| format!("{}: {}", record.case, record.outcome.statement())).collect()
}

#[test]
fn every_build_changes_what_the_example_says() {
    for build in BUILDS {
        for Change { file, from, .. } in build.changes {
            let text = std::fs::read_to_string(root().join("examples/cpp").join(file)).unwrap();
            assert!(text.contains(from), "{}: no {from:?} in {file}", build.name);
        }
    }
}

/// Of the audit below what a test run can afford.
#[test]
fn two_builds_fail_nothing_of_materials() {
    for name in ["cpp-single", "cpp-fused"] {
        let build = BUILDS.iter().find(|build| build.name == name).unwrap();
        let records = tried(&build.core(), 0, vec!["bsdf/".to_owned()]);
        assert!(records.iter().any(|record| record.outcome.status() == Status::Pass));
        let failed = unlike(&records, &[Status::Pass, Status::Inconclusive, Status::Skipped]);
        assert!(failed.is_empty(), "{name}: {failed:?}");
    }
}

#[test]
#[ignore = "hours: some thirty right cores, 20 times the suite each, for audits"]
fn right_cores_fail_nothing_whatever_the_random_numbers() {
    use Status::{Inconclusive, Pass, Skipped};
    let seeds = std::env::var("FURNACE_SEEDS").map_or(20, |seeds| seeds.parse().unwrap());
    let mut failures = 0;
    for (name, core) in cores() {
        let (mut trials, mut open) = (0, 0);
        for seed in 0..seeds {
            let records = tried(&core, seed, asked_for());
            let failed = unlike(&records, &[Pass, Inconclusive, Skipped]);
            let undecided = unlike(&records, &[Pass, Skipped]);
            trials += records.iter().filter(|r| r.outcome.status() == Pass).count();
            failures += failed.len();
            open += undecided.len() - failed.len();
            undecided.iter().for_each(|what| println!("  {name}, seed {seed}: {what}"));
        }
        println!("{name}: {seeds} seeds, {trials} pass, {open} inconclusive");
    }
    assert_eq!(failures, 0);
}
