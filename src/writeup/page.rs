//! What the pages say, whatever they are written in: sections with figures, tables and commands. All images of one
//! scene are developed with one exposure.

use super::bvh::{Timed, Traced};
use super::develop::{Developed, Exposures, developed, exposures};
use super::ladder::Ladder;
use super::store::{Figure, Store};
use super::{Plan, Row, WriteupError};
use crate::contract::Precision;
use crate::render::{Shot, renders_codes_alone};
use crate::text::number::{self, count, figure, percent, plus_minus};

pub(super) struct Page {
    pub(super) title: String,
    pub(super) facts: Vec<String>,
    pub(super) sections: Vec<Section>,
}

pub(super) struct Section {
    pub(super) title: String,
    pub(super) says: String,
    /// Beside figures the same numbers in columns.
    pub(super) table: Table,
    pub(super) figures: Vec<Shown>,
}

pub(super) struct Table {
    pub(super) head: &'static [&'static str],
    pub(super) rows: Vec<Line>,
}

impl Table {
    /// Every command, in the order of the rows.
    pub(super) fn commands(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().flat_map(|line| &line.commands).map(String::as_str)
    }
}

/// A row of a table: its cells, or its first cell and why there are no others.
pub(super) struct Line {
    pub(super) label: String,
    pub(super) cells: Result<Vec<String>, String>,
    /// The commands that make it.
    pub(super) commands: Vec<String>,
}

/// A figure that was made, one image or two.
pub(super) struct Shown {
    pub(super) label: String,
    /// Scene, samples, depth, seconds.
    pub(super) facts: String,
    pub(super) images: Vec<Developed>,
}

/// Lines in a row that lack the same are one, which says all their labels.
fn folded(lines: &[Line]) -> Vec<Line> {
    let alike = lines.chunk_by(|one, next| one.cells.is_err() && one.cells == next.cells);
    let fold = |alike: &[Line]| {
        let labels: Vec<_> = alike.iter().map(|line| line.label.as_str()).collect();
        let commands = alike.iter().flat_map(|line| line.commands.clone()).collect();
        Some(Line { label: labels.join(", "), cells: alike.first()?.cells.clone(), commands })
    };
    alike.filter_map(fold).collect()
}

impl Page {
    /// # Errors
    /// If an image cannot be written.
    pub(super) fn new(
        plan: &Plan<'_>,
        store: &Store,
        meshes: &[Row<Timed>],
        ladders: &[(Vec<Row<Figure>>, Ladder)],
    ) -> Result<Self, WriteupError> {
        let exposures = exposures(store, ladders.iter().flat_map(|(rows, _)| rows));
        let mut sections = Vec::new();
        for (rows, ladder) in ladders {
            // Part 2 has no images: it comes before the first ladder of a later part.
            if ladder.part > 1 && sections.len() == 1 {
                sections.push(bvh(meshes));
            }
            sections.push(of_ladder(store, rows, ladder, &exposures)?);
        }
        Ok(Self { title: format!("Write-up of {}", plan.core), facts: facts(plan), sections })
    }
}

fn facts(plan: &Plan<'_>) -> Vec<String> {
    let info = &plan.info;
    let [width, height] = plan.effort.size;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let arch = std::env::consts::ARCH;
    let exposed = match renders_codes_alone(info) {
        true => "8 bits as the core writes them",
        false => "each scene at one exposure throughout",
    };
    let precision = match info.precision {
        Precision::Single => "single",
        Precision::Double => "double",
    };
    let roles = plan.roles();
    vec![
        format!("Core: {} {}, {precision} precision.", info.name, info.version),
        format!("Figures: {width} × {height} pixels, {exposed}."),
        plan.cast.told(roles.into_iter()),
        format!("Times: wall clock, without the build, on {} ({arch}).", count(threads, "thread")),
        "Words: s samples per pixel, l light rays to each area light at each vertex (with hemisphere \
         sampling, directions for each light), m the maximum depth."
            .to_owned(),
        "Mean and noise: luminance of the whole image with its standard error; the mean standard \
         error of a pixel over that luminance, from how passes differ."
            .to_owned(),
    ]
}

