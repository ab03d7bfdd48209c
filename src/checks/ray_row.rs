//! Rows of a case that each put one ray to the core: whether it hits, and why it is asked.

use super::Measure;
use crate::contract::Ray;

/// A row that [`ray_row!`] declares.
pub(crate) trait RayRow {
    fn ray(&self) -> Ray;

    fn because(&self) -> &str;

    /// Where correct implementations differ a row is shown and not graded.
    fn is_graded(&self) -> bool;

    /// `ray 3 (from inside)`
    fn label(&self, number: usize) -> String {
        match self.because() {
            "" => format!("ray {}", number + 1),
            because => format!("ray {} ({because})", number + 1),
        }
    }
}

/// Declares a row of rays, with its own keys after `hits`.
macro_rules! ray_row {
    ($(#[$attribute:meta])* $visibility:vis struct $row:ident { $($key:ident: $value:ty,)* }) => {
        $(#[$attribute])*
        #[derive(Clone, Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields, rename_all = "kebab-case")]
        $visibility struct $row {
            from: $crate::text::Vector,
            toward: $crate::text::Arrow,
            #[serde(default)]
            after: f64,
            #[serde(default = "crate::checks::ray_row::infinity")]
            up_to: f64,
            $visibility hits: bool,
            $($key: $value,)*
            #[serde(default)]
            because: String,
            #[serde(default)]
            robustness: bool,
        }

        impl $crate::checks::ray_row::RayRow for $row {
            fn ray(&self) -> Ray {
                let (origin, direction) = (self.from.0, self.toward.0);
                Ray { origin, t_min: self.after, direction, t_max: self.up_to }
            }

            fn because(&self) -> &str {
                &self.because
            }

            fn is_graded(&self) -> bool {
                !self.robustness
            }
        }
    };
}
pub(crate) use ray_row;

pub(crate) const fn infinity() -> f64 {
    f64::INFINITY
}

/// What came of rows.
#[derive(Default)]
pub(crate) struct Grades {
    pub(crate) measures: Vec<Measure>,
    /// One of each row that is wrong.
    pub(crate) complaints: Vec<String>,
}

impl Grades {
    /// Takes in the measures of a row, with a complaint about the worst of them if it is graded.
    pub(crate) fn take(
        &mut self,
        row: &impl RayRow,
        measures: Vec<Measure>,
        complaint: impl FnOnce(&Measure) -> String,
    ) {
        let worst = measures.iter().find(|measure| row.is_graded() && measure.failed());
        self.complaints.extend(worst.map(complaint));
        let shown = |measure: Measure| if row.is_graded() { measure } else { measure.not_graded() };
        self.measures.extend(measures.into_iter().map(shown));
    }
}

/// Whether a ray hits, as a measure: 1 or 0.
pub(crate) fn hits_measure(found: bool, right: bool) -> Measure {
    let flag = |hits| f64::from(u8::from(hits));
    Measure::exact("hits", flag(found), flag(right), 0.0)
}
