//! Combination of two maps of one scene, cell by cell: the map of the objects that a search found, and the map of a network.
//!
//! The search's map is exact where its objects are right: once they are subtracted, the residual of the samples is zero. The network's map has a
//! moderate error everywhere, and the network estimates it as its doubt. So the search's map has all weight where the residual vanishes. Elsewhere
//! the maps are averaged. The network's weight grows with their difference over the network's doubt. White noise may hide objects that the search
//! lacks, so that a vanishing residual proves nothing. Over noise the network has a weight in every cell, and all weight where the two maps
//! contradict each other.

use crate::maps::RangeAngleMap;
use ndarray::{Array1, Array2, ArrayView1, Axis, Zip};
use rayon::prelude::*;

/// Bounds of the residual over the drawn map, decades of power. Below the first the search's map has all weight, above the second the least. A
/// residual of a tenth of the power changes the cell by half a decibel.
const RESIDUAL_DECADES: [f32; 2] = [-3.0, -1.0];

/// Shift of [`RESIDUAL_DECADES`] where a dynamic range cuts off the dark cells: in bright ones the network draws narrow lobes too dark.
const BRIGHT_SHIFT_DECADES: f32 = 3.0;

/// Bounds of the part of the shown cells that have more residual than drawn power, 0 to 1. Between them the weight of the search's map falls to
/// the least in every cell: such a scene is not made of points and rows.
const UNEXPLAINED_PART: [f32; 2] = [0.7, 0.9];

/// [`UNEXPLAINED_PART`] over a dynamic range. Cells that it cuts off don't count, and a list of points and rows leaves few bright cells unexplained.
const UNEXPLAINED_BRIGHT_PART: [f32; 2] = [0.3, 0.6];

/// Weight of the network's map, 0 to 1, where the search has a residual and the two maps agree. Their errors are different, so that a mean has a
/// smaller error than either. The network's error is the smaller one there.
const AGREED_WEIGHT: f32 = 0.7;

/// Bounds of the mean squared difference of the maps over the network's expected squared error. Below the first the maps agree, above the second
/// the network's map has all weight.
const CONTRADICTION_RATIO: [f32; 2] = [1.0, 3.0];

/// Degree to which every cell over white noise counts as unexplained at least, 0 to 1.
const MIN_UNEXPLAINED_OVER_NOISE: f32 = 0.5;

/// A doubt in standard deviations: the magnitude of nine of ten normal errors is smaller.
const DOUBT_DEVIATIONS: f32 = 1.645;

/// Range bins and columns to each side over which the squared difference of the maps is averaged: the size of a lobe of the ends' maps.
const MEAN_SIDE_CELLS: [usize; 2] = [2, 8];

/// Weight of the map `network` in each cell, 0 to 1. The rest is the weight of `drawn`, the search's map. All arrays are `[range bins, columns]`, and
/// both maps are Lambda on one scale.
///
/// `residual` is the search's residual over its drawn map, decades of power
/// ([`Found::residual_decades`](super::search::Found::residual_decades)). `doubt` is the bound, in Lambda, which nine of ten errors of the network stay
/// below. Without it the residual alone sets the weight. Cells of a Lambda of `1 - shown_part` or less are not shown. `is_hidden` says whether
/// noise may hide objects that the search lacks.
pub fn network_weight(
    drawn: &RangeAngleMap,
    network: &RangeAngleMap,
    doubt: Option<&RangeAngleMap>,
    residual: &Array2<f32>,
    shown_part: f32,
    is_hidden: bool,
) -> Array2<f32> {
    let shown = || residual.iter().zip(&drawn.lambda).filter(|(_, drawn)| **drawn > 1.0 - shown_part);
    let unexplained_part = shown().filter(|(left, _)| **left > 0.0).count() as f32 / shown().count().max(1) as f32;
    let is_cut_off = shown_part < 1.0;
    let scene_unexplained = ramp(if is_cut_off { UNEXPLAINED_BRIGHT_PART } else { UNEXPLAINED_PART }, unexplained_part);
    let mut square = &drawn.lambda - &network.lambda;
    square.par_mapv_inplace(|v| v * v);
    let mut weight = moving_mean(&square);
    let shift = if is_cut_off { BRIGHT_SHIFT_DECADES } else { 0.0 };
    let least = if is_hidden { scene_unexplained.max(MIN_UNEXPLAINED_OVER_NOISE) } else { scene_unexplained };
    let unexplained = |left: f32| ramp(RESIDUAL_DECADES, left - shift).max(least);
    let agreed = |contradiction: f32| AGREED_WEIGHT + (1.0 - AGREED_WEIGHT) * contradiction;
    match doubt {
        None => Zip::from(&mut weight).and(residual).par_for_each(|w, left| *w = unexplained(*left)),
        Some(doubt) => Zip::from(&mut weight).and(residual).and(&doubt.lambda).par_for_each(|w, left, doubt| {
            let expected = (doubt / DOUBT_DEVIATIONS).powi(2).max(f32::MIN_POSITIVE);
            let contradiction = ramp(CONTRADICTION_RATIO, *w / expected);
            let hidden = if is_hidden { contradiction } else { 0.0 };
            *w = unexplained(*left).max(hidden) * agreed(contradiction);
        }),
    }
    weight
}

