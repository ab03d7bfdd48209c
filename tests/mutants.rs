//! What the bench sees of small random mistakes in code that was not written for it: mutants of `examples/cpp`, each put
//! to the suite as a user would put it, without pictures.
//!
//! ```sh
//! FURNACE_MUTANTS=0..200 cargo test --test mutants -- --ignored --nocapture
//! FURNACE_SEED=7 ...                         # mutants in another order
//! ```
//!
//! The order is random and that of the seed, so that ranges of it are samples; mutants that do not compile are passed
//! over. The log in `docs/simulations` ends with how the survivors were classed.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furnace::math::rng::{Seed, uniform};
use furnace::report::RunTree;
use furnace::run::record::read_json;
use furnace::run::{Status, TrialRecord};
use rayon::prelude::*;
use regex_lite::Regex;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Mutation operators: a name, what is looked for (in code without comments; binary operators stand between blanks), and
/// what comes in place of its group.
const OPERATORS: &[(&str, &str, &str)] = &[
    ("arithmetic", r" (\+) ", "-"),
    ("arithmetic", r" (-) ", "+"),
    ("arithmetic", r" (\*) ", "/"),
    ("arithmetic", r" (/) ", "*"),
    ("arithmetic", r" (%) ", "/"),
    ("arithmetic", r" (\+=) ", "-="),
    ("comparison", r" (<) ", "<="),
    ("comparison", r" (<) ", ">"),
    ("comparison", r" (<=) ", "<"),
    ("comparison", r" (<=) ", ">="),
    ("comparison", r" (>) ", ">="),
    ("comparison", r" (>) ", "<"),
    ("comparison", r" (>=) ", ">"),
    ("comparison", r" (>=) ", "<="),
    ("comparison", r" (==) ", "!="),
    ("comparison", r" (!=) ", "=="),
    ("constant", r"[^\w.](0(?:\.0)?)\b", "1"),
    ("constant", r"[^\w.]([1-9]\d*(?:\.\d+)?(?:e-?\d+)?u?)\b", "(2 * $1)"),
    ("constant", r"[^\w.](0\.\d+)\b", "(2 * $1)"),
    ("constant", r"[^\w.]([1-9]\d*(?:\.\d+)?(?:e-?\d+)?u?)\b", "0"),
    ("sign", r"(?:[(,=?:{] ?|return )(-)[\w(]", ""),
    ("function", r"std::(min)\b", "max"),
    ("function", r"std::(max)\b", "min"),
    ("function", r"std::(sin)\b", "cos"),
    ("function", r"std::(cos)\b", "sin"),
    ("function", r"(std::sqrt)\(", ""),
    ("function", r"(std::abs)\(", ""),
    ("logic", r" (&&) ", "||"),
    ("logic", r" (\|\|) ", "&&"),
    ("logic", r"[( ](!)[\w(]", ""),
    ("return", r"return ([^;{}]+);", "{}"),
    ("return", r"return (true);", "false"),
    ("return", r"return (false);", "true"),
    ("statement", r"(?m)^ +([^;{}\n]+);\s*$", ""),
    ("component", r"\.(x)\b", "y"),
    ("component", r"\.(y)\b", "z"),
    ("component", r"\.(z)\b", "x"),
    ("component", r"\.(r)\b", "g"),
    ("component", r"\.(g)\b", "b"),
    ("component", r"\.(b)\b", "r"),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The parts of the example, by file name.
type Sources = BTreeMap<String, String>;

fn sources() -> Sources {
    let files = std::fs::read_dir(root().join("examples/cpp")).unwrap();
    let paths = files.map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    paths.map(|path| (name(&path), std::fs::read_to_string(&path).unwrap())).collect()
}

/// One change of one place.
#[derive(Clone, Debug)]
struct Mutant {
    operator: &'static str,
    file: String,
    place: Range<usize>,
    text: String,
}

impl Mutant {
    fn apply(&self, sources: &Sources) -> Sources {
        let mut changed = sources.clone();
        changed.get_mut(&self.file).unwrap().replace_range(self.place.clone(), &self.text);
        changed
    }

    /// The operator and the place, then the line before and after.
    fn describe(&self, sources: &Sources) -> String {
        let number = sources[&self.file][..self.place.start].matches('\n').count();
        let line = |sources: &Sources| {
            sources[&self.file].lines().nth(number).unwrap_or_default().trim().to_owned()
        };
        let (before, after) = (line(sources), line(&self.apply(sources)));
        format!("{} {}:{}\n  - {before}\n  + {after}", self.operator, self.file, number + 1)
    }
}

/// The text with blanks for comments and for lines that are no code of the renderer: the preprocessor's, and those where
/// the bench lends a component.
fn code_alone(text: &str) -> String {
    let comment = Regex::new("//[^\n]*").unwrap();
    let line = |line: &str| {
        let code =
            comment.replace(line, |found: &regex_lite::Captures<'_>| " ".repeat(found[0].len()));
        let is_code = !code.starts_with('#') && !code.contains("bench");
        if is_code { code.into_owned() } else { " ".repeat(line.len()) }
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

fn mutants_of(file: &str, text: &str) -> Vec<Mutant> {
    let code = code_alone(text);
    let mut mutants = Vec::new();
    for &(operator, pattern, replacement) in OPERATORS {
        for found in Regex::new(pattern).unwrap().captures_iter(&code) {
            let group = found.get(1).unwrap();
            // A value that is not returned is undefined behaviour, not a mistake.
            if operator == "statement" && group.as_str().starts_with("return") {
                continue;
            }
            mutants.push(Mutant {
                operator,
                file: file.to_owned(),
                place: group.range(),
                text: replacement.replace("$1", group.as_str()),
            });
        }
    }
    mutants
}

fn in_random_order(mutants: Vec<Mutant>, seed: Seed) -> Vec<Mutant> {
    let mut random = seed.child("mutants").stream();
    let mut keyed: Vec<_> = mutants.into_iter().map(|one| (uniform(&mut random), one)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    keyed.into_iter().map(|(_, mutant)| mutant).collect()
}

/// Where mutants are compiled and put to the suite.
struct Workshop {
    folder: PathBuf,
    /// A copy, which nobody builds anew in the meantime.
    furnace: PathBuf,
    optimised: &'static str,
    filters: Vec<String>,
}

/// What came of a mutant.
struct Tried {
    killed_by: Vec<String>,
    /// All headlines: degree, cause and what is told.
    told: Vec<String>,
}

impl Workshop {
    fn new(name: &str, optimised: &'static str, filters: &[&str]) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutants").join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let furnace = folder.join("furnace");
        std::fs::copy(env!("CARGO_BIN_EXE_furnace"), &furnace).unwrap();
        let filters = filters.iter().map(ToString::to_string).collect();
        Self { folder, furnace, optimised, filters }
    }

    fn core(&self) -> PathBuf {
        self.folder.join("core.so")
    }

    fn compiles(&self, sources: &Sources) -> bool {
        for (name, text) in sources {
            std::fs::write(self.folder.join(name), text).unwrap();
        }
        let compiler = std::env::var_os("CXX").unwrap_or_else(|| "c++".into());
        let ended = Command::new(compiler)
            .args(["-std=c++17", self.optimised, "-w", "-shared", "-fPIC", "-I"])
            .arg(root().join("include"))
            .arg(self.folder.join("pathtracer.cpp"))
            .arg("-o")
            .arg(self.core())
            .output();
        ended.unwrap().status.success()
    }

    /// Puts what was compiled to the suite.
    fn try_out(&self) -> Tried {
        let runs = self.folder.join("runs");
        let _ = std::fs::remove_dir_all(&runs);
        let ended = Command::new(&self.furnace)
            .arg("run")
            .args(&self.filters)
            .args(["--budget", "quick", "--jobs", "1", "--time-limit", "30", "--quiet"])
            .arg("--core")
            .arg(self.core())
            .arg("--report")
            .arg(&runs)
            .arg("--project")
            .arg(root())
            .output()
            .unwrap();
        let run = std::fs::read_dir(&runs).ok().and_then(|mut runs| runs.next());
        let run = run.unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&ended.stderr)));
        Tried::read(&run.unwrap().path())
    }
}

fn kills(trial: &TrialRecord) -> bool {
    use Status::{Blocked, Inconclusive, Pass, Skipped};
    let is_fine = matches!(trial.outcome.status(), Pass | Inconclusive | Skipped | Blocked);
    trial.tier.is_graded() && !is_fine
}

impl Tried {
    fn read(run: &Path) -> Self {
        let tree = RunTree::load(run).unwrap();
        let fails = tree.trials.iter().filter(|trial| kills(trial));
        let killed_by = fails.map(|trial| trial.case.clone()).collect();
        let record: serde_json::Value = read_json(&run.join("run.json")).unwrap();
        let headlines = record["cores"][0]["diagnosis"]["headlines"].as_array();
        let told = headlines.into_iter().flatten().map(|headline| {
            let word = |key: &str| headline[key].as_str().unwrap_or_default();
            format!("{} {} {}", word("degree"), word("cause"), word("mistake"))
        });
        Self { killed_by, told: told.collect() }
    }

    fn describe(&self) -> String {
        let Some(first) = self.killed_by.first() else { return "  SURVIVED".to_owned() };
        let others = self.killed_by.len() - 1;
        let told: String = self.told.iter().map(|told| format!("\n  told: {told}")).collect();
        format!("  killed by {first} and {others} more{told}")
    }
}

/// `FURNACE_MUTANTS=40..80`
fn range() -> Range<usize> {
    let Ok(word) = std::env::var("FURNACE_MUTANTS") else { return 0..200 };
    let (first, end) = word.split_once("..").unwrap();
    first.parse().unwrap()..end.parse().unwrap()
}

#[test]
#[ignore = "an hour: 200 mutants, each put to the whole suite without pictures"]
fn what_the_suite_sees_of_mutants() {
    let seed =
        std::env::var("FURNACE_SEED").map_or(Seed::SUITE, |word| Seed(word.parse().unwrap()));
    let sources = sources();
    let all = sources.iter().flat_map(|(file, text)| mutants_of(file, text)).collect();
    let mutants = in_random_order(all, seed);
    println!("{} mutants of examples/cpp, seed {}", mutants.len(), seed.0);
    let (tried, killed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let numbers = range().start..range().end.min(mutants.len());
    let workshop = |thread| Workshop::new(&format!("all-{thread}"), "-O2", &["!image/"]);
    let workshops: Vec<_> = (0..rayon::current_num_threads()).map(workshop).collect();
    numbers.into_par_iter().with_max_len(1).for_each(|number| {
        let workshop = &workshops[rayon::current_thread_index().unwrap_or_default()];
        let mutant = &mutants[number];
        if !workshop.compiles(&mutant.apply(&sources)) {
            return;
        }
        let found = workshop.try_out();
        tried.fetch_add(1, Relaxed);
        killed.fetch_add(usize::from(!found.killed_by.is_empty()), Relaxed);
        println!("{number} {}\n{}", mutant.describe(&sources), found.describe());
    });
    let (tried, killed) = (tried.into_inner(), killed.into_inner());
    println!("{killed} of {tried} killed");
}

/// Mistakes that one case alone is there for: a file, the case, what stands in the file, and what stands there instead.
#[rustfmt::skip]
const HANDMADE: &[[&str; 4]] = &[
    ["scene.hpp", "integrator/rays-stand-alone",
     "Rgb radiance(const Ray &ray, const furnace_integrator &settings, size_t index) const {",
     "Rgb radiance(const Ray &own, const furnace_integrator &settings, size_t index) const {
      static thread_local Ray others = own;
      Ray ray = index % 8 == 7 ? others : own;
      others = own;"],
    ["lights.hpp", "light/triangles-of-a-light-are-chosen-by-area",
     "size_t(found - area_up_to.begin())",
     "size_t(random.lobe * Real(triangles.size()))"],
    ["shapes.hpp", "shape/inward-spheres-have-inward-normals",
     "out.geometric_normal = out.shading_normal = inward ? -outward : outward;",
     "out.geometric_normal = inward ? -outward : outward;
      out.shading_normal = outward;"],
    ["scene.hpp", "light/cap-of-an-inward-sphere-emits-on-its-own-side",
     "geometry.spheres[met.index].inward ? -v.normal : v.normal",
     "v.normal"],
    ["pathtracer.cpp", "integrator/pixels-of-a-wide-film-do-not-share-noise",
     "settings.integrator->seed, index, tally.count + 1",
     "settings.integrator->seed, x + y * settings.height, tally.count + 1"],
    ["scene.hpp", "integrator/rough-conductor-in-constant-environment-shows-its-albedo",
     "if (!way.is_valid) return sum;",
     "if (!way.is_valid) continue;"],
    ["scene.hpp", "integrator/smooth-glass-reflects-by-its-shading-normals",
     "dot(v.normal, v.direction) > 0;",
     "dot(v.normal, v.direction) < 0;"],
    ["scene.hpp", "light/smooth-mesh-is-lit-by-its-shading-normals",
     "is_glass && !agree ? hit.geometric_normal : hit.shading_normal",
     "hit.geometric_normal"],
    ["scene.hpp", "light/smooth-mesh-by-hemisphere-sampling-is-lit-by-its-shading-normals",
     "return look(v.ray_to(wi)).emission",
     "return look(v.ray_along(Frame(v.normal).to_world(wi))).emission"],
    ["scene.hpp", "integrator/smooth-mirror-reflects-by-its-shading-normals",
     "ray_along(frame.to_world(wi))",
     "ray_along(Frame(normal).to_world(wi))"],
    ["scene.hpp", "light/light-samples-over-rough-conductor-are-averaged",
     "from_lobe(v, random.numbers()) / Real(samples)",
     "from_lobe(v, random.numbers())"],
    ["lights.hpp", "light/lights-over-rough-conductor-match-quadrature",
     "return 1 / (2 * PI * cone_depth(from));",
     "return 1 / (4 * PI * cone_depth(from));"],
    ["lights.hpp", "light/rough-conductor-inside-sphere-light-shows-its-albedo",
     "if (is_sphere && fills_a_cone(from))",
     "if (is_sphere)"],
    ["lights.hpp", "light/capped-sphere-light-matches-quadrature",
     "!sphere.inward && material.cap_half_angle == 0",
     "!sphere.inward"],
    ["scene.hpp", "light/far-occluder-hides-the-sun",
     "if (!std::isfinite(distance)) return ray_along(way);",
     "if (!std::isfinite(distance)) distance = 11;"],
    ["numbers.hpp", "integrator/blue-light-alone-is-no-darkness",
     "c.r == 0 && c.g == 0 && c.b == 0",
     "c.r == 0 && c.g == 0"],
    ["numbers.hpp", "integrator/red-light-alone-is-no-darkness",
     "c.r == 0 && c.g == 0 && c.b == 0",
     "c.g == 0 && c.b == 0"],
    ["numbers.hpp", "integrator/green-light-alone-is-no-darkness",
     "c.r == 0 && c.g == 0 && c.b == 0",
     "c.r == 0 && c.b == 0"],
    ["surfaces.hpp", "integrator/furnace-of-high-albedo-matches-geometric-series",
     "return {Rgb(m.reflectance) / PI, wi.z / PI};",
     "return {std::min(1.0, 0.9 / m.reflectance.r) * Rgb(m.reflectance) / PI, wi.z / PI};"],
    ["pathtracer.cpp", "adaptive/batches-draw-samples-of-their-own",
     "index, tally.count + 1);",
     "index, tally.count % (settings.adaptive ? settings.adaptive->samples_per_batch : -1));"],
    ["numbers.hpp", "adaptive/pixels-stop-as-their-samples-say",
     "Real(0.7152) * c.g",
     "Real(0.3333) * c.g"],
    ["scene.hpp", "light/occluder-close-to-a-light-hides-it",
     "whole, 1 - std::max(CLEARANCE, clearance / distance)",
     "whole, Real(0.95)"],
    ["lights.hpp", "light/sphere-light-samples-reach-the-light",
     "Real depth = u.x * cone_depth(from), distance",
     "Real depth = 1 - std::cos(std::sqrt(u.x) * std::acos(1 - cone_depth(from))), distance"],
    ["scene.hpp", "integrator/bright-light-is-not-clamped",
     "sum = sum + throughput * direct_light(v, settings, random);",
     "{ Rgb more = throughput * direct_light(v, settings, random);
       if (bounce > 0) more = {std::min(Real(2), more.r), std::min(Real(2), more.g), std::min(Real(2), more.b)};
       sum = sum + more; }"],
    ["scene.hpp", "light/samples-below-the-horizon-are-counted",
     "for (uint32_t i = 0; i < count; ++i)
            sum = sum + from_light(v, light, random.numbers(), glossy) / Real(count);",
     "Rgb lit{0, 0, 0};
      Real seen = 0;
      for (uint32_t i = 0; i < count; ++i) {
         Rgb one = from_light(v, light, random.numbers(), glossy);
         lit = lit + one;
         seen += is_black(one) ? 0 : 1;
      }
      if (seen > 0) sum = sum + lit / seen;"],
    ["shapes.hpp", "bvh/ray-box-overlap-is-right",
     "exit >= ray.t_min",
     "exit > ray.t_min"],
    ["scene.hpp", "light/emitters-cast-shadows",
     "if (bvh.any(v.ray_along(s.wi, s.distance), unused)) return {0, 0, 0};",
     "Hit met;
      bool is_met = bvh.closest(v.ray_along(s.wi, s.distance), met, unused) >= 0;
      if (is_met && !materials[material_of_shape[met.shape]].emits) return {0, 0, 0};"],
    ["scene.hpp", "light/two-lights-by-hemisphere-sampling-match-closed-form",
     "from_hemisphere(v, random.numbers()) / Real(count)",
     "from_hemisphere(v, random.numbers()) / Real(samples)"],
    ["scene.hpp", "integrator/glass-slab-under-roulette-matches-fresnel",
     "if (random.number() >= survival) return sum;
         auto way = sample_surface(*v.material, v.wo, random.numbers());",
     "Real chance = random.number();
         if (chance >= survival) return sum;
         Numbers numbers = random.numbers();
         if (plays) numbers.lobe = chance;
         auto way = sample_surface(*v.material, v.wo, numbers);"],
    ["lights.hpp", "light/gradient-environment-samples-cover-the-sphere",
     "return is_sky() ? 1 / (4 * PI) : 0;",
     "return is_sky() ? (light.kind == FURNACE_GRADIENT_SKY ? 2 : 1) / (4 * PI) : 0;"],
];

#[test]
fn each_case_kills_the_mistake_that_it_is_there_for() {
    let sources = sources();
    HANDMADE.par_iter().for_each(|&[file, case, right, wrong]| {
        let place = sources[file].find(right).unwrap_or_else(|| panic!("{file} has no `{right}`"));
        let (file, place, text) = (file.to_owned(), place..place + right.len(), wrong.to_owned());
        let mutant = Mutant { operator: "by hand", file, place, text };
        let workshop = Workshop::new(case, "-O1", &[case]);
        assert!(workshop.compiles(&mutant.apply(&sources)), "{}", mutant.describe(&sources));
        assert_eq!(workshop.try_out().killed_by, [case], "{}", mutant.describe(&sources));
    });
}
