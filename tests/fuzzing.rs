//! Every reader of bytes that somebody else has written is given bytes that make no sense: right
//! files, cut, spliced, and with numbers that nobody expects. None panics.
//!
//! ```sh
//! cargo test --test fuzzing                                  # a few hundred files each
//! FURNACE_FUZZ_SECONDS=600 cargo test --test fuzzing ply     # ten minutes of one reader
//! cargo test --test fuzzing -- --ignored seeds               # files for the targets of `fuzz/`
//! ```

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../fuzz/readers.rs"]
mod readers;

use furnace::contract::{Acceleration, Hit, Primitive, Randomness, Ray, Sampler};
use furnace::image::{Image, exr};
use furnace::math::rng::{Seed, Stream, uniform};
use furnace::project::Project;
use furnace::scene::{Library, Overrides};
use furnace::worker::build_request;
use furnace::worker::message::{Answer, Request, Sent, encode};
use glam::{DVec2, DVec3};
use readers::READERS;
use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Files a reader in a short run.
const FEW: usize = 400;

/// A file that takes longer than this is a hang.
const PATIENCE: Duration = Duration::from_secs(60);

/// Longer files are cut: they would only be slower.
const LONGEST: usize = 64 << 10;

/// Numbers that lengths, counts and coordinates are not expected to be.
#[rustfmt::skip]
const NUMBERS: &[&str] = &[
    "0", "-1", "1e308", "1e-320", "-0.0", "nan", "inf", "4294967295", "4294967296",
    "2147483648", "18446744073709551615", "99999999999999999999", "1e9", "0.5", "",
];

macro_rules! fuzzed {
    ($($reader:ident),*) => {$(
        #[test]
        fn $reader() {
            fuzz(stringify!($reader));
        }
    )*};
}
fuzzed!(protocol, toml, collada, obj, ply, exr);

#[test]
fn a_file_that_announces_more_pixels_than_it_can_hold_is_unreadable() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.exr");
    exr::write_image(&path, &Image::new(8, 6, [0.5; 3])).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let window = b"dataWindow\0box2i\0";
    let found = bytes.windows(window.len()).position(|part| part == window).unwrap();
    // After the length and the lower corner stands the upper one.
    let corner = found + window.len() + 4 + 8;
    bytes[corner..corner + 4].copy_from_slice(&(1_i32 << 28).to_le_bytes());
    bytes[corner + 4..corner + 8].copy_from_slice(&(1_i32 << 28).to_le_bytes());
    fs::write(&path, bytes).unwrap();
    assert!(exr::read(&path).is_err());
}

/// Gives one reader strange files for a while.
fn fuzz(name: &str) {
    let (_, read) = READERS.iter().find(|(reader, _)| *reader == name).unwrap();
    let seeds = seeds(name);
    assert!(!seeds.is_empty(), "no files to begin with");
    let last = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}"));
    let begun = Instant::now();
    let mut stream = Seed(number("FURNACE_FUZZ_SEED").unwrap_or(1)).child(name).stream();
    let limit = number("FURNACE_FUZZ_SECONDS").map(Duration::from_secs);
    let mut count = 0;
    while limit.map_or(count < FEW, |limit| begun.elapsed() < limit) {
        let bytes = strange(&seeds, &mut stream);
        // Kept where it is found even if the process ends here.
        fs::write(&last, &bytes).unwrap();
        let clock = Instant::now();
        let outcome = catch_unwind(|| read(&bytes));
        assert!(outcome.is_ok(), "the reader of {name} panics, file {count}: {}", last.display());
        assert!(clock.elapsed() < PATIENCE, "{name} hangs, file {count}: {}", last.display());
        count += 1;
    }
    println!("{name}: {count} files, none panics");
}

fn number(variable: &str) -> Option<u64> {
    std::env::var(variable).ok()?.parse().ok()
}

/// A right file with a few things wrong.
fn strange(seeds: &[Vec<u8>], stream: &mut Stream) -> Vec<u8> {
    let mut bytes = seeds[below(seeds.len(), stream)].clone();
    for _ in 0..1 + below(6, stream) {
        let place = below(bytes.len() + 1, stream);
        let end = (place + 1 + below(64, stream)).min(bytes.len());
        match below(8, stream) {
            0 => flip(&mut bytes, stream),
            1 => bytes.truncate(place),
            2 => drop(bytes.drain(place..end)),
            3 => drop(bytes.splice(end..end, bytes[place..end].to_vec())),
            4 => overwrite(&mut bytes, stream),
            5 => splice(&mut bytes, &seeds[below(seeds.len(), stream)], stream),
            _ => replace_a_number(&mut bytes, stream),
        }
    }
    bytes.truncate(LONGEST);
    bytes
}

fn below(count: usize, stream: &mut Stream) -> usize {
    (uniform(stream) * count as f64) as usize
}

fn flip(bytes: &mut [u8], stream: &mut Stream) {
    let place = below(bytes.len(), stream);
    if let Some(byte) = bytes.get_mut(place) {
        *byte ^= 1 << below(8, stream);
    }
}

