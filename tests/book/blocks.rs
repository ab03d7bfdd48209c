//! Blocks of code: what a page tells people to write is written, and what it tells them to type is typed.
//!
//! Each page has a folder of its own, where its blocks are tried one after the other. Behind the language a fence may say
//!
//! - `file=NAME`: the block is that file's text;
//! - `exit=N`: so the commands end, if not with 0;
//! - `output`: each line stands in what the commands before have printed; `…` is anything;
//! - `needs=WHAT`: tried only where somebody has it (a program, a renderer, minutes of time). In the test the shell reads the
//!   block, and verbs and options are looked up.

use crate::text::{below, book};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A fenced block.
pub struct Block {
    /// Of its first line, counted from 1.
    line: usize,
    language: String,
    words: Vec<String>,
    text: String,
}

impl Block {
    fn says(&self, key: &str) -> Option<&str> {
        self.words.iter().find_map(|word| word.strip_prefix(key)?.strip_prefix('='))
    }

    fn is(&self, word: &str) -> bool {
        self.words.iter().any(|known| known == word)
    }
}

/// The fenced blocks of a page.
pub fn of(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut is_open = false;
    for (number, line) in text.lines().enumerate() {
        match line.strip_prefix("```") {
            Some(_) if is_open => is_open = false,
            Some(info) => {
                let mut words = info.split_whitespace().map(str::to_owned);
                let language = words.next().unwrap_or_default();
                let words = words.collect();
                blocks.push(Block { line: number + 1, language, words, text: String::new() });
                is_open = true;
            }
            None if is_open => blocks.last_mut().unwrap().text.extend([line, "\n"]),
            None => {}
        }
    }
    blocks
}

/// Languages whose blocks have to be tried.
const TRIED: [&str; 7] = ["sh", "cpp", "c", "rust", "python", "toml", "yaml"];

/// The folder of a page, with what a checkout has beside it.
struct Room {
    folder: tempfile::TempDir,
    page: String,
}

