//! A socket that is looked at for a moment before it is waited on.
//!
//! An idle processor sleeps, and in a virtual machine its awakening takes 50 to 200 µs: more than many a request.
//! Whoever waits for less than that looks again and again, and gives way each time. Where somebody takes what is given,
//! no processor is idle, and waiting is as good.

use rustix::io::Errno;
use rustix::net::{RecvFlags, recv};
use std::io::{self, Read};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

/// How long it is looked at.
const GLANCE: Duration = Duration::from_micros(300);
/// Giving way takes longer than this only if somebody else gets the processor.
const TAKEN: Duration = Duration::from_micros(20);

/// The reading end of a channel.
pub(crate) struct Eager(pub(crate) UnixStream);

impl Read for Eager {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let begun = Instant::now();
        let mut is_taken = false;
        loop {
            match recv(&self.0, &mut *bytes, RecvFlags::DONTWAIT) {
                Ok((count, _)) => return Ok(count),
                Err(Errno::AGAIN | Errno::INTR) => {}
                Err(error) => return Err(error.into()),
            }
            if is_taken || begun.elapsed() > GLANCE {
                return self.0.read(bytes);
            }
            let given = Instant::now();
            std::thread::yield_now();
            is_taken = given.elapsed() > TAKEN;
        }
    }
}
