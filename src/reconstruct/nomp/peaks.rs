//! Where a residual still holds reflectors: both ends' beams laid over each other on the polar grid of the array's centre.
//!
//! Magnitudes are multiplied, not amplitudes added: the phase between the ends changes with every column of the full map, and what stands in one end
//! alone is a ghost.

use super::end_beams::end_beams;
use super::registered::Registered;
use crate::radar::Radar;
use num_complex::Complex64;
use std::sync::{Arc, Mutex, PoisonError};

/// Beams formed by each end for each of its elements.
const BEAMS_PER_ELEMENT: usize = 4;

/// Columns of the common polar grid for each element of an end.
const COLUMNS_PER_ELEMENT: usize = 10;

/// One look at the residual finds no two places within this many range bins of each other: what the stronger leaves comes first.
const ALONE_BINS: i32 = 8;

/// A place where something stands out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Position along the array.
    pub x_metres: f64,
    /// Position ahead of the array, at least 0.
    pub y_metres: f64,
    /// Product of both ends' magnitudes: the power of one end's beam where both are alike.
    pub power: f64,
    /// Range bin at each end.
    rows: [i32; 2],
}

/// Looks for what stands out on the common grid.
pub struct Detector {
    grid: Registered,
    beams: usize,
    columns: usize,
    bins: usize,
}

/// The last detector made: the radar seldom changes.
static LAST: Mutex<Option<(Radar, Arc<Detector>)>> = Mutex::new(None);

impl Detector {
    /// The detector of `radar`, kept from the last time where that was for the same.
    pub fn of(radar: &Radar) -> Arc<Detector> {
        // Nothing is computed while the lock is held.
        let last = LAST.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some((_, detector)) = last.filter(|(of, _)| of == radar) {
            return detector;
        }
        let detector = Arc::new(Detector::new(radar));
        *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some((radar.clone(), detector.clone()));
        detector
    }

    /// For the ends of `radar`.
    fn new(radar: &Radar) -> Self {
        let (beams, columns) = (BEAMS_PER_ELEMENT * radar.end_elements, COLUMNS_PER_ELEMENT * radar.end_elements);
        Detector { grid: Registered::new(radar, beams, columns), beams, columns, bins: radar.samples }
    }

    /// Up to `most` places whose power exceeds `least`, strongest first, none of which may be a side lobe of a stronger one.
    /// `residual` is not windowed.
    /// Nothing is found in range bins of the array's centre that are `closed`.
    pub fn peaks(
        &self,
        radar: &Radar,
        residual: &[Complex64],
        least: f64,
        most: usize,
        closed: impl Fn(usize) -> bool,
    ) -> Vec<Candidate> {
        let magnitudes: [Vec<f32>; 2] = end_beams(radar, residual, self.beams)
            .map(|beams| beams.iter().map(|v| v.norm_sqr().sqrt() as f32).collect());
        let [first, last] = &self.grid.cells;
        let power = |i: usize| magnitudes[0][first[i] as usize] * magnitudes[1][last[i] as usize];
        let mut strong: Vec<(f32, u32)> =
            (0..first.len()).map(|i| (power(i), i as u32)).filter(|(p, _)| f64::from(*p) > least).collect();
        strong.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut found: Vec<Candidate> = Vec::new();
        for (power, i) in strong {
            let power = f64::from(power);
            let i = i as usize;
            if closed(i / self.columns) {
                continue;
            }
            let rows = [first, last].map(|cells| (cells[i] as usize % self.bins) as i32);
            if found.iter().all(|f| power > f.power * self.side_lobe(f.rows, rows)) {
                let [x_metres, y_metres] = self.grid.places_metres[i];
                found.push(Candidate { x_metres, y_metres, power, rows });
                if found.len() == most {
                    break;
                }
            }
        }
        found
    }

    /// Power that a reflector may show in other range bins, against its own.
    fn side_lobe(&self, own: [i32; 2], other: [i32; 2]) -> f64 {
        let lobe = |end: usize| {
            let apart = (own[end] - other[end]).rem_euclid(self.bins as i32);
            let apart = apart.min(self.bins as i32 - apart);
            // Magnitude of the Hann window's side lobes, and some margin.
            if apart <= ALONE_BINS { f64::INFINITY } else { 4.0 / f64::from(apart - 1).powi(3) }
        };
        lobe(0) * lobe(1)
    }
}
