//! The `furnace` command.
fn main() {}
