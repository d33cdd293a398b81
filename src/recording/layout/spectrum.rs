//! Spectra of a layout: range profiles of many chirps and receivers, and figures on them.

use crate::maps::windowed_range_transform;
use crate::radar::{Radar, WindowFunction};
use crate::recording::analytic::subtract_mean;
use ndarray::{Array2, ArrayView1, ArrayView2, Axis};
use num_complex::Complex64;

/// Power of rounding to whole numbers in a bin: 1/12 for each of real and imaginary part.
pub(super) const ROUNDING_POWER: f64 = 1.0 / 6.0;

/// Least power of an echo relative to the median of the bins (15 dB), and largest distance below the strongest echo, decibels.
const MIN_ECHO_OVER_MEDIAN: f64 = 31.6;
const MAX_ECHO_BELOW_PEAK_DB: f64 = 40.0;

/// Largest distance of an image below its echo, and of that echo below the strongest, decibels. Images by unequal converters are weaker.
const MAX_IMAGE_BELOW_ECHO_DB: f64 = 20.0;
/// Least coherence of an echo with its image.
const MIN_IMAGE_COHERENCE: f64 = 0.5;
/// Number of bins beside the constant part where echoes don't count.
const CONSTANT_BINS: usize = 4;

/// Mean power of range profiles, and figures on them.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::recording) struct Spectrum {
    /// Power of each range bin, mean over chirps and receivers.
    pub power: Vec<f64>,
    /// Mean natural logarithm of `power`. It is lowest for the right layout, by which echoes are in few bins.
    pub level: f64,
    /// Mean correlation of each receiver's logarithmic range profile with the mean of the others', -1 to 1; 1 for one receiver.
    pub correlation: f64,
    /// Difference between the power in the near half and that in the far half of the bins, over their sum: -1 to 1.
    pub near: f64,
    /// Numbers of echoes in the near and in the far half of the bins.
    pub echoes: [usize; 2],
    /// Number of echoes in the near half with an image in the far half, as those of real samples have.
    pub images: usize,
    /// Number of profiles.
    pub rows: usize,
}

impl Spectrum {
    /// Spectrum of `rows`, `[chirps * receivers, samples]`, without the mean of each row.
    pub fn of(rows: &Array2<Complex64>, receivers: usize) -> Spectrum {
        let (count, samples) = rows.dim();
        let mut centred = rows.clone();
        subtract_mean(&mut centred);
        let radar = Radar { samples, ..Radar::default() };
        let window = WindowFunction::Hann.weights(samples);
        let gain = window.iter().map(|w| w * w).sum::<f64>() / samples.max(1) as f64;
        let profiles = windowed_range_transform(&radar, centred.view(), &window).profiles;
        let mut receiver_power = Array2::<f64>::zeros((receivers, samples));
        let divisor = (count / receivers).max(1) as f64 * gain.max(f64::MIN_POSITIVE);
        for (n, row) in profiles.outer_iter().enumerate() {
            let mut power = receiver_power.row_mut(n % receivers);
            power.iter_mut().zip(row).for_each(|(p, v)| *p += v.norm_sqr() / divisor);
        }
        receiver_power.mapv_inplace(|p| p + ROUNDING_POWER);
        let power: Vec<f64> = receiver_power.mean_axis(Axis(0)).map_or_else(Vec::new, |mean| mean.to_vec());
        let images = images(&power, |bin| coherence(profiles.view(), bin) > MIN_IMAGE_COHERENCE);
        let spectrum = Spectrum::of_power(power, receiver_correlation(receiver_power.view()), images);
        // The expected logarithm of a mean of n exponential powers is low by ln n less the digamma function of n, here by its series.
        let inverse = 1.0 / count.max(1) as f64;
        Spectrum { level: spectrum.level + inverse / 2.0 + inverse * inverse / 12.0, rows: count, ..spectrum }
    }

    fn of_power(power: Vec<f64>, correlation: f64, images: usize) -> Spectrum {
        let bins = power.len().max(1);
        let level = power.iter().map(|p| p.ln()).sum::<f64>() / bins as f64;
        let echoes = echoes(&power);
        let half = |range: std::ops::Range<usize>| power.get(range).map_or(0.0, |part| part.iter().sum::<f64>());
        // The constant part is in bin 0 and, by the window, in the bins beside it.
        let (near, far) = (half(2..bins / 2), half(bins / 2 + 1..bins.saturating_sub(1)));
        let near = if near + far > 0.0 { (near - far) / (near + far) } else { 0.0 };
        Spectrum { power, level, correlation, near, echoes, images, rows: 1 }
    }

