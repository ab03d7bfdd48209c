//! The side of the bench: sends a request, and reads the answer into the memory it is meant for.

use super::Channel;
use super::clock::CpuClock;
use super::frame::{self, FrameError, Opening};
use super::lender::{Lender, asks};
use super::message::{Answer, ArrayHeader, Header, Request, Wanted, encode, parse};
use crate::contract::Components;
use crate::contract::crossing::padded;
use std::fmt::Display;

/// One end of a channel to a core.
pub struct Client {
    channel: Channel,
    number: u64,
    buffer: Vec<u8>,
    clock: CpuClock,
    /// What the other side may ask while it is asked.
    lender: Option<Box<Lender>>,
}

/// Why there is no answer.
#[derive(Debug)]
pub enum Silence {
    /// The other side is gone.
    Gone,
    /// What it says is no answer to what it was asked; nothing it says later can be understood.
    Nonsense(String),
}

impl From<FrameError> for Silence {
    fn from(error: FrameError) -> Self {
        match error {
            FrameError::Closed | FrameError::Io(_) => Self::Gone,
            FrameError::Malformed(_) | FrameError::Unknown(_) => Self::Nonsense(error.to_string()),
        }
    }
}

fn nonsense(what: impl Display) -> Silence {
    Silence::Nonsense(what.to_string())
}

impl Client {
    /// At this end of `channel`.
    pub fn new(channel: Channel) -> Self {
        Self { channel, number: 0, buffer: Vec::new(), clock: CpuClock::default(), lender: None }
    }

    /// From now on the other side may ask, too, while it is asked.
    pub(super) fn lend(&mut self, lender: Lender) {
        self.lender = Some(Box::new(lender));
    }

    /// What is lent, and was never asked for.
    pub(super) fn unasked(&self) -> Components {
        self.lender.as_ref().map_or(Components::empty(), |lender| lender.unasked())
    }

    /// Where it reads and writes.
    pub(super) const fn channel(&mut self) -> &mut Channel {
        &mut self.channel
    }

    /// What the other side says of its CPU time.
    pub(super) const fn clock(&self) -> &CpuClock {
        &self.clock
    }

    /// Asks, and fills `wanted` if the core could answer.
    ///
    /// # Errors
    /// If no answer comes, or one that does not fit.
    pub fn ask(
        &mut self,
        request: &Request<'_>,
        wanted: &mut [Wanted<'_>],
    ) -> Result<Answer, Silence> {
        self.number += 1;
        if let Some(lender) = &mut self.lender {
            lender.follow(request)?;
        }
        encode(&mut self.buffer, self.number, request.members(), request.arrays(), None)?;
        frame::send(&mut self.channel.output, &self.buffer)?;
        self.hear(wanted)
    }

    /// Reads the next answer, and lends what is asked for before it. Number 0 is what a worker says of its own accord.
    ///
    /// # Errors
    /// If no answer comes, or one that does not fit.
    pub fn hear(&mut self, wanted: &mut [Wanted<'_>]) -> Result<Answer, Silence> {
        let opening = self.next_answer()?;
        let header: Header<Answer> = parse(&opening.header)?;
        if opening.number != self.number {
            let (number, asked) = (opening.number, self.number);
            return Err(nonsense(format!("it answered request {number}, and was asked {asked}")));
        }
        self.clock.add(header.cpu_seconds.unwrap_or(0.0));
        let has_arrays =
            matches!(header.message, Answer::Done | Answer::Traced { .. } | Answer::Coded { .. });
        let wanted = if has_arrays { wanted } else { &mut [] };
        fits(&header.arrays, opening.body, wanted)?;
        for array in wanted {
            frame::read_array(&mut self.channel.input, array.bytes_mut())?;
        }
        Ok(header.message)
    }

    fn next_answer(&mut self) -> Result<Opening, Silence> {
        loop {
            let opening = frame::open(&mut self.channel.input)?;
            match &mut self.lender {
                Some(lender) if asks(&opening.header) => {
                    lender.answer(&opening, &mut self.channel)?;
                }
                _ => return Ok(opening),
            }
        }
    }
}

/// Whether an answer brings the arrays that were asked for, no more and no less.
fn fits(arrays: &[ArrayHeader], body: u64, wanted: &[Wanted<'_>]) -> Result<(), Silence> {
    for (number, wanted) in wanted.iter().enumerate() {
        let ArrayHeader(name, element, count) = wanted.header();
        match arrays.get(number) {
            Some(found) if *found == wanted.header() => {}
            Some(ArrayHeader(n, e, c)) => {
                return Err(nonsense(format!(
                    "it answered `{n}`, {c} of {e}; asked for was `{name}`, {count} of {element}"
                )));
            }
            None => return Err(nonsense(format!("its answer has no `{name}`"))),
        }
    }
    let size: usize = wanted.iter().map(|wanted| padded(wanted.bytes().len())).sum();
    if arrays.len() != wanted.len() || body != size as u64 {
        return Err(nonsense(format!(
            "its answer has {} arrays in {body} bytes; asked for were {} in {size}",
            arrays.len(),
            wanted.len()
        )));
    }
    Ok(())
}
