//! How much of an audit is asked for, from the environment.

/// A number, or the usual one.
///
/// # Panics
/// If it is no number.
pub fn number(name: &str, default: u32) -> u32 {
    std::env::var(name).map_or(default, |word| word.parse().unwrap())
}

/// `FURNACE_SHARD=1/4`: this part, and of how many.
///
/// # Panics
/// If it is not two numbers.
pub fn shard() -> (u32, u32) {
    let Ok(word) = std::env::var("FURNACE_SHARD") else { return (1, 1) };
    let (part, of) = word.split_once('/').unwrap();
    (part.parse().unwrap(), of.parse().unwrap())
}