/// Stretches two maps of one scene, `[range bins, columns]`, to one scale of Lambda, the geometric mean of their scales. The peaks stay at 1.
/// Returns the thresholds `etas` on that scale.
/// Under min-max over noise, the smallest of all cells sets the scale by chance. The mean of the two scales has a smaller error than either.
pub fn stretch_to_common_scale(maps: [&mut RangeAngleMap; 2], etas: [f32; 2]) -> [f32; 2] {
    let depths = maps[0].lambda.iter().zip(&maps[1].lambda).map(|(a, b)| [1.0 - f64::from(*a), 1.0 - f64::from(*b)]);
    let [square, product] = depths.fold([0.0; 2], |[square, product], [a, b]| [square + a * a, product + a * b]);
    // The least-squares ratio of the second map's depths below the peak to the first's, and its square root.
    let root = if square > 0.0 && product > 0.0 { (product / square).sqrt() as f32 } else { 1.0 };
    let stretched = |factor: f32, v: f32| (1.0 - factor * (1.0 - v)).clamp(0.0, 1.0);
    let factors = [root, root.recip()];
    for (map, factor) in maps.into_iter().zip(factors) {
        map.lambda.par_mapv_inplace(|v| stretched(factor, v));
    }
    [0, 1].map(|i| stretched(factors[i], etas[i]))
}

/// Linear ramp: 0 up to `low`, 1 from `high` on.
fn ramp([low, high]: [f32; 2], value: f32) -> f32 {
    ((value - low) / (high - low)).clamp(0.0, 1.0)
}

/// Moving mean over the cells within [`MEAN_SIDE_CELLS`], `[range bins, columns]`. Beyond its edges the map continues with the edge cells.
fn moving_mean(cells: &Array2<f32>) -> Array2<f32> {
    let [rows, columns] = MEAN_SIDE_CELLS;
    let mut along = cells.clone();
    along.axis_iter_mut(Axis(0)).into_par_iter().for_each(|mut row| {
        let mean = moving_mean_of_row(row.view(), columns);
        row.assign(&mean);
    });
    let (height, _) = along.dim();
    let mut mean = Array2::zeros(along.dim());
    Zip::indexed(mean.axis_iter_mut(Axis(0))).par_for_each(|row, mut to| {
        for offset in 0..=2 * rows {
            let from = (row + offset).saturating_sub(rows).min(height - 1);
            to += &along.row(from);
        }
        to /= (2 * rows + 1) as f32;
    });
    mean
}

/// Moving mean over `2 * side + 1` cells of a row, which continues with its edge cells.
fn moving_mean_of_row(cells: ArrayView1<f32>, side: usize) -> Array1<f32> {
    let last = cells.len() as isize - 1;
    let at = |i: isize| f64::from(cells[i.clamp(0, last) as usize]);
    let side = side as isize;
    let mut sum: f64 = (-side..=side).map(at).sum();
    let width = (2 * side + 1) as f64;
    Array1::from_shape_fn(cells.len(), |i| {
        let mean = (sum / width) as f32;
        sum += at(i as isize + side + 1) - at(i as isize - side);
        mean
    })
}

