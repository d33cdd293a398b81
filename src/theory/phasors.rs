//! The contributions of all elements to one cell of a map, in the complex plane: added head to tail they end at the cell.

use crate::maps::Aperture;
use crate::radar::Radar;
use ndarray::ArrayView2;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Contributions of an aperture's elements to one cell (thesis section 3.1), that of [`crate::maps::angle_transform`] under the window.
#[derive(Debug, Clone, PartialEq)]
pub struct Phasors {
    /// The first element of the aperture.
    pub first_element: usize,
    /// The contribution of each element, in the order of the elements.
    pub contributions: Vec<Complex64>,
}

impl Phasors {
    /// The contributions to the cell `[bin, column]` of the map of `aperture`, from the samples of the whole array,
    /// `[elements, samples]`. Without `windowed`, the window over the elements is left out: every element counts alike.
    pub fn of(
        radar: &Radar,
        samples: ArrayView2<'_, Complex64>,
        aperture: Aperture,
        [bin, column]: [usize; 2],
        windowed: bool,
    ) -> Phasors {
        let elements = aperture.channels(radar);
        let ranges = radar.window.weights(radar.samples);
        let over_samples: Vec<Complex64> =
            ranges.iter().enumerate().map(|(n, w)| turn(n * bin, radar.samples) * *w).collect();
        let weights = match windowed {
            true => radar.window.weights(elements.len()),
            false => vec![1.0; elements.len()],
        };
        let scale = ((radar.samples * radar.elements) as f64).sqrt().recip();
        // The map's columns are rolled by half their number, so that broadside is in the middle.
        let frequency = (column + radar.elements - radar.elements / 2) % radar.elements;
        let first_element = elements.start;
        let contribution = |(k, weight): (usize, f64)| {
            let profile: Complex64 =
                samples.row(first_element + k).iter().zip(&over_samples).map(|(sample, turn)| sample * turn).sum();
            profile * turn(k * frequency, radar.elements) * (weight * scale)
        };
        Phasors { first_element, contributions: weights.into_iter().enumerate().map(contribution).collect() }
    }

    /// The sums of the first 0, 1, 2, ... contributions: the corners of the chain from 0 to the cell.
    pub fn chain(&self) -> Vec<Complex64> {
        let sums = self.contributions.iter().scan(Complex64::default(), |sum, c| {
            *sum += c;
            Some(*sum)
        });
        std::iter::once(Complex64::default()).chain(sums).collect()
    }

    /// The sum of all contributions: the cell.
    pub fn sum(&self) -> Complex64 {
        self.contributions.iter().sum()
    }

    /// Each contribution times the conjugate phase of `of_point`'s, which straightens the chain of a near point; zeros there turn nothing.
    pub fn focused(&self, of_point: &Phasors) -> Phasors {
        let turned = self.contributions.iter().zip(&of_point.contributions).map(|(own, point)| {
            let length = point.norm();
            if length > 0.0 { own * point.conj() / length } else { *own }
        });
        Phasors { first_element: self.first_element, contributions: turned.collect() }
    }
}

/// `exp(-2 pi i k / n)`; the phase is reduced to a turn before it is taken.
fn turn(k: usize, n: usize) -> Complex64 {
    Complex64::from_polar(1.0, -TAU * (k % n) as f64 / n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{angle_transform, range_transform};
    use crate::radar::Convention;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    fn radar() -> Radar {
        Radar { elements: 64, end_elements: 12, samples: 32, ..Radar::default() }
    }

    #[test]
    fn the_chain_ends_at_the_cell_of_the_map() {
        let radar = radar();
        let scene = Scene::of_points([(0.2, 0.9), (-0.5, 1.6)]);
        let signal = simulate(&radar, &scene, Floor::Thesis, 3).unwrap();
        let profiles = range_transform(&radar, &signal);
        for aperture in Aperture::ALL {
            let map = angle_transform(&radar, &profiles, aperture);
            let peak = map.cells.iter().map(|c| c.norm()).fold(0.0, f64::max);
            for cell in [[0, 0], [12, 40], [21, 19], [31, 63]] {
                let phasors = Phasors::of(&radar, signal.samples.view(), aperture, cell, true);
                let error = (phasors.sum() - map.cells[cell]).norm();
                assert!(error < 1e-12 * peak, "{aperture:?} {cell:?}: {error:e} of {peak:e}");
                assert_eq!(*phasors.chain().last().unwrap(), phasors.chain()[phasors.contributions.len()]);
            }
        }
    }

    fn straightness(radar: &Radar, point: (f64, f64), cell: [usize; 2]) -> [f64; 2] {
        let signal = simulate(radar, &Scene::of_points([point]), Floor::Exact, 0).unwrap();
        let phasors = Phasors::of(radar, signal.samples.view(), Aperture::Full, cell, true);
        let length: f64 = phasors.contributions.iter().map(|c| c.norm()).sum();
        [phasors.sum().norm() / length, phasors.focused(&phasors).sum().norm() / length]
    }

    #[test]
    fn chains_look_as_the_lesson_phasors_says() {
        let whole = Radar::default().in_convention(Convention::Physical);
        let short = Radar { elements: 96, ..whole.clone() };
        let bin = short.bin_of_range(20.0).round() as usize;
        let [blob, _] = straightness(&short, (0.0, 20.0), [bin, 48]);
        let [null, _] = straightness(&short, (0.0, 20.0), [bin, 50]);
        assert!(blob > 0.98 && null < 0.03, "{blob} {null}");
        let bin = whole.bin_of_range(5.0).round() as usize;
        let [spiral, focused] = straightness(&whole, (0.0, 5.0), [bin, 512]);
        assert!(spiral < 0.3 && focused > 0.999, "{spiral} {focused}");
    }
}
