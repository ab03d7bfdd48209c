//! What people read uses the field's words, and each of the field's words leads to the room where a rendering
//! engineer expects it.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Words to avoid, and what the field says.
const AVOID: &[(&str, &str)] = &[
    ("lamp", "light, emitter or area light"),
    ("lamps", "lights, emitters or area lights"),
    ("glow", "emission"),
    ("glows", "emits"),
    ("glowing", "emissive"),
    ("gather", "light sampling or hemisphere sampling"),
    ("gathers", "light sampling or hemisphere sampling"),
    ("gathered", "light sampling or hemisphere sampling"),
    ("by the hemisphere", "hemisphere sampling"),
    ("even sky", "constant environment light"),
    ("the eye", "the camera, or wo"),
    ("facet", "microfacet, or normal distribution function"),
    ("facets", "microfacets, or normal distribution function"),
    ("thin side", "side of lower index of refraction"),
    ("index beyond", "eta_t"),
    ("index here", "eta_i"),
    ("Fresnel's share", "Fresnel reflectance"),
    ("let through", "transmitted"),
    ("lets through", "transmits"),
    ("chance to survive", "survival probability"),
    ("probability of going on", "survival probability"),
    ("the chance", "the probability"),
    ("other chance", "selection probability that does not match the pdf"),
    ("density", "pdf"),
    ("densities", "pdfs"),
    ("strangers", "independent"),
    ("hierarchy", "BVH"),
    ("hierarchies", "BVHs"),
    ("ball", "sphere"),
    ("balls", "spheres"),
    ("is no number", "is not a number, or NaN"),
    ("no numbers", "not numbers, or NaN"),
    ("comes up", "starts"),
    ("come up", "start"),
    ("shut in", "sandboxed"),
    ("shuts in", "sandboxes"),
    ("says no", "refuses"),
    ("heard out", "read to the end"),
    ("suspected by", "needed a second look"),
    ("remember", "background"),
    ("wager", "test"),
];

/// Where such a word is the field's own after all; the last one seeds random numbers.
const EXCEPT: &[&str] = &["bounding volume hierarchy", "probability density", "form of a density"];

/// Of those, the ones that no name and no comment of the code may have either.
#[rustfmt::skip]
const NOT_IN_CODE: &[&str] = &[
    "lamp", "lamps", "glow", "glows", "glowing", "gather", "gathers", "gathered", "ball", "balls", "density",
    "densities", "hierarchy", "strangers",
];