fn of_ladder(
    store: &Store,
    rows: &[Row<Figure>],
    ladder: &Ladder,
    exposures: &Exposures,
) -> Result<Section, WriteupError> {
    let mut figures = Vec::new();
    for row in rows {
        figures.extend(shown(store, row, exposures)?);
    }
    let head = &["figure", "scene", "s", "l", "depth", "time", "mean", "noise"];
    let table = Table { head, rows: folded(&rows.iter().map(line).collect::<Vec<_>>()) };
    let title = format!("Part {}: {}", ladder.part, ladder.title);
    Ok(Section { title, says: ladder.says.to_owned(), table, figures })
}

fn line(row: &Row<Figure>) -> Line {
    let cells = match (&row.shot, &row.result) {
        (Some(shot), Ok(figure)) => Ok(cells(shot, figure)),
        (_, Err(why)) => Err(why.clone()),
        (None, Ok(_)) => Err("no scene".to_owned()),
    };
    let commands = if row.command.is_empty() { Vec::new() } else { vec![row.command.clone()] };
    Line { label: row.label.clone(), cells, commands }
}

fn cells(shot: &Shot, figure: &Figure) -> Vec<String> {
    let measured = &figure.measured;
    let samples = match measured.samples {
        _ if shot.normals => "1".to_owned(),
        Some(mean) => format!("{} of {}", self::figure(mean), shot.spp),
        None => shot.spp.to_string(),
    };
    let rays = if shot.normals { "–".to_owned() } else { shot.light_samples.to_string() };
    let mean = match measured.mean {
        _ if shot.normals => "–".to_owned(),
        None => "–".to_owned(),
        Some((mean, None)) => self::figure(mean),
        Some((mean, Some(error))) => plus_minus(mean, error),
    };
    let noise = measured.noise.map_or_else(|| "–".to_owned(), percent);
    vec![scene_name(shot), samples, rays, depth(shot), duration(measured.seconds), mean, noise]
}

/// The scene as people call it: of a path the file's name, and its parameters but for the frame, which all have.
fn scene_name(shot: &Shot) -> String {
    let path = std::path::Path::new(&shot.scene);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let told = shot.set.iter().filter(|(parameter, _)| parameter != "film");
    told.fold(name, |name, (parameter, value)| format!("{name}, {parameter} {value}"))
}

fn depth(shot: &Shot) -> String {
    match shot.bounces.as_ref().map(|bounces| (*bounces.start(), *bounces.end())) {
        _ if shot.normals => "–".to_owned(),
        None => "–".to_owned(),
        Some((0, last)) => format!("m = {last}"),
        Some((first, last)) if first == last => format!("{last} alone"),
        Some((first, last)) => format!("{first} to {last}"),
    }
}

fn shown(
    store: &Store,
    row: &Row<Figure>,
    exposures: &Exposures,
) -> Result<Option<Shown>, WriteupError> {
    let (Some(shot), Ok(figure)) = (&row.shot, &row.result) else { return Ok(None) };
    let stops = exposures.get(&shot.scene).copied().unwrap_or(0.0);
    let images = developed(store, figure, shot, stops)?;
    let label = row.label.clone();
    let facts = caption(&label, shot, figure, stops);
    Ok(Some(Shown { label, facts, images }))
}

/// Scene, samples, depth, seconds and exposure, without what the label says.
fn caption(label: &str, shot: &Shot, figure: &Figure, stops: f32) -> String {
    let (mut facts, scene) = (Vec::new(), scene_name(shot));
    if !label.starts_with(&scene) {
        facts.push(scene);
    }
    if !shot.normals {
        facts.push(match figure.measured.samples {
            Some(mean) => format!("s = {} of {} on average", self::figure(mean), shot.spp),
            None => format!("s = {}", shot.spp),
        });
        facts.extend([format!("l = {}", shot.light_samples), depth(shot)]);
    }
    facts.push(duration(figure.measured.seconds));
    if !shot.normals && figure.measured.mean.is_some() {
        facts.push(format!("exposure {stops:+} stops"));
    }
    facts.extend(figure.measured.breach.clone());
    facts.join(", ")
}

