//! What a core prints: its end is kept, the rest is only counted.

use std::collections::VecDeque;
use std::io::{PipeReader, Read};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

const KEPT: usize = 64 << 10;

/// The last of what a process has printed, on both of its streams.
pub(crate) struct Output {
    tail: Arc<Mutex<Tail>>,
    reader: JoinHandle<()>,
}

#[derive(Default)]
struct Tail {
    bytes: VecDeque<u8>,
    dropped: u64,
}

impl Output {
    /// Reads from `pipe` until nobody holds its other end.
    pub(crate) fn of(pipe: PipeReader) -> Self {
        let tail = Arc::default();
        let kept = Arc::clone(&tail);
        Self { tail, reader: thread::spawn(move || read(pipe, &kept)) }
    }

    /// What was printed so far: of much, the end, and how much came before.
    pub(crate) fn text(&self) -> String {
        let tail = self.tail.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes: Vec<_> = tail.bytes.iter().copied().collect();
        let text = String::from_utf8_lossy(&bytes);
        match tail.dropped {
            0 => text.into_owned(),
            dropped => format!("[{dropped} bytes before this]\n{text}"),
        }
    }

    /// The same, when all that was printed has been read, or else after `patience`.
    pub(crate) fn last_words(&self, patience: Duration) -> String {
        let begun = Instant::now();
        while !self.reader.is_finished() && begun.elapsed() < patience {
            thread::sleep(Duration::from_millis(1));
        }
        self.text()
    }
}

fn read(mut pipe: PipeReader, tail: &Mutex<Tail>) {
    let mut buffer = [0; 16 << 10];
    while let Ok(length @ 1..) = pipe.read(&mut buffer) {
        tail.lock().unwrap_or_else(PoisonError::into_inner).append(&buffer[..length]);
    }
}

impl Tail {
    fn append(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
        let excess = self.bytes.len().saturating_sub(KEPT);
        self.bytes.drain(..excess);
        self.dropped += excess as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn of_a_flood_the_end_is_kept_and_the_rest_is_counted() {
        let (reader, mut writer) = std::io::pipe().unwrap();
        let output = Output::of(reader);
        for _ in 0..100 {
            writer.write_all(&[b'x'; 1000]).unwrap();
        }
        writer.write_all(b"last words").unwrap();
        drop(writer);
        let text = output.last_words(Duration::from_secs(10));
        assert!(text.starts_with("[34474 bytes before this]\nxxx"), "{}", &text[..40]);
        assert!(text.ends_with("xlast words"));
    }
}
