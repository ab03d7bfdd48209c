//! A plot with two axes: its frame, its ticks, and the marks in it.

use super::figure::{Mark, px, svg};
use super::scale::Scale;
use maud::{Markup, html};
use std::ops::RangeInclusive;

const SIZE: [f64; 2] = [360.0, 224.0];
/// Where the axes end: left and right, top and bottom.
const X: [f64; 2] = [56.0, 350.0];
const Y: [f64; 2] = [24.0, 182.0];
/// A bar that is thinner is not seen.
const THINNEST: f64 = 1.5;

pub(super) struct Axis {
    /// With its unit.
    label: String,
    scale: Scale,
    ticks: Vec<(f64, String)>,
}

impl Axis {
    pub(super) fn new(label: &str, scale: Scale) -> Self {
        Self { label: label.to_owned(), scale, ticks: scale.ticks(5) }
    }

    /// An axis of whole numbers, which are all written if they are few.
    pub(super) fn of_whole(label: &str, scale: Scale, numbers: RangeInclusive<u32>) -> Self {
        let is_few = numbers.end() - numbers.start() <= 12;
        let ticks = numbers.map(|number| (f64::from(number), number.to_string()));
        match is_few {
            true => Self { label: label.to_owned(), scale, ticks: ticks.collect() },
            false => Self::new(label, scale),
        }
    }
}

pub(super) struct Chart {
    x: Axis,
    y: Axis,
    marks: Vec<Markup>,
    /// Points that have no place.
    pub(super) left_out: usize,
}

impl Chart {
    pub(super) fn new(x: Axis, y: Axis) -> Self {
        let x = Axis { scale: x.scale.between(X), ..x };
        let y = Axis { scale: y.scale.between([Y[1], Y[0]]), ..y };
        Self { x, y, marks: Vec::new(), left_out: 0 }
    }

    fn place(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x.scale.place(x)?, self.y.scale.place(y)?])
    }

    pub(super) fn point(&mut self, mark: Mark, at: [f64; 2], title: &str) {
        match self.place(at) {
            Some([x, y]) => self.marks.push(mark.at(x, y, title)),
            None => self.left_out += 1,
        }
    }

    /// An interval at `x`; an end that has no place is at the end of the axis.
    pub(super) fn interval(&mut self, class: &str, x: f64, [low, high]: [f64; 2]) {
        let end = |value: f64, end| self.y.scale.place(value).unwrap_or(end);
        let (x, low, high) = (self.x.scale.place(x), end(low, Y[1]), end(high, Y[0]));
        if let Some(x) = x {
            let path = format!("M{} {}V{}", px(x), px(low), px(high));
            self.marks.push(html! { path class={ (class) " line" } d=(path) {} });
        }
    }

    /// A line through points; what has no place is a gap in it.
    pub(super) fn line(&mut self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) {
        let mut pen = 'M';
        let mut path = String::new();
        for point in points {
            let Some([x, y]) = self.place(point) else {
                pen = 'M';
                continue;
            };
            path += &format!("{pen}{} {}", px(x), px(y));
            pen = 'L';
        }
        self.marks.push(html! { path class={ (class) " line" } d=(path) {} });
    }

    /// A rectangle between two places on each axis.
    pub(super) fn bar(&mut self, class: &str, x: [f64; 2], y: [f64; 2], title: &str) {
        let places = [self.place([x[0], y[0]]), self.place([x[1], y[1]])];
        let [Some([left, bottom]), Some([right, top])] = places else {
            self.left_out += 1;
            return;
        };
        let (width, height) = ((right - left).max(THINNEST), bottom - top);
        self.marks.push(html! {
            rect class={ (class) " area" } x=(px(left)) y=(px(top)) width=(px(width)) height=(px(height)) {
                @if !title.is_empty() { title { (title) } }
            }
        });
    }

    pub(super) fn svg(&self, title: &str, description: &str) -> Markup {
        let marks = html! {
            (self.x_axis())
            (self.y_axis())
            @for mark in &self.marks { (mark) }
        };
        html! { div.chart { (svg(SIZE, title, description, &marks)) } }
    }

    fn x_axis(&self) -> Markup {
        html! {
            path.axis d={ "M" (px(X[0])) " " (px(Y[1])) "H" (px(X[1])) } {}
            @for (value, label) in &self.x.ticks {
                @if let Some(x) = self.x.scale.place(*value) {
                    path.axis d={ "M" (px(x)) " " (px(Y[1])) "v4" } {}
                    text x=(px(x)) y=(px(Y[1] + 18.0)) text-anchor="middle" { (label) }
                }
            }
            text.label x=(px(X[1])) y=(px(SIZE[1] - 5.0)) text-anchor="end" { (self.x.label) }
        }
    }

    fn y_axis(&self) -> Markup {
        html! {
            @for (value, label) in &self.y.ticks {
                @if let Some(y) = self.y.scale.place(*value) {
                    path.grid d={ "M" (px(X[0])) " " (px(y)) "H" (px(X[1])) } {}
                    text x=(px(X[0] - 6.0)) y=(px(y + 4.0)) text-anchor="end" { (label) }
                }
            }
            text.label x="0" y="12" { (self.y.label) }
        }
    }
}
