//! Where the residual still holds a reflector: both ends' beams laid over each other on the polar grid of the array's centre.
//!
//! Magnitudes are added, not amplitudes: the phase between the ends changes with every column of the full map.

use crate::radar::Radar;
use crate::reconstruct::nomp::end_beams::end_beams;
use crate::reconstruct::nomp::registered::Registered;
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

/// Looks for what stands out on the common polar grid.
pub struct Detector {
    grid: Registered,
}

impl Detector {
    /// A detector for the ends of `radar`.
    pub fn new(radar: &Radar) -> Self {
        Detector { grid: Registered::new(radar, BEAMS, COLUMNS) }
    }

    /// The strongest cell of `residual` (not windowed), up to one wrap beyond the maximum range.
    pub fn strongest(&self, radar: &Radar, residual: &[Complex64]) -> Option<Candidate> {
        let magnitudes: [Vec<f64>; 2] =
            end_beams(radar, residual, BEAMS).map(|beams| beams.iter().map(|v| v.norm_sqr().sqrt()).collect());
        let [first, last] = &self.grid.cells;
        let sum = |(a, b): (&u32, &u32)| (magnitudes[0][*a as usize] + magnitudes[1][*b as usize]).powi(2);
        let mut powers: Vec<f64> = first.iter().zip(last).map(sum).collect();
        let (at, &power) = powers.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        let middle = powers.len() / 2;
        let median = *powers.select_nth_unstable_by(middle, f64::total_cmp).1;
        let [x, y] = self.grid.places_metres[at];
        (power > 0.0).then(|| Candidate { x, y, prominence: power / median.max(f64::MIN_POSITIVE) })
    }
}
