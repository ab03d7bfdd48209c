//! What a run and a grade answer as data, of a core with one mistake.

mod adapter;

use furnace::contract::{
    Capabilities, Core, CoreInfo, DirectionSample, Randomness, Result, Sampler,
};
use furnace::glam::DVec3;
use furnace::run::Status;
use furnace::stats::Budget;

/// Its pdfs forget that directions near the pole are drawn more often.
struct Wrong;

impl Core for Wrong {
    fn info(&self) -> CoreInfo {
        let capabilities = Capabilities::SAMPLE_DIRECTION | Capabilities::CALLERS_RANDOMNESS;
        CoreInfo { name: "wrong".to_owned(), capabilities, ..CoreInfo::default() }
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        adapter::Tiny.sample_direction(sampler, random, samples)?;
        samples.iter_mut().for_each(|sample| sample.pdf = tiny::hemisphere_pdf(DVec3::Z, false));
        Ok(())
    }

    fn direction_pdf(&mut self, _: Sampler, _: &[DVec3], pdf: &mut [f64]) -> Result<()> {
        pdf.fill(tiny::hemisphere_pdf(DVec3::Z, false));
        Ok(())
    }
}

#[test]
fn a_mistake_fails_its_cases_and_is_in_a_headline() {
    let runs = env!("CARGO_TARGET_TMPDIR");
    let trials = furnace::trials("wrong", || Wrong).cases(["sampling/"]).budget(Budget::Quick);
    let run = trials.run(runs).expect("the cases are there");
    let failing: Vec<_> =
        run.trials.iter().filter(|trial| trial.outcome.status() == Status::Fail).collect();
    assert!(failing.iter().any(|trial| trial.case.contains("cosine")), "{failing:?}");
    let headline = run.headlines().next().expect("something is wrong");
    assert!(failing.iter().any(|trial| headline.explains.contains(&trial.case)), "{headline:?}");
    assert!(run.folder.join("index.html").is_file());
}

#[test]
fn a_right_core_passes_what_it_is_asked() {
    let trials = furnace::trials("tiny", || adapter::Tiny).cases(["camera/", "sampling/"]);
    let run = trials.run(env!("CARGO_TARGET_TMPDIR")).expect("the cases are there");
    let fails = |status: Status| !matches!(status, Status::Pass | Status::Skipped);
    assert!(run.trials.iter().all(|trial| !fails(trial.outcome.status())));
    assert_eq!(run.headlines().count(), 0);
}

#[test]
fn what_there_is_not_is_an_error_that_says_so() {
    let trials = furnace::trials("tiny", || adapter::Tiny).cases(["no-such-case"]);
    let error = trials.run(env!("CARGO_TARGET_TMPDIR")).expect_err("there is no such case");
    assert!(error.to_string().contains("no-such-case"), "{error}");
    assert!(furnace::grade("no-such-suite", || adapter::Tiny).is_err());
}
