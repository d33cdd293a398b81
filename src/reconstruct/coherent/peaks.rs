//! Local maxima of power over direction, and the gains of reflectors there.

use super::places::Place;
use super::sectors::Sectors;
use crate::radar::Radar;
use crate::reconstruct::echoes::Gained;
use crate::reconstruct::error::ReconstructError;
use crate::signal::{ArrayEcho, TwoEnds};
use crate::task::Task;
use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use num_complex::Complex64;
use rayon::prelude::*;

/// Largest number of peaks of a model: two ends of a dozen elements resolve no more.
const MAX_PEAKS_PER_PLACE: usize = 8;

/// Largest number of reflectors: the time for their gains grows with the square of their number, and faster.
const MAX_REFLECTORS: usize = 400;

/// Ridge on the gains of unit echoes, so that those of close ones don't cancel each other.
const CLOSE_GAINS_RIDGE: f64 = 1e-3;

/// Least energy of an echo over that of the strongest.
const MIN_ENERGY_PART: f64 = 1e-6;

/// A local maximum of power over direction, in polar coordinates around the array's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::reconstruct) struct Peak {
    pub range_metres: f64,
    pub cos_theta: f64,
    pub power: f64,
}

/// The largest local maxima of `powers`, one for each of the sector's directions, that are at least `min_part` of the largest.
pub(super) fn peaks(sectors: &Sectors, place: &Place, powers: &[f64], min_part: f64) -> Vec<Peak> {
    let largest = powers.iter().copied().fold(0.0, f64::max);
    let powers = &powers[..sectors.steps_cos.len().min(powers.len())];
    let at = |i: usize| powers[i];
    // A maximum at the edge belongs to the neighbouring sector, whose directions extend over it.
    let mut maxima: Vec<usize> = (1..powers.len().saturating_sub(1))
        .filter(|&i| at(i) > 0.0 && at(i) >= min_part * largest && at(i) > at(i - 1) && at(i) >= at(i + 1))
        .collect();
    maxima.sort_by(|a, b| at(*b).total_cmp(&at(*a)));
    maxima.truncate(MAX_PEAKS_PER_PLACE);
    maxima
        .into_iter()
        .map(|i| {
            let around = i - 1..i + 2;
            let power: f64 = around.clone().map(at).sum();
            let step = around.map(|k| at(k) * sectors.steps_cos[k]).sum::<f64>() / power;
            let cos_theta = (place.sector.middle_cos + step).clamp(-1.0, 1.0);
            Peak { range_metres: place.range_metres, cos_theta, power: at(i) }
        })
        .collect()
}

/// `peaks` without those nearer to a stronger one than so many range bins and such a difference of cosines, the strongest first.
pub(super) fn distinct(radar: &Radar, mut peaks: Vec<Peak>, [bins, cos]: [f64; 2]) -> Vec<Peak> {
    peaks.sort_by(|a, b| b.power.total_cmp(&a.power));
    let mut found: Vec<Peak> = Vec::new();
    for peak in peaks {
        let same = |k: &Peak| {
            radar.bin_of_range((k.range_metres - peak.range_metres).abs()) < bins
                && (k.cos_theta - peak.cos_theta).abs() < cos
        };
        if found.len() < MAX_REFLECTORS && !found.iter().any(same) {
            found.push(peak);
        }
    }
    found
}

/// Gains of the peaks' exact echoes by least squares on all samples of both ends.
pub(in crate::reconstruct) fn gains(
    radar: &Radar,
    peaks: &[Peak],
    ends: &TwoEnds,
    task: &Task,
) -> Result<Vec<Gained>, ReconstructError> {
    let (samples, hears) = (ends.flat(), ends.measured_elements());
    let echoes: Vec<ArrayEcho> = peaks
        .iter()
        .map(|p| ArrayEcho::at(radar, p.range_metres, p.cos_theta).masked(&hears))
        .filter(|echo| echo.norm().is_finite() && echo.norm() > 0.0)
        .collect();
    let count = echoes.len();
    let products: Vec<Complex64> = echoes.par_iter().map(|e| e.correlate(&samples)).collect();
    task.check()?;
    let mut gram = vec![Complex64::default(); count * count];
    gram.par_chunks_mut(count.max(1)).enumerate().for_each(|(i, row)| {
        for (cell, other) in row.iter_mut().zip(&echoes[..=i]) {
            *cell = echoes[i].inner(other);
        }
    });
    task.check()?;
    let gram = Mat::from_fn(count, count, |i, j| {
        let value = if i >= j { gram[i * count + j] } else { gram[j * count + i].conj() };
        value + if i == j { CLOSE_GAINS_RIDGE } else { 0.0 }
    });
    let Ok(factor) = Llt::new(gram.as_ref(), Side::Lower) else { return Ok(Vec::new()) };
    let gains = factor.solve(Mat::from_fn(count, 1, |i, _| products[i]));
    let strongest = (0..count).map(|i| gains[(i, 0)].norm_sqr()).fold(0.0, f64::max);
    let found = echoes.iter().enumerate().filter(|(i, _)| gains[(*i, 0)].norm_sqr() > strongest * MIN_ENERGY_PART);
    Ok(found.map(|(i, e)| Gained { reflector: e.reflector, gain: gains[(i, 0)] / e.norm() }).collect())
}
