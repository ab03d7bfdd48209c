//! The page of images that were compared: what with what, the verdicts, the images in the viewer of the report, and the
//! metrics. It stands alone.

use super::assets::{STYLE, pages_script, viewer_script};
use super::develop::{Look, Shows};
use super::parts::{badge, command, scrolls};
use super::shell::{Document, icon};
use super::viewer::{Frame, Noisy, look, viewer};
use super::{ReportError, light_enough, put};
use crate::checks::RejectedCell;
use crate::image::metric::METRICS;
use crate::image::pair::Plane;
use crate::image::{Image, luminance};
use crate::report::comparison::{Compared, Comparisons, evidence, statement, value};
use crate::stats::{Extent, OddCell, Pattern, Verdict};
use crate::text::number::figure;
use maud::{Markup, PreEscaped, html};
use std::path::Path;

/// What the viewer is called in addresses.
const VIEWER: &str = "images";
/// As [`OddCell`] numbers them.
const COMPONENTS: [&str; 4] = ["red", "green", "blue", "luminance"];

/// The page, before it is text.
pub(crate) struct Page<'a> {
    pub(crate) comparisons: &'a Comparisons,
    /// In the order of the comparisons.
    pub(crate) images: Vec<Pixels>,
    pub(crate) reference: Pixels,
    /// What was typed.
    pub(crate) command: String,
}

/// The pixels of one side.
pub(crate) struct Pixels {
    pub(crate) image: Image,
    /// Of each value, if it is known.
    pub(crate) standard_error: Option<Image>,
    /// FLIP of each pixel, of an image if it was measured.
    pub(crate) flip: Option<Plane>,
    /// Whether it came from a file of codes, which are shown as they are.
    pub(crate) is_coded: bool,
}

impl Page<'_> {
    /// Writes the page, whole or not at all.
    ///
    /// # Errors
    /// On an I/O error.
    pub(crate) fn write(&self, path: &Path) -> Result<(), ReportError> {
        put(path, &light_enough(|longest| self.render(longest))).map(drop)
    }

    /// The text of the page, its images no longer than this.
    fn render(&self, longest: usize) -> String {
        let verdict = self.verdict();
        let body = html! {
            (self.header())
            main #main {
                @for compared in &self.comparisons.images { (self.judgement(compared)) }
                section aria-labelledby="images-heading" {
                    h2 #images-heading { "Images" }
                    (self.viewer(longest))
                }
                section aria-labelledby="metrics-heading" {
                    h2 #metrics-heading { "Metrics" }
                    (self.metrics())
                }
                section aria-labelledby="again-heading" {
                    h2 #again-heading { "Again" }
                    (command(&self.command))
                }
            }
            script { (PreEscaped(pages_script())) }
            script { (PreEscaped(viewer_script())) }
        };
        let style = html! { style { (PreEscaped(STYLE)) } };
        let icon = icon(verdict == Verdict::Fail, verdict == Verdict::Pass);
        Document { title: format!("{} · furnace", self.title()), icon, style, body }.render()
    }

    /// The worst of all images.
    fn verdict(&self) -> Verdict {
        let worst = [Verdict::Fail, Verdict::Inconclusive];
        let has = |verdict: &Verdict| self.with(*verdict).next().is_some();
        worst.into_iter().find(has).unwrap_or(Verdict::Pass)
    }

    fn with(&self, verdict: Verdict) -> impl Iterator<Item = &Compared> {
        self.comparisons.images.iter().filter(move |one| one.comparison.verdict == verdict)
    }

    /// The result.
    fn title(&self) -> String {
        let reference = short(&self.comparisons.reference);
        let (count, verdict) = (self.comparisons.images.len(), self.verdict());
        let with = self.with(verdict).count();
        match (&self.comparisons.images[..], verdict) {
            ([one], Verdict::Fail) => format!("{} differs from {reference}", name(one)),
            ([one], Verdict::Pass) => {
                format!("{} does not differ from {reference} beyond noise", name(one))
            }
            ([one], Verdict::Inconclusive) => {
                format!("Whether {} differs from {reference} is undecided", name(one))
            }
            (_, Verdict::Fail) => format!("{with} of {count} images differ from {reference}"),
            (_, Verdict::Pass) => {
                format!("None of {count} images differs from {reference} beyond noise")
            }
            (_, Verdict::Inconclusive) => {
                format!("Whether {with} of {count} images differ from {reference} is undecided")
            }
        }
    }

    fn header(&self) -> Markup {
        let [width, height] = self.reference.image.size();
        html! {
            a.skip href="#main" { "Skip to the results" }
            header {
                h1 { (self.title()) }
                p.facts {
                    "reference " code { (self.comparisons.reference) }
                    " · " (width) " × " (height) " pixels"
                    " · each image is compared with the reference, by itself"
                }
                button #theme.scripted type="button" { "light / dark" }
            }
        }
    }

    fn judgement(&self, compared: &Compared) -> Markup {
        let comparison = &compared.comparison;
        html! {
            article.card {
                p.kicker {
                    (badge(comparison.verdict.into())) " · " b { (compared.name()) }
                    " against " (self.comparisons.reference)
                }
                p.said.statement { (statement(comparison)) }
                @for words in evidence(comparison) { p.said.faint { (words) } }
                @for (number, (pattern, place)) in places(compared).enumerate() {
                    (if number == 0 { "Where it is largest: " } else { ", " })
                    a href=(region(place)) { (pattern) }
                }
            }
        }
    }

    /// The reference, the images, and where FLIP sees them differ; the viewer works out the other errors.
    fn viewer(&self, longest: usize) -> Markup {
        let reference =
            frame(&self.comparisons.reference, Shows::Reference, &self.reference, longest);
        let images = self.comparisons.images.iter().zip(&self.images);
        let rejected: Vec<_> =
            images.clone().map(|(one, pixels)| self.rejected(one, pixels)).collect();
        let renders = images.clone().zip(&rejected).map(|((compared, pixels), rejected)| Frame {
            rejected,
            ..frame(&compared.name(), Shows::Render, pixels, longest)
        });
        let flips = images.filter_map(|(compared, pixels)| flip(compared, pixels, longest));
        let frames: Vec<_> = std::iter::once(reference).chain(renders).chain(flips).collect();
        // Codes are shown as any other program shows them.
        let look = if self.reference.is_coded { Look { stops: 0.0 } } else { look(&frames) };
        viewer(&frames, VIEWER, look)
    }

    /// The cells that stand out by themselves, with their means.
    fn rejected(&self, compared: &Compared, pixels: &Pixels) -> Vec<RejectedCell> {
        let told = |pattern: Pattern, odd: &OddCell| {
            let Extent { x, y, width, height } = odd.extent;
            let mean = |image: &Image| mean(image, [x, y, width, height], odd.component);
            RejectedCell {
                scale: pattern.to_string(),
                component: COMPONENTS[odd.component].to_owned(),
                extent: [x, y, width, height],
                measured: mean(&pixels.image),
                expected: mean(&self.reference.image),
                t: odd.t,
                p: odd.p,
            }
        };
        let patterns = compared.comparison.difference.patterns.iter();
        patterns
            .flat_map(|found| found.odd.iter().map(move |odd| told(found.pattern, odd)))
            .collect()
    }

    fn metrics(&self) -> Markup {
        let images = &self.comparisons.images;
        let names = images.iter().flat_map(|one| &one.comparison.metrics).map(|metric| metric.name);
        let names: Vec<_> =
            METRICS.iter().filter(|of| names.clone().any(|n| n == of.name)).collect();
        let table = html! {
            table.small {
                thead { tr {
                    th scope="col" { "metric" }
                    @for one in images { th.number scope="col" { (name(one)) } }
                    th.number scope="col" { "of equal images" }
                } }
                tbody { @for metric in names { tr {
                    th scope="row" { (metric.name) }
                    @for one in images { td.number { (measured(one, metric.name)) } }
                    td.number { (figure(metric.of_equals)) }
                } } }
            }
        };
        html! {
            div.card {
                (scrolls("metrics", &table))
                p.faint { "Metrics inform: they know no noise, and no verdict rests on them." }
            }
        }
    }
}

