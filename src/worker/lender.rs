//! The bench's own components, lent to a program: while it answers the bench, it may ask the bench, in the same frames.
//!
//! What answers it is a right core, served as any other: on a thread of the bench, and once more for the scene that is
//! built. A program can only ask what the bench asks cores. Not here: which core that is, and what a program makes of it.

use super::client::Silence;
use super::frame::{self, FrameError, Opening};
use super::message::{Answer, Request};
use super::{Channel, Client, serve};
use crate::contract::question::is_within_a_scene;
use crate::contract::{Components, Core};
use std::io;
use std::thread::{self, JoinHandle};

/// Right cores on threads of their own.
pub(crate) struct Lender {
    /// For what needs no scene.
    without_scene: Desk,
    within_scene: Desk,
    /// Whether that has one.
    has_scene: bool,
    /// What the program was told to take, and what of it it has asked for.
    taken: Components,
    asked: Components,
}

/// One right core that is served.
struct Desk {
    client: Client,
    /// How the serving ended, if it has.
    thread: Option<JoinHandle<Result<(), FrameError>>>,
}

impl Lender {
    /// Of these components, from the core that `make` makes. Fails if the system gives no pipes or threads.
    pub(crate) fn start<C: Core>(
        taken: Components,
        make: impl Fn() -> C + Send + Clone + 'static,
    ) -> io::Result<Self> {
        let (without_scene, within_scene) = (Desk::open(make.clone())?, Desk::open(make)?);
        let asked = Components::empty();
        Ok(Self { without_scene, within_scene, has_scene: false, taken, asked })
    }

    /// Takes in the scene that the core is to build, and lets go of it when the core does; nothing else is for the lender.
    pub(super) fn follow(&mut self, request: &Request<'_>) -> Result<(), Silence> {
        let builds = request.name() == "build";
        if self.has_scene && (builds || request.name() == "release") {
            self.has_scene = false;
            self.within_scene.client.ask(&Request::new("release"), &mut [])?;
        }
        if builds {
            let built = self.within_scene.client.ask(request, &mut [])?;
            self.has_scene = matches!(built, Answer::Built { .. });
        }
        Ok(())
    }

    /// Hands a question of the core's on, and what comes of it back.
    pub(super) fn answer(&mut self, asked: &Opening, core: &mut Channel) -> Result<(), Silence> {
        let question = name_of(&asked.header);
        let answers = self.taken.intersection(Components::of_request(&question));
        if answers.is_empty() {
            return Err(nonsense(
                &question,
                "which is not of a component that it was told to take",
            ));
        }
        self.asked |= answers;
        let within = is_within_a_scene(&question);
        let desk = if within { &mut self.within_scene } else { &mut self.without_scene };
        desk.relay(asked, core).map_err(|error| match error {
            FrameError::Malformed(why) | FrameError::Unknown(why) => nonsense(&question, &why),
            error => error.into(),
        })
    }

    /// What the program was told to take, and has never asked for, nor for anything made of it: its own is still in that place.
    pub(super) fn unasked(&self) -> Components {
        let came_along = |one: &Components| self.asked.iter().any(|it| it.is_made_of(*one));
        self.taken.difference(self.asked).iter().filter(|one| !came_along(one)).collect()
    }
}

fn nonsense(question: &str, why: &str) -> Silence {
    Silence::Nonsense(format!("it asked the bench for `{question}`: {why}"))
}

/// What a header asks for, in the words of the protocol; empty if that is nothing.
fn name_of(header: &[u8]) -> String {
    #[derive(serde::Deserialize)]
    struct Named {
        request: String,
    }
    serde_json::from_slice(header).map(|named: Named| named.request).unwrap_or_default()
}

/// Whether a header asks something, and is no answer.
pub(super) fn asks(header: &[u8]) -> bool {
    !name_of(header).is_empty()
}

impl Desk {
    fn open<C: Core>(make: impl Fn() -> C + Send + 'static) -> io::Result<Self> {
        let (requests, asking) = io::pipe()?;
        let (answers, answering) = io::pipe()?;
        let channel = Channel { input: Box::new(requests), output: Box::new(answering) };
        let serving = move || serve(&mut make(), channel);
        let thread = thread::Builder::new().name("lender".to_owned()).spawn(serving)?;
        let channel = Channel { input: Box::new(answers), output: Box::new(asking) };
        Ok(Self { client: Client::new(channel), thread: Some(thread) })
    }

    fn relay(&mut self, asked: &Opening, core: &mut Channel) -> Result<(), FrameError> {
        let own = self.client.channel();
        let handed_on = frame::pass(asked, &mut core.input, &mut own.output);
        match handed_on.and_then(|()| frame::open(&mut own.input)) {
            Ok(answer) => frame::pass(&answer, &mut own.input, &mut core.output),
            // It serves no longer: it says why.
            Err(FrameError::Closed) => Err(self.last_words()),
            Err(error) => Err(error),
        }
    }

    fn last_words(&mut self) -> FrameError {
        let ended = self.thread.take().and_then(|thread| thread.join().ok());
        ended.and_then(Result::err).unwrap_or(FrameError::Closed)
    }
}
