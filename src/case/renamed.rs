//! What cases were called before: an old name in a script is answered with the new one.

/// `old new`, a case a line; lines with `#` are comments.
const TABLE: &str = include_str!("renamed.txt");

fn pairs() -> impl Iterator<Item = (&'static str, &'static str)> {
    TABLE.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(' '))
}

/// The cases whose old names have `word` in them, as they are called now.
pub(super) fn renamed(word: &str) -> impl Iterator<Item = &'static str> {
    pairs().filter(move |(old, _)| old.contains(word)).map(|(_, new)| new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn an_old_name_leads_to_a_case_that_is_there() {
        let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
        assert!(pairs().count() > 150);
        for (old, new) in pairs() {
            assert!(cases.join(format!("{new}.toml")).exists(), "{new}");
            assert!(!cases.join(format!("{old}.toml")).exists(), "{old} is still there");
        }
        let found: Vec<_> = renamed("a-furnace-glows-by-its-series").collect();
        assert_eq!(found, ["integrator/furnace-matches-geometric-series"]);
    }
}
