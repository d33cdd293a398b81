//! Where the residual still holds a reflector: both ends' beams laid over each other on the polar grid of the array's centre.
//!
//! The ends see a reflector up to 27 range bins apart and at different angles, so each cell looks up its own range and angle at
//! each end. Magnitudes are added, not amplitudes: the phase between the ends changes with every column of the full map.

use crate::radar::{End, Radar};
use crate::reconstruct::nomp::end_beams::{beam_of_cos, end_beams};
use num_complex::Complex64;

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

/// Registered magnitude of a residual, `[2 * range bins, COLUMNS]`.
pub struct Detector {
    /// Centre (x, y) of every cell of the common grid, metres; one wrap beyond the maximum range included.
    places: Vec<[f64; 2]>,
    /// Where each cell lies in the beams of each end, `[beam * range bins + range bin]`.
    cells: [Vec<u32>; 2],
}

impl Detector {
    /// A detector for the ends of `radar`.
    pub fn new(radar: &Radar) -> Self {
        let (bins, bin_metres) = (radar.samples, radar.range_resolution_metres());
        let place = |i: usize| {
            let range = (i / COLUMNS) as f64 * bin_metres;
            let cos = ((i % COLUMNS) as f64 + 0.5) / COLUMNS as f64 * 2.0 - 1.0;
            [range * cos, range * (1.0 - cos * cos).sqrt()]
        };
        let places: Vec<[f64; 2]> = (0..2 * bins * COLUMNS).map(place).collect();
        let cells = End::BOTH.map(|end| {
            let centre = radar.end_centre_metres(end);
            let cell = |[x, y]: &[f64; 2]| {
                let dx = x - centre;
                let range = (dx * dx + y * y).sqrt().max(1e-9);
                let row = (range / bin_metres).round() as usize % bins;
                (beam_of_cos(dx / range, BEAMS) * bins + row) as u32
            };
            places.iter().map(cell).collect()
        });
        Detector { places, cells }
    }

    /// The strongest cell of `residual` (not windowed), up to one wrap beyond the maximum range.
    pub fn strongest(&self, radar: &Radar, residual: &[Complex64]) -> Option<Candidate> {
        let magnitudes: [Vec<f64>; 2] =
            end_beams(radar, residual, BEAMS).map(|beams| beams.iter().map(|v| v.norm_sqr().sqrt()).collect());
        let [first, last] = &self.cells;
        let sum = |(a, b): (&u32, &u32)| (magnitudes[0][*a as usize] + magnitudes[1][*b as usize]).powi(2);
        let mut powers: Vec<f64> = first.iter().zip(last).map(sum).collect();
        let (at, &power) = powers.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        let middle = powers.len() / 2;
        let median = *powers.select_nth_unstable_by(middle, f64::total_cmp).1;
        let [x, y] = self.places[at];
        (power > 0.0).then(|| Candidate { x, y, prominence: power / median.max(f64::MIN_POSITIVE) })
    }
}
