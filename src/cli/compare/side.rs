//! One side of a comparison, from its files.

use crate::cli::Failure;
use crate::image::encoding::Curve;
use crate::image::file::{Loaded, load};
use crate::scene::reference::{ERROR_PREFIX, Layers};
use crate::stats::Side;
use std::path::{Path, PathBuf};

/// One image, or the mean of several renders.
pub(super) fn of_runs(
    runs: &[PathBuf],
    encoding: Curve,
    variance: Option<&Path>,
) -> Result<Side, Failure> {
    let read = |path: &PathBuf| load(path, Some(encoding)).map_err(Failure::request);
    let side = match runs {
        [one] => of_file(read(one)?),
        _ => Side::mean_of(&runs.iter().map(read).collect::<Result<Vec<_>, _>>()?)
            .map_err(Failure::request)?,
    };
    match variance {
        None => Ok(side),
        Some(path) => with_variance(side, path),
    }
}

fn of_file(mut loaded: Loaded) -> Side {
    let extra = loaded.extra.take();
    let errors = extra.as_ref().and_then(|file| file.colours(ERROR_PREFIX).ok());
    let bounces = extra.map(|file| Layers::read(&file).bounces).unwrap_or_default();
    Side::of(loaded, errors.as_ref(), bounces)
}

fn with_variance(side: Side, path: &Path) -> Result<Side, Failure> {
    let variance = load(path, Some(Curve::Linear)).map_err(Failure::request)?.image;
    side.with_variance(variance).ok_or_else(|| {
        let path = path.display();
        Failure::request(format!(
            "`{path}` is not a variance of the image: it has another size, or negative values"
        ))
    })
}

/// `srgb`, `linear`, or a gamma.
pub(super) fn encoding(text: &str) -> Result<Curve, String> {
    match text {
        "srgb" => Ok(Curve::Srgb),
        "linear" => Ok(Curve::Linear),
        number => match number.parse::<f64>() {
            Ok(gamma) if gamma > 0.1 && gamma < 10.0 => Ok(Curve::Gamma(gamma)),
            _ => Err("`srgb`, `linear`, or a gamma between 0.1 and 10".to_owned()),
        },
    }
}
