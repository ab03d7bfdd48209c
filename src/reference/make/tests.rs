//! Nothing is replaced or counted twice, and parts make the whole.

use super::*;
use crate::scene::Library;
use tempfile::TempDir;

const RECIPE: &str = "bounces = 1\npasses = 16\nsamples-per-pass = 4\n";

/// A folder with a scene and a recipe for each film, and no Mitsuba.
fn workshop(film: &str) -> (TempDir, References) {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    std::fs::create_dir(&scenes).unwrap();
    let scene = format!(
        "title = \"t\"\nsource = \"s\"\n[camera]\nposition = [0, 0, 1]\nlook-at = [0, 0, 0]\n\
         horizontal-fov = \"40 deg\"\nfilm = {film}\n"
    );
    std::fs::write(scenes.join("void.toml"), scene).unwrap();
    std::fs::write(folder.path().join("recipes.toml"), format!("[void]\n{RECIPE}")).unwrap();
    std::fs::write(folder.path().join("requirements.txt"), "mitsuba==3.9.1\n").unwrap();
    let references = References::new(folder.path(), Library::new(scenes));
    (folder, references)
}

fn refusal(references: &References, options: &MakeOptions) -> String {
    references.make("void", options, &mut |_| ()).unwrap_err().to_string()
}

#[test]
fn what_exists_is_not_replaced_unasked() {
    let (folder, references) = workshop("[64, 32]");
    std::fs::create_dir(folder.path().join("void")).unwrap();
    std::fs::write(provenance_path(folder.path(), "void"), "precious").unwrap();
    let message = refusal(&references, &MakeOptions::default());
    assert!(
        message.contains("exists already\nhint: `--extend` adds passes, `--replace`"),
        "{message}"
    );
    let kept = std::fs::read_to_string(provenance_path(folder.path(), "void")).unwrap();
    assert_eq!(kept, "precious");
}

#[test]
fn films_that_make_seeds_overlap_are_refused() {
    let (_folder, references) = workshop("[100, 76]");
    let message = refusal(&references, &MakeOptions::default());
    assert!(message.contains("multiples of 32"), "{message}");
}

#[test]
fn options_are_held_to_what_recipes_are_held_to() {
    let (_folder, references) = workshop("[64, 32]");
    let few = MakeOptions { passes: Some(2), ..MakeOptions::default() };
    assert!(refusal(&references, &few).contains("at least 16 passes"));
    let long = MakeOptions { samples_per_pass: Some(1000), ..MakeOptions::default() };
    assert!(refusal(&references, &long).contains("1 to 256 samples"));
}

#[test]
fn without_mitsuba_the_scene_is_ready_and_the_way_to_get_it_is_named() {
    let (folder, references) = workshop("[64, 32]");
    let message = refusal(&references, &MakeOptions::default());
    assert!(message.contains("`--create-venv` installs mitsuba==3.9.1"), "{message}");
    let work = std::fs::read_dir(folder.path().join(".work")).unwrap().next().unwrap().unwrap();
    assert!(work.path().join("scene.xml").is_file());
}

/// Passes as Mitsuba would leave them, even seeds dark and odd ones bright.
fn leave_passes(folder: &Path, seeds: Range<u32>) {
    for seed in seeds {
        let value = if seed.is_multiple_of(2) { 0.5f32 } else { 1.5 };
        let bytes = vec![value.to_le_bytes(); 64 * 32 * 3].concat();
        std::fs::write(folder.join(format!("pass-{seed}.f32")), bytes).unwrap();
    }
}

fn shard(references: &References, seeds: Range<u32>) -> (Plan, Shard) {
    let recipe = recipe::read(&references.folder, "void").unwrap();
    let plan = references.plan("void", recipe, "make").unwrap();
    leave_passes(&plan.job.folder, seeds.clone());
    let variant = super::super::mitsuba::Variant { name: "none".to_owned(), llvm: None };
    let mitsuba = Mitsuba { python: "python".into(), variant, version: "3.9.1".to_owned() };
    let seeds: Vec<u32> = seeds.collect();
    let shard = plan.shard(&seeds, &mitsuba, &Spent::default()).unwrap();
    (plan, shard)
}

fn merging(references: &References, seeds: Range<u32>) -> MakeOptions {
    let path = references.sums_path(&format!("part-{}", seeds.start));
    shard(references, seeds).1.write(&path).unwrap();
    MakeOptions { merge: vec![path], ..MakeOptions::default() }
}

