//! One process of Mitsuba: passes in, files out.

use super::{Listener, MakeError, Progress};
use crate::image::Image;
use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Loads the scene, renders one pass after another. Given to Python on standard input.
const SCRIPT: &str = include_str!("render_passes.py");

/// The end of a log that is shown when something fails.
const LAST_WORDS: u64 = 2_000;

/// A Python with Mitsuba in it, and the back end to use.
pub(super) struct Mitsuba {
    pub(crate) python: PathBuf,
    pub(crate) variant: Variant,
    /// Its version; empty until it has been probed.
    pub(crate) version: String,
}

/// A back end of Mitsuba.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Variant {
    /// Such as `llvm_ad_rgb`.
    pub(crate) name: String,
    /// The library that LLVM is loaded from.
    pub(crate) llvm: Option<PathBuf>,
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.llvm {
            Some(library) => write!(f, "{} with {}", self.name, library.display()),
            None => f.write_str(&self.name),
        }
    }
}

/// A scene in a folder of its own, where the passes go too.
#[derive(Clone, Debug)]
pub(super) struct Job {
    /// Holds `scene.xml`.
    pub(crate) folder: PathBuf,
    pub(crate) film: [u32; 2],
    pub(crate) samples: u32,
    /// The last bounce, if a pass holds each bounce alone, one below the other.
    pub(crate) last_bounce: Option<u32>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Spent {
    /// Its version; empty if it did not run.
    pub(crate) version: String,
    /// Processor seconds of all its threads.
    pub(crate) cpu_seconds: f64,
}

impl Job {
    /// The same with each bounce alone, one below the other: the film is so many times as high.
    pub(crate) fn apart(&self, last_bounce: u32) -> Self {
        let film = [self.film[0], self.film[1] * (last_bounce + 1)];
        Self { film, last_bounce: Some(last_bounce), ..self.clone() }
    }

    /// The pass of a seed, if it is there and whole.
    pub(crate) fn pass(&self, seed: u32) -> Option<Image> {
        let bytes = std::fs::read(self.pass_path(seed)).ok()?;
        let [width, height] = self.film.map(|pixels| pixels as usize);
        let (values, rest) = bytes.as_chunks::<4>();
        let is_whole = rest.is_empty() && values.len() == 3 * width * height;
        let values: Vec<f32> = values.iter().map(|value| f32::from_le_bytes(*value)).collect();
        let (pixels, _) = values.as_chunks::<3>();
        is_whole.then(|| Image { width, height, pixels: pixels.to_vec() })
    }

    fn pass_path(&self, seed: u32) -> PathBuf {
        let content = if self.last_bounce.is_some() { "bounces" } else { "pass" };
        self.folder.join(format!("{content}-{seed}.f32"))
    }
}

impl Mitsuba {
    /// Whether this back end renders the scene at all, found out with a pass of one sample.
    pub(crate) fn probe(&mut self, job: &Job) -> Result<(), MakeError> {
        const SEED: u32 = 0;
        let folder = tempfile::tempdir().map_err(MakeError::at(&job.folder))?;
        self.version = self.run(job, folder.path(), 1, &[SEED], &mut |_| ())?.version;
        Ok(())
    }

    /// Renders the passes of these seeds that are not there yet.
    pub(crate) fn render(
        &self,
        job: &Job,
        seeds: &[u32],
        progress: Listener<'_>,
    ) -> Result<Spent, MakeError> {
        let missing: Vec<u32> =
            seeds.iter().copied().filter(|seed| job.pass(*seed).is_none()).collect();
        let of = seeds.len() as u32;
        let mut done = of - missing.len() as u32;
        progress(Progress::Rendering { done, of });
        if missing.is_empty() {
            return Ok(Spent::default());
        }
        self.run(job, &job.folder, job.samples, &missing, &mut |_| {
            done += 1;
            progress(Progress::Rendering { done, of });
        })
    }

