//! Which cases are selected: substrings of `folder/claim`, `@tag`, and `!` for not.

use super::Case;

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

impl Filter {
    /// Reads words such as `bvh`, `@energy`, `3` (a part's number), `!@slow`.
    pub fn new(words: &[String]) -> Self {
        let mut filter = Self::default();
        for word in words {
            match word.strip_prefix('!') {
                Some(rest) => filter.unwanted.push(Word::new(rest)),
                None => filter.wanted.push(Word::new(word)),
            }
        }
        filter
    }

    /// Whether the case is selected.
    pub fn selects(&self, case: &Case) -> bool {
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
}