fn picture(references: &References) -> Vec<u8> {
    std::fs::read(crate::scene::reference::picture_path(&references.folder, "void")).unwrap()
}

#[test]
fn passes_become_a_reference_that_loads_and_says_where_it_comes_from() {
    let (_folder, references) = workshop("[64, 32]");
    let (plan, shard) = shard(&references, 0..16);
    let reference = references.store(&plan, &shard, "by hand".to_owned()).unwrap();
    assert_eq!(reference.mean.pixels[0], [1.0; 3]);
    // Squared deviations of a quarter, over 15, over 16 passes.
    let expected = (0.25f32 / 15.0).sqrt();
    let found = reference.standard_error.pixels[0][0];
    assert!((found - expected).abs() < expected / 64.0, "{found}");
    assert_eq!(reference.provenance.seeds, [[0, 15]]);
    assert_eq!(reference.provenance.command, "by hand");
    let path = crate::scene::reference::picture_path(&references.folder, "void");
    let file = crate::image::exr::read(&path).unwrap();
    assert_eq!(file.attributes["furnace"], reference.provenance.header());
}

#[test]
fn parts_merge_to_the_bytes_of_the_whole_and_a_seed_counts_once() {
    let (_folder, references) = workshop("[64, 32]");
    let (plan, whole) = shard(&references, 0..48);
    references.store(&plan, &whole, String::new()).unwrap();
    let whole = picture(&references);
    let first = MakeOptions { replace: true, ..merging(&references, 16..48) };
    references.make("void", &first, &mut |_| ()).unwrap();
    assert_ne!(picture(&references), whole);
    let Made::Reference(made) =
        references.make("void", &merging(&references, 0..16), &mut |_| ()).unwrap()
    else {
        panic!("a reference")
    };
    assert_eq!(picture(&references), whole);
    assert_eq!(made.provenance.passes, 48);
    let again = refusal(&references, &merging(&references, 40..56));
    assert!(again.contains("duplicate seed 40"), "{again}");
    let other = MakeOptions { samples_per_pass: Some(8), ..merging(&references, 48..64) };
    assert!(refusal(&references, &other).contains("not of `void` as the recipe says"));
    assert_eq!(picture(&references), whole);
}

#[test]
fn a_merge_keeps_the_layers() {
    let (_folder, references) = workshop("[64, 32]");
    let (plan, shard) = shard(&references, 0..16);
    let mut reference = references.store(&plan, &shard, String::new()).unwrap();
    reference.layers.bounces = vec![Image::new(64, 32, [0.25; 3]); 2];
    references.write(&mut reference).unwrap();
    references.make("void", &merging(&references, 16..32), &mut |_| ()).unwrap();
    let merged = load(&references.folder, "void", &plan.scene).unwrap();
    assert_eq!((merged.provenance.passes, &merged.layers), (32, &reference.layers));
}

#[test]
fn what_cannot_be_extended_says_why() {
    let (_folder, references) = workshop("[64, 32]");
    let extend = MakeOptions { extend: true, ..MakeOptions::default() };
    let message = refusal(&references, &extend);
    assert!(message.contains("the sums of the passes of `void` are not in"), "{message}");
    let (plan, shard) = shard(&references, 0..16);
    references.store(&plan, &shard, String::new()).unwrap();
    let message = refusal(&references, &extend);
    assert!(message.contains("has all of its 16 passes"), "{message}");
    // More are asked for, and there is no Mitsuba to render them with.
    let more = MakeOptions { samples: Some(100), ..extend };
    assert!(refusal(&references, &more).contains("--create-venv"));
}

#[test]
fn a_pass_with_light_that_cannot_be_is_named() {
    let (_folder, references) = workshop("[64, 32]");
    let (plan, _) = shard(&references, 0..7);
    let bytes = vec![f32::NAN.to_le_bytes(); 64 * 32 * 3].concat();
    std::fs::write(plan.job.folder.join("pass-7.f32"), bytes).unwrap();
    let message = plan.pass(7).unwrap_err().to_string();
    assert!(message.contains("pass 7 of `void`"), "{message}");
    let message = plan.pass(8).unwrap_err().to_string();
    assert!(message.contains("pass 8 is missing"), "{message}");
}
