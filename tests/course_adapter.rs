//! Which files of a course's submission the adapter compiles: not all that lies in its folders.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;
use std::process::Command;

/// What a submission has in `src/pathtracer`: an earlier version, and a source that another includes, among it.
const SOURCES: [(&str, &str); 8] = [
    ("pathtracer.h", ""),
    ("sampler.h", ""),
    ("bsdf.h", ""),
    ("pathtracer.cpp", "#include \"pathtracer.h\"\n"),
    ("pathtracer_old.cpp", "#include \"pathtracer.h\"\n"),
    ("bsdf.cpp", "#include \"bsdf.h\"\n"),
    ("advanced-bsdf.cpp", "#include \"bsdf.h\"\n#include \"colours.cpp\"\n"),
    ("colours.cpp", "#include \"bsdf.h\"\n"),
];

/// How its own build names those that it compiles.
const OWN_BUILD: &str = "add_executable(pathtracer
    src/pathtracer/pathtracer.cpp
    # src/pathtracer/pathtracer_old.cpp
    ${PROJECT_SOURCE_DIR}/src/pathtracer/bsdf.cpp
    src/pathtracer/advanced-bsdf.cpp)\n";

/// How many files are compiled of these sources; nothing where there is no CMake.
fn compiled(own_build: Option<&str>) -> Option<u32> {
    let folder = tempfile::tempdir().unwrap();
    let submission = folder.path().join("submission");
    fs::create_dir_all(submission.join("src/pathtracer")).unwrap();
    for (name, text) in SOURCES {
        fs::write(submission.join("src/pathtracer").join(name), text).unwrap();
    }
    if let Some(text) = own_build {
        fs::write(submission.join("CMakeLists.txt"), text).unwrap();
    }
    let said = configured(&submission, &folder.path().join("build"))?;
    let (before, _) = said.split_once(" files are compiled").unwrap();
    Some(before.rsplit(' ').next().unwrap().parse().unwrap())
}

/// What CMake says of a submission.
fn configured(submission: &Path, build: &Path) -> Option<String> {
    let adapter = Path::new(env!("CARGO_MANIFEST_DIR")).join("adapters/cs184");
    let submission = format!("-DSUBMISSION={}", submission.display());
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(adapter).arg("-B").arg(build).arg(submission);
    let Ok(output) = cmake.output() else {
        println!("skipped: there is no CMake");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn a_source_that_another_includes_is_not_compiled_twice() {
    let count = compiled(None);
    assert!(count.is_none_or(|count| count == 4), "{count:?}");
}

#[test]
fn an_earlier_version_that_the_submission_does_not_build_is_left_out() {
    let count = compiled(Some(OWN_BUILD));
    assert!(count.is_none_or(|count| count == 3), "{count:?}");
}
