//! What f and pdf of a surface that scatters are made of, and so may be wrong by.

use super::albedo::masking;
use super::ggx_pair::Pair;
use super::rough_glass::RoughGlass;
use crate::checks::law::{Answered, Formula, Terms, are_right, law_of, replaced};
use crate::contract::{BsdfQuery, Conventions, SmithTerm};
use crate::math::closed_form::fresnel::reflectance;
use crate::math::closed_form::microfacet::{
    Masking, distribution, masking as one_sided, masking_shadowing,
};
use crate::scene::{Rgb, Surface};
use std::f64::consts::FRAC_1_PI;

const CHANNELS: [[&str; 2]; 3] = [
    ["in red", "in green and blue"],
    ["in green", "in red and blue"],
    ["in blue", "in red and green"],
];

const DIFFUSE: Terms =
    Terms { quantities: &["cos θi", "cos θo"], places: &CHANNELS, right: "what it should be" };

const CONDUCTOR: Terms = Terms {
    quantities: &["cos θo", "cos θi", "cos θh", "(ωo · h)", "D(h)", "G", "G1(ωo)", "G1(ωi)", "α"],
    ..DIFFUSE
};

const ROUGH_GLASS: Terms = Terms {
    quantities: &[
        "cos θo",
        "cos θi",
        "cos θh",
        "(ωo · h)",
        "(ωi · h)",
        "D(h)",
        "G",
        "G1(ωo)",
        "G1(ωi)",
        "F",
        "(1 - F)",
        "η",
        "(ωo · h + η ωi · h)²",
        "α",
        "the index",
    ],
    places: &[
        CHANNELS[0],
        CHANNELS[1],
        CHANNELS[2],
        ["where light passes", "where light is reflected"],
        ["inside", "outside"],
    ],
    ..DIFFUSE
};

const SEPARABLE: Formula =
    Formula { takes: CONDUCTOR_TAKES, value: |taken, _| conductor(taken, Masking::Separable) };

const HEIGHT_CORRELATED: Formula = Formula {
    takes: CONDUCTOR_TAKES,
    value: |taken, _| conductor(taken, Masking::HeightCorrelated),
};

const CONDUCTOR_TAKES: &[(&str, usize)] = &[
    ("D", 2),
    ("D", 8),
    ("G", 0),
    ("G", 1),
    ("G", 8),
    ("the denominator", 0),
    ("the denominator", 1),
];

fn conductor(taken: &[f64], form: Masking) -> f64 {
    let [cos_h, alpha, a, b, width, cos_o, cos_i] = *taken else { return f64::NAN };
    distribution(cos_h, alpha) * masking_shadowing(a, b, width, form) / (cos_o * cos_i)
}

const GLASS_SEPARABLE: Formula = Formula {
    takes: GLASS_TAKES,
    value: |taken, places| rough_glass(taken, places, Masking::Separable),
};

const GLASS_HEIGHT_CORRELATED: Formula = Formula {
    takes: GLASS_TAKES,
    value: |taken, places| rough_glass(taken, places, Masking::HeightCorrelated),
};

const GLASS_TAKES: &[(&str, usize)] = &[
    ("F", 3),
    ("F", 11),
    ("D", 2),
    ("D", 13),
    ("G", 0),
    ("G", 1),
    ("G", 13),
    ("the denominator", 0),
    ("the denominator", 1),
    ("the Jacobian", 3),
    ("the Jacobian", 4),
    ("the Jacobian", 11),
];

/// Which of the places says that light passes.
const PASSES: usize = 3;

fn rough_glass(taken: &[f64], places: &[bool], form: Masking) -> f64 {
    let [cos_f, eta, cos_h, alpha, a, b, width, cos_o, cos_i, o_h, i_h, bends] = *taken else {
        return f64::NAN;
    };
    let facets =
        distribution(cos_h, alpha) * masking_shadowing(a, b, width, form) / (cos_o * cos_i);
    let reflected = reflectance(cos_f, eta);
    match places[PASSES] {
        true => (1.0 - reflected) * facets * o_h * i_h / (o_h - bends * i_h).powi(2),
        false => 0.25 * reflected * facets,
    }
}

