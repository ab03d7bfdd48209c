//! A picture: what it holds, and what form it has to have.

use super::answer::{Answer, Asked, Fill, Form, Unformed, colour, each, holds, touched};
use super::crossing::{Part, Sent, Value, Wanted};
use super::{Breach, BreachKind, Capabilities, CoreError, Place, Result};

/// A picture: row-major from the top left, linear RGB radiance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` values.
    pub pixels: Vec<[f32; 3]>,
    /// Camera samples spent on each pixel, `width · height` values.
    pub sample_counts: Vec<u32>,
    /// Estimated variance of each value of `pixels`, in radiance squared: of the mean that is written there, not
    /// of one sample; 0 where one sample says nothing. `width · height` values of a core with
    /// [`Capabilities::REPORTED_VARIANCE`], none of others.
    pub variances: Vec<[f32; 3]>,
}

impl Film {
    /// A film that nothing has been written to, as a core with these capabilities is handed it.
    pub(crate) fn blank(width: u32, height: u32, capabilities: Capabilities) -> Self {
        let count = width as usize * height as usize;
        let reports = capabilities.contains(Capabilities::REPORTED_VARIANCE);
        Self {
            width,
            height,
            pixels: vec![[f32::NAN; 3]; count],
            sample_counts: vec![0; count],
            variances: vec![[f32::NAN; 3]; if reports { count } else { 0 }],
        }
    }
}

impl Answer for Film {
    const PARTS: &'static [Part] = &[
        Part::array::<[f32; 3]>("pixels"),
        Part::array::<u32>("sample-counts"),
        Part::array::<[f32; 3]>("variances"),
    ];

    fn blank(asked: &Asked<'_>) -> Box<Self> {
        let mut film = Box::<Self>::default();
        film.untouch(asked);
        film
    }

    fn untouch(&mut self, asked: &Asked<'_>) {
        let [width, height] = asked.size;
        let count = width * height;
        *self = Self {
            width: width as u32,
            height: height as u32,
            pixels: vec![Value::UNTOUCHED; count],
            sample_counts: vec![Value::UNTOUCHED; count],
            variances: vec![Value::UNTOUCHED; if reports(asked.capabilities) { count } else { 0 }],
        };
    }

    fn accept(&mut self, asked: &Asked<'_>) -> Result<()> {
        let [width, height] = asked.size;
        let count = width * height;
        if self.pixels.len() != count || self.sample_counts.len() != count {
            return Err(CoreError::breach(format!(
                "the picture has {} pixels and {} sample counts; {width} x {height} is {count}",
                self.pixels.len(),
                self.sample_counts.len(),
            )));
        }
        each_pixel(&self.pixels, width, "pixel", "radiance", asked.unformed)?;
        each(&self.sample_counts, "sample count", |count| touched("it", *count))?;
        if !reports(asked.capabilities) {
            self.variances.clear();
        } else if self.variances.len() != count {
            let found = self.variances.len();
            return Err(CoreError::breach(format!(
                "the picture has {found} variances of {count} pixels"
            )));
        }
        each_pixel(&self.variances, width, "variance of pixel", "it", Unformed::Refused)
    }

    fn sent(&self, _: &'static str, can: Capabilities) -> Vec<Sent<'_>> {
        let counts = Sent::new("sample-counts", &self.sample_counts);
        let mut arrays = vec![Sent::new("pixels", &self.pixels), counts];
        if reports(can) {
            arrays.push(Sent::new("variances", &self.variances));
        }
        arrays
    }

    fn receive(&mut self, _: &'static str, can: Capabilities, fill: Fill<'_>) -> Result<()> {
        let counts = Wanted::new("sample-counts", &mut self.sample_counts);
        let mut arrays = vec![Wanted::new("pixels", &mut self.pixels), counts];
        if reports(can) {
            arrays.push(Wanted::new("variances", &mut self.variances));
        }
        fill(&mut arrays)
    }
}

fn reports(capabilities: Capabilities) -> bool {
    capabilities.contains(Capabilities::REPORTED_VARIANCE)
}

/// Whether every value of the pixels of a film is written, finite and not negative; whoever mends takes negative ones as
/// they are.
fn each_pixel(
    values: &[[f32; 3]],
    width: usize,
    what: &'static str,
    field: &'static str,
    unformed: Unformed,
) -> Result<()> {
    values.iter().enumerate().try_for_each(|(index, value)| {
        let place = || Place::Pixel { what: what.into(), x: index % width, y: index / width };
        let breach = |breach| CoreError::from(Breach { place: place(), ..breach });
        valid_pixel(field, *value, unformed).map_err(breach)
    })
}

fn valid_pixel(field: &'static str, value: [f32; 3], unformed: Unformed) -> Form {
    let is_touched = value.iter().all(|value| value.to_bits() != f32::UNTOUCHED.to_bits());
    holds(is_touched, field, || BreachKind::Untouched)?;
    let size = if unformed == Unformed::Mended { value.map(f32::abs) } else { value };
    colour(field, size.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_mends_takes_a_negative_pixel_and_no_nan_beside_it() {
        let valid = |value, unformed| valid_pixel("radiance", value, unformed).is_ok();
        let [negative, nan] = [[-1.0, 0.0, 2.0], [-1.0, f32::NAN, 2.0]];
        assert!(valid(negative, Unformed::Mended) && !valid(negative, Unformed::Refused));
        assert!(!valid(nan, Unformed::Mended) && !valid([-f32::INFINITY; 3], Unformed::Mended));
        assert!(!valid([f32::UNTOUCHED; 3], Unformed::Mended));
    }
}
