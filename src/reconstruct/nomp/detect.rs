//! Where the residual still holds a reflector: both ends' beams laid over each other on the polar grid of the array's centre.
//!
//! The ends see a reflector up to 27 range bins apart and at different angles, so each cell looks up its own range and angle at
//! each end. Magnitudes are added, not amplitudes: the phase between the ends changes with every column of the full map.

use super::sensor::Sensor;
use crate::maps::channels_range_transform;
use crate::radar::{End, Radar};
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Beams formed by each end; twelve elements resolve about twelve.
const BEAMS: usize = 48;

/// Columns of the common polar grid.
const COLUMNS: usize = 128;

/// A cell of the common polar grid that stands out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// x in metres.
    pub x: f64,
    /// y in metres, at least 0.
    pub y: f64,
    /// Power of the cell over the median of all cells.
    pub prominence: f64,
}

/// Registered magnitude of the residual, `[range bins, COLUMNS]`.
pub struct Detector {
    /// x of the centre of each end.
    centres: [f64; 2],
    bin_metres: f64,
    bins: usize,
    /// Phase from element to element for cos(theta) = 1, radians.
    radians_per_element: f64,
}

impl Detector {
    /// A detector for the ends of `radar`.
    pub fn new(radar: &Radar) -> Self {
        Detector {
            centres: End::BOTH.map(|e| radar.end_centre_metres(e)),
            bin_metres: radar.range_resolution_metres(),
            bins: radar.samples,
            radians_per_element: -TAU * radar.carrier.turns_per_wavelength() * radar.element_spacing_metres
                / radar.wavelength_metres(),
        }
    }

    /// Magnitude of each end's beams, `[range bins, BEAMS]` for each end.
    fn beams(&self, radar: &Radar, sensor: &Sensor, residual: &[Complex64]) -> [Array2<f64>; 2] {
        let ends = sensor.unflatten(residual);
        End::BOTH.map(|end| {
            let profiles = channels_range_transform(radar, ends.end(end).view()).profiles;
            let mut magnitude = Array2::zeros((self.bins, BEAMS));
            for (beam, mut column) in magnitude.axis_iter_mut(Axis(1)).enumerate() {
                let cos = (beam as f64 + 0.5) / BEAMS as f64 * 2.0 - 1.0;
                let steer: Vec<Complex64> =
                    (0..profiles.nrows()).map(|n| Complex64::cis(-self.radians_per_element * cos * n as f64)).collect();
                let mut sums = vec![Complex64::default(); self.bins];
                for (profile, steer) in profiles.outer_iter().zip(&steer) {
                    for (sum, p) in sums.iter_mut().zip(profile) {
                        *sum += p * steer;
                    }
                }
                for (m, s) in column.iter_mut().zip(&sums) {
                    *m = s.norm();
                }
            }
            magnitude
        })
    }

    /// The strongest cell of `residual` (not windowed), up to one wrap beyond the maximum range.
    pub fn strongest(&self, radar: &Radar, sensor: &Sensor, residual: &[Complex64]) -> Option<Candidate> {
        let beams = self.beams(radar, sensor, residual);
        let mut cells = Array2::<f64>::zeros((2 * self.bins, COLUMNS));
        for ((bin, column), cell) in cells.indexed_iter_mut() {
            let [x, y] = self.position(bin, column);
            let mut sum = 0.0;
            for (end, centre) in self.centres.iter().enumerate() {
                let dx = x - centre;
                let range = (dx * dx + y * y).sqrt().max(1e-9);
                let row = (range / self.bin_metres).round() as usize % self.bins;
                let beam = ((dx / range + 1.0) / 2.0 * BEAMS as f64).floor().clamp(0.0, BEAMS as f64 - 1.0);
                sum += beams[end][[row, beam as usize]];
            }
            *cell = sum * sum;
        }
        let ((bin, column), &power) = cells.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1))?;
        let mut all: Vec<f64> = cells.iter().copied().collect();
        let middle = all.len() / 2;
        let median = *all.select_nth_unstable_by(middle, f64::total_cmp).1;
        let [x, y] = self.position(bin, column);
        (power > 0.0).then(|| Candidate { x, y, prominence: power / median.max(f64::MIN_POSITIVE) })
    }

    /// Centre (x, y) of a cell of the common grid, metres.
    fn position(&self, bin: usize, column: usize) -> [f64; 2] {
        let range = bin as f64 * self.bin_metres;
        let cos = (column as f64 + 0.5) / COLUMNS as f64 * 2.0 - 1.0;
        [range * cos, range * (1.0 - cos * cos).sqrt()]
    }
}
