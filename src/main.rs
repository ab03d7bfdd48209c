//! The `furnace` command. Everything it does is in the library's `cli`; what it needs beside it, it carries.
//!
//! The files are carried by the program and not by the library: a changed case links this file anew, and
//! compiles nothing else. A program of the dev profile reads them where it was built.

use rust_embed::RustEmbed;
use std::borrow::Cow;

/// Declares the folders that are carried, and how to go through their files.
macro_rules! carried {
    ($($name:ident $folder:literal: $($pattern:literal)*;)*) => {
        $(
            #[derive(RustEmbed)]
            #[folder = $folder]
            $(#[include = $pattern])*
            #[exclude = "*__pycache__*"]
            struct $name;
        )*

        fn carried() -> Box<dyn Iterator<Item = (String, Cow<'static, [u8]>)>> {
            let files = std::iter::empty();
            $(
                let files = files.chain($name::iter().filter_map(|path| {
                    Some((format!("{}/{path}", $folder), $name::get(&path)?.data))
                }));
            )*
            Box::new(files)
        }
    };
}

carried! {
    Cases "cases":;
    Scenes "scenes":;
    // Not the sums and the Python environment of who makes references.
    References "references": "*.toml" "*.txt" "*/reference.exr" "*/provenance.toml";
    Header "include":;
    Adapters "adapters":;
    // Not the crate that has this one as its dependency.
    Examples "examples": "cpp/*" "python/*" "rust/*";
    Suites "suites":;
}

fn main() -> std::process::ExitCode {
    furnace::cli::main(carried).into()
}
