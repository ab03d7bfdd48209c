//! Images between the lines of a terminal that can show them: by the protocols of kitty and of iTerm2. Nothing is shown in a
//! pipe, to who wants no colours, or by a terminal that does not say by its variables that it can.

use super::say::say;
use crate::image::Image;
use crate::image::png::{self, Picture};
use crate::report::html::develop::{Look, Shows};
use crate::text::colour::Colour;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::fmt::Write;
use std::io::IsTerminal;

/// Pixels between two images.
const GAP: usize = 8;
/// Columns of the terminal that each takes, and that a terminal has which does not say.
const COLUMNS: usize = 36;
const USUAL: usize = 80;
/// Letters of base64 that kitty takes at a time.
const CHUNK: usize = 4096;

/// How a terminal is told an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Protocol {
    /// <https://sw.kovidgoyal.net/kitty/graphics-protocol>
    Kitty,
    /// <https://iterm2.com/documentation-images.html>
    Iterm,
}

/// Who says what of itself in which variable. The first that fits counts.
const TERMINALS: [(&str, &str, Protocol); 7] = [
    ("TERM", "xterm-kitty", Protocol::Kitty),
    ("TERM", "xterm-ghostty", Protocol::Kitty),
    ("TERM_PROGRAM", "ghostty", Protocol::Kitty),
    ("TERM_PROGRAM", "iTerm.app", Protocol::Iterm),
    ("TERM_PROGRAM", "WezTerm", Protocol::Iterm),
    ("TERM_PROGRAM", "mintty", Protocol::Iterm),
    ("LC_TERMINAL", "iTerm2", Protocol::Iterm),
];

impl Protocol {
    /// That of the terminal which set these variables, if it has one. What stands between, such as tmux, lets none through.
    fn of(variable: impl Fn(&str) -> Option<String>) -> Option<Self> {
        let between = ["tmux", "screen", "dumb"];
        let term = variable("TERM").unwrap_or_default();
        if between.iter().any(|name| term.starts_with(name)) {
            return None;
        }
        let said = |name: &str, value: &str| variable(name).is_some_and(|said| said == value);
        TERMINALS.iter().find(|(name, value, _)| said(name, value)).map(|(.., it)| *it)
    }

    /// A PNG file as this terminal is told it, so many columns wide.
    fn escape(self, file: &[u8], columns: usize) -> String {
        let text = BASE64_STANDARD.encode(file);
        match self {
            Self::Kitty => in_chunks(&text, columns),
            Self::Iterm => format!(
                "\x1b]1337;File=inline=1;size={};width={columns};preserveAspectRatio=1:{text}\x07",
                file.len()
            ),
        }
    }
}

/// The first chunk says what it is: PNG, to be shown here, and not to be answered.
fn in_chunks(text: &str, columns: usize) -> String {
    let chunks = text.len().div_ceil(CHUNK);
    let mut told = String::new();
    for (number, chunk) in text.as_bytes().chunks(CHUNK).enumerate() {
        let what = if number == 0 { format!("a=T,f=100,q=2,c={columns},") } else { String::new() };
        let goes_on = u8::from(number + 1 < chunks);
        let chunk = String::from_utf8_lossy(chunk);
        let _ = write!(told, "\x1b_G{what}m={goes_on};{chunk}\x1b\\");
    }
    told
}

/// Whether standard output is where images can be seen.
pub(super) fn is_possible() -> bool {
    protocol().is_some()
}

fn protocol() -> Option<Protocol> {
    let is_terminal = std::io::stdout().is_terminal();
    let is_wanted = is_terminal && Colour::is_wanted(is_terminal);
    is_wanted.then(|| Protocol::of(|name| std::env::var(name).ok())).flatten()
}

/// Shows images side by side, all as bright as suits the last one of light, where that is possible.
pub(super) fn show(images: &[(&Image, Shows)]) {
    if is_possible() {
        let light = images.iter().filter(|(_, shows)| shows.scale().is_none());
        let look = Look::for_picture(light.map(|(image, _)| *image).next_back());
        let pictures = images.iter().map(|(image, shows)| look.picture(image, *shows));
        show_pictures(&pictures.collect::<Vec<_>>());
    }
}

