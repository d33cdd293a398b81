//! Which of two maps of one scene to believe, cell by cell: that of the objects which a search found, or that of a network.
//!
//! The search's map is exact where its objects are right, and says so: nothing is left of the samples when they are drawn. The network's is
//! about right everywhere, and says how far off it expects to be. So the search is believed where it leaves nothing. Elsewhere the two are
//! averaged, and the more they differ beyond the network's doubt, the more the network is believed. White noise hides what the search may lack:
//! over it nothing left is no proof, so that the network counts everywhere, and alone where the two contradict each other.

use crate::maps::RangeAngleMap;
use ndarray::{Array1, Array2, ArrayView1, Axis, Zip};
use rayon::prelude::*;

/// Residual over the drawn map, in decades of power, from which the search's map no longer has all weight, and from which it has least: a tenth
/// of the power is half a decibel of the cell.
const LEFT_DECADES: [f32; 2] = [-3.0, -1.0];

/// Shift of these bounds, in decades, where a dynamic range cuts off the dark cells. In bright ones the network draws narrow lobes too dark.
const BRIGHT_SHIFT_DECADES: f32 = 3.0;

/// Parts of the shown cells with more residual than drawn power between which the weight of the search's map falls everywhere: such a scene is
/// not made of points and rows. Cells that a dynamic range cuts off don't count.
const UNEXPLAINED_PART: [f32; 2] = [0.7, 0.9];

/// Weight of the network where the search has a residual and the two agree. Their errors differ, so that the mean is better than either, and the
/// network's error is the smaller one there.
const AGREED_WEIGHT: f32 = 0.7;

/// Mean square of the difference, over that of the network's expected error, from which the two disagree, and from which the network has all weight.
const CONTRADICTION: [f32; 2] = [1.0, 3.0];

/// How far a cell over white noise counts as unexplained at least, 0 to 1.
const HIDDEN_PART: f32 = 0.5;

/// Standard deviations in a doubt, which nine of ten normal errors stay below.
const DOUBT_DEVIATIONS: f32 = 1.645;

/// Range bins and columns to each side over which the difference of the maps is averaged: the width of a lobe of the ends' maps.
const MEAN_SIDE_CELLS: [usize; 2] = [2, 8];

/// Weight of `network`'s map in each cell, 0 to 1, over `drawn`, the search's; both are Lambda on one scale, `[range bins, columns]`.
/// `left_decades` is what the search leaves ([`Found::left_decades`](super::search::Found::left_decades)), and `doubt` what nine of ten
/// errors of the network stay below. A network without doubt is believed wherever something is left. Cells whose Lambda lies deeper below 1
/// than `shown_part` are cut off in what is shown. `is_hidden` says whether noise may hide what the search lacks.
pub fn network_weight(
    drawn: &RangeAngleMap,
    network: &RangeAngleMap,
    doubt: Option<&RangeAngleMap>,
    left_decades: &Array2<f32>,
    shown_part: f32,
    is_hidden: bool,
) -> Array2<f32> {
    let shown = || left_decades.iter().zip(&drawn.lambda).filter(|(_, drawn)| **drawn > 1.0 - shown_part);
    let more_left = shown().filter(|(left, _)| **left > 0.0).count() as f32 / shown().count().max(1) as f32;
    let nowhere = between(UNEXPLAINED_PART, more_left);
    let mut square = &drawn.lambda - &network.lambda;
    square.par_mapv_inplace(|v| v * v);
    let mut weight = mean_around(&square);
    let shift = if shown_part < 1.0 { BRIGHT_SHIFT_DECADES } else { 0.0 };
    let least = if is_hidden { nowhere.max(HIDDEN_PART) } else { nowhere };
    let unexplained = |left: f32| between(LEFT_DECADES, left - shift).max(least);
    let agreed = |contradiction: f32| AGREED_WEIGHT + (1.0 - AGREED_WEIGHT) * contradiction;
    match doubt {
        None => Zip::from(&mut weight).and(left_decades).par_for_each(|w, left| *w = unexplained(*left)),
        Some(doubt) => Zip::from(&mut weight).and(left_decades).and(&doubt.lambda).par_for_each(|w, left, doubt| {
            let expected = (doubt / DOUBT_DEVIATIONS).powi(2).max(f32::MIN_POSITIVE);
            let contradiction = between(CONTRADICTION, *w / expected);
            let hidden = if is_hidden { contradiction } else { 0.0 };
            *w = unexplained(*left).max(hidden) * agreed(contradiction);
        }),
    }
    weight
}

/// Stretches two maps of one scene, each from its peak downwards, to the geometric mean of their scales, and converts their thresholds.
///
/// Over noise the smallest of all cells sets the scale by chance. The mean of two scales is nearer to it than either.
pub fn scales_joined(maps: [&mut RangeAngleMap; 2], etas: [f32; 2]) -> [f32; 2] {
    let depths = maps[0].lambda.iter().zip(&maps[1].lambda).map(|(a, b)| [1.0 - f64::from(*a), 1.0 - f64::from(*b)]);
    let [square, product] = depths.fold([0.0; 2], |[square, product], [a, b]| [square + a * a, product + a * b]);
    let half = if square > 0.0 && product > 0.0 { (product / square).sqrt() as f32 } else { 1.0 };
    let stretched = |factor: f32, v: f32| (1.0 - factor * (1.0 - v)).clamp(0.0, 1.0);
    let factors = [half, half.recip()];
    for (map, factor) in maps.into_iter().zip(factors) {
        map.lambda.par_mapv_inplace(|v| stretched(factor, v));
    }
    [0, 1].map(|i| stretched(factors[i], etas[i]))
}

