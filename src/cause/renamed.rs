//! What causes were called before: an old name in a case or a sidecar still finds its cause.

/// `old new`, a cause a line; lines with `#` are comments.
const TABLE: &str = include_str!("renamed.txt");

fn pairs() -> impl Iterator<Item = (&'static str, &'static str)> {
    TABLE.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(' '))
}

/// What the cause once called `old` is called now; any other name is its own.
pub(crate) fn current(old: &str) -> &str {
    pairs().find(|(before, _)| *before == old).map_or(old, |(_, now)| now)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cause::{all, find};

    #[test]
    fn an_old_name_finds_the_cause_of_today() {
        for (old, new) in pairs() {
            assert!(all().all(|cause| cause.name != old), "{old} is still there");
            assert_eq!(find(old).map(|cause| cause.name), Some(new));
        }
    }
}
