//! How sets of flags cross: by the names of those that are set, so that a bit may move.

/// Flags that cross by their names, written as users write them.
macro_rules! by_names {
    ($flags:ident, $kind:literal) => {
        impl $flags {
            /// The names of the single flags in `self`, as users write them: `box-test`.
            pub fn names(self) -> Vec<String> {
                self.iter_names().map(|(name, _)| name.to_lowercase().replace('_', "-")).collect()
            }

            /// The flags of these names.
            ///
            /// # Errors
            /// With the word that names none.
            pub(crate) fn from_names(names: &[String]) -> Result<Self, String> {
                names.iter().try_fold(Self::empty(), |all, name| {
                    let flag = Self::from_name(&name.to_uppercase().replace('-', "_"));
                    let unknown = || format!("there is no {} `{name}`", $kind);
                    flag.map(|flag| all | flag).ok_or_else(unknown)
                })
            }
        }

        impl serde::Serialize for $flags {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.names().serialize(serializer)
            }
        }

        impl<'de> serde::Deserialize<'de> for $flags {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let names = Vec::<String>::deserialize(deserializer)?;
                let known = Self::all().names();
                let wrong = names.iter().find(|name| !known.contains(name));
                let meant = wrong.and_then(|name| {
                    crate::text::did_you_mean(name, known.iter().map(String::as_str))
                });
                let hint = meant.map_or_else(String::new, |meant| format!(": {meant}"));
                Self::from_names(&names)
                    .map_err(|problem| serde::de::Error::custom(format!("{problem}{hint}")))
            }
        }
    };
}
pub(super) use by_names;