/// Place of `value` between two bounds, 0 to 1.
fn between([low, high]: [f32; 2], value: f32) -> f32 {
    ((value - low) / (high - low)).clamp(0.0, 1.0)
}

/// Mean of the cells within [`MEAN_SIDE_CELLS`] of each; those beyond the edges count as the edges.
fn mean_around(cells: &Array2<f32>) -> Array2<f32> {
    let [rows, columns] = MEAN_SIDE_CELLS;
    let mut along = cells.clone();
    along.axis_iter_mut(Axis(0)).into_par_iter().for_each(|mut row| {
        let mean = mean_of_window(row.view(), columns);
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

/// Running mean of `2 * side + 1` cells.
fn mean_of_window(cells: ArrayView1<f32>, side: usize) -> Array1<f32> {
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

/// The mean of `drawn` and `network`, with the weight `weight` of the latter; all `[range bins, columns]`.
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

    fn weight(drawn: f32, network: f32, doubt: f32, left: f32) -> f32 {
        let left = Array2::from_elem((40, 60), left);
        network_weight(&flat(drawn), &flat(network), Some(&flat(doubt)), &left, 1.0, false)[[20, 30]]
    }

    #[test]
    fn the_search_is_believed_where_it_leaves_nothing() {
        assert_eq!(weight(0.2, 0.6, 0.01, -4.0), 0.0);
    }

    #[test]
    fn the_network_is_believed_where_the_search_contradicts_it() {
        // Twice the expected error is a square of four.
        assert_eq!(weight(0.2, 0.4, 0.1645, -0.5), 1.0);
        assert_eq!(weight(0.2, 0.25, 0.1645, -0.5), AGREED_WEIGHT);
        let halfway = weight(0.2, 0.2 + 0.1 * 2f32.sqrt(), 0.1645, -0.5);
        assert!((halfway - (1.0 + AGREED_WEIGHT) / 2.0).abs() < 1e-3, "{halfway}");
    }

    #[test]
    fn over_noise_nothing_left_does_not_outweigh_a_contradiction() {
        let left = Array2::from_elem((40, 60), -9.0);
        let over_noise =
            |network| network_weight(&flat(0.2), &flat(network), Some(&flat(0.1645)), &left, 1.0, true)[[20, 30]];
        assert_eq!([over_noise(0.25), over_noise(0.4)], [HIDDEN_PART * AGREED_WEIGHT, 1.0]);
    }

    #[test]
    fn two_scales_become_their_geometric_mean() {
        let [mut deep, mut shallow] = [flat(0.2), flat(0.8)];
        let etas = scales_joined([&mut deep, &mut shallow], [0.6, 0.9]);
        for value in [deep.lambda[[0, 0]], shallow.lambda[[0, 0]]] {
            assert!((value - 0.6).abs() < 1e-6, "{value}");
        }
        assert!(etas.iter().zip([0.8, 0.8]).all(|(eta, expected)| (eta - expected).abs() < 1e-6), "{etas:?}");
    }

    #[test]
    fn a_scene_that_is_mostly_unexplained_is_the_networks() {
        let mut left = Array2::from_elem((40, 60), 1.0);
        left.row_mut(3).fill(-9.0);
        let mut drawn = flat(0.2);
        drawn.lambda.row_mut(3).fill(0.6);
        let weight = |part| network_weight(&drawn, &flat(0.9), Some(&flat(0.1)), &left, part, false)[[3, 5]];
        assert_eq!(weight(1.0), 1.0);
        assert_eq!(weight(0.5), 0.0, "what is cut off says nothing");
    }

    #[test]
    fn bright_cells_are_the_searchs_until_as_much_is_left() {
        let of = |left: f32, part| {
            let left = Array2::from_elem((40, 60), left);
            network_weight(&flat(0.9), &flat(0.95), Some(&flat(0.2)), &left, part, false)[[20, 30]]
        };
        assert_eq!([of(-0.5, 1.0), of(-0.5, 0.5), of(2.0, 0.5)], [AGREED_WEIGHT, 0.0, AGREED_WEIGHT]);
    }

    #[test]
    fn a_network_without_doubt_is_believed_where_something_is_left() {
        let left = Array2::from_elem((40, 60), -2.0);
        let weight = network_weight(&flat(0.2), &flat(0.9), None, &left, 1.0, false);
        assert!((weight[[1, 1]] - 0.5).abs() < 1e-6);
        assert!((blended(flat(0.2), &flat(0.9), &weight).lambda[[1, 1]] - 0.55).abs() < 1e-6);
    }

    #[test]
    fn a_mean_counts_each_cell_around_once() {
        let mut one = Array2::zeros((40, 60));
        one[[20, 30]] = 1.0;
        let mean = mean_around(&one);
        let [rows, columns] = MEAN_SIDE_CELLS;
        let cells = ((2 * rows + 1) * (2 * columns + 1)) as f32;
        assert!((mean[[20 + rows, 30 - columns]] - 1.0 / cells).abs() < 1e-6);
        assert!(mean[[20 + rows + 1, 30]].abs() < 1e-6 && mean[[20, 30 + columns + 1]].abs() < 1e-6);
        assert!((mean.sum() - 1.0).abs() < 1e-4);
    }
}
