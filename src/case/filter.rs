//! Which cases are selected: substrings of `folder/claim`, `@tag`, a part's number, and `!` for not.

use super::renamed::renamed;
use super::{Case, PARTS};
use crate::text::{hint, listed};
use std::sync::Arc;

/// What the user typed after the verb. Of the positive words one must match, of the negative none may.
#[derive(Clone, Debug, Default)]
pub struct Filter {
    wanted: Vec<Word>,
    unwanted: Vec<Word>,
}

#[derive(Clone, Debug)]
enum Word {
    Tag(String),
    Part(u32),
    Text(String),
}

/// Why there is nothing to do. Displays with a hint.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}\nhint: {hint}")]
pub struct NothingSelected {
    problem: String,
    hint: String,
}

impl NothingSelected {
    /// By the number of a part.
    pub(crate) fn part(number: u32) -> Self {
        Self {
            problem: format!("there is no part {number}"),
            hint: format!("the parts are 1 to {}", PARTS.len()),
        }
    }

    /// By a word that is in none of these names. A piece of one may have been meant.
    pub(crate) fn by<'a>(word: &str, names: impl Iterator<Item = &'a str> + Clone) -> Self {
        let slugs = names.clone().flat_map(|name| name.split('/'));
        let pieces = names.clone().flat_map(|name| name.split(['/', '-']));
        let all = || "`furnace list` shows what there is".to_owned();
        Self {
            problem: format!("nothing is selected by `{word}`"),
            hint: hint(word, names.chain(slugs).chain(pieces), all),
        }
    }
}

impl Filter {
    /// Reads words such as `bvh`, `@energy`, `3` (a part's number), `!@slow`.
    pub(crate) fn new(words: &[String]) -> Self {
        let mut filter = Self::default();
        for word in words {
            match word.strip_prefix('!') {
                Some(rest) => filter.unwanted.push(Word::new(rest)),
                None => filter.wanted.push(Word::new(word)),
            }
        }
        filter
    }

    /// The cases that are selected: one at least.
    ///
    /// # Errors
    /// If there is none, or one of the words alone selects none: it is mistyped, or its case has another name now.
    pub(crate) fn select<'a>(
        &self,
        cases: &'a [Arc<Case>],
    ) -> Result<Vec<&'a Arc<Case>>, NothingSelected> {
        let mut words = self.wanted.iter().chain(&self.unwanted);
        if let Some(dead) = words.find(|word| !cases.iter().any(|case| word.matches(case))) {
            return Err(dead.selects_nothing(cases));
        }
        let selected: Vec<_> = cases.iter().filter(|case| self.selects(case)).collect();
        match selected.is_empty() {
            false => Ok(selected),
            true => Err(NothingSelected {
                problem: "no case is left to try".to_owned(),
                hint: "`furnace list` shows the cases".to_owned(),
            }),
        }
    }

    fn selects(&self, case: &Case) -> bool {
        let wanted = self.wanted.is_empty() || self.wanted.iter().any(|word| word.matches(case));
        wanted && !self.unwanted.iter().any(|word| word.matches(case))
    }
}

impl Word {
    fn new(text: &str) -> Self {
        if let Some(tag) = text.strip_prefix('@') {
            Self::Tag(tag.to_owned())
        } else if let Ok(number) = text.parse() {
            Self::Part(number)
        } else {
            Self::Text(text.to_owned())
        }
    }

    fn matches(&self, case: &Case) -> bool {
        match self {
            Self::Tag(tag) => case.tags.contains(tag),
            Self::Part(number) => case.part().is_some_and(|part| part.number == *number),
            Self::Text(text) => case.id.contains(text.as_str()),
        }
    }

    /// The complaint about it, with the nearest word that would select something.
    fn selects_nothing(&self, cases: &[Arc<Case>]) -> NothingSelected {
        let ids = cases.iter().map(|case| case.id.as_str());
        match self {
            Self::Tag(tag) => {
                let tags = cases.iter().flat_map(|case| &case.tags).map(|tag| format!("@{tag}"));
                let tags: Vec<_> = tags.collect();
                NothingSelected::by(&format!("@{tag}"), tags.iter().map(String::as_str))
            }
            Self::Part(number) => NothingSelected::part(*number),
            Self::Text(text) if renamed(text).next().is_some() => NothingSelected {
                problem: format!("nothing is called `{text}` any more"),
                hint: format!("now there is {}", listed(renamed(text))),
            },
            Self::Text(text) => NothingSelected::by(text, ids),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::Project;
    use std::path::Path;

    fn selected(words: &[&str]) -> Result<usize, String> {
        let project = Project::at(Path::new(env!("CARGO_MANIFEST_DIR")));
        let cases = super::super::load_all(&project.cases()).unwrap();
        let words: Vec<_> = words.iter().map(ToString::to_string).collect();
        let selected = Filter::new(&words).select(&cases).map(|cases| cases.len());
        selected.map_err(|error| error.to_string())
    }

    #[test]
    fn words_add_and_negated_words_take_away() {
        let all = selected(&[]).unwrap();
        let second = selected(&["2"]).unwrap();
        assert_eq!(selected(&["bvh/"]), Ok(second));
        assert_eq!(selected(&["!bvh/"]), Ok(all - second));
    }

    #[test]
    fn a_word_that_selects_nothing_is_an_error_with_the_nearest_name() {
        let message = |words: &[&str]| selected(words).unwrap_err();
        assert!(message(&["bvh/", "furnce"]).ends_with("did you mean `furnace`?"));
        assert!(message(&["!trangle"]).ends_with("did you mean `triangle`?"));
        assert!(message(&["7"]).starts_with("there is no part 7"));
        assert!(message(&["@part-33"]).contains("`@part-3"));
        assert!(message(&["bvh/", "!bvh/"]).starts_with("no case is left"));
    }

    #[test]
    fn a_case_is_found_by_its_old_name_or_by_the_rest_of_it() {
        let message = selected(&["elsewhere/furnace-"]).unwrap_err();
        assert!(message.contains("integrator/furnace-"), "{message}");
        let message = selected(&["samplers/the-cosine-map"]).unwrap_err();
        assert!(message.contains("now there is `sampling/"), "{message}");
    }
}
