//! What a write-up shows, as one list: every ladder with the settings of its rungs. All else follows from it.

use super::cast::{BANANA, BOX_BUNNY, COIL, Cast, DRAGON, EMPTY, Role, SPHERES};
use crate::contract::{AdaptiveSettings, Roulette};
use crate::render::Shot;
use crate::stats::Budget;
use std::ops::RangeInclusive;

/// How large figures are, and how many samples those have whose number is not what they show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Effort {
    pub(crate) size: [u32; 2],
    /// What the course's numbers of samples are divided by.
    pub(crate) divisor: u32,
}

impl From<Budget> for Effort {
    fn from(budget: Budget) -> Self {
        match budget {
            Budget::Quick => Self { size: [120, 90], divisor: 8 },
            Budget::Default => Self { size: [240, 180], divisor: 1 },
            Budget::Strict => Self { size: [480, 360], divisor: 1 },
        }
    }
}

impl Effort {
    fn samples(self, usual: u32) -> u32 {
        (usual / self.divisor).max(1)
    }

    /// Of a figure with so many samples, whose number is what it shows: in a hurry it is small, or it would take
    /// longer than all others together.
    fn size_of(self, samples: u32) -> [u32; 2] {
        let is_dear = self.divisor > 1 && samples > 256;
        if is_dear { self.size.map(|side| side.div_ceil(2)) } else { self.size }
    }
}

/// Figures that differ in one setting.
#[derive(Clone, Debug)]
pub(crate) struct Ladder {
    /// What the files of its figures begin with.
    pub(crate) name: &'static str,
    pub(crate) part: u32,
    pub(crate) title: &'static str,
    /// What to look at.
    pub(crate) says: &'static str,
    pub(crate) rungs: Vec<Rung>,
}

/// One figure.
#[derive(Clone, Debug)]
pub(crate) struct Rung {
    /// Of its file, after the name of the ladder.
    pub(crate) name: String,
    /// Its setting; none where it is the scene.
    pub(crate) label: Option<String>,
    pub(crate) role: Role,
    /// The shot, but for its scene and size.
    settings: Shot,
}

impl Rung {
    /// What is rendered, if the scene is there.
    ///
    /// # Errors
    /// Why it is not.
    pub(super) fn shot(&self, cast: &Cast, effort: Effort) -> Result<Shot, String> {
        let Shot { scene, set, .. } = cast.framed(self.role)?;
        let size = Some(effort.size_of(self.settings.spp));
        Ok(Shot { scene, set, size, ..self.settings.clone() })
    }
}

/// Up to one bounce, by one sample of each light.
fn direct(spp: u32, light_samples: u32) -> Shot {
    Shot { spp, light_samples, bounces: Some(0..=1), ..Shot::of("") }
}

/// Up to five bounces.
fn global(spp: u32, light_samples: u32) -> Shot {
    Shot { bounces: Some(0..=5), ..direct(spp, light_samples) }
}

fn rung(role: Role, name: impl ToString, label: impl ToString, settings: Shot) -> Rung {
    Rung { name: name.to_string(), label: Some(label.to_string()), role, settings }
}

/// One of several that differ in their scene.
fn scene(role: Role, settings: Shot) -> Rung {
    Rung { name: role.name.to_owned(), label: None, role, settings }
}

/// Every ladder, in the order of the course. The numbers are those of the write-ups that students hand in.
pub(crate) fn ladders(effort: Effort) -> Vec<Ladder> {
    let mut ladders = vec![normals()];
    ladders.extend([hemisphere(effort), light_rays()]);
    ladders.extend([accumulated(effort), isolated(effort), direct_and_indirect(effort)]);
    ladders.extend(SYSTEMS.iter().map(|system| system.ladder(effort)));
    ladders.extend([samples(effort), adaptive(effort)]);
    ladders
}

fn normals() -> Ladder {
    let settings = Shot { normals: true, ..Shot::of("") };
    let roles = [SPHERES, EMPTY, COIL, BANANA, BOX_BUNNY];
    Ladder {
        name: "normals",
        part: 1,
        title: "Surface normals",
        says: "Shading normals at pixel centres as colours, (n + 1) / 2: x is red, y green, z blue.",
        rungs: roles.map(|role| scene(role, settings.clone())).to_vec(),
    }
}

fn hemisphere(effort: Effort) -> Ladder {
    let efforts = [(16, 8), (64, 32)];
    let mut rungs = Vec::new();
    for role in [SPHERES, BOX_BUNNY] {
        for (spp, rays) in efforts {
            for (hemisphere, by) in [(true, "hemisphere"), (false, "light")] {
                let name = format!("{}-{by}-{spp}-{rays}", role.name);
                let (spp, rays) = (effort.samples(spp), effort.samples(rays));
                let settings = Shot { hemisphere, ..direct(spp, rays) };
                let label = format!("{by} sampling, s = {spp}, l = {rays}");
                rungs.push(rung(role, name, label, settings));
            }
        }
    }
    let (spp, rays) = (effort.samples(64), effort.samples(32));
    let label = format!("light sampling, s = {spp}, l = {rays}");
    rungs.push(rung(DRAGON, "dragon-light-64-32", label, direct(spp, rays)));
    Ladder {
        name: "direct",
        part: 3,
        title: "Hemisphere and light sampling",
        says: "Direct light. Both estimate the same integral: the means should agree, the noise need not.",
        rungs,
    }
}

