//! What a compiler warned of in what was handed in.
//!
//! A function that ends without `return`, a variable that nobody has set or that hides another: what such code does is up
//! to the compiler, and no case can tell more than that something differs. The compiler knows the line.

use regex_lite::{Captures, Regex};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use std::sync::LazyLock;

/// Those that are shown of a submission.
const MOST: usize = 12;

/// A compiler's warning of a line that was handed in.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Warning {
    /// Path below the submission, with `/`.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// In the compiler's words.
    pub message: String,
    /// The function that it is in; empty where the compiler does not say.
    pub function: String,
}

impl fmt::Display for Warning {
    /// `src/scene/bbox.cpp:53: control reaches end of non-void function, in CGL::BBox::intersect`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, message, function } = self;
        write!(f, "{file}:{line}: {message}")?;
        if function.is_empty() { Ok(()) } else { write!(f, ", in {function}") }
    }
}

/// The first of them, a line each, and how many more there are.
pub(super) fn shown(warnings: &[Warning]) -> Vec<String> {
    let mut lines: Vec<_> = warnings.iter().take(MOST).map(ToString::to_string).collect();
    if warnings.len() > MOST {
        lines.push(format!("… and {} more", warnings.len() - MOST));
    }
    lines
}

/// A place and words, as GCC and Clang write them, and as Visual C++ does, whose builds add the project.
static WARNINGS: LazyLock<[Regex; 2]> = LazyLock::new(|| {
    [
        r"^(?<file>.+?):(?<line>[0-9]+):(?:[0-9]+:)? warning: (?<message>.+)$",
        r"^\s*(?<file>[^(]+?)\((?<line>[0-9]+)(?:,[0-9]+)?\)\s*: warning (?<message>.+?)(?: \[[^\]]*proj\])?$",
    ]
    .map(expression)
});

/// The line by which GCC says which function its next warnings are of, or that they are of none.
static SECTION: LazyLock<Regex> =
    LazyLock::new(|| expression(r"^.+?: (?:In|At) [^'‘]*(?:['‘](?<function>.+)['’])?.*:$"));

#[expect(clippy::expect_used, reason = "expressions are constants")]
fn expression(pattern: &str) -> Regex {
    Regex::new(pattern).expect("a regular expression")
}

/// The warnings of files below `submission`, in their order there, each once: a header is compiled many times.
pub(super) fn warnings(said: &str, submission: &Path) -> Vec<Warning> {
    let mut found = Vec::new();
    let mut function = String::new();
    for line in said.lines() {
        if let Some(warned) = WARNINGS.iter().find_map(|pattern| pattern.captures(line)) {
            found.extend(warning(&warned, &function, submission));
        } else if let Some(section) = SECTION.captures(line) {
            function = section.name("function").map_or(String::new(), |it| name(it.as_str()));
        }
    }
    found.sort();
    found.dedup();
    found
}

fn warning(warned: &Captures<'_>, function: &str, submission: &Path) -> Option<Warning> {
    // A compiler may name the file by a link, or otherwise than this system names it in full.
    let path = Path::new(&warned["file"]);
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let file = path.strip_prefix(submission).ok()?.to_string_lossy().replace('\\', "/");
    let message = warned["message"].trim().to_owned();
    Some(Warning {
        file,
        line: warned["line"].parse().ok()?,
        message,
        function: function.to_owned(),
    })
}

/// Of `virtual bool CGL::BBox::intersect(const Ray&) const` the name.
fn name(signature: &str) -> String {
    let head = signature.split('(').next().unwrap_or_default();
    head.split_whitespace().last().unwrap_or_default().trim_start_matches(['*', '&']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(said: &str) -> Vec<String> {
        warnings(said, Path::new("/class/ada")).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn each_compiler_says_it_in_its_way() {
        let gcc = "\
[ 12%] Building CXX object CMakeFiles/course.dir/bbox.cpp.o
/class/ada/src/bbox.cpp: In member function 'bool CGL::BBox::intersect(const CGL::Ray&, double&) const':
/class/ada/src/bbox.cpp:53:1: warning: control reaches end of non-void function [-Wreturn-type]
   53 | }
/class/ada/src/bbox.cpp: At global scope:
/class/ada/src/bbox.cpp:60:5: warning: overflow [-Woverflow]";
        let expected = [
            "src/bbox.cpp:53: control reaches end of non-void function [-Wreturn-type], in CGL::BBox::intersect",
            "src/bbox.cpp:60: overflow [-Woverflow]",
        ];
        assert_eq!(told(gcc), expected);
        let in_utf8 = gcc.replacen('\'', "‘", 1).replacen('\'', "’", 1);
        assert_eq!(told(&in_utf8), expected);
        let clang = "/class/ada/src/bbox.cpp:53:1: warning: non-void function does not return a value [-Wreturn-type]";
        let expected = "src/bbox.cpp:53: non-void function does not return a value [-Wreturn-type]";
        assert_eq!(told(clang), [expected]);
        let msvc = "/class/ada/src/bbox.cpp(53,1): warning C4715: 'f': not all control paths return a value [/class/b.vcxproj]";
        let expected = "src/bbox.cpp:53: C4715: 'f': not all control paths return a value";
        assert_eq!(told(msvc), [expected]);
    }

    #[test]
    fn a_header_warns_once_and_what_is_not_the_submissions_never() {
        let said = "\
/class/ada/src/ray.h:7:3: warning: 'x' may be used uninitialized
/class/ada/src/ray.h:7:3: warning: 'x' may be used uninitialized
/usr/include/vector:9:1: warning: something
/class/adam/src/ray.h:7:3: warning: of another
/class/ada/src/ray.h:8:3: error: no warning
cc1plus: warning: unrecognized option";
        assert_eq!(told(said), ["src/ray.h:7: 'x' may be used uninitialized"]);
    }
}
