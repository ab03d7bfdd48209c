//! The word that was probably meant.

/// Words named that have the wrong one in them.
const ALIKE: usize = 3;

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

/// What to say of a word that nothing is called: the valid one that was probably meant, or those that have it in them,
/// or else `otherwise`.
pub(crate) fn hint<'a>(
    word: &str,
    valid: impl Iterator<Item = &'a str> + Clone,
    otherwise: impl FnOnce() -> String,
) -> String {
    did_you_mean(word, valid.clone()).or_else(|| alike(word, valid)).unwrap_or_else(otherwise)
}

/// `did you mean …?` for the first valid words that have `word` in them, or what stands behind its last slash.
fn alike<'a>(word: &str, valid: impl Iterator<Item = &'a str>) -> Option<String> {
    let last = word.rsplit('/').next().filter(|last| last.len() > 2)?;
    let alike: Vec<_> = valid.filter(|candidate| candidate.contains(last)).take(ALIKE).collect();
    (!alike.is_empty()).then(|| format!("did you mean {}?", listed(alike)))
}

/// All valid words, where they are few.
pub(crate) fn all_of<'a>(valid: impl Iterator<Item = &'a str>) -> String {
    format!("there are {}", listed(valid))
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
    fn a_part_of_a_name_is_answered_with_names() {
        let hint = |word| hint(word, ["cornell-box", "cornell-spheres"].into_iter(), String::new);
        assert_eq!(hint("cornel-box"), "did you mean `cornell-box`?");
        assert_eq!(hint("image/cornell"), "did you mean `cornell-box` or `cornell-spheres`?");
        assert_eq!(hint("teapot"), "");
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
