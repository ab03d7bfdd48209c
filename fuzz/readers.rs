//! Every reader of bytes that somebody else has written. Each takes any bytes at all and may answer
//! an error; none may panic, hang, or take memory that the bytes do not pay for.
//!
//! Shared by the targets of libFuzzer (`fuzz/fuzz_targets`) and by `tests/fuzzing.rs`.

use furnace::case;
use furnace::contract::{Core, CoreInfo, Hit, Ray};
use furnace::image::exr;
use furnace::scene::format::collada;
use furnace::scene::mesh::{self, Format};
use furnace::scene::{self, Overrides};
use furnace::worker::message::{Request, Wanted};
use furnace::worker::{Channel, Client, serve};
use std::cell::OnceCell;
use std::fs;
use std::io::{Cursor, sink};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A reader by its name.
pub type Reader = (&'static str, fn(&[u8]));

/// Every reader.
pub static READERS: &[Reader] = &[
    ("protocol", protocol),
    ("toml", toml),
    ("collada", collada),
    ("obj", obj),
    ("ply", ply),
    ("exr", exr),
];

/// As requests to a core, and as the answer of one.
pub fn protocol(bytes: &[u8]) {
    let channel =
        || Channel { input: Box::new(Cursor::new(bytes.to_vec())), output: Box::new(sink()) };
    let _ = serve(&mut Nobody, channel());
    let mut hits = [Hit::MISS; 2];
    let _ = Client::new(channel())
        .ask(&Request::new("intersect"), &mut [Wanted::new("hits", &mut hits)]);
    let mut rays = [Ray::new(glam::DVec3::ZERO, glam::DVec3::Z)];
    let _ = Client::new(channel()).hear(&mut [Wanted::new("rays", &mut rays)]);
}

/// As a scene, and as a case.
pub fn toml(bytes: &[u8]) {
    with_file("cases/any/file.toml", bytes, |path| {
        let _ = scene::load_file(path, &Overrides::new());
        if let Some(folder) = path.parent().and_then(Path::parent) {
            let _ = case::load_one(folder, "any/file");
        }
    });
}

/// As a scene of the course.
pub fn collada(bytes: &[u8]) {
    with_file("file.dae", bytes, |path| drop(collada::load(path, [32, 24])));
}

/// As a mesh.
pub fn obj(bytes: &[u8]) {
    with_file("file.obj", bytes, |path| drop(mesh::load(path, Format::Obj)));
}

/// As a mesh.
pub fn ply(bytes: &[u8]) {
    with_file("file.ply", bytes, |path| drop(mesh::load(path, Format::Ply)));
}

/// As a picture.
pub fn exr(bytes: &[u8]) {
    with_file("file.exr", bytes, |path| drop(exr::read_image(path)));
}

/// Hands `read` the path of a file with these bytes.
fn with_file(name: &str, bytes: &[u8], read: impl FnOnce(&Path)) {
    thread_local! { static FOLDER: OnceCell<TempDir> = const { OnceCell::new() } }
    FOLDER.with(|folder| {
        let folder =
            folder.get_or_init(|| tempfile::tempdir().expect("there is a place for files"));
        let path: PathBuf = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("it lies in a folder")).expect("it can be made");
        fs::write(&path, bytes).expect("it can be written");
        read(&path);
    });
}

/// A core that can do nothing: what is asked of it is read all the same.
struct Nobody;

impl Core for Nobody {
    fn info(&self) -> CoreInfo {
        CoreInfo::default()
    }
}
