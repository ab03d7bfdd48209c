//! The bytes of one message: a prefix of 24 bytes, a header in JSON, and arrays as they lie in memory.
//!
//! ```text
//! offset  size  what, little-endian
//!      0     4  "FRN1": the version of the protocol
//!      4     4  H, bytes of the header
//!      8     8  number of the request, echoed by its answer
//!     16     8  B, bytes of the body
//!     24     H  the header: a JSON object, UTF-8
//!   24+H     B  the body: the arrays that the header lists, each filled up to a multiple of 8
//! ```
//!
//! Not here: what headers say (`message`). Whoever sends is not trusted: no length is believed before it is bounded.

use crate::contract::crossing::{ALIGNMENT, Malformed, padded};
use std::io::{self, Read, Write};

pub(crate) const MAGIC: [u8; 4] = *b"FRN1";

const PREFIX: usize = 24;

/// The longest header that is read: the names of a scene's shapes, or a long complaint.
const LONGEST_HEADER: usize = 64 << 20;

/// Why no frame could be read.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The other side has closed the channel, between two frames or within one.
    #[error("the channel was closed")]
    Closed,
    /// An I/O error.
    #[error("the channel failed: {0}")]
    Io(io::Error),
    /// What came is no frame.
    #[error("what came on the channel is no frame: {0}")]
    Malformed(String),
    /// A frame whose header says what nobody knows.
    #[error("its header says what cannot be: {0}")]
    Unknown(String),
}

impl From<Malformed> for FrameError {
    fn from(Malformed(what): Malformed) -> Self {
        Self::Malformed(what)
    }
}

impl From<io::Error> for FrameError {
    fn from(error: io::Error) -> Self {
        use io::ErrorKind::{BrokenPipe, ConnectionReset, UnexpectedEof};
        match error.kind() {
            UnexpectedEof | BrokenPipe | ConnectionReset => Self::Closed,
            _ => Self::Io(error),
        }
    }
}

/// What a frame announces of itself, and its header.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Opening {
    pub(crate) number: u64,
    pub(crate) header: Vec<u8>,
    /// Bytes of the body, which have not been read yet.
    pub(crate) body: u64,
}

/// Puts a whole frame into `buffer`, in place of what was there. Fails if the header is longer than any reader takes.
pub(crate) fn encode(
    buffer: &mut Vec<u8>,
    number: u64,
    header: &[u8],
    arrays: &[&[u8]],
) -> Result<(), FrameError> {
    let body: usize = arrays.iter().map(|array| padded(array.len())).sum();
    buffer.clear();
    buffer.reserve(PREFIX + header.len() + body);
    encode_start(buffer, number, header, body as u64)?;
    for array in arrays {
        buffer.extend_from_slice(array);
        buffer.resize(buffer.len() + padded(array.len()) - array.len(), 0);
    }
    Ok(())
}

/// Appends a frame up to its body. Fails if the header is longer than any reader takes.
fn encode_start(
    buffer: &mut Vec<u8>,
    number: u64,
    header: &[u8],
    body: u64,
) -> Result<(), FrameError> {
    let too_long = |_| FrameError::Malformed(format!("a header of {} bytes", header.len()));
    let header_length = u32::try_from(header.len()).map_err(too_long)?;
    buffer.extend_from_slice(&MAGIC);
    buffer.extend_from_slice(&header_length.to_le_bytes());
    buffer.extend_from_slice(&number.to_le_bytes());
    buffer.extend_from_slice(&body.to_le_bytes());
    buffer.extend_from_slice(header);
    Ok(())
}

/// Sends what [`encode`] has made. Fails if the other side is gone, or on an I/O error.
pub(crate) fn send(channel: &mut impl Write, frame: &[u8]) -> Result<(), FrameError> {
    channel.write_all(frame)?;
    Ok(channel.flush()?)
}

/// Reads a frame up to its body. Fails if the channel ends, or what comes is no frame.
pub(crate) fn open(channel: &mut impl Read) -> Result<Opening, FrameError> {
    let mut prefix = [0; PREFIX];
    channel.read_exact(&mut prefix)?;
    if prefix[..4] != MAGIC {
        let found = String::from_utf8_lossy(&prefix).escape_debug().to_string();
        return Err(FrameError::Malformed(format!("it begins with \"{found}\"")));
    }
    let length = number_at(&prefix, 4, 4) as usize;
    if length > LONGEST_HEADER {
        return Err(FrameError::Malformed(format!("it announces a header of {length} bytes")));
    }
    let mut header = Vec::new();
    // In pieces: a frame that announces more than it sends costs no more than it sends.
    if channel.take(length as u64).read_to_end(&mut header)? != length {
        return Err(FrameError::Closed);
    }
    Ok(Opening { number: number_at(&prefix, 8, 8), header, body: number_at(&prefix, 16, 8) })
}

