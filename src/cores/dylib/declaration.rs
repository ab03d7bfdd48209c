//! What a C core declares: the functions it has, its traits, its conventions.

use crate::contract::abi::{self, Traits};
use crate::contract::question::each_question;
use crate::contract::{
    Capabilities, Conventions, EmissionSides, Falloff, GlassFresnel, GlassRadiance, SmithTerm,
};

/// What the core declares; `None` for a number that no convention has.
pub(crate) fn conventions(declared: &abi::Conventions) -> Option<Conventions> {
    Some(Conventions {
        point_light_falloff: match declared.point_light_falloff {
            abi::FALLOFF_INVERSE_SQUARE => Falloff::InverseSquare,
            abi::FALLOFF_NONE => Falloff::None,
            _ => return None,
        },
        emission: match declared.emission {
            abi::EMISSION_FRONT => EmissionSides::Front,
            abi::EMISSION_BOTH => EmissionSides::Both,
            _ => return None,
        },
        smith_term: match declared.smith_term {
            abi::SMITH_SEPARABLE => SmithTerm::Separable,
            abi::SMITH_CORRELATED => SmithTerm::HeightCorrelated,
            _ => return None,
        },
        glass_fresnel: match declared.glass_fresnel {
            abi::FRESNEL_EXACT => GlassFresnel::Exact,
            abi::FRESNEL_SCHLICK => GlassFresnel::Schlick,
            abi::FRESNEL_SCHLICK_OUTSIDE => GlassFresnel::SchlickOutside,
            _ => return None,
        },
        glass_radiance: match declared.glass_radiance {
            abi::RADIANCE_SCALED => GlassRadiance::Scaled,
            abi::RADIANCE_UNSCALED => GlassRadiance::Unscaled,
            _ => return None,
        },
    })
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
    let traits = Traits::from_bits_truncate(table.traits);
    let has = |wanted| traits.contains(wanted);
    let mut found = Capabilities::empty();
    each_question! { PlainCore add_if_there (found, table) }
    let builds = table.build.is_some() && table.release.is_some();
    if builds {
        each_question! { PlainScene add_if_there (found, table) }
    }
    let renders = builds && table.render.is_some();
    let integrates = renders || found.contains(Capabilities::RADIANCE);
    let counts = has(Traits::COUNTS_TRAVERSAL) || has(Traits::COUNTED_TESTS);
    let hits_primitives = table.intersect_triangle.is_some() || table.intersect_sphere.is_some();
    let others = [
        (hits_primitives, Capabilities::INTERSECT_PRIMITIVE),
        (table.intersect_box.is_some(), Capabilities::INTERSECT_BOX),
        (builds, Capabilities::BUILD_SCENE),
        (renders, Capabilities::RENDER),
        (builds && has(Traits::BRUTE_FORCE), Capabilities::BRUTE_FORCE),
        (builds && has(Traits::SPLIT_RULES), Capabilities::SPLIT_RULES),
        (found.contains(Capabilities::INTERSECT) && counts, Capabilities::TRAVERSAL_STATS),
        (integrates && has(Traits::HEMISPHERE_SAMPLING), Capabilities::HEMISPHERE_SAMPLING),
        (integrates && has(Traits::ISOLATED_BOUNCES), Capabilities::ISOLATED_BOUNCES),
        (integrates && has(Traits::DEPTH_LIMIT), Capabilities::DEPTH_LIMIT),
        (integrates && has(Traits::ROULETTE), Capabilities::ROULETTE),
        (renders && has(Traits::ADAPTIVE_SAMPLING), Capabilities::ADAPTIVE_SAMPLING),
        (has(Traits::KNOWS_ROUGH_GLASS), Capabilities::ROUGH_GLASS),
        (renders && has(Traits::REPORTED_VARIANCE), Capabilities::REPORTED_VARIANCE),
        (renders && has(Traits::STRATIFIED_PIXELS), Capabilities::STRATIFIED_PIXELS),
        (has(Traits::CALLERS_RANDOMNESS), Capabilities::CALLERS_RANDOMNESS),
        (has(Traits::DETERMINISTIC), Capabilities::DETERMINISTIC),
        (has(Traits::INDEPENDENT_PIXELS), Capabilities::INDEPENDENT_PIXELS),
        (has(Traits::INDEPENDENT_SAMPLES), Capabilities::INDEPENDENT_SAMPLES),
        (has(Traits::PLAIN_ESTIMATORS), Capabilities::PLAIN_ESTIMATORS),
    ];
    others.into_iter().filter(|(can, _)| *can).fold(found, |all, (_, one)| all | one)
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
