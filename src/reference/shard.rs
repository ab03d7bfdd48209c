//! Passes that have been added up, in a file: what references are merged from and extended by.
//!
//! A file begins with a line of its own and a table that says what the passes are of; after a line
//! of three dashes come Σx and Σx² of every value, each in two doubles, little-endian.

use super::MakeError;
use super::seeds::Seeds;
use super::sums::Sums;
use crate::disk;
use serde::{Deserialize, Serialize};
use std::path::Path;

const FIRST_LINE: &str = "furnace-sums 1\n";
const LAST_LINE: &str = "---\n";

/// What passes are of. Only those alike in all of this are added up.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct About {
    pub(crate) scene: String,
    pub(crate) scene_hash: String,
    pub(crate) bounces: [u32; 2],
    pub(crate) film: [u32; 2],
    pub(crate) samples_per_pass: u32,
    pub(crate) sampler: String,
    pub(crate) version: String,
    pub(crate) variant: String,
}

/// Passes that have been added up.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shard {
    pub(crate) about: About,
    pub(crate) seeds: Seeds,
    pub(crate) cpu_seconds: f64,
    pub(crate) sums: Sums,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Head {
    seeds: Vec<[u32; 2]>,
    cpu_seconds: f64,
    about: About,
}

impl Shard {
    /// Takes in passes of the same kind with other seeds, from the file `path` if they are refused.
    pub(crate) fn merge(&mut self, other: &Self, path: &Path) -> Result<(), MakeError> {
        let refused = |problem: String| Err(MakeError::file(path, &problem));
        if let Some(seed) = self.seeds.first_in_both(&other.seeds) {
            return refused(format!("duplicate seed {seed}: it is in the sums already"));
        }
        if self.about != other.about {
            return refused(format!(
                "its passes have other settings\n  here  {:?}\n  there {:?}",
                self.about, other.about
            ));
        }
        self.seeds.add(&other.seeds);
        self.cpu_seconds += other.cpu_seconds;
        self.sums.merge(&other.sums);
        Ok(())
    }

    pub(crate) fn write(&self, path: &Path) -> Result<(), MakeError> {
        let head = Head {
            seeds: self.seeds.ranges().to_vec(),
            cpu_seconds: self.cpu_seconds,
            about: self.about.clone(),
        };
        let head = toml::to_string(&head).map_err(MakeError::at(path))?;
        let content =
            [FIRST_LINE.as_bytes(), head.as_bytes(), LAST_LINE.as_bytes(), self.sums.bytes()];
        disk::replace(path, &content.concat()).map_err(MakeError::at(path))
    }

    /// Reads a file that [`Shard::write`] wrote.
    pub(crate) fn read(path: &Path) -> Result<Self, MakeError> {
        let content = std::fs::read(path).map_err(MakeError::at(path))?;
        Self::parsed(&content)
            .ok_or_else(|| MakeError::file(path, &"not a file of sums of passes, or truncated"))
    }

    fn parsed(content: &[u8]) -> Option<Self> {
        let rest = content.strip_prefix(FIRST_LINE.as_bytes())?;
        let end = LAST_LINE.len();
        let at = rest.windows(end).position(|bytes| bytes == LAST_LINE.as_bytes())?;
        let head: Head = crate::text::read_toml(std::str::from_utf8(&rest[..at]).ok()?).ok()?;
        let seeds = Seeds::from_ranges(&head.seeds)?;
        let film = head.about.film.map(|pixels| pixels as usize);
        let sums = Sums::from_bytes(film, seeds.count(), &rest[at + end..])?;
        Some(Self { about: head.about, seeds, cpu_seconds: head.cpu_seconds, sums })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;

    fn shard(first: u32, last: u32) -> Shard {
        let about = About {
            scene: "room".to_owned(),
            film: [32, 32],
            version: "3.9.1".to_owned(),
            ..About::default()
        };
        let mut sums = Sums::new(32, 32);
        (first..=last).for_each(|seed| sums.push(&Image::new(32, 32, [seed as f32 / 7.0; 3])));
        let seeds = Seeds::from_ranges(&[[first, last]]).unwrap();
        Shard { about, seeds, cpu_seconds: 0.5, sums }
    }

    #[test]
    fn a_shard_comes_back_from_its_file_and_a_part_of_the_file_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sums");
        shard(3, 9).write(&path).unwrap();
        assert_eq!(Shard::read(&path).unwrap(), shard(3, 9));
        let content = std::fs::read(&path).unwrap();
        std::fs::write(&path, &content[..content.len() - 1]).unwrap();
        let message = Shard::read(&path).unwrap_err().to_string();
        assert!(message.contains("not a file of sums of passes, or truncated"), "{message}");
    }

    #[test]
    fn merged_shards_are_the_whole_and_seeds_count_once() {
        let mut merged = shard(0, 3);
        merged.merge(&shard(8, 15), Path::new("b")).unwrap();
        merged.merge(&shard(4, 7), Path::new("c")).unwrap();
        assert_eq!(merged.sums, shard(0, 15).sums);
        assert_eq!(merged.seeds.ranges(), [[0, 15]]);
        let message = merged.merge(&shard(15, 20), Path::new("d")).unwrap_err().to_string();
        assert!(message.contains("`d`: duplicate seed 15"), "{message}");
        let mut other = shard(20, 21);
        other.about.version = "3.9.2".to_owned();
        let message = merged.merge(&other, Path::new("e")).unwrap_err().to_string();
        assert!(message.contains("have other settings"), "{message}");
        assert_eq!(merged.seeds.count(), 16);
    }
}
