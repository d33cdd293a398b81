//! What every model-based method does first: check the samples, take their gain off, and listen to their noise.

use super::{ReconstructError, check_ends};
use crate::maps::Spectrum;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use ndarray::ArrayView1;
use num_complex::Complex64;

/// Samples of both ends with a peak between 1 and 2, and the noise beneath them.
pub(super) struct Conditioned {
    /// The samples, scaled by a power of two.
    pub ends: TwoEnds,
    /// What the samples were multiplied with.
    pub gain: f64,
    /// Variance of the white complex noise of a scaled sample, as measured.
    pub noise_variance: f64,
}

/// Scales the samples of both ends, or gives `None` for silence.
///
/// # Errors
/// As [`check_ends`].
pub(super) fn condition(radar: &Radar, ends: &TwoEnds) -> Result<Option<Conditioned>, ReconstructError> {
    check_ends(radar, ends)?;
    let Some((ends, gain)) = unit_gain(ends) else { return Ok(None) };
    let noise_variance = noise_variance(radar, End::BOTH.into_iter().flat_map(|e| ends.end(e).outer_iter()));
    Ok(Some(Conditioned { ends, gain, noise_variance }))
}

/// Scales the samples of both ends to a peak between 1 and 2 and says by how much; `None` for silence.
pub(crate) fn unit_gain(ends: &TwoEnds) -> Option<(TwoEnds, f64)> {
    let peak = ends.first.iter().chain(&ends.last).fold(0.0f64, |m, v| m.max(v.re.abs()).max(v.im.abs()));
    if peak == 0.0 {
        return None;
    }
    // A power of two loses no bit, so that the gain leaves no trace, not even in the rounding noise of the floor.
    let gain = (-peak.log2().floor()).clamp(-1000.0, 1000.0).exp2();
    Some((TwoEnds { first: ends.first.mapv(|v| v * gain), last: ends.last.mapv(|v| v * gain) }, gain))
}

/// Shape of the Kaiser window: side lobes 300 dB down, below the rounding of f64.
const KAISER_BETA: f64 = 32.0;

/// Part of the range bins that are taken to hold noise only.
const QUIET_PART: f64 = 0.2;

/// Variance of white noise in the samples of `channels`: the power of the quietest range bins under a window without side lobes.
pub(super) fn noise_variance<'a>(radar: &Radar, channels: impl Iterator<Item = ArrayView1<'a, Complex64>>) -> f64 {
    let window = kaiser(radar.samples);
    let power: f64 = window.iter().map(|w| w * w).sum();
    let spectrum = Spectrum::new(radar.samples);
    let mut bins = vec![0.0; radar.samples];
    let mut count = 0.0;
    for channel in channels {
        for (bin, v) in bins.iter_mut().zip(spectrum.of(channel.iter().zip(&window).map(|(v, w)| v * w))) {
            *bin += v.norm_sqr();
        }
        count += 1.0;
    }
    let quiet = (QUIET_PART * bins.len() as f64) as usize;
    let quantile = *bins.select_nth_unstable_by(quiet, f64::total_cmp).1;
    // The mean of `count` exponential powers is nearly normal with this relative spread; its 20 % quantile is 0.84 below.
    quantile / (count * power) / (1.0 - 0.84 / f64::sqrt(count)).max(0.3)
}

/// Kaiser window (J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function", 1974).
fn kaiser(len: usize) -> Vec<f64> {
    let middle = (len as f64 - 1.0) / 2.0;
    (0..len)
        .map(|n| bessel_i0(KAISER_BETA * (1.0 - ((n as f64 - middle) / middle).powi(2)).max(0.0).sqrt()))
        .map(|w| w / bessel_i0(KAISER_BETA))
        .collect()
}

/// Modified Bessel function of the first kind and order 0, by its power series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..200 {
        term *= quarter / f64::from(k * k);
        sum += term;
        if term < sum * 1e-17 {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::scene::Scene;
    use crate::signal::floor::{snr_noise_variance, thesis_noise_variance};
    use crate::signal::{Floor, simulate};

    #[test]
    fn the_measured_noise_is_the_noise_that_was_added() {
        let radar = Radar::default();
        let scene = Scene::of_points([(2.0, 10.0), (-6.0, 17.0), (9.0, 20.0)]);
        for snr in [60.0, 0.0] {
            let signal = simulate(&radar, &scene, Floor::Snr(Decibels(snr)), 3).unwrap();
            let expected = snr_noise_variance(&radar, &scene.reflectors(), Decibels(snr))[0];
            let c = condition(&radar, &signal.two_ends(&radar)).unwrap().unwrap();
            let found = c.noise_variance / (c.gain * c.gain);
            assert!((found / expected - 1.0).abs() < 0.15, "{snr} dB: {found:e} {expected:e}");
        }
        let signal = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
        let expected = thesis_noise_variance(&radar, &scene.reflectors())[5];
        let c = condition(&radar, &signal.two_ends(&radar)).unwrap().unwrap();
        let found = c.noise_variance / (c.gain * c.gain);
        // Rounding is not white: the quiet bins hold less of it than the mean.
        assert!((found / expected).log10().abs() < 0.7, "{found:e} {expected:e}");
    }

    #[test]
    fn silence_is_none() {
        let radar = Radar::default();
        let silence = crate::signal::BeatSignal::silence(&radar).two_ends(&radar);
        assert!(condition(&radar, &silence).unwrap().is_none());
    }

    #[test]
    fn bessel_function_has_its_tabled_values() {
        assert!((bessel_i0(1.0) - 1.266_065_877_752_008_3).abs() < 1e-15);
        assert!((bessel_i0(5.0) / 27.239_871_823_604_44 - 1.0).abs() < 1e-14);
    }
}
