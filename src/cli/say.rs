//! Words for whoever reads the other end of a pipe. Once nobody does, as after `| head`, they are dropped: what the
//! command does besides is done all the same.

use super::ExitCode;
use std::fmt::Arguments;
use std::io::{ErrorKind, Write};

/// As `print!`, without its panic.
macro_rules! say {
    ($($words:tt)*) => { $crate::cli::say::to(std::io::stdout(), format_args!($($words)*)) };
}
/// As `println!`, without its panic.
macro_rules! say_line {
    () => { $crate::cli::say::say!("\n") };
    ($($words:tt)*) => { $crate::cli::say::say!("{}\n", format_args!($($words)*)) };
}
pub(super) use {say, say_line};

/// Writes, or ends the process where a terminal or a disk takes no more.
pub(super) fn to(mut reader: impl Write, words: Arguments<'_>) {
    match reader.write_fmt(words) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            complain(format_args!("cannot write what there is to say: {error}"));
            std::process::exit(ExitCode::Broken.number().into());
        }
        _ => {}
    }
}

/// As `eprintln!`, without its panic: if this cannot be written there is nobody left to tell.
pub(super) fn complain(words: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{words}");
}
