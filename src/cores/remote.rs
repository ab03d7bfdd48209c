//! A core that lives in a worker process, asked through its channel.
//!
//! To checks it is a [`Core`] like any other. If it dies in a batch, fresh workers are given halves
//! of that batch until the element is found that it dies of.

use crate::contract::answer::Answer as Filled;
use crate::contract::question::*;
use crate::contract::{Acceleration, BuildStats, Built, BuiltScene, Components, Core, CoreInfo};
use crate::cores::textbook::variant;
use crate::worker::message::{Answer, Request, Told, Wanted};
use crate::worker::narrow::narrow;
use crate::worker::{
    Confinement, CoreOrigin, CpuClock, Launch, Lender, StartError, Worker, build_request,
};
use std::ops::Range;
use std::time::{Duration, Instant};

/// How long the search for the element that crashes a core may take.
const SEARCH: Duration = Duration::from_secs(10);

/// A core in a worker process.
pub struct Remote {
    launch: Launch,
    worker: Worker,
    /// What it takes of the bench's, for workers that have to take it again.
    taken: Components,
    /// What built the scene that there is, for workers that have to build it again.
    built: Option<Request<'static>>,
}

impl Remote {
    /// Starts a worker for the core.
    ///
    /// # Errors
    /// If there is no process, or the core fails to start.
    pub(crate) fn start(launch: &Launch) -> std::result::Result<Self, StartError> {
        Ok(Self {
            launch: launch.clone(),
            worker: Worker::start(launch)?,
            taken: Components::empty(),
            built: None,
        })
    }

    /// What the system enforces on it.
    pub(crate) const fn confinement(&self) -> &Confinement {
        self.worker.confinement()
    }

    /// CPU time of its process while the core answers.
    pub(crate) fn clock(&self) -> CpuClock {
        self.worker.clock()
    }

    /// What it was told to take of the bench's, and has never asked for.
    pub(crate) fn unasked(&self) -> Components {
        self.worker.unasked()
    }

    /// What it has printed.
    pub(crate) fn printed(&self) -> String {
        self.worker.printed()
    }

    /// Asks, and fills the answer; a crash in a batch is narrowed to the element that it comes of.
    fn ask<A: Filled + ?Sized, T: Told>(
        &mut self,
        request: &Request<'_>,
        name: &'static str,
        answer: &mut A,
    ) -> Result<T> {
        let capabilities = self.worker.info().capabilities;
        let mut told = Answer::Done;
        answer.receive(name, capabilities, &mut |wanted| {
            told = match self.worker.ask(request, wanted) {
                Err(CoreError::Crashed { how, during, .. }) => {
                    let (place, element) = self.search(request, wanted).unwrap_or_default();
                    return Err(CoreError::Crashed { how, during: during + &place, element });
                }
                answer => answer?,
            };
            Ok(())
        })?;
        T::of(&told).ok_or_else(|| out_of_place(&told))
    }

    /// Where in the batch the core dies, in words, and of what, if that is one element.
    fn search(
        &self,
        request: &Request<'_>,
        wanted: &[Wanted<'_>],
    ) -> Option<(String, Option<Box<Culprit>>)> {
        let count = wanted.first()?.count();
        // A picture has no elements that could be asked for alone.
        request.batch(count)?;
        let begun = Instant::now();
        let found = narrow(count, |range| {
            (begun.elapsed() < SEARCH).then(|| self.dies_of(request, wanted, &range))
        });
        Some(match found {
            None => (format!(" of {count} elements, though not of them alone"), None),
            Some(Range { start: index, end }) if end == index + 1 => {
                let numbers = request.describe(index, count);
                let culprit = numbers.map(|numbers| Box::new(Culprit { index, numbers }));
                (format!(", element {index} of {count}"), culprit)
            }
            Some(Range { start, end }) => {
                (format!(", elements {start} to {} of {count}", end - 1), None)
            }
        })
    }

    /// Whether a fresh worker dies of a part of the batch.
    fn dies_of(&self, request: &Request<'_>, wanted: &[Wanted<'_>], range: &Range<usize>) -> bool {
        let Ok(mut worker) = Worker::start(&self.launch) else { return false };
        if !self.taken.is_empty() && take(&mut worker, &self.launch, self.taken).is_err() {
            return false;
        }
        if self.built.iter().any(|request| worker.ask(request, &mut []).is_err()) {
            return false;
        }
        let memory = |array: &Wanted<'_>| vec![0; array.size_of_one() * range.len()];
        let mut memory: Vec<_> = wanted.iter().map(memory).collect();
        let places = wanted.iter().zip(&mut memory);
        let mut answers: Vec<_> =
            places.map(|(array, bytes)| array.within(&mut bytes[..])).collect();
        let answer = worker.ask(&request.part(range), &mut answers);
        matches!(answer, Err(CoreError::Crashed { .. }))
    }
}

/// Has a core take components of the bench. A library finds them in its own process; a program asks for what they answer.
fn take(worker: &mut Worker, launch: &Launch, components: Components) -> Result<()> {
    if matches!(launch.worker.origin, CoreOrigin::Program(_)) {
        let conventions = worker.info().conventions;
        let lender = Lender::start(components, move || variant::following(conventions));
        worker.lend(lender.map_err(|error| CoreError::Refused(error.to_string()))?);
    }
    let request = Request::new("take_components").with("components", components);
    worker.ask(&request, &mut []).map(drop)
}

/// Sends a question, and fills its answer with what comes back.
macro_rules! sent_and_heard {
    (($($remote:ident)?) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        fn $method(&mut self, $($arg: $ty,)* $out: &mut $answer) -> Result<$told> {
            let request =
                Request::new(stringify!($method))$(.with_argument(stringify!($arg), $arg))*;
            self$(.$remote)?.ask(&request, stringify!($out), $out)
        }
    };
}

impl Core for Remote {
    fn info(&self) -> CoreInfo {
        self.worker.info().clone()
    }

    fn take_components(&mut self, components: Components) -> Result<()> {
        take(&mut self.worker, &self.launch, components)?;
        self.taken = components;
        Ok(())
    }

    each_question! { Core sent_and_heard () }

    fn build_scene(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<Built<'_>> {
        let build = build_request(scene, how);
        match self.worker.ask(&build, &mut [])? {
            Answer::Built { stats } => {
                self.built = Some(build);
                Ok(Box::new(RemoteScene { remote: self, stats }))
            }
            other => Err(out_of_place(&other)),
        }
    }
}

/// A scene that a core in a worker has taken in.
struct RemoteScene<'a> {
    remote: &'a mut Remote,
    stats: BuildStats,
}

impl BuiltScene for RemoteScene<'_> {
    fn stats(&self) -> BuildStats {
        self.stats
    }

    each_question! { Scene sent_and_heard (remote) }
}

impl Drop for RemoteScene<'_> {
    fn drop(&mut self) {
        self.remote.built = None;
        // If it cannot be released, the core has died, and the next request will say so.
        let _ = self.remote.worker.ask(&Request::new("release"), &mut []);
    }
}

fn out_of_place(answer: &Answer) -> CoreError {
    CoreError::breach(format!("it answered `{}`, which does not match the request", answer.word()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_out_of_place_is_called_what_the_protocol_calls_it() {
        let answers = [Answer::Done, Answer::Refused { why: "no \"glass\"".to_owned() }];
        for (answer, word) in answers.iter().zip(["done", "refused"]) {
            let told = out_of_place(answer).to_string();
            assert!(told.contains(&format!("it answered `{word}`, which")), "{told}");
        }
    }
}