    /// The spectrum with I and Q in the other order, which conjugates the samples.
    pub fn mirrored(&self) -> Spectrum {
        let bins = self.power.len();
        let power = (0..bins).map(|bin| self.power[(bins - bin) % bins]).collect();
        let [near, far] = self.echoes;
        Spectrum { power, near: -self.near, echoes: [far, near], ..self.clone() }
    }

    /// The spectrum of real samples: the near half at twice the power, that of complex samples of the same words.
    pub fn of_real(self) -> Spectrum {
        let bins = self.power.len();
        let power: Vec<f64> = self.power[..bins.div_ceil(2)].iter().map(|p| 2.0 * p).collect();
        let level = self.level + std::f64::consts::LN_2;
        Spectrum { near: 0.0, level, rows: self.rows, ..Spectrum::of_power(power, self.correlation, 0) }
    }

    /// Distance of the mean level below that of a flat spectrum of the same power, decibels.
    pub fn flatness_db(&self) -> f64 {
        let mean = self.power.iter().sum::<f64>() / self.power.len().max(1) as f64;
        10.0 * (mean.ln() - self.level) / std::f64::consts::LN_10
    }
}

/// Numbers of echoes in the near half of the bins and in the far half.
fn echoes(power: &[f64]) -> [usize; 2] {
    let Some((peak, median)) = peak_and_median(power) else { return [0; 2] };
    let least = (median * MIN_ECHO_OVER_MEDIAN).max(peak * 10f64.powf(-MAX_ECHO_BELOW_PEAK_DB / 10.0));
    let bins = power.len();
    let is_peak = |n: &usize| {
        let at = power[*n];
        at >= least && at >= power[(n + 1) % bins] && at > power[(n + bins - 1) % bins]
    };
    [0..bins / 2, bins / 2..bins].map(|mut half| half.by_ref().filter(is_peak).count())
}

/// Number of echoes in the near half with an image at the mirrored bin, but for images of equal power: those of real samples stored as complex.
fn images(power: &[f64], is_coherent: impl Fn(usize) -> bool) -> usize {
    let bins = power.len();
    let Some((peak, median)) = peak_and_median(power) else { return 0 };
    let range = 10f64.powf(MAX_IMAGE_BELOW_ECHO_DB / 10.0);
    let is_image = |n: &usize| {
        let [at, other] = [power[*n], power[bins - n]];
        let (louder, fainter) = (at.max(other), at.min(other));
        let stands_out =
            louder * range >= peak && fainter * range >= louder && fainter >= median * MIN_ECHO_OVER_MEDIAN;
        let is_peak = at > power[n - 1] && at >= power[n + 1];
        is_peak && stands_out && louder - fainter > 1e-9 * louder && is_coherent(*n)
    };
    (CONSTANT_BINS..(bins / 2).saturating_sub(1)).filter(is_image).count()
}

/// Coherence of a bin's values with the mirrored bin's conjugates over all profiles: 1 for an image, low for two echoes of unequal phases.
fn coherence(profiles: ArrayView2<'_, Complex64>, bin: usize) -> f64 {
    let [near, far] = [bin, profiles.ncols() - bin].map(|n| profiles.column(n));
    let power = |of: &ArrayView1<'_, Complex64>| of.iter().map(|v| v.norm_sqr()).sum::<f64>();
    let product: Complex64 = near.iter().zip(&far).map(|(a, b)| a * b).sum();
    product.norm() / (power(&near) * power(&far)).sqrt().max(f64::MIN_POSITIVE)
}

fn peak_and_median(power: &[f64]) -> Option<(f64, f64)> {
    let mut sorted = power.to_vec();
    sorted.sort_by(f64::total_cmp);
    Some((*sorted.last()?, *sorted.get(sorted.len() / 2)?))
}

/// Mean correlation of the logarithm of each row with the mean of the others'.
fn receiver_correlation(power: ArrayView2<'_, f64>) -> f64 {
    let receivers = power.nrows();
    if receivers < 2 {
        return 1.0;
    }
    let logs = power.mapv(f64::ln);
    let total = logs.sum_axis(Axis(0));
    let one = |n: usize| {
        let row = logs.row(n);
        let others = (&total - &row) / (receivers - 1) as f64;
        correlation(row.iter().copied(), others.iter().copied())
    };
    (0..receivers).map(one).sum::<f64>() / receivers as f64
}

/// Correlation of two sequences; 0 where one is constant.
pub(super) fn correlation(a: impl Iterator<Item = f64> + Clone, b: impl Iterator<Item = f64> + Clone) -> f64 {
    let mean = |of: &mut dyn Iterator<Item = f64>| {
        let (count, sum) = of.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v));
        sum / f64::max(count, 1.0)
    };
    let (mean_a, mean_b) = (mean(&mut a.clone()), mean(&mut b.clone()));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    if aa * bb > 0.0 { ab / (aa * bb).sqrt() } else { 0.0 }
}