impl Room {
    fn new(page: String) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        fs::create_dir(folder.path().join("bin")).unwrap();
        link(Path::new(env!("CARGO_BIN_EXE_furnace")), &folder.path().join("bin/furnace"));
        fs::create_dir(folder.path().join("here")).unwrap();
        for name in ["adapters", "examples", "include", "references"] {
            link(&root.join(name), &folder.path().join("here").join(name));
        }
        Self { folder, page }
    }

    fn here(&self) -> PathBuf {
        self.folder.path().join("here")
    }

    /// How a script ended, and what it printed.
    fn run(&self, options: &[&str], script: &str) -> (i32, String) {
        let bin = self.folder.path().join("bin");
        let path = std::env::var("PATH").unwrap_or_default();
        let mut command = Command::new("sh");
        command.args(options).arg("-c").arg(format!("exec 2>&1\n{script}"));
        command.current_dir(self.here()).stdin(std::process::Stdio::null());
        command.env("PATH", format!("{}:{path}", bin.display()));
        command.env("FURNACE_CACHE", std::env::temp_dir().join("furnace-book"));
        command.env_remove("FURNACE_HOME").env_remove("CARGO_PKG_NAME").env("COLUMNS", "88");
        let output = command.output().unwrap();
        (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn file(&self, name: &str, text: &str) {
        let path = self.here().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// Tries the blocks of the page in their order, and answers the first complaint.
    fn try_all(&self, blocks: &[Block]) -> Option<String> {
        let mut printed = String::new();
        for block in blocks {
            let complaint = self.complaint(block, &mut printed);
            if let Some(complaint) = complaint {
                return Some(format!("{}, block at line {}: {complaint}", self.page, block.line));
            }
        }
        None
    }

    fn complaint(&self, block: &Block, printed: &mut String) -> Option<String> {
        if let Some(name) = block.says("file") {
            self.file(name, &block.text);
            return None;
        }
        if block.is("output") {
            let text = lost_line(&block.text, printed);
            return text.map(|line| format!("`{line}` is not printed; this is:\n{printed}"));
        }
        match block.language.as_str() {
            "sh" if block.says("needs").is_some() => self.unreadable(block),
            "sh" => {
                let expected = block.says("exit").map_or(0, |code| code.parse().unwrap());
                let (code, words) = self.run(&["-e"], &block.text);
                *printed = words;
                (code != expected).then(|| format!("ends with {code}:\n{printed}"))
            }
            "toml" => block.text.parse::<toml::Table>().err().map(|error| error.to_string()),
            language if TRIED.contains(&language) => {
                Some(format!("a block of {language} that nothing compiles: say `file=NAME`"))
            }
            _ => None,
        }
    }

    /// What is wrong with commands that are not run: the shell cannot read them, or furnace has no such option.
    fn unreadable(&self, block: &Block) -> Option<String> {
        let (code, words) = self.run(&["-n"], &block.text);
        if code != 0 {
            return Some(words);
        }
        let lines = block.text.replace("\\\n", " ");
        let lines = lines.lines().filter(|line| line.contains("furnace "));
        lines.filter_map(|line| self.unknown_word(line)).next()
    }

    fn unknown_word(&self, line: &str) -> Option<String> {
        let code = line.split(" #").next().unwrap();
        let words = shell_words::split(code).unwrap();
        let start = words.iter().position(|word| word == "furnace")?;
        let words: Vec<_> = words[start + 1..].iter().take_while(|word| *word != "&&").collect();
        let verbs = self.run(&[], "furnace --help").1;
        let is_verb = |word: &str| verbs.contains(&format!("\n  {word} "));
        let verb: Vec<_> = words.iter().take(2).filter(|word| !word.starts_with('-')).collect();
        let verb = match verb.first() {
            Some(first) if ["new", "reference"].contains(&first.as_str()) => {
                format!("{first} {}", words[1])
            }
            Some(first) if is_verb(first) => (**first).clone(),
            _ => "run".to_owned(),
        };
        let help = self.run(&[], &format!("furnace {verb} --help")).1;
        let options = words.iter().filter(|word| word.starts_with("--"));
        let mut names = options.map(|option| option.split('=').next().unwrap());
        let unknown = names.find(|name| {
            !help.contains(&format!("{name} ")) && !help.contains(&format!("{name}\n"))
        });
        unknown.map(|name| format!("`furnace {verb}` has no {name}"))
    }
}

#[cfg(unix)]
fn link(from: &Path, to: &Path) {
    std::os::unix::fs::symlink(from, to).unwrap();
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) {}

/// The first line that was not printed, pieces between `…` in their order.
fn lost_line<'a>(text: &'a str, printed: &str) -> Option<&'a str> {
    let is_there = |line: &str| {
        printed.lines().any(|known| {
            let mut rest = known;
            line.trim().split('…').all(|piece| match rest.find(piece.trim()) {
                Some(place) => {
                    rest = &rest[place + piece.trim().len()..];
                    true
                }
                None => false,
            })
        })
    };
    text.lines().filter(|line| !line.trim().is_empty()).find(|line| !is_there(line))
}

/// Tries the blocks of one page of the book, by its name.
pub fn complaint_about(page: &Path) -> Option<String> {
    let text = fs::read_to_string(page).unwrap();
    let room = Room::new(below(page, &book()));
    room.try_all(&of(&text))
}

#[test]
fn a_block_that_is_wrong_is_found() {
    let complaint = |text: &str| Room::new("page".to_owned()).try_all(&of(text)).is_some();
    for wrong in [
        "```sh\nfalse\n```\n",
        "```sh\necho a\n```\n```text output\nb\n```\n",
        "```sh needs=time\nfurnace run --no-such-option\n```\n",
        "```sh needs=time\nfurnace grade --fail-fast\n```\n",
        "```sh needs=time\nif true\n```\n",
        "```cpp\nint main(\n```\n",
        "```toml\nx = \n```\n",
    ] {
        assert!(complaint(wrong), "{wrong}");
    }
    for right in [
        "```sh\necho a 12 b\n```\n```text output\na … b\n```\n",
        "```sh exit=4\nfurnace run no-such-case\n```\n",
        "```sh needs=time\nfurnace run 4 --fail-fast --core ./libmine.so   # part 4\n```\n",
        "```sh\ncat x.txt\n```\n"
            .replace("```sh\ncat", "```text file=x.txt\n1\n```\n```sh\ncat")
            .as_str(),
    ] {
        assert!(!complaint(right), "{right}");
    }
}