/// The same of pictures for people.
pub(super) fn show_pictures(pictures: &[Picture]) {
    let Some(protocol) = protocol() else { return };
    // What cannot be encoded has no pixels.
    let Ok(file) = png::encode(&side_by_side(pictures)) else { return };
    let terminal = terminal_size::terminal_size().map_or(USUAL, |(width, _)| width.0.into());
    let columns = (COLUMNS * pictures.len()).min(terminal.saturating_sub(2)).max(1);
    say!("{}\n", protocol.escape(&file, columns));
}

/// Pictures in a row, on black.
fn side_by_side(pictures: &[Picture]) -> Picture {
    let height = pictures.iter().map(|picture| picture.height).max().unwrap_or(0);
    let row = |y: usize| {
        let part = move |picture: &Picture| {
            let row = picture.pixels.get(y * picture.width..(y + 1) * picture.width);
            row.map_or_else(|| vec![[0; 3]; picture.width], <[_]>::to_vec)
        };
        let parts: Vec<_> = pictures.iter().map(part).collect();
        parts.join(&[[0; 3]; GAP][..])
    };
    let rows: Vec<_> = (0..height).map(row).collect();
    Picture { width: rows.first().map_or(0, Vec::len), height, pixels: rows.concat() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(variables: &[(&str, &str)]) -> Option<Protocol> {
        let value = |name: &str| variables.iter().find(|(known, _)| *known == name);
        Protocol::of(|name| value(name).map(|(_, value)| (*value).to_owned()))
    }

    #[test]
    fn a_terminal_announces_itself_or_is_shown_nothing() {
        assert_eq!(of(&[("TERM", "xterm-kitty")]), Some(Protocol::Kitty));
        let wezterm = [("TERM", "xterm-256color"), ("TERM_PROGRAM", "WezTerm")];
        assert_eq!(of(&wezterm), Some(Protocol::Iterm));
        assert_eq!(of(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "Apple_Terminal")]), None);
        assert_eq!(of(&[("TERM", "tmux-256color"), ("TERM_PROGRAM", "iTerm.app")]), None);
        assert_eq!(of(&[]), None);
    }

    /// What a terminal reads out of kitty's chunks.
    fn read(told: &str) -> (String, Vec<u8>) {
        let chunks: Vec<_> = told
            .split("\x1b\\")
            .filter_map(|chunk| chunk.strip_prefix("\x1b_G")?.split_once(';'))
            .collect();
        let (last, others) = chunks.split_last().unwrap();
        assert!(last.0.ends_with("m=0") && others.iter().all(|(keys, _)| keys.ends_with("m=1")));
        assert!(chunks.iter().all(|(_, chunk)| chunk.len() <= CHUNK));
        let text: String = chunks.iter().map(|(_, chunk)| *chunk).collect();
        (chunks[0].0.to_owned(), BASE64_STANDARD.decode(text).unwrap())
    }

    #[test]
    fn a_file_arrives_whole() {
        let file: Vec<u8> = (0..10_000_u32).map(|n| (n * 7 % 251) as u8).collect();
        let (keys, arrived) = read(&Protocol::Kitty.escape(&file, 72));
        assert_eq!((keys.as_str(), arrived), ("a=T,f=100,q=2,c=72,m=1", file.clone()));
        let told = Protocol::Iterm.escape(&file, 72);
        let (keys, text) = told.split_once(':').unwrap();
        let expected = "\x1b]1337;File=inline=1;size=10000;width=72;preserveAspectRatio=1";
        assert_eq!(keys, expected);
        assert_eq!(BASE64_STANDARD.decode(text.trim_end_matches('\x07')).unwrap(), file);
    }

    #[test]
    fn pictures_stand_in_a_row() {
        let picture = |width, height, colour| {
            let pixels = vec![[colour; 3]; width * height];
            Picture { width, height, pixels }
        };
        let strip = side_by_side(&[picture(2, 1, 10), picture(1, 2, 20)]);
        assert_eq!((strip.width, strip.height), (3 + GAP, 2));
        assert_eq!(strip.pixels[0], [10; 3]);
        assert_eq!(strip.pixels[strip.width], [0; 3], "the first has no second row");
        assert_eq!(strip.pixels[2 * strip.width - 1], [20; 3]);
    }
}
