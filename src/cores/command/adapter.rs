//! `adapters/command/<name>.toml`: how a program is called, what it writes, and what it is known to do otherwise.

use crate::contract::Conventions;
use crate::image;
use crate::scene::format::Format;
use crate::text::{Diagnostic, Source};
use regex_lite::Regex;
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use std::collections::BTreeMap;

/// The words of a template, and what each stands for.
pub(super) const PLACEHOLDERS: [(&str, &str); 19] = [
    ("program", "the program"),
    ("adapter", "the folder of the adapter's file"),
    ("scene", "the scene's file"),
    ("camera", "the camera's file, for formats that have one"),
    ("folder", "the folder of the scene and the image"),
    ("output", "the image's file"),
    ("width", "width in pixels"),
    ("height", "rows"),
    ("spp", "samples per pixel"),
    ("seed", "seed of the random numbers"),
    ("first-bounce", "the first bounce to add up"),
    ("last-bounce", "the last bounce to add up"),
    ("depth", "the last bounce plus `depth-offset`"),
    ("threads", "maximum number of threads"),
    ("light-samples", "samples per light"),
    ("horizontal-fov", "degrees"),
    ("vertical-fov", "degrees"),
    ("name", "of the scene"),
    ("direct", "the arguments that select hemisphere or light sampling"),
];

/// What an adapter's file says.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Adapter {
    /// What reports call the renderer.
    pub(crate) name: String,
    /// Of the renderer that it was written for.
    pub(crate) version: String,
    /// One line for people.
    #[expect(dead_code, reason = "for who reads the file")]
    pub(crate) about: String,
    /// What scenes are written in.
    pub(crate) scene: Format,
    pub(crate) program: Executable,
    /// What it is given; words in braces are replaced.
    pub(crate) arguments: Vec<String>,
    /// For the environment of the program.
    #[serde(default)]
    pub(crate) environment: BTreeMap<String, String>,
    /// Variables of the user's environment that the program gets to see; others but a few it does not.
    #[serde(default)]
    pub(crate) keeps: Vec<String>,
    /// What `{depth}` adds to the last bounce.
    #[serde(default)]
    pub(crate) depth_offset: u32,
    /// Seconds until a picture is given up.
    pub(crate) time_limit: u32,
    pub(crate) output: Output,
    /// How two pictures become independent.
    pub(crate) runs: Runs,
    /// What it can be asked beyond a picture of all bounces.
    #[serde(default)]
    pub(crate) can: Abilities,
    /// What scenes may say and this program cannot do.
    #[serde(default)]
    pub(crate) lacks: Vec<Feature>,
    /// What it has freely chosen.
    #[serde(default)]
    pub(crate) conventions: Conventions,
    /// What is read from the program's own words.
    #[serde(default)]
    pub(crate) log: LogPatterns,
}

/// Where the program is.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Executable {
    /// An environment variable that names it.
    pub(crate) variable: String,
    /// What is started where that is not set.
    pub(crate) default: String,
    /// What it has to be, for the message where it is not.
    pub(crate) needs: String,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Output {
    /// Its file; the ending says which format: `.exr`, `.pfm`, `.hdr` or `.png`.
    pub(crate) file: String,
    pub(crate) encoding: Encoding,
    #[serde(default)]
    pub(crate) first_row: FirstRow,
}

/// From radiance to what is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Encoding {
    /// Radiance itself.
    Linear,
    /// 8 bits of sRGB, rounded.
    Srgb,
    /// The course's 8 bits: ⌊255 (√2 L)^(1/2.2)⌋.
    Course,
}

impl Encoding {
    /// How codes are made; none where radiance itself is stored.
    pub(crate) fn of_codes(self) -> Option<image::encoding::Encoding> {
        match self {
            Self::Linear => None,
            Self::Srgb => Some(image::encoding::Encoding::of(image::encoding::Curve::Srgb)),
            Self::Course => Some(image::encoding::Encoding::COURSE),
        }
    }
}

/// Which row comes first in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FirstRow {
    /// As in most formats.
    #[default]
    Top,
    /// Upside down, beyond what the format itself prescribes.
    Bottom,
}

/// How two pictures become independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) enum Runs {
    /// `{seed}` is a number of this many bits.
    SeedBits(u32),
    /// The program takes no seed and draws one stream of numbers through the picture: the n-th run has n
    /// samples a pixel more, so that every number meets another sample. The first pixel's first samples are
    /// the same in all of them.
    OneSampleMore,
}

/// What can be asked beyond a picture of all bounces.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct Abilities {
    /// `{first-bounce}` is honoured.
    pub(crate) isolated_bounces: bool,
    /// Arguments that select hemisphere sampling; what `{direct}` stands for then.
    pub(crate) hemisphere: Option<Vec<String>>,
    /// The same command gives the same bits.
    pub(crate) deterministic: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Feature {
    Mirror,
    Glass,
    /// Glass whose reflectance or transmittance is not one.
    TintedGlass,
    RoughMetal,
    RoughGlass,
    PointLight,
    DirectionalLight,
    ConstantSky,
    GradientSky,
    SphereLight,
    EmissiveSurface,
    InwardSphere,
    /// Light sampling of area lights by the pdf of directions; hemisphere sampling needs none.
    AreaLightPdf,
}

/// Patterns with one group, a number.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct LogPatterns {
    /// Seconds of rendering, by whichever clock the program has.
    pub(crate) seconds: Option<Pattern>,
    pub(crate) rays: Option<Pattern>,
    /// Boxes and primitives tested for one ray.
    pub(crate) tests_per_ray: Option<Pattern>,
}

