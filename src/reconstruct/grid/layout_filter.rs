//! The near-field matched filter for elements at any places: maps of a scene for other layouts of a few elements.

use super::cells::GridCells;
use crate::maps::RangeAngleMap;
use crate::radar::{Layout, Pair, Radar};
use crate::reconstruct::answer::Request;
use crate::reconstruct::error::{ReconstructError, Result};
use crate::reconstruct::noise::noise_variance;
use crate::reconstruct::polar::polar_from_pair;
use crate::reconstruct::power::{focused_gain, lambda_of_power};
use crate::reconstruct::profiles::Profiles;
use ndarray::{Array2, ArrayView2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;

/// Rows of an element's padded range profile for each range bin: enough for linear interpolation.
const LAYOUT_ROWS_PER_BIN: usize = 8;

/// Lambda of the whole array as the coherent matched filter of a few elements estimates it: every cell of the centre's polar grid looks up each
/// element's range profile at its own distance and removes the phase of that distance.
///
/// `samples` is `[elements of layout, samples]`, in the layout's order. This is back-projection, as in
/// [`MatchedFilter`](crate::reconstruct::MatchedFilter), which does the same for the two ends with whole-end beams. Random elements have the
/// main lobe of the whole aperture and side lobes everywhere (thesis figures 1-2 and 1-3).
/// # Errors
/// [`ReconstructError::Shape`] where `samples` don't fit, [`ReconstructError::Cancelled`].
pub fn layout_matched_filter(
    radar: &Radar,
    layout: &Layout,
    samples: ArrayView2<'_, Complex64>,
    request: &Request,
) -> Result<RangeAngleMap> {
    ReconstructError::check_shape("samples of the layout", samples.shape(), [layout.len(), radar.samples])?;
    let peak = samples.iter().fold(0.0f64, |m, v| m.max(v.norm()));
    if peak == 0.0 || layout.is_empty() {
        return Ok(RangeAngleMap { lambda: Array2::zeros((radar.samples, radar.elements)) });
    }
    let samples = samples.mapv(|v| v / peak);
    let channels: Vec<_> = samples.outer_iter().collect();
    let profiles = Profiles::new(radar, &channels, LAYOUT_ROWS_PER_BIN);
    request.task.check()?;
    let scale = focused_gain(radar) / layout.len() as f64;
    let (cells, pairs) = (GridCells::new(radar), layout.pairs());
    let mut power = Array2::zeros(cells.dim());
    power.axis_iter_mut(Axis(0)).into_par_iter().zip(&cells.range_metres).try_for_each(|(mut row, range_metres)| {
        request.task.check()?;
        for (cell, direction) in row.iter_mut().zip(&cells.directions) {
            let distance = |pair: &Pair| polar_from_pair(*pair, *range_metres, direction.cos_theta).range_metres;
            let heard = pairs.iter().enumerate().map(|(channel, pair)| profiles.at(channel, distance(pair)));
            let sum: Complex64 = heard.sum();
            *cell = (sum * scale).norm_sqr();
        }
        Ok::<(), ReconstructError>(())
    })?;
    let noise_variance = noise_variance(radar, samples.outer_iter());
    Ok(lambda_of_power(radar, cells.folded(&power), noise_variance, request).0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::LayoutKind;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_reflector_on_a_cell_is_the_strongest_cell_for_every_layout() {
        let radar = Radar::default();
        let (bin, column) = (211usize, 640usize);
        let (range, cos) = (radar.range_of_bin_metres(bin as f64), radar.cos_of_column(column as f64));
        let scene = Scene::of_points([(range * cos, range * (1.0 - cos * cos).sqrt())]);
        let signal = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
        for kind in [LayoutKind::TwoEnds, LayoutKind::Random { elements: 24, seed: 2 }] {
            let layout = kind.layout(&radar).unwrap();
            let samples = signal.samples.select(Axis(0), &kind.numbers(&radar).unwrap());
            let map = layout_matched_filter(&radar, &layout, samples.view(), &Request::default()).unwrap();
            let strongest = map.lambda.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
            assert_eq!(strongest, (bin, column), "{kind}");
            assert!(map.lambda.iter().all(|v| (0.0..=1.0).contains(v)), "{kind}");
        }
    }

    #[test]
    fn silence_of_the_layout_alone_is_a_dark_map() {
        let radar = Radar::default();
        let layout = Layout::random(&radar, 3, 0).unwrap();
        let map_of_silence = |elements: usize| {
            layout_matched_filter(&radar, &layout, Array2::zeros((elements, 512)).view(), &Request::default())
        };
        assert!(map_of_silence(3).unwrap().lambda.iter().all(|v| *v == 0.0));
        assert!(map_of_silence(2).unwrap_err().to_string().contains("[3, 512]"), "another shape is refused");
    }
}