/// Of the pixels of a cell; those at the border may be fewer.
fn mean(image: &Image, [x, y, width, height]: [usize; 4], component: usize) -> f64 {
    let rows = image.pixels.chunks(image.width).skip(y).take(height);
    let pixels: Vec<_> = rows.flat_map(|row| row.iter().skip(x).take(width)).collect();
    let value = |pixel: &[f32; 3]| match component {
        3 => luminance(*pixel),
        channel => f64::from(pixel[channel]),
    };
    pixels.iter().map(|pixel| value(pixel)).sum::<f64>() / pixels.len() as f64
}

/// The number of a metric; nothing where it says nothing of these images.
fn measured(compared: &Compared, name: &str) -> String {
    let found = compared.comparison.metrics.iter().find(|metric| metric.name == name);
    found.map(value).unwrap_or_default()
}

/// Where differences of a kind are largest.
fn places(compared: &Compared) -> impl Iterator<Item = (String, Extent)> {
    let patterns = compared.comparison.difference.patterns.iter().filter(|found| found.rejects);
    patterns.filter_map(|found| Some((found.pattern.to_string(), found.worst?)))
}

/// The address of the viewer with a region chosen.
fn region(place: Extent) -> String {
    let Extent { x, y, width, height } = place;
    format!("#{VIEWER}?region={x}+{y}+{width}+{height}")
}

fn frame<'a>(file: &str, shows: Shows, pixels: &Pixels, longest: usize) -> Frame<'a> {
    let noise = if pixels.standard_error.is_some() { "noise known" } else { "noise unknown" };
    let role =
        if shows == Shows::Reference { "the reference" } else { "compared with the reference" };
    let noisy = Noisy {
        standard_error: pixels.standard_error.clone(),
        ..Noisy::alone(pixels.image.clone())
    };
    Frame {
        label: short(file),
        caption: format!("{role}, {noise}"),
        shows,
        rejected: &[],
        image: Ok(noisy.shrunk_to(longest)),
        source: html! { code { (file) } },
    }
}

fn flip<'a>(compared: &Compared, pixels: &Pixels, longest: usize) -> Option<Frame<'a>> {
    let plane = pixels.flip.as_ref()?;
    let of = if compared.comparison.clipped.is_some() { "FLIP" } else { "HDR-FLIP" };
    let image = Image {
        width: plane.width,
        height: plane.height,
        pixels: plane.values.iter().map(|error| [*error; 3]).collect(),
    };
    let noisy = Noisy::alone(image);
    Some(Frame {
        label: format!("{of} of {}", name(compared)),
        caption: format!("{of} of each pixel, from 0 to 1"),
        shows: Shows::Flip,
        rejected: &[],
        image: Ok(noisy.shrunk_to(longest)),
        source: html! { code { (compared.name()) } },
    })
}

fn name(compared: &Compared) -> String {
    short(&compared.name())
}

/// The last two parts of a path: who compares renderers has files of one name in several folders.
fn short(path: &str) -> String {
    let parts: Vec<_> = path.rsplitn(3, ['/', '\\']).take(2).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_path_is_called_by_its_end() {
        assert_eq!(short("image.png"), "image.png");
        assert_eq!(short("/home/ada/renders/mine/image.png"), "mine/image.png");
    }
}
