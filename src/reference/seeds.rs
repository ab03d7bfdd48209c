//! Sets of seeds, as ranges: which passes a reference holds.

use std::fmt;

/// Seeds, as first and last of each unbroken range, ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Seeds(Vec<[u32; 2]>);

impl Seeds {
    /// From ranges; none if two share a seed or one ends before it begins.
    pub(crate) fn from_ranges(ranges: &[[u32; 2]]) -> Option<Self> {
        let mut seeds = Self::default();
        for &[first, last] in ranges {
            let range = Self(vec![[first, last]]);
            if last < first || seeds.first_in_both(&range).is_some() {
                return None;
            }
            seeds.add(&range);
        }
        Some(seeds)
    }

    pub(crate) fn ranges(&self) -> &[[u32; 2]] {
        &self.0
    }

    pub(crate) fn count(&self) -> u32 {
        self.0.iter().map(|[first, last]| last - first + 1).sum()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = u32> {
        self.0.iter().flat_map(|&[first, last]| first..=last)
    }

    pub(crate) fn contains(&self, seed: u32) -> bool {
        self.0.iter().any(|&[first, last]| (first..=last).contains(&seed))
    }

    pub(crate) fn first_in_both(&self, other: &Self) -> Option<u32> {
        other.iter().find(|seed| self.contains(*seed))
    }

    /// Takes in a seed that is not among them.
    pub(crate) fn add_one(&mut self, seed: u32) {
        self.add(&Self(vec![[seed, seed]]));
    }

    /// Takes in seeds that are not among them.
    pub(crate) fn add(&mut self, other: &Self) {
        self.0.extend(&other.0);
        self.0.sort_unstable();
        let mut joined: Vec<[u32; 2]> = Vec::new();
        for &range in &self.0 {
            match joined.last_mut() {
                Some([_, last]) if *last + 1 == range[0] => *last = range[1],
                _ => joined.push(range),
            }
        }
        self.0 = joined;
    }
}

impl fmt::Display for Seeds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ranges: Vec<String> =
            self.0.iter().map(|[first, last]| format!("{first} to {last}")).collect();
        f.write_str(&ranges.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_touch_become_one_and_those_that_overlap_are_refused() {
        let seeds = Seeds::from_ranges(&[[64, 95], [0, 31], [32, 63], [100, 100]]).unwrap();
        assert_eq!(seeds.ranges(), [[0, 95], [100, 100]]);
        assert_eq!(seeds.count(), 97);
        assert_eq!(seeds.to_string(), "0 to 95 and 100 to 100");
        assert!(Seeds::from_ranges(&[[0, 31], [31, 40]]).is_none());
        assert!(Seeds::from_ranges(&[[5, 4]]).is_none());
        let other = Seeds::from_ranges(&[[96, 101]]).unwrap();
        assert_eq!(seeds.first_in_both(&other), Some(100));
    }
}
