//! The word that was probably meant.

/// `did you mean …?` for the valid word closest to `word`, if one is close enough to be worth naming.
///
/// Damerau-Levenshtein distance of at most a third of the length: two slips in `positon`, none in `at`.
pub(crate) fn did_you_mean<'a>(
    word: &str,
    valid: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let distance = |candidate: &str| strsim::damerau_levenshtein(word, candidate);
    let nearest = valid.into_iter().min_by_key(|candidate| distance(candidate))?;
    let allowed = word.chars().count().max(3) / 3;
    (distance(nearest) <= allowed).then(|| format!("did you mean `{nearest}`?"))
}

/// Words as a list for a message: "`a`, `b` or `c`".
pub(crate) fn listed<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// The words in backticks of one of serde's messages: the wrong one first, then the valid ones.
pub(super) fn quoted_words(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_is_recognised() {
        let valid = ["position", "look-at", "film"];
        assert_eq!(did_you_mean("positon", valid), Some("did you mean `position`?".to_owned()));
        assert_eq!(did_you_mean("lookat", valid), Some("did you mean `look-at`?".to_owned()));
    }

    #[test]
    fn a_word_unlike_all_others_gets_no_suggestion() {
        assert_eq!(did_you_mean("aperture", ["position", "film"]), None);
        assert_eq!(did_you_mean("aperture", []), None);
    }

    #[test]
    fn lists_read_as_a_sentence_does() {
        assert_eq!(listed([]), "nothing");
        assert_eq!(listed(["a"]), "`a`");
        assert_eq!(listed(["a", "b", "c"]), "`a`, `b` or `c`");
    }

    #[test]
    fn serdes_words_are_found_between_backticks() {
        let message = "unknown field `fov`, expected one of `film`, `up`";
        assert_eq!(quoted_words(message), ["fov", "film", "up"]);
    }
}
