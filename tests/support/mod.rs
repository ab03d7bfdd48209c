//! What tests of foreign cores share: compiling them.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the project.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// `$CXX` or `c++`.
///
/// # Panics
/// Where there is none: a test that could not be made has not passed.
pub fn cpp_compiler() -> PathBuf {
    compiler("CXX", "c++", "C++")
}

/// What a variable of the environment names, or the usual one.
///
/// # Panics
/// Where there is none.
pub fn compiler(variable: &str, usual: &str, language: &str) -> PathBuf {
    let program = std::env::var(variable).unwrap_or_else(|_| usual.to_owned());
    let version = Command::new(&program).arg("--version").output();
    let is_there = version.is_ok_and(|output| output.status.success());
    assert!(
        is_there,
        "there is no {language} compiler `{program}`: install one or name it in ${variable}"
    );
    program.into()
}

/// Runs a compiler on our headers.
///
/// # Panics
/// With the compiler's words, if it refuses.
pub fn compile(compiler: &Path, arguments: &[&str]) {
    let output = Command::new(compiler)
        .arg(format!("-I{}", root().join("include").display()))
        .args(arguments)
        .output()
        .unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {complaint}", arguments.join(" "));
}

/// Compiles a C++ core into a shared library, with these flags besides the usual ones.
pub fn compile_core(compiler: &Path, flags: &[&str], source: &Path, library: &Path) {
    let (source, library) = (source.to_string_lossy(), library.to_string_lossy());
    let language = ["-std=c++17", "-O2", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror"];
    compile(compiler, &[&language[..], flags, &[&source, "-o", &library]].concat());
}
