//! The side of the core: reads requests, asks the core, answers. Any [`Core`] can stand behind it.

use super::frame::{self, Body, FrameError};
use super::message::{Answer, Received, Sent, Told, encode, parse};
use super::{Channel, clock, scene};
use crate::contract::answer::{Answer as Filled, Asked, Unformed};
use crate::contract::argument::{Argument, size_of_answer};
use crate::contract::question::*;
use crate::contract::{BuiltScene, Core};
use std::io::{Read, Write};

/// That a request was answered, if only with an error; a channel that fails is the end.
type Served<T = ()> = std::result::Result<T, FrameError>;

/// Answers every request that comes, until the channel is closed.
///
/// # Errors
/// If the channel fails, or what comes is no request.
pub fn serve(core: &mut dyn Core, channel: Channel) -> Served {
    let (mut inbox, mut outbox) = ends(channel);
    while let Some((number, mut request)) = inbox.next()? {
        outbox.number = number;
        match request.name() {
            "hello" => outbox.send(Answer::Core { core: core.info() }, &[])?,
            "take-components" => match core.take_components(request.member("components")?) {
                Ok(()) => outbox.send(Answer::Done, &[])?,
                Err(error) => outbox.fail(error)?,
            },
            "build" => {
                let scene = scene::decode(&mut request)?;
                let acceleration = request.member("acceleration")?;
                let capabilities = core.info().capabilities;
                let begun = clock::now();
                let built = core.build_scene(&scene, acceleration);
                outbox.cpu_seconds = Some((clock::now() - begun).as_secs_f64());
                match built {
                    Ok(built) => serve_built(built, capabilities, &mut inbox, &mut outbox)?,
                    Err(error) => outbox.fail(error)?,
                }
            }
            _ => answer(core, request, &mut outbox)?,
        }
    }
    Ok(())
}

/// Answers what is asked of a scene until it is released or the channel is closed.
fn serve_built(
    mut built: Box<dyn BuiltScene + '_>,
    capabilities: Capabilities,
    inbox: &mut Inbox,
    outbox: &mut Outbox,
) -> Served {
    outbox.send(Answer::Built { stats: built.stats() }, &[])?;
    while let Some((number, request)) = inbox.next()? {
        outbox.number = number;
        if request.name() == "release" {
            drop(built);
            return outbox.send(Answer::Done, &[]);
        }
        answer_built(built.as_mut(), capabilities, request, outbox)?;
    }
    Ok(())
}

/// Answers every request that comes with the reason why there is no core.
///
/// # Errors
/// As [`serve`].
pub(crate) fn refuse(why: String, channel: Channel) -> Served {
    let (mut inbox, mut outbox) = ends(channel);
    while let Some((number, _)) = inbox.next()? {
        outbox.number = number;
        outbox.fail(CoreError::Refused(why.clone()))?;
    }
    Ok(())
}

/// Answers one question, if it is the one that was asked: takes its arguments out of the request, lets the core fill
/// an answer of their size, and sends that.
macro_rules! answer_if_asked {
    (($core:ident, $capabilities:ident, $request:ident, $outbox:ident) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)?
        fn $method:ident($($arg:ident: $ty:ty),*; $out:ident: &mut $answer:ty) -> $told:ty;
    }) => {
        if $request.asks(stringify!($method)) {
            $(let $arg = <$ty as Argument<'_>>::keep(stringify!($arg), &mut $request)?;)*
            $(let $arg: $ty = Argument::lend(&$arg);)*
            let size = size_of_answer([$(Argument::size($arg)),*]);
            let asked = Asked {
                size,
                capabilities: $capabilities,
                primitives_of_shape: &[],
                unformed: Unformed::Left,
            };
            let mut answer = <$answer as Filled>::blank(&asked);
            let begun = clock::now();
            let answered = $core.$method($($arg,)* &mut answer);
            $outbox.cpu_seconds = Some((clock::now() - begun).as_secs_f64());
            return match answered {
                Ok(told) => {
                    let arrays = answer.sent(stringify!($out), $capabilities);
                    $outbox.send(Told::into_answer(told), &arrays)
                }
                Err(error) => $outbox.fail(error),
            };
        }
    };
}

/// Answers a request that needs no scene.
fn answer(core: &mut dyn Core, mut request: Received<'_>, outbox: &mut Outbox) -> Served {
    let capabilities = Capabilities::empty();
    each_question! { Core answer_if_asked (core, capabilities, request, outbox) }
    Err(FrameError::Malformed(format!("`{}` without a scene", request.name())))
}

/// Answers a request to a scene.
fn answer_built(
    built: &mut dyn BuiltScene,
    capabilities: Capabilities,
    mut request: Received<'_>,
    outbox: &mut Outbox,
) -> Served {
    each_question! { Scene answer_if_asked (built, capabilities, request, outbox) }
    Err(FrameError::Malformed(format!("`{}` within a scene", request.name())))
}

fn ends(channel: Channel) -> (Inbox, Outbox) {
    let outbox =
        Outbox { output: channel.output, buffer: Vec::new(), number: 0, cpu_seconds: None };
    (Inbox { input: channel.input, body: Body::default() }, outbox)
}

/// Where requests come from.
struct Inbox {
    input: Box<dyn Read + Send>,
    body: Body,
}

impl Inbox {
    /// The next request and its number; none when the channel is closed.
    fn next(&mut self) -> Served<Option<(u64, Received<'_>)>> {
        let opening = match frame::open(&mut self.input) {
            Err(FrameError::Closed) => return Ok(None),
            opening => opening?,
        };
        self.body.read(&mut self.input, opening.body)?;
        let request = Received::new(parse(&opening.header)?, self.body.bytes())?;
        Ok(Some((opening.number, request)))
    }
}

/// Where answers go.
struct Outbox {
    output: Box<dyn Write + Send>,
    buffer: Vec<u8>,
    /// Of the request that is being answered.
    number: u64,
    /// What the core took for it.
    cpu_seconds: Option<f64>,
}

impl Outbox {
    fn send(&mut self, message: Answer, arrays: &[Sent<'_>]) -> Served {
        encode(&mut self.buffer, self.number, message, arrays, self.cpu_seconds.take())?;
        frame::send(&mut self.output, &self.buffer)
    }

    fn fail(&mut self, error: CoreError) -> Served {
        self.send(Answer::of_error(error), &[])
    }
}
