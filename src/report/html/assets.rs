//! Style sheet and scripts, as they stand in the pages or beside them. Scripts are classic ones: pages opened from disk
//! may load no modules.

/// Beside the index.
pub(super) const FOLDER: &str = "assets";
pub(super) const STYLE: &str = include_str!("assets/report.css");
/// Before anything is drawn: what needs scripts is shown, and the reader's choice of colours holds.
pub(super) const EARLY_SCRIPT: &str = "{const root=document.documentElement;root.classList.add('js');\
    try{const t=localStorage.getItem('furnace-theme');if(t)root.dataset.theme=t}catch{}}";

/// What every page has: one concern a file.
const PAGES: &[&str] = &[
    include_str!("assets/address.js"),
    include_str!("assets/page.js"),
    include_str!("assets/filter.js"),
];

/// What pages with images have besides.
const VIEWER: &[&str] = &[
    include_str!("assets/viewer/make.js"),
    include_str!("assets/viewer/half.js"),
    include_str!("assets/viewer/tone.js"),
    include_str!("assets/viewer/colour.js"),
    include_str!("assets/viewer/frames.js"),
    include_str!("assets/viewer/error.js"),
    include_str!("assets/viewer/layers.js"),
    include_str!("assets/viewer/panes.js"),
    include_str!("assets/viewer/paint.js"),
    include_str!("assets/viewer/probe.js"),
    include_str!("assets/viewer/histogram.js"),
    include_str!("assets/viewer/state.js"),
    include_str!("assets/viewer/actions.js"),
    include_str!("assets/viewer/controls.js"),
    include_str!("assets/viewer/pointer.js"),
    include_str!("assets/viewer/start.js"),
];

pub(super) fn pages_script() -> String {
    script(PAGES)
}

pub(super) fn viewer_script() -> String {
    script(VIEWER)
}

fn script(files: &[&str]) -> String {
    format!("'use strict';\n{}", files.concat())
}