fn bvh(meshes: &[Row<Timed>]) -> Section {
    let head = &[
        "scene",
        "primitives",
        "rays",
        "build",
        "with the BVH",
        "without",
        "speed-up",
        "tests a ray with",
        "without",
        "boxes a ray",
    ];
    Section {
        title: "Part 2: BVH".to_owned(),
        says: "The camera rays of an image through the BVH, and against every primitive in turn. Where \
               that takes long it is timed on some of the rays, and their time stands for all."
            .to_owned(),
        table: Table { head, rows: meshes.iter().map(mesh).collect() },
        figures: Vec::new(),
    }
}

fn mesh(row: &Row<Timed>) -> Line {
    let cells = row.result.as_ref().map(mesh_cells).map_err(Clone::clone);
    let without = row.shot.as_ref().map(|_| format!("{} --brute-force", row.command));
    let with = Some(row.command.clone()).filter(|command| !command.is_empty());
    Line { label: row.label.clone(), cells, commands: with.into_iter().chain(without).collect() }
}

fn mesh_cells(timed: &Timed) -> Vec<String> {
    let tests = |traced: &Traced, which: usize| {
        let counted = traced.tests.map(|tests| tests[which]).filter(|tests| *tests > 0.0);
        counted.map_or_else(|| "not counted".to_owned(), figure)
    };
    let [without, tests_without] = match &timed.without {
        Ok(traced) => [seconds_of_all(traced, timed.rays), tests(traced, 0)],
        Err(why) => [why.clone(), "–".to_owned()],
    };
    let speed_up =
        timed.speed_up().map_or_else(|| "–".to_owned(), |times| format!("{}×", figure(times)));
    let differ = match timed.different {
        0 => speed_up,
        rays => format!("{speed_up}, but {} differ", count(rays, "hit")),
    };
    vec![
        timed.triangles.to_string(),
        timed.rays.to_string(),
        duration(timed.build_seconds),
        duration(timed.with.seconds),
        without,
        differ,
        tests(&timed.with, 0),
        tests_without,
        tests(&timed.with, 1),
    ]
}

/// Three digits of short times: a ladder is compared step by step.
fn duration(seconds: f64) -> String {
    match seconds {
        ..0.1 => format!("{} ms", figure(1e3 * seconds)),
        0.1..10.0 => format!("{} s", figure(seconds)),
        _ => number::duration(seconds),
    }
}

fn seconds_of_all(traced: &Traced, rays: usize) -> String {
    let seconds = duration(traced.seconds * rays as f64 / traced.rays as f64);
    match traced.rays == rays {
        true => seconds,
        false => format!("{seconds}, by {} rays", traced.rays),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_in_a_row_that_lack_the_same_are_one() {
        let line = |label: &str, cells: Result<&str, &str>| Line {
            label: label.to_owned(),
            cells: cells.map(|cell| vec![cell.to_owned()]).map_err(str::to_owned),
            commands: vec![label.to_owned()],
        };
        let lines = [
            line("m = 0", Ok("1 s")),
            line("m = 1", Ok("1 s")),
            line("m = 2", Err("no roulette")),
            line("m = 3", Err("no roulette")),
            line("m = 4", Err("no roulette")),
            line("m = 5", Err("a crash")),
        ];
        let folded = folded(&lines);
        let labels: Vec<_> = folded.iter().map(|line| line.label.as_str()).collect();
        assert_eq!(labels, ["m = 0", "m = 1", "m = 2, m = 3, m = 4", "m = 5"]);
        assert_eq!(folded[2].commands, ["m = 2", "m = 3", "m = 4"]);
    }
}
