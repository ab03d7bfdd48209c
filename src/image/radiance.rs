//! Radiance HDR: three bytes and one exponent for a pixel. The channels of a row stand one after another and
//! run-length coded, or, in old files, its pixels do.

use super::Image;

/// The first bytes of a file.
pub(super) const MAGIC: &[u8] = b"#?RADIANCE";

/// More pixels than any image has: a few bytes of runs can claim to be as many as they like.
const MOST_PIXELS: usize = 1 << 26;

/// Red, green and blue, and the exponent that they share.
type Pixel = [u8; 4];

/// The image in a file's bytes. Values are as they stand, whatever exposure the header tells of.
///
/// # Errors
/// If the file is cut off, claims what cannot be, or is of a kind that nobody writes.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, String> {
    let mut rest = Rest(bytes);
    let [width, height] = header(&mut rest)?;
    let mut pixels = Vec::new();
    for _ in 0..height {
        pixels.extend(row(&mut rest, width)?.into_iter().map(light));
    }
    Ok(Image { width, height, pixels })
}

fn light([red, green, blue, exponent]: Pixel) -> [f32; 3] {
    let unit = if exponent == 0 { 0.0 } else { 2f64.powi(i32::from(exponent) - 136) };
    #[expect(clippy::cast_possible_truncation, reason = "eight bits are exact in single precision")]
    let channel = |value: u8| (f64::from(value) * unit) as f32;
    [red, green, blue].map(channel)
}

/// What is not read yet.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or("it is cut off")?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, String> {
        Ok(self.take(1)?[0])
    }

    fn pixel(&mut self) -> Result<Pixel, String> {
        let taken = self.take(4)?;
        Ok(std::array::from_fn(|i| taken[i]))
    }

    fn line(&mut self) -> Result<String, String> {
        let end = self.0.iter().position(|byte| *byte == b'\n').ok_or("truncated header")?;
        let line = String::from_utf8_lossy(self.take(end)?).trim().to_owned();
        self.take(1)?;
        Ok(line)
    }
}

/// Width and height.
fn header(rest: &mut Rest<'_>) -> Result<[usize; 2], String> {
    loop {
        let line = rest.line()?;
        match line.split_once('=') {
            _ if line.is_empty() => break,
            Some(("FORMAT", format)) if format.trim() != "32-bit_rle_rgbe" => {
                return Err(format!("its format is `{format}`, not `32-bit_rle_rgbe`"));
            }
            _ => {}
        }
    }
    size(&rest.line()?)
}

fn size(line: &str) -> Result<[usize; 2], String> {
    let nonsense = || format!("its size is `{line}`, not such as `-Y 480 +X 640`");
    let words = line.split_whitespace().collect::<Vec<_>>();
    let ["-Y", height, "+X", width] = words[..] else { return Err(nonsense()) };
    let [width, height] = [width, height].map(|side| side.parse::<usize>().unwrap_or(0));
    match width.checked_mul(height) {
        Some(1..=MOST_PIXELS) => Ok([width, height]),
        _ => Err(nonsense()),
    }
}

fn row(rest: &mut Rest<'_>, width: usize) -> Result<Vec<Pixel>, String> {
    match rest.pixel()? {
        [2, 2, high, low] if high < 128 => {
            let claimed = usize::from(high) << 8 | usize::from(low);
            if claimed == width { by_channel(rest, width) } else { Err(over_its_end()) }
        }
        first => by_pixel(first, rest, width),
    }
}

fn by_channel(rest: &mut Rest<'_>, width: usize) -> Result<Vec<Pixel>, String> {
    let mut row = vec![Pixel::default(); width];
    for channel in 0..4 {
        let mut x = 0;
        while x < width {
            let length = usize::from(rest.byte()?);
            let values = match length.checked_sub(128) {
                Some(run @ 1..) => vec![rest.byte()?; run],
                _ => rest.take(length)?.to_vec(),
            };
            let part = row.get_mut(x..x + values.len()).ok_or_else(over_its_end)?;
            part.iter_mut().zip(&values).for_each(|(pixel, value)| pixel[channel] = *value);
            x += values.len();
        }
    }
    Ok(row)
}

/// Ones for colours say how often the pixel before comes again; one such after another counts 256 times as much.
fn by_pixel(first: Pixel, rest: &mut Rest<'_>, width: usize) -> Result<Vec<Pixel>, String> {
    let mut row = vec![first];
    let (mut last, mut shift) = (first, 0);
    while row.len() < width {
        match rest.pixel()? {
            [1, 1, 1, count] => {
                let length = row.len() + (usize::from(count) << shift);
                if length > width {
                    return Err(over_its_end());
                }
                row.resize(length, last);
                shift = (shift + 8).min(24);
            }
            pixel => {
                row.push(pixel);
                (last, shift) = (pixel, 0);
            }
        }
    }
    Ok(row)
}

fn over_its_end() -> String {
    "a row runs over its end".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(size: &str, pixels: &[u8]) -> Vec<u8> {
        let header = format!("#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
        [header.as_bytes(), pixels].concat()
    }

    fn pixels(size: &str, pixels: &[u8]) -> Vec<[f32; 3]> {
        decode(&file(size, pixels)).unwrap().pixels
    }

    #[test]
    fn a_pixel_is_its_bytes_times_a_power_of_two() {
        assert_eq!(light([128, 64, 255, 129]), [1.0, 0.5, 255.0 / 128.0]);
        assert_eq!(
            light([255, 1, 0, 1]),
            [255.0 * 2f32.powi(-100) * 2f32.powi(-35), light([1; 4])[0], 0.0]
        );
        assert_eq!(light([255, 255, 255, 0]), [0.0; 3]);
    }

    #[test]
    fn rows_are_read_however_they_are_coded() {
        let plain = [128, 0, 0, 129, 0, 128, 0, 129];
        assert_eq!(pixels("-Y 1 +X 2", &plain), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let repeated = [128, 128, 0, 129, 1, 1, 1, 2];
        assert_eq!(pixels("-Y 1 +X 3", &repeated), [[1.0, 1.0, 0.0]; 3]);
        let runs = [2, 2, 0, 3, 131, 128, 3, 64, 128, 0, 131, 0, 131, 129];
        let expected = [[1.0, 0.5, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
        assert_eq!(pixels("-Y 1 +X 3", &runs), expected);
    }

    #[test]
    fn what_is_cut_off_or_cannot_be_is_refused() {
        for (size, bytes) in [
            ("-Y 1 +X 2", &[1, 2, 3, 4][..]),
            ("-Y 1 +X 3", &[2, 2, 0, 3, 135, 1]),
            ("-Y 1 +X 3", &[2, 2, 0, 4, 132, 1]),
            ("-Y 1 +X 2", &[9, 9, 9, 9, 1, 1, 1, 255]),
            ("-Y 99999999 +X 99999999", &[9, 9, 9, 9]),
            ("-Y 0 +X 3", &[]),
            ("+X 1 -Y 1", &[9, 9, 9, 9]),
        ] {
            assert!(decode(&file(size, bytes)).is_err(), "{size} {bytes:?}");
        }
        let foreign = b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234";
        assert!(decode(foreign).unwrap_err().contains("xyze"));
        assert!(decode(b"#?RADIANCE\n").is_err());
    }
}
