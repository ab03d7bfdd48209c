//! Where things are: the folders of cases, scenes, references and reports.
//!
//! A checkout has them all. Anywhere else the folder where one stands is the project: what it has of its own is laid over
//! the bench's, which the program carries and unpacks once into the user's cache.

use crate::text::hexadecimal;
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use walkdir::{DirEntry, WalkDir};

/// The root of a checkout, or of any folder laid out like one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Project {
    root: PathBuf,
    /// What it is laid over, if it is no checkout.
    bench: Option<PathBuf>,
}

/// Why it is not known where things are.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NoProject {
    /// There is no checkout, and the program carries nothing.
    #[error("no cases here or above; run furnace inside its checkout, or set FURNACE_HOME to it")]
    Nowhere,
    /// The folder that was named is not there.
    #[error(
        "there is no folder `{0}`\n\
         hint: --project and FURNACE_HOME name the folder with cases, scenes or suites of your own"
    )]
    Missing(String),
    /// Neither the library's own source nor a checkout is on this machine.
    #[error(
        "the cases of furnace were in {0} when this program was built, and are not there any more\n\
         hint: build it again here, or set FURNACE_HOME to a checkout of furnace"
    )]
    Moved(PathBuf),
    /// What the program carries could not be written.
    #[error(
        "cannot unpack the cases into {folder}: {error}\n\
         hint: FURNACE_CACHE=DIR names a folder that can be written"
    )]
    Cache { folder: PathBuf, error: io::Error },
}

/// The files that the program carries: each path inside the checkout, and its content.
pub(crate) type Carried = fn() -> Box<dyn Iterator<Item = (String, Cow<'static, [u8]>)>>;

static CARRIED: OnceLock<Carried> = OnceLock::new();

/// Says what the program carries. The first word counts.
pub(crate) fn carry(files: Carried) {
    let _ = CARRIED.set(files);
}

impl Project {
    /// The project at `root`, and nothing below it.
    pub fn at(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into(), bench: None }
    }

    /// The project that the user stands in: `FURNACE_HOME`, or the nearest folder above the current one that
    /// has cases or suites of its own, or else the current one.
    pub(crate) fn find() -> Result<Self, NoProject> {
        if let Some(home) = std::env::var_os("FURNACE_HOME") {
            return Self::over_the_bench(home.into());
        }
        let here = std::env::current_dir().map_err(|_| NoProject::Nowhere)?;
        let root = here.ancestors().find(|folder| is_root(folder)).unwrap_or(&here);
        Self::over_the_bench(root.to_owned())
    }

    /// The project at `root`: whole by itself, or else laid over what the program carries.
    pub(crate) fn over_the_bench(root: PathBuf) -> Result<Self, NoProject> {
        if !root.is_dir() {
            return Err(NoProject::Missing(root.display().to_string()));
        }
        if is_checkout(&root) {
            return Ok(Self::at(root));
        }
        match CARRIED.get() {
            Some(files) => Ok(Self { root, bench: Some(unpacked(*files)?) }),
            None if root.join("cases").is_dir() => Ok(Self::at(root)),
            None => Err(NoProject::Nowhere),
        }
    }

    /// What programs of others try: the source that this library was built from, or the checkout that `FURNACE_HOME`
    /// names, below a folder of their own.
    pub(crate) fn of_the_library(own: Option<PathBuf>) -> Result<Self, NoProject> {
        let home = std::env::var_os("FURNACE_HOME").map(PathBuf::from);
        let bench = home.unwrap_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")));
        if !is_checkout(&bench) {
            return Err(NoProject::Moved(bench));
        }
        match own {
            None => Ok(Self::at(bench)),
            Some(root) if root.is_dir() => Ok(Self { root, bench: Some(bench) }),
            Some(root) => Err(NoProject::Missing(root.display().to_string())),
        }
    }

    /// What is asked.
    pub fn cases(&self) -> PathBuf {
        self.root.join("cases")
    }

    /// What it is asked of.
    pub fn scenes(&self) -> PathBuf {
        self.root.join("scenes")
    }

    /// How a core is graded.
    pub(crate) fn suites(&self) -> PathBuf {
        self.root.join("suites")
    }

    /// Where a class is built and graded by this suite. Cores may read what is built there.
    pub(crate) fn class(&self, suite: &str) -> PathBuf {
        self.root.join("classes").join(suite)
    }

    /// What is true. Only `furnace reference make` writes here.
    pub fn references(&self) -> PathBuf {
        self.root.join("references")
    }

    /// The folders of this name that there are: the project's own before the bench's.
    pub(crate) fn layers(&self, name: &str) -> Vec<PathBuf> {
        let own = self.root.join(name);
        let Some(bench) = &self.bench else { return vec![own] };
        let below = bench.join(name);
        if own.is_dir() { vec![own, below] } else { vec![below] }
    }

    /// The file or folder of this name that belongs to the bench.
    pub(crate) fn of_the_bench(&self, name: &str) -> PathBuf {
        self.bench.as_ref().unwrap_or(&self.root).join(name)
    }

    /// The folder of references whose recipes count: the project's own, if it has any.
    pub(crate) fn recipes(&self) -> PathBuf {
        let mut layers = self.layers("references").into_iter();
        let with_recipes = layers.find(|folder| folder.join("recipes.toml").is_file());
        with_recipes.unwrap_or_else(|| self.references())
    }

    /// What no core may read: what is asked, what is true, what was found, and where copies of that are kept.
    pub(crate) fn secrets(&self) -> Vec<PathBuf> {
        let folders = ["cases", "references", "reports", "suites", ".git"];
        let of = |root: &PathBuf| folders.map(|folder| root.join(folder));
        [Some(&self.root), self.bench.as_ref()].into_iter().flatten().flat_map(of).collect()
    }

    /// Where runs go.
    pub fn runs(&self) -> PathBuf {
        self.root.join("reports").join("runs")
    }
}

