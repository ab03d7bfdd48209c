//! Where the runs of `cargo test` go, and what repeats one of its cases.

use std::path::{Path, PathBuf};

/// What Cargo marks its folder with.
const MARK: &str = "CACHEDIR.TAG";

/// `furnace` in the folder where Cargo builds this program.
pub(super) fn runs() -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    let built = program.ancestors().find(|folder| folder.join(MARK).is_file());
    built.unwrap_or(Path::new("target")).join("furnace")
}

/// `cargo test --test furnace -- --exact`, by the name of this program: `furnace-0123456789abcdef`.
pub(super) fn command() -> String {
    let program = std::env::current_exe().unwrap_or_default();
    let name = program.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = name.rsplit_once('-').map_or(name.as_str(), |(name, _)| name);
    format!("cargo test --test {name} -- --exact")
}
