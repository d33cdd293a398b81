//! The input of a row method.

use crate::maps::Spectrum;
use crate::radar::hann;
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use num_complex::Complex64;

/// One end's snapshot at one range row, and its surroundings.
pub struct RowSnapshot<'a> {
    /// Range profiles of the elements at the rows before, at and after this one; the middle is the row itself.
    pub snapshots: [&'a [Complex64]; 3],
    pub noise_variance: f64,
    /// Part of the power of one echo that no plane wave describes: its range, and so its amplitude in a range row, changes over the end.
    pub not_plane: f64,
    pub spectrum: &'a Spectrum,
}

impl RowSnapshot<'_> {
    /// The row's own snapshot, one value an element.
    pub fn own(&self) -> &[Complex64] {
        self.snapshots[1]
    }

    /// Power over angle of plain beamforming, in the order of the transform: amplitude is the mean over the elements.
    pub fn bartlett(&self) -> Vec<f64> {
        let elements = self.own().len() as f64;
        self.spectrum.of(self.own().iter().copied()).into_iter().map(|v| v.norm_sqr() / (elements * elements)).collect()
    }

    /// Converts a null spectrum, small where there is a reflector, into power: its reciprocal, scaled to plain beamforming's largest. A
    /// pseudo-spectrum has the places of reflectors, not their strengths.
    pub fn power_of_nulls(&self, nulls: &[f64]) -> Vec<f64> {
        let strongest = self.bartlett().into_iter().fold(0.0, f64::max);
        let guard = nulls.iter().fold(0.0, |m: f64, v| m.max(*v)) * 1e-15 + f64::MIN_POSITIVE;
        let deepest = nulls.iter().fold(f64::INFINITY, |m, v| m.min(*v)).max(guard);
        nulls.iter().map(|v| strongest * deepest / v.max(deepest)).collect()
    }

    /// Power over angle, in the order of the transform, of the whole array: waves of `turns` per element, with amplitudes by least squares.
    pub fn continued(&self, turns: &[f64]) -> Option<Vec<f64>> {
        let own = self.own();
        if turns.is_empty() {
            return None;
        }
        let wave = |turns: f64, n: f64| Complex64::cis(std::f64::consts::TAU * turns * n);
        let waves = Mat::from_fn(own.len(), turns.len(), |n, i| wave(turns[i], n as f64));
        let samples = Mat::from_fn(own.len(), 1, |n, _| own[n]);
        let amplitudes = waves.qr().solve_lstsq(samples);

        let columns = self.spectrum.len();
        let window = hann(columns);
        let mut array = vec![Complex64::default(); columns];
        for (i, turns) in turns.iter().enumerate() {
            let step = wave(*turns, 1.0);
            let mut phasor = amplitudes[(i, 0)];
            for value in &mut array {
                *value += phasor;
                phasor *= step;
            }
        }
        let total: f64 = window.iter().sum();
        let windowed = array.into_iter().zip(&window).map(|(v, w)| v * w / total);
        Some(self.spectrum.of(windowed).into_iter().map(|v| v.norm_sqr()).collect())
    }
}

/// Calls `look` with twelve elements, almost without noise, and with waves of these turns per element and amplitudes.
#[cfg(test)]
pub(super) fn with_waves<T>(waves: &[(f64, f64)], look: impl FnOnce(&RowSnapshot<'_>) -> T) -> T {
    let heard = |n: usize| waves.iter().map(|(t, a)| a * Complex64::cis(std::f64::consts::TAU * t * n as f64)).sum();
    let own: Vec<Complex64> = (0..12).map(heard).collect();
    let silent = vec![Complex64::default(); 12];
    let snapshots: [&[Complex64]; 3] = [&silent, &own, &silent];
    look(&RowSnapshot { snapshots, noise_variance: 1e-20, not_plane: 1e-10, spectrum: &Spectrum::new(1024) })
}
