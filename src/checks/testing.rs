//! Puts a check to a fake core, the way the executor does: its settings from TOML, its core behind validation.

use super::{Check, CheckError, Context, Finding};
use crate::contract::validate::Validated;
use crate::contract::{Capabilities, Core, CoreInfo, Precision};
use crate::math::rng::Seed;
use crate::scene::{Library, SceneDescription};
use crate::stats::{Budget, Verdict};
use crate::text::read_key;
use std::sync::Arc;

/// The check of a case with this text: a whole file of `cases/`, or its `[expect]` alone.
pub(crate) fn check_of<C: Check>(text: &str) -> C {
    let expect: C = read_key(text, "expect").unwrap();
    expect.validate().unwrap();
    expect
}

/// Who a fake core is: it can do everything it is asked, and makes pictures without variances.
pub(crate) fn info(precision: Precision) -> CoreInfo {
    CoreInfo {
        name: "fake".into(),
        version: "0".into(),
        capabilities: Capabilities::all() - Capabilities::REPORTED_VARIANCE,
        precision,
        ..CoreInfo::default()
    }
}

/// What the check says of the core, or why it says nothing.
pub(crate) fn try_judge<C: Check>(
    check: &C,
    core: &mut dyn Core,
    scene: Option<SceneDescription>,
) -> Result<Finding, CheckError> {
    let info = core.info();
    let mut core = Validated::new(core);
    let scenes = Library::new("scenes");
    let mut context = Context {
        core: &mut core,
        info,
        scene: scene.map(Arc::new),
        scenes: &scenes,
        references: &[],
        seed: Seed::SUITE.child(C::NAME),
        budget: Budget::Default.into(),
        pictures: Vec::new(),
    };
    check.run(&mut context)
}

/// What the check says of the core.
pub(crate) fn judge<C: Check>(check: &C, core: &mut dyn Core) -> Finding {
    try_judge(check, core, None).unwrap()
}

/// The number that follows these words in a statement; NaN where they are not there.
pub(crate) fn number_after(statement: &str, words: &str) -> f64 {
    let rest = statement.split_once(words).map_or("", |(_, rest)| rest);
    let number = rest.split(|c: char| !c.is_ascii_digit() && c != '.').next();
    number.and_then(|number| number.parse().ok()).unwrap_or(f64::NAN)
}

/// The statement of a finding that has to be a failure.
pub(crate) fn failure(finding: &Finding) -> &str {
    assert_eq!(finding.verdict, Verdict::Fail, "{finding:#?}");
    &finding.statement
}

/// The causes that a failure names, the likeliest first.
pub(crate) fn causes(finding: &Finding) -> Vec<&str> {
    failure(finding);
    finding.clues.iter().map(|clue| clue.cause.as_str()).collect()
}

/// Asserts that a finding passes and says what it would have caught.
pub(crate) fn assert_passes(finding: &Finding) {
    assert_eq!(finding.verdict, Verdict::Pass, "{finding:#?}");
    assert!(!finding.resolution.is_empty(), "a pass says what it would have caught");
}
