//! Enums whose words stand beside their variants.

/// Declares an enum that is displayed as the words of its variants.
macro_rules! spoken {
    ($(#[$meta:meta])* $vis:vis enum $name:ident { $($(#[$of:meta])* $variant:ident = $words:literal,)* }) => {
        $(#[$meta])*
        $vis enum $name { $($(#[$of])* $variant,)* }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(match self { $(Self::$variant => $words,)* })
            }
        }
    };
}

pub(crate) use spoken;