/// A regular expression with one group.
#[derive(Clone, Debug)]
pub(crate) struct Pattern(pub(crate) Regex);

impl<'de> Deserialize<'de> for Pattern {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let regex = Regex::new(&text).map_err(D::Error::custom)?;
        match regex.captures_len() {
            2 => Ok(Self(regex)),
            groups => Err(D::Error::custom(format!("`{text}` has {} groups, not one", groups - 1))),
        }
    }
}

impl Adapter {
    /// Reads an adapter's file.
    ///
    /// # Errors
    /// If it says something that is not known, or does not fit together.
    pub(crate) fn parse(source: &Source) -> Result<Self, Diagnostic> {
        let adapter: Self = source.parse_toml()?;
        match adapter.complaint() {
            None => Ok(adapter),
            Some(complaint) => {
                let at = source.text.find(&complaint.word).unwrap_or(0);
                Err(source.diagnostic(at..at + complaint.word.len(), complaint.message))
            }
        }
    }

    fn complaint(&self) -> Option<Complaint> {
        for argument in self.arguments.iter().chain(self.environment.values()) {
            if let Some(word) = unknown_placeholder(argument) {
                let known: Vec<_> = PLACEHOLDERS.iter().map(|(name, _)| *name).collect();
                let message = format!(
                    "unknown placeholder `{{{word}}}`; the placeholders are {}",
                    crate::text::listed(known)
                );
                return Some(Complaint { word, message });
            }
        }
        let templates = || self.arguments.iter().chain(self.environment.values());
        let has = |word: &str| templates().any(|template| template.contains(word));
        let complain = |word: &str, message: &str| {
            Some(Complaint { word: word.to_owned(), message: message.to_owned() })
        };
        match self.runs {
            Runs::SeedBits(bits) if !(1..=64).contains(&bits) => {
                return complain("seed-bits", "a seed has 1 to 64 bits");
            }
            Runs::SeedBits(_) if !has("{seed}") && self.scene != Format::Pbrt => {
                return complain("seed-bits", "`{seed}` does not occur in the arguments");
            }
            _ => {}
        }
        if self.can.hemisphere.is_some() && !self.arguments.iter().any(|a| a == "{direct}") {
            return complain("hemisphere", "`{direct}` is not an argument of its own");
        }
        if self.can.isolated_bounces && !has("{first-bounce}") {
            return complain(
                "isolated-bounces",
                "`{first-bounce}` does not occur in the arguments",
            );
        }
        let ending = self.output.file.rsplit_once('.').map_or("", |(_, ending)| ending);
        match (ending, self.output.encoding) {
            ("exr" | "pfm" | "hdr", Encoding::Linear) => None,
            ("png", Encoding::Srgb | Encoding::Course) => None,
            ("exr" | "pfm" | "hdr", _) => {
                complain("encoding", "files of this format hold radiance: `linear`")
            }
            ("png", _) => complain("encoding", "a PNG has 8 bits: `srgb` or `course`"),
            _ => complain("file", "the image must be an .exr, .pfm, .hdr or .png"),
        }
    }
}

struct Complaint {
    /// Where it is, as it stands in the file.
    word: String,
    message: String,
}

/// The first word in braces that stands for nothing.
fn unknown_placeholder(text: &str) -> Option<String> {
    let words = text.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
    let is_known = |word: &str| PLACEHOLDERS.iter().any(|(name, _)| *name == word);
    words.map(|(word, _)| word).find(|word| !is_known(word)).map(str::to_owned)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// An adapter that is in order.
    pub(crate) const GOOD: &str = r#"
name = "sh"
version = "1"
about = "A shell"
scene = "mitsuba"
arguments = ["-c", "true", "{scene}", "{output}", "{seed}"]
time-limit = 5
program = { variable = "FURNACE_TEST_SHELL", default = "sh", needs = "a shell" }
output = { file = "picture.pfm", encoding = "linear" }
runs = { seed-bits = 31 }
"#;

    fn parse(text: &str) -> Result<Adapter, String> {
        Adapter::parse(&Source::new("sh.toml", text)).map_err(|error| error.to_string())
    }

    #[test]
    fn an_adapter_in_order_is_read() {
        let adapter = parse(GOOD).unwrap();
        assert_eq!(adapter.runs, Runs::SeedBits(31));
        assert_eq!(adapter.output.first_row, FirstRow::Top);
    }

    #[test]
    fn what_is_wrong_is_pointed_at() {
        for (from, to, message) in [
            ("{scene}", "{scenes}", "unknown placeholder `{scenes}`"),
            ("name = \"sh\"", "name = \"sh\"\nnames = 1", "unknown field `names`"),
            ("{seed}", "1", "`{seed}` does not occur"),
            ("linear", "srgb", "files of this format hold radiance"),
            ("picture.pfm", "picture.png", "a PNG has 8 bits"),
            ("picture.pfm", "picture.jpg", "an .exr, .pfm, .hdr or .png"),
            ("{ seed-bits = 31 }", "{ seed-bits = 0 }", "1 to 64 bits"),
            ("\nruns", "\ncan = { hemisphere = [\"-H\"] }\nruns", "`{direct}` is not an argument"),
            ("\nruns", "\ncan = { isolated-bounces = true }\nruns", "`{first-bounce}`"),
            ("\nruns", "\nlog = { seconds = \"no group\" }\nruns", "has 0 groups"),
        ] {
            assert!(GOOD.contains(from), "{from}");
            let error = parse(&GOOD.replacen(from, to, 1)).expect_err(message);
            assert!(error.contains(message) && error.contains("sh.toml:"), "{error}");
        }
    }
}
