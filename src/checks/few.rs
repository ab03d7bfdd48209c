//! Which few of the known mistakes explain what is seen.

use crate::cause::Cause;

/// Mistakes that explain what is seen.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Few<T> {
    /// Any one of these would.
    OneOf(Vec<T>),
    /// None does alone, and these are in every pair that does.
    Both(Vec<T>),
}

/// Every mistake that fits alone, or else what all pairs that fit have in common. None where nothing wrong fits as well:
/// a mistake that does not show here would fit too.
pub(crate) fn few_that_fit<'a, Mistake>(
    known: &'a [Mistake],
    fits: impl Fn(&[&'a Mistake]) -> bool,
) -> Few<&'a Mistake> {
    if fits(&[]) {
        return Few::OneOf(Vec::new());
    }
    let alone: Vec<_> = known.iter().filter(|one| fits(&[one])).collect();
    if !alone.is_empty() {
        return Few::OneOf(alone);
    }
    let others = (1..=known.len()).map(|next| &known[next..]);
    let pairs = known.iter().zip(others).flat_map(|(a, others)| others.iter().map(move |b| [a, b]));
    let fitting: Vec<_> = pairs.filter(|pair| fits(pair)).collect();
    let is_in_all = |one: &&Mistake| {
        fitting.iter().all(|pair| pair.iter().any(|other| std::ptr::eq(*other, *one)))
    };
    let first = fitting.first().into_iter().flatten();
    Few::Both(first.copied().filter(is_in_all).collect())
}

impl<T> Few<T> {
    pub(crate) fn map<U>(self, f: impl Fn(T) -> U) -> Few<U> {
        match self {
            Self::OneOf(all) => Few::OneOf(all.into_iter().map(f).collect()),
            Self::Both(all) => Few::Both(all.into_iter().map(f).collect()),
        }
    }

    pub(crate) const fn is_empty(&self) -> bool {
        let (Self::OneOf(all) | Self::Both(all)) = self;
        all.is_empty()
    }
}

impl Few<&'static Cause> {
    /// Their headlines: `one thing, or another`.
    pub(crate) fn words(&self) -> String {
        let (all, link) = match self {
            Self::OneOf(all) => (all, ", or "),
            Self::Both(all) => (all, ", and "),
        };
        all.iter().map(|cause| cause.headline).collect::<Vec<_>>().join(link)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_product<const N: usize>(known: &[u32; N], wanted: u32) -> Few<&u32> {
        few_that_fit(known, move |few| few.iter().copied().product::<u32>() == wanted)
    }

    #[test]
    fn a_pair_is_tried_only_where_none_alone_fits() {
        assert_eq!(of_product(&[2, 3, 5, 6], 6), Few::OneOf(vec![&6]));
        assert_eq!(of_product(&[2, 3, 5, 6], 15), Few::Both(vec![&3, &5]));
        assert!(of_product(&[2, 3, 5, 6], 7).is_empty());
    }

    #[test]
    fn what_is_right_needs_no_mistake_that_changes_nothing() {
        assert!(of_product(&[1, 2, 3], 1).is_empty());
        assert_eq!(of_product(&[1, 2, 3], 2), Few::OneOf(vec![&2]));
    }

    #[test]
    fn what_only_some_of_the_pairs_need_is_not_told() {
        assert!(of_product(&[2, 4, 6, 3], 12).is_empty());
    }
}