/// The weighted mean of two maps of Lambda, all `[range bins, columns]`. `weight`, 0 to 1, is that of `network`.
pub fn blended(mut drawn: RangeAngleMap, network: &RangeAngleMap, weight: &Array2<f32>) -> RangeAngleMap {
    Zip::from(&mut drawn.lambda).and(&network.lambda).and(weight).par_for_each(|d, n, w| *d += w * (n - *d));
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32) -> RangeAngleMap {
        RangeAngleMap { lambda: Array2::from_elem((40, 60), value) }
    }

    fn weight([drawn, network, doubt, left]: [f32; 4], shown_part: f32, is_hidden: bool) -> f32 {
        let left = Array2::from_elem((40, 60), left);
        network_weight(&flat(drawn), &flat(network), Some(&flat(doubt)), &left, shown_part, is_hidden)[[20, 30]]
    }

    #[test]
    fn the_search_has_all_weight_where_no_residual_is_left() {
        assert_eq!(weight([0.2, 0.6, 0.01, -4.0], 1.0, false), 0.0);
    }

    #[test]
    fn the_network_has_all_weight_where_the_search_contradicts_it() {
        let of = |network| weight([0.2, network, 0.1645, -0.5], 1.0, false);
        // Twice the expected error is a square of four.
        assert_eq!([of(0.4), of(0.25)], [1.0, AGREED_WEIGHT]);
        let halfway = of(0.2 + 0.1 * 2f32.sqrt());
        assert!((halfway - (1.0 + AGREED_WEIGHT) / 2.0).abs() < 1e-3, "{halfway}");
    }

    #[test]
    fn over_noise_a_contradiction_outweighs_a_zero_residual() {
        let over_noise = |network| weight([0.2, network, 0.1645, -9.0], 1.0, true);
        assert_eq!([over_noise(0.25), over_noise(0.4)], [MIN_UNEXPLAINED_OVER_NOISE * AGREED_WEIGHT, 1.0]);
    }

    #[test]
    fn two_scales_become_their_geometric_mean() {
        let [mut deep, mut shallow] = [flat(0.2), flat(0.8)];
        let etas = stretch_to_common_scale([&mut deep, &mut shallow], [0.6, 0.9]);
        for value in [deep.lambda[[0, 0]], shallow.lambda[[0, 0]]] {
            assert!((value - 0.6).abs() < 1e-6, "{value}");
        }
        assert!(etas.iter().zip([0.8, 0.8]).all(|(eta, expected)| (eta - expected).abs() < 1e-6), "{etas:?}");
    }

    #[test]
    fn the_network_has_all_weight_in_a_mostly_unexplained_scene() {
        let mut left = Array2::from_elem((40, 60), 1.0);
        left.row_mut(3).fill(-9.0);
        let mut drawn = flat(0.2);
        drawn.lambda.row_mut(3).fill(0.6);
        let weight = |part| network_weight(&drawn, &flat(0.9), Some(&flat(0.1)), &left, part, false)[[3, 5]];
        assert_eq!(weight(1.0), 1.0);
        assert_eq!(weight(0.5), 0.0, "cells that are cut off do not count");
    }

    #[test]
    fn bright_cells_of_a_scene_count_as_unexplained_sooner() {
        let mut left = Array2::from_elem((40, 60), -9.0);
        left.slice_mut(ndarray::s![..18, ..]).fill(0.5);
        let weight = |part| network_weight(&flat(0.9), &flat(0.9), Some(&flat(0.1)), &left, part, false)[[30, 30]];
        assert_eq!(weight(1.0), 0.0);
        assert!((weight(0.5) - 0.5 * AGREED_WEIGHT).abs() < 1e-6, "{}", weight(0.5));
    }

    #[test]
    fn the_search_has_all_weight_in_bright_cells_up_to_the_residual() {
        let of = |left, part| weight([0.9, 0.95, 0.2, left], part, false);
        assert_eq!([of(-0.5, 1.0), of(-0.5, 0.5), of(2.0, 0.5)], [AGREED_WEIGHT, 0.0, AGREED_WEIGHT]);
    }

    #[test]
    fn without_doubt_the_residual_alone_sets_the_weight() {
        let left = Array2::from_elem((40, 60), -2.0);
        let weight = network_weight(&flat(0.2), &flat(0.9), None, &left, 1.0, false);
        assert!((weight[[1, 1]] - 0.5).abs() < 1e-6);
        assert!((blended(flat(0.2), &flat(0.9), &weight).lambda[[1, 1]] - 0.55).abs() < 1e-6);
    }

    #[test]
    fn a_moving_mean_counts_each_cell_once() {
        let mut one = Array2::zeros((40, 60));
        one[[20, 30]] = 1.0;
        let mean = moving_mean(&one);
        let [rows, columns] = MEAN_SIDE_CELLS;
        let cells = ((2 * rows + 1) * (2 * columns + 1)) as f32;
        assert!((mean[[20 + rows, 30 - columns]] - 1.0 / cells).abs() < 1e-6);
        assert!(mean[[20 + rows + 1, 30]].abs() < 1e-6 && mean[[20, 30 + columns + 1]].abs() < 1e-6);
        assert!((mean.sum() - 1.0).abs() < 1e-4);
    }
}