/// Writes a number of one to eight bytes that lies at an edge.
fn overwrite(bytes: &mut [u8], stream: &mut Stream) {
    let edges =
        [0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fff_ffff, 0xffff_ffff, i64::MAX as u64, u64::MAX];
    let number = edges[below(edges.len(), stream)].to_le_bytes();
    let size = 1 << below(4, stream);
    let place = below(bytes.len(), stream);
    for (byte, new) in bytes.iter_mut().skip(place).zip(&number[..size]) {
        *byte = *new;
    }
}

/// Goes on with another file.
fn splice(bytes: &mut Vec<u8>, other: &[u8], stream: &mut Stream) {
    bytes.truncate(below(bytes.len() + 1, stream));
    bytes.extend_from_slice(&other[below(other.len() + 1, stream)..]);
}

/// Puts another number where there is one in digits.
fn replace_a_number(bytes: &mut Vec<u8>, stream: &mut Stream) {
    let from = below(bytes.len(), stream);
    let Some(start) = bytes.iter().skip(from).position(u8::is_ascii_digit) else { return };
    let start = from + start;
    let digits = bytes[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let number = NUMBERS[below(NUMBERS.len(), stream)].bytes();
    bytes.splice(start..start + digits, number);
}

/// Right files to begin with.
fn seeds(name: &str) -> Vec<Vec<u8>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    match name {
        "protocol" => frames(),
        "toml" => {
            [files(&root.join("scenes"), "toml"), files(&root.join("cases"), "toml")].concat()
        }
        "collada" => files(&root.join("tests/fixtures/collada"), "dae"),
        "obj" => files(&root.join("scenes"), "obj"),
        "ply" => [files(&root.join("scenes"), "ply"), vec![binary_ply()]].concat(),
        "exr" => pictures(),
        other => panic!("nobody knows `{other}`"),
    }
}

fn files(folder: &Path, extension: &str) -> Vec<Vec<u8>> {
    let entries = walkdir::WalkDir::new(folder).sort_by_file_name().into_iter();
    let paths = entries.map(|entry| entry.unwrap().into_path());
    let is_it = |path: &PathBuf| path.extension().is_some_and(|found| found == extension);
    let texts = paths.filter(is_it).map(|path| fs::read(path).unwrap());
    texts.filter(|bytes| bytes.len() <= LONGEST).collect()
}

/// Requests and answers as they are.
fn frames() -> Vec<Vec<u8>> {
    let mut frames = Vec::new();
    let mut push = |request: Request<'_>| {
        let mut buffer = Vec::new();
        encode(&mut buffer, 1, request.members(), request.arrays(), None).unwrap();
        frames.push(buffer);
    };
    let rays = [Ray::new(DVec3::ZERO, DVec3::Z); 2];
    let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    push(Request::new("hello"));
    let triangle = Primitive::Triangle { positions: corners, normals: corners };
    let sphere = Primitive::Sphere { centre: DVec3::ZERO, radius: 1.0 };
    for primitive in [triangle, sphere] {
        let request = Request::new("intersect_primitive").with_argument("primitive", &primitive);
        push(request.with_argument("rays", rays.as_slice()));
    }
    push(Request::new("intersect").with_argument("rays", rays.as_slice()));
    let (points, lobes) = ([DVec2::ZERO; 3], [0.5; 3]);
    let random = Randomness { points: &points, lobes: &lobes, seed: 7 };
    let sampler = Sampler::CosineHemisphere;
    let request = Request::new("sample_direction").with_argument("sampler", sampler);
    push(request.with_argument("random", random));
    let scenes = Library::new(Project::at(env!("CARGO_MANIFEST_DIR")).scenes());
    for scene in ["cornell-diffuse-spheres", "gradient-sky", "rough-conductor-in-sky"] {
        let scene = scenes.load(scene, &Overrides::new()).unwrap();
        push(build_request(&scene, Acceleration::DEFAULT));
    }
    let mut answer = Vec::new();
    encode(&mut answer, 1, Answer::Done, &[Sent::new("hits", &[Hit::MISS; 2])], None).unwrap();
    frames.push(answer);
    frames
}

/// A square in bytes.
fn binary_ply() -> Vec<u8> {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n\
                  property float y\nproperty float z\nelement face 1\n\
                  property list uchar int vertex_indices\nend_header\n";
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend(corners.iter().flatten().flat_map(|number| number.to_le_bytes()));
    bytes.push(4);
    bytes.extend([0_i32, 1, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// A picture as we write it, and the small ones among the references.
fn pictures() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("seed.exr");
    exr::write_image(&path, &Image::new(8, 6, [0.5; 3])).unwrap();
    let mut pictures = vec![fs::read(path).unwrap()];
    pictures.extend(files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("references"), "exr"));
    pictures
}

#[test]
#[ignore = "writes files: `cargo test --test fuzzing -- --ignored seeds`"]
fn seeds_are_written_for_the_targets() {
    for (name, _) in READERS {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(name);
        fs::create_dir_all(&folder).unwrap();
        for (number, bytes) in seeds(name).iter().enumerate() {
            fs::write(folder.join(format!("seed-{number}")), bytes).unwrap();
        }
    }
}