/// A term of the field, and the file or folder whose text has it.
const TERMS: &[(&str, &str)] = &[
    ("next event estimation", "src/cause/light.rs"),
    ("next event estimation", "cases/light"),
    ("next event estimation", "include/furnace_core.h"),
    ("hemisphere sampling", "src/cause/light.rs"),
    ("next event estimation", "src/cores/builtin/direct.rs"),
    ("hemisphere sampling", "src/cores/builtin/direct.rs"),
    ("multiple importance sampling", "src/cores/builtin/mis.rs"),
    ("power heuristic", "src/cores/builtin/mis.rs"),
    ("shadow ray", "src/cause/light.rs"),
    ("shadow acne", "src/cause/light.rs"),
    ("self-intersection", "src/cause/light.rs"),
    ("self-shadowing", "src/cause/light.rs"),
    ("solid angle", "src/cause/light.rs"),
    ("delta light", "src/cause/light.rs"),
    ("Russian roulette", "src/cause/integrator.rs"),
    ("survival probability", "src/cause/integrator.rs"),
    ("throughput", "src/cause/integrator.rs"),
    ("radiosity", "cases/integrator"),
    ("furnace", "cases/integrator"),
    ("form factor", "cases/light"),
    ("form factor", "src/math/closed_form/form_factor.rs"),
    ("normal distribution function", "src/cause/bsdf.rs"),
    ("normal distribution function", "src/cores/builtin/scatter/microfacets.rs"),
    ("masking-shadowing", "src/cause/bsdf.rs"),
    ("Fresnel reflectance", "src/cause/bsdf.rs"),
    ("total internal reflection", "src/cause/bsdf.rs"),
    ("relative index of refraction", "src/cause/bsdf.rs"),
    ("lobe selection probability", "src/cause/bsdf.rs"),
    ("delta distribution", "src/cause/bsdf.rs"),
    ("reciprocity", "cases/bsdf"),
    ("Jacobian", "cases/sampling"),
    ("pdf", "src/cause/sampling.rs"),
    ("cosine-weighted", "src/cause/sampling.rs"),
    ("slab test", "src/cause/bvh.rs"),
    ("slab test", "src/cores/builtin/slab.rs"),
    ("splitting axis", "src/cause/bvh.rs"),
    ("traversal", "src/cause/bvh.rs"),
    ("surface area heuristic", "src/cores/builtin/trace/surface_area.rs"),
    ("barycentric coordinates", "src/cause/shape.rs"),
    ("Möller and Trumbore", "src/cause/shape.rs"),
    ("catastrophic cancellation", "src/cause/shape.rs"),
    ("watertight", "src/cause/shape.rs"),
    ("stratified", "src/cause/camera.rs"),
    ("field of view", "src/cause/camera.rs"),
    ("confidence interval", "src/cause/adaptive.rs"),
    ("sRGB transfer function", "src/cause/image.rs"),
    ("fireflies", "src/cause/image.rs"),
    ("next event estimation", "src/cores/textbook/direct.rs"),
    ("shadow acne", "src/checks/light/no_self_shadowing.rs"),
    ("self-intersection", "src/checks/shape/leaves_its_surface.rs"),
    ("Russian roulette", "src/checks/integrator/roulette_law.rs"),
    ("throughput", "src/cores/textbook/integrator.rs"),
    ("radiosity", "src/math/closed_form/cavity.rs"),
    ("reciprocity", "src/checks/bsdf/reciprocal.rs"),
    ("Fresnel", "src/cores/textbook/glass.rs"),
    ("Snell", "src/cores/textbook/glass.rs"),
    ("stratified sampling", "src/checks/camera/stratified_samples.rs"),
    ("cosine-weighted hemisphere", "src/cores/textbook/sampling.rs"),
    ("cosine-weighted hemisphere", "src/cores/builtin/scatter/warp.rs"),
    ("solid angle", "src/checks/light/light_samples_reach_light.rs"),
    ("irradiance", "src/scene/light.rs"),
    ("white furnace", "src/math/closed_form/cavity.rs"),
    ("white furnace", "src/checks/bsdf/conserves_energy.rs"),
    ("albedo", "src/checks/bsdf/conserves_energy.rs"),
    ("BRDF", "src/checks/bsdf/rough_glass.rs"),
    ("BTDF", "src/checks/bsdf/rough_glass.rs"),
    ("BSDF", "src/cores/textbook/bsdf.rs"),
    ("GGX", "src/cores/textbook/ggx.rs"),
    ("masking-shadowing", "src/cores/textbook/ggx.rs"),
    ("visible normals", "src/cores/textbook/ggx.rs"),
    ("SAH", "src/cores/builtin/trace/surface_area.rs"),
    ("slab test", "src/cores/textbook/slab.rs"),
    ("Möller-Trumbore", "src/cores/textbook/intersect.rs"),
    ("thin lens", "src/scene/camera.rs"),
    ("tone mapping", "src/image/tonemap.rs"),
    ("caustic", "cases/image"),
    ("indirect lighting", "src/checks/integrator/mod.rs"),
    ("global illumination", "src/checks/integrator/mod.rs"),
    ("global illumination", "src/cores/textbook/integrator.rs"),
    ("chi-square", "src/stats/test/counts.rs"),
    ("variance reduction", "src/checks/integrator/variance_is_known.rs"),
    ("unbiased estimator", "src/checks/integrator/estimators_agree.rs"),
    ("firefly", "src/image/pixel_error.rs"),
    ("environment map", "src/scene/light.rs"),
    ("area light", "src/scene/light.rs"),
    ("microfacet", "src/math/closed_form/microfacet.rs"),
];

/// What the glossary of the README explains or names.
#[rustfmt::skip]
const GLOSSARY: &[&str] = &[
    "next event estimation", "multiple importance sampling", "power heuristic", "normal distribution function",
    "masking-shadowing", "visible normals", "GGX", "shadow acne", "self-intersection", "Russian roulette",
    "throughput", "radiosity", "reciprocity", "Fresnel", "Snell", "stratified sampling", "solid angle",
    "irradiance", "white furnace", "albedo", "BRDF", "BTDF", "SAH", "slab test", "Möller-Trumbore", "caustic",
    "indirect lighting", "global illumination", "firefly", "environment light", "area light",
];