fn light_rays() -> Ladder {
    let one = |rays: u32| rung(SPHERES, rays, format!("l = {rays}"), direct(1, rays));
    Ladder {
        name: "light-rays",
        part: 3,
        title: "Soft shadows by light rays",
        says: "Light sampling with one sample per pixel and a growing number of shadow rays.",
        rungs: [1, 4, 16, 64].map(one).to_vec(),
    }
}

/// The depths of each ladder of global illumination.
const DEPTHS: RangeInclusive<u32> = 0..=5;

fn accumulated(effort: Effort) -> Ladder {
    let one = |m: u32| {
        let settings = Shot { bounces: Some(0..=m), ..global(effort.samples(64), 4) };
        rung(SPHERES, m, format!("m = {m}"), settings)
    };
    Ladder {
        name: "depth",
        part: 4,
        title: "Maximum depth, bounces accumulated",
        says: "All light of up to m bounces; each step should add less.",
        rungs: DEPTHS.map(one).collect(),
    }
}

fn isolated(effort: Effort) -> Ladder {
    let one = |m: u32| {
        let settings = Shot { bounces: Some(m..=m), ..global(effort.samples(64), 4) };
        rung(SPHERES, m, format!("bounce {m} alone"), settings)
    };
    Ladder {
        name: "bounce",
        part: 4,
        title: "Each bounce alone, not accumulated",
        says: "Light of exactly m bounces: together they should be the image of all.",
        rungs: DEPTHS.map(one).collect(),
    }
}

fn direct_and_indirect(effort: Effort) -> Ladder {
    let shown =
        [("direct", "direct light alone", 0..=1), ("indirect", "indirect light alone", 2..=5)];
    let one = |role: Role, (name, label, bounces): (&str, &str, RangeInclusive<u32>)| {
        let settings = Shot { bounces: Some(bounces), ..global(effort.samples(64), 4) };
        rung(role, format!("{}-{name}", role.name), label, settings)
    };
    let of = |role: Role| shown.clone().map(|what| one(role, what));
    Ladder {
        name: "light",
        part: 4,
        title: "Direct and indirect light",
        says: "Emission and one bounce, and bounces 2 to 5.",
        rungs: [SPHERES, BOX_BUNNY].into_iter().flat_map(of).collect(),
    }
}

/// Russian roulette as one of the write-ups has it.
struct System {
    name: &'static str,
    title: &'static str,
    roulette: Roulette,
}

const SYSTEMS: [System; 4] = [
    System {
        name: "roulette-30",
        title: "Russian roulette, stop 0.3 after one guaranteed bounce",
        roulette: Roulette { stop: 0.3, guaranteed: 1 },
    },
    System {
        name: "roulette-35",
        title: "Russian roulette, stop 0.35 from the first bounce",
        roulette: Roulette { stop: 0.35, guaranteed: 0 },
    },
    System {
        name: "roulette-40",
        title: "Russian roulette, stop 0.4 after one guaranteed bounce",
        roulette: Roulette { stop: 0.4, guaranteed: 1 },
    },
    System {
        name: "roulette-5",
        title: "Russian roulette, stop 0.05 after one guaranteed bounce",
        roulette: Roulette { stop: 0.05, guaranteed: 1 },
    },
];

impl System {
    fn ladder(&self, effort: Effort) -> Ladder {
        let one = |m: u32| {
            let roulette = Some(self.roulette);
            let spp = effort.samples(64);
            let settings = Shot { bounces: Some(0..=m), roulette, ..global(spp, 4) };
            rung(SPHERES, m, format!("m = {m}"), settings)
        };
        Ladder {
            name: self.name,
            part: 4,
            title: self.title,
            says: "Survivors are divided by the survival probability: each mean should be that of the same \
                   depth without roulette, with more noise.",
            rungs: DEPTHS.chain([100]).map(one).collect(),
        }
    }
}

fn samples(effort: Effort) -> Ladder {
    let one = |s: u32| {
        let [width, height] = effort.size_of(s);
        let size = match [width, height] == effort.size {
            true => String::new(),
            false => format!(", {width} × {height} pixels"),
        };
        rung(SPHERES, s, format!("s = {s}{size}"), global(s, 4))
    };
    Ladder {
        name: "samples",
        part: 4,
        title: "Samples per pixel",
        says: "Four light rays. Four times the samples should halve the noise; the mean should stay.",
        rungs: [1, 2, 4, 8, 16, 64, 1024].map(one).to_vec(),
    }
}

fn adaptive(effort: Effort) -> Ladder {
    let one = |role: Role| {
        let spp = effort.samples(2048);
        let adaptive = Some(AdaptiveSettings::default());
        let settings = Shot { adaptive, ..global(spp, 1) };
        scene(role, settings)
    };
    Ladder {
        name: "adaptive",
        part: 5,
        title: "Adaptive sampling",
        says: "After every batch of 32 samples a pixel stops if 1.96 σ/√n ≤ 0.05 μ. Beside each image \
               its sample rate: purple pixels stop early, yellow ones take every sample.",
        rungs: [SPHERES, BOX_BUNNY, DRAGON].map(one).to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_figures_have_one_file() {
        for budget in [Budget::Quick, Budget::Default, Budget::Strict] {
            let ladders = ladders(budget.into());
            let names = ladders.iter().flat_map(|ladder| {
                ladder.rungs.iter().map(|rung| format!("{}-{}", ladder.name, rung.name))
            });
            let names: Vec<_> = names.collect();
            assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
        }
    }
}
