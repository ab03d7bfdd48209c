//! What every plot has around its drawing: a title, the words beside it, and the legend of its marks.

use maud::{Markup, html};

/// A plot with the words beside it.
pub(in crate::report::html) struct Figure {
    pub(super) title: String,
    pub(super) drawing: Markup,
    /// What each kind of mark is, by its class and its shape.
    pub(super) legend: Vec<(Mark, String)>,
    /// What is there, in numbers.
    pub(super) found: String,
    /// What one should see, and what it means where one does not; empty where the plot above has said it.
    pub(super) should: &'static str,
    /// Values that are not finite, or have no place on a logarithmic axis.
    pub(super) left_out: usize,
}

/// A kind of mark: the class that colours it, and its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Mark {
    pub(super) class: &'static str,
    pub(super) shape: Shape,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Circle,
    /// A square, open and so large that others are seen in it.
    Frame,
    Square,
    Triangle,
    Line,
    Area,
    Outline,
}

impl Mark {
    pub(super) const fn new(class: &'static str, shape: Shape) -> Self {
        Self { class, shape }
    }

    /// The mark around a place.
    pub(super) fn at(self, x: f64, y: f64, title: &str) -> Markup {
        let shape = match self.shape {
            Shape::Circle => "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0z",
            Shape::Frame => "m-4.5-4.5h9v9h-9z",
            Shape::Square => "m-2.7-2.7h5.4v5.4h-5.4z",
            Shape::Triangle => "m-3.2 2.5l3.2-5.8l3.2 5.8z",
            Shape::Line => "m-9 0h18",
            Shape::Area | Shape::Outline => "m-8-4h16v8h-16z",
        };
        html! {
            path class={ (self.class) " " (self.kind()) } d={ "M" (px(x)) " " (px(y)) (shape) } {
                @if !title.is_empty() { title { (title) } }
            }
        }
    }

    pub(super) const fn kind(self) -> &'static str {
        match self.shape {
            Shape::Circle | Shape::Square | Shape::Triangle => "mark",
            Shape::Line | Shape::Frame => "line",
            Shape::Area => "area",
            Shape::Outline => "outline",
        }
    }
}

impl Figure {
    pub(in crate::report::html) fn markup(&self) -> Markup {
        html! {
            figure.plot {
                div.drawing {
                    p.plot-title { (self.title) }
                    (self.drawing)
                    (self.key())
                }
                figcaption {
                    p { (self.found) }
                    @if let Some(words) = left_out(self.left_out) { p.bad { (words) } }
                    @if !self.should.is_empty() {
                        p.faint { b { "What one should see. " } (self.should) }
                    }
                }
            }
        }
    }

    fn key(&self) -> Markup {
        html! {
            @if !self.legend.is_empty() {
                ul.key {
                    @for (mark, words) in &self.legend {
                        li {
                            svg viewBox="0 0 22 12" width="22" height="12" aria-hidden="true" {
                                (mark.at(11.0, 6.0, ""))
                            }
                            (words)
                        }
                    }
                }
            }
        }
    }
}

/// What is not drawn, and why.
fn left_out(values: usize) -> Option<String> {
    let words = match values {
        0 => return None,
        1 => "1 value is not drawn: it is NaN, infinite, or not above 0 on a logarithmic axis."
            .to_owned(),
        _ => format!(
            "{values} values are not drawn: they are NaN, infinite, or not above 0 on a logarithmic axis."
        ),
    };
    Some(words)
}

/// A drawing of this size, which says in words what it shows.
pub(super) fn svg(
    [width, height]: [f64; 2],
    title: &str,
    description: &str,
    marks: &Markup,
) -> Markup {
    html! {
        svg role="img" viewBox={ "0 0 " (px(width)) " " (px(height)) } {
            title { (title) }
            desc { (description) }
            (marks)
        }
    }
}

/// A length, to a tenth.
pub(super) fn px(length: f64) -> String {
    let text = format!("{length:.1}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}
