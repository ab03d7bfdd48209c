//! The `furnace` command. Everything it does is in the library's `cli`.

fn main() -> std::process::ExitCode {
    furnace::cli::main().into()
}