/// A pdf by a way to sample.
struct Sampling {
    name: &'static str,
    pdf: Formula,
}

const OF_DIFFUSE: &[Sampling] = &[Sampling {
    name: "cosine-weighted directions",
    pdf: Formula { takes: &[("it", 0)], value: |taken, _| taken[0] * FRAC_1_PI },
}];

const OF_CONDUCTORS: &[Sampling] = &[
    Sampling {
        name: "visible normals",
        pdf: Formula {
            takes: &[("D", 2), ("D", 8), ("G1", 0), ("G1", 8), ("the denominator", 0)],
            value: |taken, _| {
                let [cos_h, alpha, cos_g, width, cos_o] = *taken else { return f64::NAN };
                distribution(cos_h, alpha) * one_sided(cos_g, width) / (4.0 * cos_o)
            },
        },
    },
    Sampling {
        name: "all normals",
        pdf: Formula {
            takes: &[("D", 2), ("D", 8), ("the cosine", 2), ("the Jacobian", 3)],
            value: |taken, _| {
                let [cos_h, alpha, cosine, o_h] = *taken else { return f64::NAN };
                distribution(cos_h, alpha) * cosine / (4.0 * o_h)
            },
        },
    },
];

const OF_ROUGH_GLASS: &[Sampling] = &[
    Sampling {
        name: "visible normals",
        pdf: Formula {
            takes: &[
                ("F", 3),
                ("F", 11),
                ("D", 2),
                ("D", 13),
                ("G1", 0),
                ("G1", 13),
                ("the denominator", 0),
                ("the Jacobian", 3),
                ("the Jacobian", 4),
                ("the Jacobian", 11),
            ],
            value: |taken, places| {
                let [cos_f, eta, cos_h, alpha, cos_g, width, cos_o, o_h, i_h, bends] = *taken
                else {
                    return f64::NAN;
                };
                let seen = distribution(cos_h, alpha) * one_sided(cos_g, width) / cos_o;
                seen * turned([cos_f, eta, o_h, i_h, bends], places) * o_h
            },
        },
    },
    Sampling {
        name: "all normals",
        pdf: Formula {
            takes: &[
                ("F", 3),
                ("F", 11),
                ("D", 2),
                ("D", 13),
                ("the cosine", 2),
                ("the Jacobian", 3),
                ("the Jacobian", 4),
                ("the Jacobian", 11),
            ],
            value: |taken, places| {
                let [cos_f, eta, cos_h, alpha, cosine, o_h, i_h, bends] = *taken else {
                    return f64::NAN;
                };
                distribution(cos_h, alpha) * cosine * turned([cos_f, eta, o_h, i_h, bends], places)
            },
        },
    },
];

/// The probability of a way through the interface, and directions per microfacet.
fn turned([cos_f, eta, o_h, i_h, bends]: [f64; 5], places: &[bool]) -> f64 {
    let reflected = reflectance(cos_f, eta);
    match places[PASSES] {
        true => (1.0 - reflected) * bends * bends * i_h / (o_h - bends * i_h).powi(2),
        false => reflected / (4.0 * o_h),
    }
}

/// A surface by the conventions of a core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scattering {
    pub(crate) surface: Surface,
    pub(crate) conventions: Conventions,
}

/// What a core answered for a pair of directions, and what it is held against.
pub(crate) struct Value {
    pub(crate) query: BsdfQuery,
    pub(crate) found: Rgb,
    pub(crate) right: Rgb,
}

