//! The head of a check, said once: its settings, its names, and what it asks a core to be able to do.

use crate::contract::Capabilities;
use serde::de::DeserializeOwned;

/// What [`check!`](crate::checks::check) writes for a check.
pub(crate) trait Declared: DeserializeOwned + Send + Sync + 'static {
    /// The word in `check = "…"`.
    const NAME: &'static str;
    /// One line for `furnace list checks`.
    const SUMMARY: &'static str;
    /// What a core must be able to do, whatever the settings.
    const NEEDS: Capabilities;
}

/// Declares a check: the struct that is the `[expect]` of its cases, refusing keys it does not have;
/// its `name`, its `summary` and what it `needs`. `impl Check` follows by hand.
macro_rules! check {
    (
        $(#[$attribute:meta])*
        $visibility:vis struct $check:ident { $($settings:tt)* }
        name: $name:literal,
        summary: $summary:literal,
        $(needs: $($capability:ident)|+,)?
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields, rename_all = "kebab-case")]
        $visibility struct $check { $($settings)* }

        impl $crate::checks::Declared for $check {
            const NAME: &'static str = $name;
            const SUMMARY: &'static str = $summary;
            const NEEDS: $crate::contract::Capabilities =
                $crate::contract::Capabilities::empty()
                    $($(.union($crate::contract::Capabilities::$capability))+)?;
        }
    };
}

/// The `CHECKS` of a subject.
macro_rules! checks {
    ($($check:ty,)+) => {
        pub(crate) static CHECKS: &[$crate::checks::CheckKind] =
            &[$($crate::checks::CheckKind::of::<$check>()),+];
    };
}

pub(crate) use {check, checks};
