//! The values that Mitsuba's elements hold.

use crate::scene::Rgb;
use crate::scene::format::xml::XmlWriter;
use crate::scene::format::{matrix, numbers};
use glam::{DAffine3, DVec3};

impl XmlWriter {
    pub(super) fn integer(&mut self, name: &str, value: u32) {
        self.leaf("integer", &[("name", name), ("value", &value.to_string())]);
    }

    pub(super) fn float(&mut self, name: &str, value: f64) {
        self.leaf("float", &[("name", name), ("value", &value.to_string())]);
    }

    pub(super) fn string(&mut self, name: &str, value: &str) {
        self.leaf("string", &[("name", name), ("value", value)]);
    }

    pub(super) fn boolean(&mut self, name: &str, value: bool) {
        self.leaf("boolean", &[("name", name), ("value", &value.to_string())]);
    }

    pub(super) fn rgb(&mut self, name: &str, value: Rgb) {
        self.leaf("rgb", &[("name", name), ("value", &numbers(value))]);
    }

    pub(super) fn point(&mut self, name: &str, value: DVec3) {
        self.vector("point", name, value);
    }

    pub(super) fn direction(&mut self, name: &str, value: DVec3) {
        self.vector("vector", name, value);
    }

    pub(super) fn look_at(&mut self, origin: DVec3, target: DVec3, up: DVec3) {
        let [origin, target, up] =
            [origin, target, up].map(|v| numbers(v.to_array()).replace(' ', ", "));
        self.leaf("lookat", &[("origin", &origin), ("target", &target), ("up", &up)]);
    }

    /// The transform `to_world`, row by row.
    pub(super) fn transform(&mut self, transform: DAffine3) {
        self.open("transform", &[("name", "to_world")]);
        self.leaf("matrix", &[("value", &matrix(transform))]);
        self.close();
    }

    fn vector(&mut self, element: &str, name: &str, value: DVec3) {
        let [x, y, z] = value.to_array().map(|coordinate| coordinate.to_string());
        self.leaf(element, &[("name", name), ("x", &x), ("y", &y), ("z", &z)]);
    }
}