/// The little-endian number in `size` bytes from `offset` on.
fn number_at(bytes: &[u8; PREFIX], offset: usize, size: usize) -> u64 {
    let digits = bytes[offset..offset + size].iter().rev();
    digits.fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// Passes on a frame of which only the opening has been read. Fails if either side is gone.
pub(crate) fn pass(
    opening: &Opening,
    from: &mut impl Read,
    to: &mut impl Write,
) -> Result<(), FrameError> {
    let mut start = Vec::new();
    encode_start(&mut start, opening.number, &opening.header, opening.body)?;
    to.write_all(&start)?;
    if io::copy(&mut from.take(opening.body), to)? != opening.body {
        return Err(FrameError::Closed);
    }
    Ok(to.flush()?)
}

/// Reads one array of a body, and what it is filled up with. Fails if the channel ends.
pub(crate) fn read_array(channel: &mut impl Read, array: &mut [u8]) -> Result<(), FrameError> {
    channel.read_exact(array)?;
    let mut filling = [0; ALIGNMENT];
    Ok(channel.read_exact(&mut filling[..padded(array.len()) - array.len()])?)
}

/// Words of memory that are taken at a time: a body that announces more than it sends costs little more than it sends.
const PIECE: usize = 1 << 17;

/// A body that was read whole, aligned so that its arrays can be looked at where they lie.
#[derive(Debug, Default)]
pub(crate) struct Body(Vec<u64>);

impl Body {
    /// Reads a body into the memory of the last one. Fails if the channel ends, or the length is no multiple of 8.
    pub(crate) fn read(&mut self, channel: &mut impl Read, bytes: u64) -> Result<(), FrameError> {
        let words = usize::try_from(bytes / ALIGNMENT as u64).unwrap_or(usize::MAX);
        if !bytes.is_multiple_of(ALIGNMENT as u64) || words == usize::MAX {
            return Err(FrameError::Malformed(format!("it announces a body of {bytes} bytes")));
        }
        self.0.truncate(words);
        let mut filled = 0;
        loop {
            channel.read_exact(bytemuck::cast_slice_mut(&mut self.0[filled..]))?;
            filled = self.0.len();
            if filled == words {
                return Ok(());
            }
            self.0.resize(words.min(filled + PIECE), 0);
        }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(number: u64, header: &[u8], arrays: &[&[u8]]) -> Vec<u8> {
        let mut buffer = b"left over".to_vec();
        encode(&mut buffer, number, header, arrays).unwrap();
        buffer
    }

    #[test]
    fn a_body_that_announces_more_than_it_sends_is_closed() {
        let mut body = Body::default();
        let announced = u64::MAX - 7;
        assert!(matches!(body.read(&mut &[1; 64][..], announced), Err(FrameError::Closed)));
    }

    #[test]
    fn what_is_sent_is_what_arrives() {
        let sent = frame(7, b"{}", &[b"12345", b"12345678"]);
        let mut channel = sent.as_slice();
        let opening = open(&mut channel).unwrap();
        assert_eq!(opening, Opening { number: 7, header: b"{}".to_vec(), body: 16 });
        let mut array = [0; 5];
        read_array(&mut channel, &mut array).unwrap();
        assert_eq!(&array, b"12345");
        let mut body = Body::default();
        body.read(&mut channel, 8).unwrap();
        assert_eq!(body.bytes(), b"12345678");
        assert!(matches!(open(&mut channel), Err(FrameError::Closed)));
    }

    #[test]
    fn text_on_the_channel_is_told_in_its_own_words() {
        let complaint = open(&mut b"Building BVH...\nDone! (0.1 s)\n".as_slice()).unwrap_err();
        assert!(complaint.to_string().contains(r#"begins with "Building BVH...\nDone!"#));
    }

    #[test]
    fn a_frame_cut_anywhere_is_a_closed_channel() {
        let whole = frame(1, b"{\"a\":1}", &[&[1, 2, 3]]);
        for end in 0..whole.len() {
            let mut channel = &whole[..end];
            let outcome = open(&mut channel)
                .and_then(|opening| Body::default().read(&mut channel, opening.body));
            assert!(matches!(outcome, Err(FrameError::Closed)), "cut at {end}: {outcome:?}");
        }
    }

    #[test]
    fn lengths_that_cannot_be_are_refused_before_memory_is_taken() {
        let mut lie = frame(1, b"{}", &[]);
        lie[4..8].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(matches!(open(&mut lie.as_slice()), Err(FrameError::Malformed(_))));
        let mut body = Body::default();
        assert!(matches!(body.read(&mut io::empty(), 12), Err(FrameError::Malformed(_))));
    }
}