fn is_root(folder: &Path) -> bool {
    ["cases", "suites"].iter().any(|name| holds_toml(&folder.join(name)))
}

/// Folders of these names stand in many places; ours hold cases, below a folder for each part, or suites.
fn holds_toml(folder: &Path) -> bool {
    let files = WalkDir::new(folder).max_depth(2).into_iter().filter_map(Result::ok);
    files.map(DirEntry::into_path).any(|path| path.extension().is_some_and(|of| of == "toml"))
}

/// Whether all that the bench consists of is here.
fn is_checkout(folder: &Path) -> bool {
    ["cases", "scenes", "references"].iter().all(|name| folder.join(name).is_dir())
        && folder.join("include/furnace_core.h").is_file()
}

/// The folder with all that the program carries. Its name is that of its content: what was unpacked once is right.
fn unpacked(files: Carried) -> Result<PathBuf, NoProject> {
    let folder = cache().join(format!("bench-{}", fingerprint(files)));
    let unpack = || {
        let parent = folder.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(parent)?;
        let fresh = tempfile::Builder::new().prefix("bench-").tempdir_in(parent)?;
        for (path, content) in files() {
            let path = fresh.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap_or(parent))?;
            std::fs::write(&path, &content)?;
        }
        match std::fs::rename(fresh.path(), &folder) {
            // Somebody else was faster.
            Err(_) if folder.is_dir() => Ok(()),
            renamed => renamed,
        }
    };
    if !folder.is_dir() {
        unpack().map_err(|error| NoProject::Cache { folder: folder.clone(), error })?;
    }
    Ok(folder)
}

fn fingerprint(files: Carried) -> String {
    let mut digest = Sha256::new();
    for (path, content) in files() {
        digest.update(format!("{path} {}\n", content.len()));
        digest.update(&content);
    }
    hexadecimal(digest)[..16].to_owned()
}

/// The user's folder for what can be made again.
fn cache() -> PathBuf {
    let named = |variable| std::env::var_os(variable).map(PathBuf::from);
    let at_home = || {
        let folder = if cfg!(target_os = "macos") { "Library/Caches" } else { ".cache" };
        named("HOME").map(|home| home.join(folder))
    };
    let of_user = || named("XDG_CACHE_HOME").or_else(|| named("LOCALAPPDATA")).or_else(at_home);
    let below = || of_user().unwrap_or_else(std::env::temp_dir).join("furnace");
    named("FURNACE_CACHE").unwrap_or_else(below)
}
