//! SHA-256 in hexadecimal: how a file, a case or a build is known again.

use sha2::{Digest, Sha256};

/// The SHA-256 of a file's content, in hexadecimal: how provenance knows its image.
pub fn fingerprint(content: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(content))
}

/// What a hash has come to.
pub(crate) fn hexadecimal(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_is_that_of_the_standard() {
        // FIPS 180-4, of the message "abc".
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(fingerprint(b"abc"), expected);
    }
}