/// Files at and below `path`, of the checkout.
fn files_below(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_owned()];
    }
    let entries = fs::read_dir(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.iter().flat_map(|path| files_below(path)).collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Path below the checkout, with forward slashes.
fn label(path: &Path) -> String {
    path.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/")
}

/// Everything that people read, as `place, text`.
fn readings() -> Vec<(String, String)> {
    let tops = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs", "cases"];
    let more = ["scenes", "include", "examples", "adapters", "src"];
    let paths = tops.iter().chain(&more).flat_map(|top| files_below(&root().join(top)));
    paths.flat_map(|path| read(&path)).collect()
}

/// What people read of one file.
fn read(path: &Path) -> Vec<(String, String)> {
    let name = label(path);
    let Some(extension) = path.extension().and_then(|extension| extension.to_str()) else {
        return Vec::new();
    };
    let is_unread = ["simulations/", "/tests/", "tests.rs"].iter().any(|part| name.contains(part));
    if is_unread || !is_text(extension) {
        return Vec::new();
    }
    let text = fs::read_to_string(path).unwrap();
    let lines = || text.lines().enumerate();
    let at = |line: usize| format!("{name}:{}", line + 1);
    match extension {
        "rs" => strings(&text, name.starts_with("src/cli/"))
            .into_iter()
            .map(|(line, text)| (at(line), text))
            .collect(),
        "toml" => lines().filter_map(|(i, line)| Some((at(i), sentence(line)?))).collect(),
        "md" => lines().map(|(i, line)| (at(i), prose(line))).collect(),
        _ if name.starts_with("adapters/") => Vec::new(),
        _ => lines().map(|(i, line)| (at(i), line.to_owned())).collect(),
    }
}

fn is_text(extension: &str) -> bool {
    ["rs", "toml", "md", "h", "hpp", "cpp", "py"].contains(&extension)
}

/// What a line of a case or scene says to people: a sentence or a comment. Names are names.
fn sentence(line: &str) -> Option<String> {
    let keys = ["title", "teaches", "source", "about"];
    let (key, value) = line.split_once('=').unwrap_or(("", ""));
    if keys.contains(&key.trim()) {
        return Some(value.to_owned());
    }
    line.split_once('#').map(|(_, comment)| comment.to_owned())
}

/// A line of Markdown without code, and of the glossary without the words that it tells to avoid.
fn prose(line: &str) -> String {
    let line = match line.strip_suffix('|') {
        Some(row) if row.starts_with("| **") => row.rsplit_once('|').map_or(row, |(kept, _)| kept),
        _ => line,
    };
    let is_data = line.starts_with(['{', ' ']) && line.contains('"');
    let spoken: Vec<_> = line.split('`').step_by(2).collect();
    if is_data { String::new() } else { spoken.join(" ") }
}

/// The strings of a source before its tests, with their lines; and its doc comments, where they are help texts.
fn strings(text: &str, has_help: bool) -> Vec<(usize, String)> {
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    let mut found = Vec::new();
    let (mut open, mut is_escaped) = (None::<(usize, String)>, false);
    for (number, line) in text.lines().enumerate() {
        let comment = line.trim_start();
        if open.is_none() && comment.starts_with("//") {
            let is_help = has_help && comment.starts_with("///");
            found.extend(is_help.then(|| (number, comment.to_owned())));
            continue;
        }
        let mut before = ' ';
        for character in line.chars() {
            let is_quote = character == '"' && !is_escaped && before != '\'';
            is_escaped = open.is_some() && character == '\\' && !is_escaped;
            match open.as_mut() {
                Some(_) if is_quote => found.extend(open.take()),
                Some((_, string)) => string.push(character),
                None if is_quote => open = Some((number, String::new())),
                None => {}
            }
            before = character;
        }
        is_escaped = false;
        open.iter_mut().for_each(|(_, string)| string.push(' '));
    }
    found.retain(|(_, string)| string.contains(' '));
    found
}

/// Whether a text has a word, as a whole word.
fn has(text: &str, word: &str) -> bool {
    let (text, word) = (text.to_lowercase(), word.to_lowercase());
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    text.match_indices(&word).any(|(start, _)| {
        let before = text[..start].chars().next_back();
        let after = text[start + word.len()..].trim_start_matches('.').chars().next();
        !before.is_some_and(is_part) && !after.is_some_and(is_part)
    })
}

#[test]
fn what_people_read_is_in_the_words_of_the_field() {
    let readings = readings();
    assert!(readings.len() > 5_000, "only {} texts are read", readings.len());
    let mut complaints = String::new();
    for (place, text) in readings {
        let text = EXCEPT.iter().fold(text.to_lowercase(), |text, term| text.replace(term, ""));
        for (word, instead) in AVOID.iter().filter(|(word, _)| has(&text, word)) {
            let _ = writeln!(complaints, "{place}: `{word}`; the field says: {instead}");
        }
    }
    assert!(complaints.is_empty(), "\n{complaints}");
}

#[test]
fn names_and_comments_are_in_the_words_of_the_field() {
    let paths =
        ["src", "tests", "benches", "fuzz/fuzz_targets"].map(|top| files_below(&root().join(top)));
    let sources =
        paths.iter().flatten().filter(|path| path.extension().is_some_and(|end| end == "rs"));
    let mut complaints = String::new();
    for path in sources.filter(|path| !path.ends_with("tests/words.rs")) {
        for (number, line) in fs::read_to_string(path).unwrap().lines().enumerate() {
            let code = EXCEPT.iter().fold(code(line), |code, term| code.replace(term, ""));
            let is_said = |word: &&&str| parts(&code).any(|part| part == **word);
            for word in NOT_IN_CODE.iter().filter(is_said) {
                let _ = writeln!(complaints, "{}:{}: `{word}`", label(path), number + 1);
            }
        }
    }
    assert!(complaints.is_empty(), "\n{complaints}");
}

/// A line of a source without its strings, and with its names in small letters parted by `_`.
fn code(line: &str) -> String {
    let mut before = ' ';
    let mut spaced = String::new();
    for character in line.replace("\\\"", "").split('"').step_by(2).flat_map(str::chars) {
        if character.is_uppercase() && before.is_lowercase() {
            spaced.push('_');
        }
        spaced.push(character);
        before = character;
    }
    spaced.to_lowercase()
}

fn parts(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !c.is_alphabetic())
}