    fn run(
        &self,
        job: &Job,
        output: &Path,
        samples: u32,
        seeds: &[u32],
        on_pass: &mut dyn FnMut(&str),
    ) -> Result<Spent, MakeError> {
        let log_path = output.join("mitsuba.log");
        let log = File::create(&log_path).map_err(MakeError::at(&log_path))?;
        let mut command = Command::new(&self.python);
        command.arg("-").arg(job.folder.join("scene.xml")).arg(&self.variant.name);
        command.arg(samples.to_string()).arg(output);
        command.arg(job.last_bounce.map_or("together".to_owned(), |last| last.to_string()));
        command.args(seeds.iter().map(u32::to_string));
        if let Some(library) = &self.variant.llvm {
            command.env("DRJIT_LIBLLVM_PATH", library);
        }
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(log);
        let failed = |problem: &dyn fmt::Display| MakeError::Program {
            program: format!("Mitsuba ({})", self.variant),
            how: problem.to_string(),
            last_words: last_words(&log_path),
        };
        let mut child = command.spawn().map_err(|problem| failed(&problem))?;
        let spent = converse(&mut child, on_pass).map_err(|problem| failed(&problem));
        let status = child.wait().map_err(|problem| failed(&problem))?;
        if status.success() { spent } else { Err(failed(&status)) }
    }
}

/// Hands the script over and listens until the process closes its standard output.
fn converse(child: &mut Child, on_pass: &mut dyn FnMut(&str)) -> std::io::Result<Spent> {
    if let Some(mut input) = child.stdin.take() {
        input.write_all(SCRIPT.as_bytes())?;
    }
    let mut spent = Spent::default();
    let Some(output) = child.stdout.take() else { return Ok(spent) };
    for line in BufReader::new(output).lines() {
        match line?.split_once(' ') {
            Some(("version", version)) => spent.version = version.to_owned(),
            Some(("pass", seed)) => on_pass(seed),
            Some(("cpu", seconds)) => spent.cpu_seconds = seconds.parse().unwrap_or(f64::NAN),
            _ => {}
        }
    }
    Ok(spent)
}

fn last_words(log: &Path) -> String {
    let read = || -> std::io::Result<String> {
        let mut file = File::open(log)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(LAST_WORDS)))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    read().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job() -> (tempfile::TempDir, Job) {
        let folder = tempfile::tempdir().unwrap();
        let job =
            Job { folder: folder.path().to_owned(), film: [2, 1], samples: 4, last_bounce: None };
        (folder, job)
    }

    #[test]
    fn a_pass_is_read_only_if_it_is_whole() {
        let (_folder, job) = job();
        assert_eq!(job.pass(3), None);
        let bytes: Vec<u8> = (1..=6u8).flat_map(|value| f32::from(value).to_le_bytes()).collect();
        std::fs::write(job.pass_path(3), &bytes[..23]).unwrap();
        assert_eq!(job.pass(3), None);
        std::fs::write(job.pass_path(3), &bytes).unwrap();
        assert_eq!(job.pass(3).unwrap().pixels, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    }

    #[test]
    fn bounces_apart_are_other_files_of_a_higher_film() {
        let (_folder, job) = job();
        let apart = job.apart(2);
        assert_eq!(apart.film, [2, 3]);
        assert_ne!(apart.pass_path(0), job.pass_path(0));
        std::fs::write(apart.pass_path(0), [0; 4 * 3 * 6]).unwrap();
        assert_eq!((job.pass(0), apart.pass(0).unwrap().height), (None, 3));
    }

    #[test]
    fn passes_that_are_there_are_not_rendered_again() {
        let (_folder, job) = job();
        std::fs::write(job.pass_path(0), [0; 24]).unwrap();
        let variant = Variant { name: "scalar_rgb".to_owned(), llvm: None };
        let python = "no-such-python".into();
        let mitsuba = Mitsuba { python, variant, version: String::new() };
        let mut heard = Vec::new();
        mitsuba.render(&job, &[0], &mut |progress| heard.push(progress)).unwrap();
        assert_eq!(heard, [Progress::Rendering { done: 1, of: 1 }]);
        let error = mitsuba.render(&job, &[0, 1], &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains("Mitsuba (scalar_rgb) failed"), "{error}");
    }
}
