//! How the user calls this program, for the commands that it tells them.

/// `cargo furnace` where Cargo has started it in its own checkout, else `furnace`.
pub(crate) fn program() -> &'static str {
    match std::env::var("CARGO_PKG_NAME") {
        Ok(package) if package == env!("CARGO_PKG_NAME") => "cargo furnace",
        _ => "furnace",
    }
}
