//! A pdf is a weight: the mean of g/pdf over samples is the integral of g, whatever is sampled.
//!
//! g = cos³θ and cos⁴θ of the upper hemisphere: their weights are bounded for uniform and for
//! cosine-distributed directions alike. A wrong constant shows as one ratio, a wrong power of the
//! cosine as two different ones; no surface and no light takes part.

use super::claimed_pdf::{ClaimedPdf, Law};
use super::distribution::{Distribution, DistributionEntry};
use super::of_distributions::OfDistributions;
use crate::cause::Cause;
use crate::checks::phrase::figure;
use crate::checks::{CheckError, Context, Finding, Measure, Result, check};
use crate::math::ratios::names_of;
use crate::stats::{Band, Claim, MeanReport, Verdict, judge_means};
use crate::text::{Count, Percent};
use glam::DVec3;
use std::f64::consts::TAU;

/// Powers of the cosine that are integrated.
const POWERS: [i32; 2] = [3, 4];
/// Weights are called constant if they differ by less than this.
const SAME: f64 = 0.02;

check! {
    /// E[cosⁿθ / pdf] = 2π/(n + 1).
    pub(crate) struct WeightsIntegrate {
        /// A sampler, or a surface whose samples fill the hemisphere.
        distribution: DistributionEntry,
        detects: Percent,
        at_most: Count,
    }
    name: "weights-integrate",
    summary: "means of cos³/pdf and cos⁴/pdf are integrals that are known",
}

impl OfDistributions for WeightsIntegrate {
    type Judged = Judged;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn judge(&self, context: &mut Context<'_>, distribution: &Distribution) -> Result<Judged> {
        let effort = context.effort(self.detects, self.at_most);
        let band = Band::math(context.info.precision);
        let claims = POWERS.map(|power| Claim::value(TAU / f64::from(power + 1), band));
        let seed = context.seed.child(distribution.name());
        let reports = judge_means(&claims, &effort, &mut |draw| {
            let weight = |direction: DVec3, pdf| match direction.z {
                up if up > 0.0 => POWERS.map(|power| up.powi(power) / pdf),
                _ => [0.0; POWERS.len()],
            };
            let core = &mut *context.core;
            Ok::<_, CheckError>(distribution.means(core, draw.seed(seed), draw.samples, weight)?)
        })?;
        let pdf = ClaimedPdf::of(context.core, distribution)?;
        Ok(Judged { name: distribution.name(), reports, pdf })
    }

    fn finding(judged: &[Judged]) -> Finding {
        let measures: Vec<_> = judged.iter().flat_map(Judged::measures).collect();
        let right = format!("{} integrals come out of samples and their pdfs", measures.len());
        Finding::measured(right, measures)
            .complaining(judged.iter().filter_map(Judged::complaint))
            .because_of(judged.iter().filter_map(Judged::cause))
    }
}

/// What came of one distribution.
pub(crate) struct Judged {
    name: String,
    reports: Vec<MeanReport>,
    pdf: Option<ClaimedPdf>,
}

impl Judged {
    fn failed(&self) -> bool {
        self.reports.iter().any(|report| report.verdict == Verdict::Fail)
    }

    fn measures(&self) -> impl Iterator<Item = Measure> {
        self.reports.iter().zip(POWERS).map(|(report, power)| {
            Measure::of(format!("mean of cos^{power}/pdf"), report).of_row(&self.name)
        })
    }

    /// Measured over expected.
    fn ratios(&self) -> [f64; POWERS.len()] {
        std::array::from_fn(|i| self.reports[i].mean / self.reports[i].expected)
    }

    fn complaint(&self) -> Option<String> {
        if !self.failed() {
            return None;
        }
        let [third, fourth] = self.ratios();
        let name = &self.name;
        if (third / fourth - 1.0).abs() > SAME {
            let (third, fourth) = (figure(third), figure(fourth));
            return Some(format!(
                "{name}: the mean of cos³/pdf is {third} of its integral, that of cos⁴/pdf {fourth}"
            ));
        }
        let named = names_of(self.reports[0].ratio.unwrap_or([third; 2]), &[]);
        let word = named.first().map_or_else(|| figure(third), |ratio| ratio.name.clone());
        Some(format!("{name}: means of g/pdf are {word} of the integrals of g"))
    }

    /// A pdf that is wrong in itself, or one that belongs to another law of heights.
    fn cause(&self) -> Option<(&'static Cause, String)> {
        let pdf = self.pdf.filter(|_| self.failed())?;
        let [third, fourth] = self.ratios();
        let told = format!("ratios of {} and {}", figure(third), figure(fourth));
        let is_near = |expected: [f64; 2]| {
            (third / expected[0] - 1.0).abs() <= SAME && (fourth / expected[1] - 1.0).abs() <= SAME
        };
        if is_near([third, third]) {
            return Some((pdf.mistake()?, told));
        }
        // ∫ cosⁿ p/q with p and q out of 1/2π and cos/π.
        let law = if is_near([2.0 / 3.0, 5.0 / 8.0]) {
            Law::Uniform
        } else if is_near([8.0 / 5.0, 5.0 / 3.0]) {
            Law::Cosine
        } else {
            return None;
        };
        Some((pdf.mistake_of_map(law).or_else(|| pdf.mistake())?, told))
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{cosine, cosine_pdf, drawing, uniform, uniform_pdf};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, judge};
    use glam::DVec2;

    fn found(sampler: &str, map: fn(DVec2) -> Option<DVec3>, pdf: fn(DVec3) -> f64) -> Finding {
        let check: WeightsIntegrate = check_of(&format!(
            "[expect]\ndistribution = {{ sampler = \"{sampler}\" }}\n\
             detects = \"3 %\"\nat-most = \"400 k\""
        ));
        judge(&check, &mut drawing(map, pdf))
    }

    #[test]
    fn right_pdfs_integrate() {
        assert_passes(&found("cosine-hemisphere", cosine, cosine_pdf));
        assert_passes(&found("uniform-hemisphere", uniform, uniform_pdf));
    }

    #[test]
    fn constants_are_named() {
        let finding = found("cosine-hemisphere", cosine, |d| d.z.max(0.0));
        assert!(failure(&finding).ends_with("means of g/pdf are 1/π of the integrals of g"));
        assert_eq!(causes(&finding), ["pdf-without-pi"]);
        let finding = found("uniform-hemisphere", uniform, |d| 0.5 * uniform_pdf(d));
        assert!(failure(&finding).contains("are 2 of"), "{}", finding.statement);
        assert_eq!(causes(&finding), ["pdf-halved"]);
    }

    #[test]
    fn the_wrong_pdf_for_the_map_shows_in_two_ratios() {
        let finding = found("uniform-hemisphere", uniform, cosine_pdf);
        let statement = failure(&finding);
        assert!(statement.contains("cos³/pdf is 0.66"), "{statement}");
        assert!(statement.contains("cos⁴/pdf 0.62"), "{statement}");
        assert_eq!(causes(&finding), ["cosine-pdf-for-uniform"]);
        let finding = found("cosine-hemisphere", uniform, cosine_pdf);
        assert_eq!(causes(&finding), ["uniform-for-cosine"]);
        let finding = found("uniform-hemisphere", cosine, uniform_pdf);
        assert_eq!(causes(&finding), ["cosine-for-uniform"]);
    }
}