impl Scattering {
    /// As a law names it: what is wrong with one is wrong with all of its kind.
    pub(crate) const fn kind(&self) -> &'static str {
        match self.surface {
            Surface::Diffuse { .. } => "diffuse surfaces",
            Surface::Conductor { .. } => "rough metal",
            Surface::RoughGlass { .. } => "rough glass",
            Surface::Mirror { .. } => "mirrors",
            Surface::Glass { .. } => "glass",
        }
    }

    /// f, by the formula.
    pub(crate) fn value(&self, query: &BsdfQuery) -> Option<Rgb> {
        let (white, ..) = self.factors(query)?;
        Some(match self.surface {
            Surface::RoughGlass { transmittance, .. } if query.wo.z * query.wi.z < 0.0 => {
                transmittance.map(|colour| white * colour)
            }
            Surface::Diffuse { reflectance }
            | Surface::Conductor { reflectance, .. }
            | Surface::RoughGlass { reflectance, .. } => reflectance.map(|colour| white * colour),
            Surface::Mirror { .. } | Surface::Glass { .. } => return None,
        })
    }

    /// The law of values that a core has for this surface. What nothing is known of is left out.
    pub(crate) fn law_of_values(&self, values: &[Value], allowed: f64) -> Option<String> {
        let answers: Vec<_> = values.iter().flat_map(|value| self.answered(value)).collect();
        let of_formula =
            self.formula().and_then(|formula| replaced(self.terms(), formula, &answers, allowed));
        of_formula.or_else(|| law_of(self.terms(), &answers, allowed))
    }

    /// What gives these pdfs, which do not fit the samples: a formula of a way to sample, as it is or with something else in
    /// the place of a quantity.
    pub(crate) fn law_of_pdfs(&self, pdfs: &[(BsdfQuery, f64)], allowed: f64) -> Option<String> {
        let ways = match self.surface {
            Surface::Diffuse { .. } => OF_DIFFUSE,
            Surface::Conductor { .. } => OF_CONDUCTORS,
            Surface::RoughGlass { .. } => OF_ROUGH_GLASS,
            Surface::Mirror { .. } | Surface::Glass { .. } => &[],
        };
        let answers = |way: &Sampling| {
            let answered = |(query, found): &(BsdfQuery, f64)| {
                let grey = Value { query: *query, found: [*found; 3], right: [1.0; 3] };
                let mut one = self.answered(&grey).into_iter().next()?;
                let taken: Vec<_> =
                    way.pdf.takes.iter().map(|(_, of)| one.quantities[*of]).collect();
                one.right = (way.pdf.value)(&taken, &one.places);
                Some(one)
            };
            pdfs.iter().filter_map(answered).collect::<Vec<_>>()
        };
        let plain = ways.iter().find(|way| are_right(&answers(way), allowed));
        if let Some(way) = plain {
            return Some(format!("is that of {}, and samples do not follow it", way.name));
        }
        ways.iter().find_map(|way| {
            let law = replaced(self.terms(), way.pdf, &answers(way), allowed)?;
            Some(format!("is that of {}, but {law}", way.name))
        })
    }

    fn formula(&self) -> Option<Formula> {
        let is_separable = self.conventions.smith_term == SmithTerm::Separable;
        match (self.surface, is_separable) {
            (Surface::Conductor { .. }, true) => Some(SEPARABLE),
            (Surface::Conductor { .. }, false) => Some(HEIGHT_CORRELATED),
            (Surface::RoughGlass { .. }, true) => Some(GLASS_SEPARABLE),
            (Surface::RoughGlass { .. }, false) => Some(GLASS_HEIGHT_CORRELATED),
            _ => None,
        }
    }

    /// The law of numbers without a colour, each held against what a correct core has there.
    pub(crate) fn law_of_numbers(
        &self,
        numbers: &[(BsdfQuery, f64, f64)],
        against: &'static str,
        allowed: f64,
    ) -> Option<String> {
        let grey = |(query, found, right): &(BsdfQuery, f64, f64)| {
            let value = Value { query: *query, found: [*found; 3], right: [*right; 3] };
            self.answered(&value).into_iter().next()
        };
        let answers: Vec<_> = numbers.iter().filter_map(grey).collect();
        law_of(Terms { right: against, ..self.terms() }, &answers, allowed)
    }

    fn terms(&self) -> Terms {
        match self.surface {
            Surface::Conductor { .. } => CONDUCTOR,
            Surface::RoughGlass { .. } => ROUGH_GLASS,
            _ => DIFFUSE,
        }
    }

    /// One of each channel.
    fn answered(&self, value: &Value) -> Vec<Answered> {
        let Some((_, quantities, places)) = self.factors(&value.query) else { return Vec::new() };
        let of_channel = |channel: usize| {
            let channels = (0..3).map(|other| other == channel);
            Answered {
                found: value.found[channel],
                right: value.right[channel],
                quantities: quantities.clone(),
                places: channels.chain(places.clone()).collect(),
            }
        };
        (0..3).map(of_channel).collect()
    }

    /// f of the white surface, what it is made of, and the places; none where it is 0.
    fn factors(&self, query: &BsdfQuery) -> Option<(f64, Vec<f64>, Vec<bool>)> {
        let BsdfQuery { wo, wi } = *query;
        match self.surface {
            Surface::Diffuse { .. } => {
                let above = wo.z > 0.0 && wi.z > 0.0;
                above.then(|| (FRAC_1_PI, vec![wi.z, wo.z], Vec::new()))
            }
            Surface::Conductor { reflectance, roughness } => {
                let masking = masking(self.conventions.smith_term);
                let pair = Pair { wo, wi, reflectance, roughness, masking };
                let above = wo.z > 0.0 && wi.z > 0.0;
                above.then(|| (pair.right(), pair.factors(), Vec::new()))
            }
            Surface::RoughGlass { index, roughness, .. } => {
                let glass = RoughGlass { index, roughness, conventions: self.conventions };
                let (white, factors, passes) = glass.factors(query)?;
                Some((white, factors, vec![passes, wo.z < 0.0]))
            }
            Surface::Mirror { .. } | Surface::Glass { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::GlassRadiance;
    use crate::math::rng::Seed;
    use crate::math::sphere::on_sphere;

    /// What stands in the formulas by its place has to be what belongs there.
    #[test]
    fn the_formulas_give_what_is_right() {
        let metal = Surface::Conductor { reflectance: [1.0; 3], roughness: 0.3 };
        let (reflectance, transmittance) = ([1.0; 3], [1.0; 3]);
        let glass = Surface::RoughGlass { index: 1.5, roughness: 0.3, reflectance, transmittance };
        for (surface, scale) in [(metal, 0.25), (glass, 1.0)] {
            for smith_term in [SmithTerm::Separable, SmithTerm::HeightCorrelated] {
                let glass_radiance = GlassRadiance::Scaled;
                let conventions =
                    Conventions { smith_term, glass_radiance, ..Conventions::default() };
                let scattering = Scattering { surface, conventions };
                let formula = scattering.formula().unwrap();
                let mut stream = Seed(5).stream();
                let mut query =
                    || BsdfQuery { wo: on_sphere(&mut stream), wi: on_sphere(&mut stream) };
                let (mut compared, queries) = (0, (0..200).map(|_| query()));
                for query in queries.collect::<Vec<_>>() {
                    let Some(right) = scattering.value(&query) else { continue };
                    let value = Value { query, found: right, right };
                    let one = &scattering.answered(&value)[0];
                    let taken: Vec<_> =
                        formula.takes.iter().map(|(_, of)| one.quantities[*of]).collect();
                    let given = scale * (formula.value)(&taken, &one.places);
                    assert!((given / right[0] - 1.0).abs() <= 1e-9, "{surface:?} {query:?}");
                    compared += 1;
                }
                assert!(compared > 20);
            }
        }
    }
}
