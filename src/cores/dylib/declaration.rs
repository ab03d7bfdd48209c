//! What a C core declares: the functions it has, its traits, its conventions.

use crate::contract::abi::{self, Traits};
use crate::contract::question::each_question;
use crate::contract::{
    Capabilities, Conventions, EmissionSides, Falloff, GlassFresnel, GlassRadiance, SmithTerm,
};

/// What is freely chosen, and the number of each choice.
macro_rules! choices {
    ($($field:ident: $type:ident { $($choice:ident = $number:ident),* })*) => {
        /// What the core declares; `None` for a number that no convention has.
        pub(crate) fn conventions(declared: &abi::Conventions) -> Option<Conventions> {
            Some(Conventions {
                $($field: match declared.$field {
                    $(abi::$number => $type::$choice,)*
                    _ => return None,
                },)*
            })
        }

        /// What a core declares that has chosen so.
        pub(super) const fn of_conventions(chosen: &Conventions) -> abi::Conventions {
            abi::Conventions {
                $($field: match chosen.$field {
                    $($type::$choice => abi::$number,)*
                },)*
                reserved: [0; 3],
            }
        }
    };
}
choices! {
    point_light_falloff: Falloff { InverseSquare = FALLOFF_INVERSE_SQUARE, None = FALLOFF_NONE }
    emission: EmissionSides { Front = EMISSION_FRONT, Both = EMISSION_BOTH }
    smith_term: SmithTerm { Separable = SMITH_SEPARABLE, HeightCorrelated = SMITH_CORRELATED }
    glass_fresnel: GlassFresnel {
        Exact = FRESNEL_EXACT, Schlick = FRESNEL_SCHLICK, SchlickOutside = FRESNEL_SCHLICK_OUTSIDE
    }
    glass_radiance: GlassRadiance { Scaled = RADIANCE_SCALED, Unscaled = RADIANCE_UNSCALED }
}

/// What each trait says, of a core that can do one of these; of any, where there is none.
const TRAITS: &[(Traits, Capabilities, Capabilities)] = {
    use {Capabilities as Can, Traits as Has};
    const INTEGRATES: Capabilities = Can::RENDER.union(Can::RADIANCE);
    &[
        (Has::BRUTE_FORCE, Can::BRUTE_FORCE, Can::BUILD_SCENE),
        (Has::SPLIT_RULES, Can::SPLIT_RULES, Can::BUILD_SCENE),
        (Has::COUNTS_TRAVERSAL, Can::TRAVERSAL_STATS, Can::INTERSECT),
        (Has::COUNTED_TESTS, Can::TRAVERSAL_STATS, Can::INTERSECT),
        (Has::HEMISPHERE_SAMPLING, Can::HEMISPHERE_SAMPLING, INTEGRATES),
        (Has::ISOLATED_BOUNCES, Can::ISOLATED_BOUNCES, INTEGRATES),
        (Has::DEPTH_LIMIT, Can::DEPTH_LIMIT, INTEGRATES),
        (Has::ROULETTE, Can::ROULETTE, INTEGRATES),
        (Has::ADAPTIVE_SAMPLING, Can::ADAPTIVE_SAMPLING, Can::RENDER),
        (Has::REPORTED_VARIANCE, Can::REPORTED_VARIANCE, Can::RENDER),
        (Has::STRATIFIED_PIXELS, Can::STRATIFIED_PIXELS, Can::RENDER),
        (Has::KNOWS_ROUGH_GLASS, Can::ROUGH_GLASS, Can::empty()),
        (Has::CALLERS_RANDOMNESS, Can::CALLERS_RANDOMNESS, Can::empty()),
        (Has::DETERMINISTIC, Can::DETERMINISTIC, Can::empty()),
        (Has::INDEPENDENT_PIXELS, Can::INDEPENDENT_PIXELS, Can::empty()),
        (Has::INDEPENDENT_SAMPLES, Can::INDEPENDENT_SAMPLES, Can::empty()),
        (Has::PLAIN_ESTIMATORS, Can::PLAIN_ESTIMATORS, Can::empty()),
    ]
};

/// The traits of a core that can do this; its ray tests are its own.
pub(super) fn traits(can: Capabilities) -> Traits {
    let said = TRAITS.iter().filter(|(_, says, _)| can.contains(*says));
    said.fold(Traits::empty(), |all, (one, ..)| all | *one) - Traits::COUNTED_TESTS
}

/// The capabilities of plain questions whose functions are there.
macro_rules! add_if_there {
    (($found:ident, $table:ident) {
        $(#[$doc:meta])* $can:ident $(= $bit:literal)? fn $method:ident $($rest:tt)*
    }) => {
        if $table.$method.is_some() {
            $found |= Capabilities::$can;
        }
    };
}

/// What a core can be asked: the functions it has, and of its traits those that go with them.
pub(crate) fn capabilities(table: &abi::CoreTable) -> Capabilities {
    let mut found = Capabilities::empty();
    each_question! { PlainCore add_if_there (found, table) }
    let hits_primitives = table.intersect_triangle.is_some() || table.intersect_sphere.is_some();
    found.set(Capabilities::INTERSECT_PRIMITIVE, hits_primitives);
    found.set(Capabilities::INTERSECT_BOX, table.intersect_box.is_some());
    if table.build.is_some() && table.release.is_some() {
        found |= Capabilities::BUILD_SCENE;
        each_question! { PlainScene add_if_there (found, table) }
        found.set(Capabilities::RENDER, table.render.is_some());
    }
    let has = Traits::from_bits_truncate(table.traits);
    let said = TRAITS.iter().filter(|(one, _, with)| {
        has.contains(*one) && (with.is_empty() || found.intersects(*with))
    });
    said.fold(found, |all, (_, says, _)| all | *says)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_core_that_declares_nothing_follows_the_defaults() {
        assert_eq!(conventions(&abi::Conventions::default()), Some(Conventions::default()));
    }

    #[test]
    fn a_convention_that_nobody_knows_is_refused() {
        let declared = abi::Conventions { smith_term: 2, ..abi::Conventions::default() };
        assert_eq!(conventions(&declared), None);
    }
}