#[test]
fn the_words_of_the_field_lead_to_the_right_room() {
    let is_missing = |(term, room): &&(&str, &str)| {
        let said = |path: &PathBuf| fs::read_to_string(path).is_ok_and(|text| says(&text, term));
        !files_below(&root().join(room)).iter().any(said)
    };
    let glossary = GLOSSARY.iter().map(|term| (*term, "README.md"));
    let terms: Vec<_> = TERMS.iter().copied().chain(glossary).collect();
    let missing: Vec<_> = terms.iter().filter(is_missing).collect();
    assert!(missing.is_empty(), "terms that their rooms do not say: {missing:?}");
}

/// Whether a text has a term, though a line ends within it.
fn says(text: &str, term: &str) -> bool {
    let words: Vec<_> = text.split(|c: char| c.is_whitespace() || c == '/').collect();
    let flat: Vec<_> = words.into_iter().filter(|word| !word.is_empty()).collect();
    flat.join(" ").to_lowercase().contains(&term.to_lowercase())
}

#[test]
fn the_test_finds_what_it_looks_for() {
    assert!(has("Two lamps.", "lamps") && !has("a clamp", "lamp") && !has("ball.hpp", "ball"));
    assert!(
        parts(&code("fn aim(at: &BallLight) // \"lamp\""))
            .eq(["fn", "aim", "at", "", "", "ball", "light", "", "", "", "", ""])
    );
    let source = "let a = \"a \\\" lamp\"; // \"not this\"\n/// nor this\nlet b = '\"'; f(\"and a\n  ball\")";
    let found: Vec<_> = strings(source, false).into_iter().map(|(_, text)| text).collect();
    assert_eq!(found[0], "a \\\" lamp");
    assert_eq!(found.last().unwrap(), "and a   ball");
    assert_eq!(prose("| **light** | a source | lamp |"), "| **light** | a source ");
    assert_eq!(sentence("title = \"A lamp\"").as_deref(), Some(" \"A lamp\""));
    assert_eq!(sentence("name = \"lamp\""), None);
    assert!(says("normal\n/// distribution function", "normal distribution function"));
}
