//! Where a residual still holds reflectors: both ends' beams laid over each other on the polar grid of the array's centre.
//!
//! Magnitudes are multiplied, not amplitudes added: the phase between the ends changes with every column of the full map, and what stands in one end
//! alone is a ghost.

use super::end_beams::end_beams;
use super::registered::Registered;
use crate::radar::Radar;
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Beams formed by each end for each of its elements.
const BEAMS_PER_ELEMENT: usize = 4;

/// Columns of the common polar grid for each element of an end.
const COLUMNS_PER_ELEMENT: usize = 10;

/// One look at the residual finds no two places within this many range bins of each other: what the stronger leaves comes first.
const ALONE_BINS: usize = 8;

/// Fewest cells of the common grid that are worth a task of their own.
const LEAST_CELLS: usize = 4096;

/// A place where something stands out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Position along the array.
    pub x_metres: f64,
    /// Position ahead of the array, at least 0.
    pub y_metres: f64,
    /// Product of both ends' magnitudes: the power of one end's beam where both are alike.
    pub power: f64,
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
        closed: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Candidate> {
        let magnitudes: [Vec<f32>; 2] = end_beams(radar, residual, self.beams)
            .map(|beams| beams.into_par_iter().map(|v| v.norm_sqr().sqrt() as f32).collect());
        let [first, last] = &self.grid.cells;
        let power = |i: usize| magnitudes[0][first[i] as usize] * magnitudes[1][last[i] as usize];
        let is_open = |i: usize| !closed(i / self.columns);
        let cells = (0..first.len()).into_par_iter().with_min_len(LEAST_CELLS);
        let mut strong: Vec<(f32, usize)> =
            cells.map(|i| (power(i), i)).filter(|(p, i)| f64::from(*p) > least && is_open(*i)).collect();
        let mut found: Vec<Candidate> = Vec::new();
        let weaker = |a: &&(f32, usize), b: &&(f32, usize)| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1));
        while let Some(&(power, i)) = strong.iter().max_by(weaker) {
            let power = f64::from(power);
            let rows = [first, last].map(|cells| cells[i] as usize % self.bins);
            let [x_metres, y_metres] = self.grid.places_metres[i];
            found.push(Candidate { x_metres, y_metres, power });
            if found.len() == most {
                break;
            }
            let [near, far] = rows.map(|own| self.side_lobes(own));
            let lobe = |i: usize| near[first[i] as usize % self.bins] * far[last[i] as usize % self.bins];
            strong.retain(|(other, i)| f64::from(*other) > power * lobe(*i));
        }
        found
    }

    /// Amplitude that a reflector in range bin `own` may show in every other at one end, against its own there.
    fn side_lobes(&self, own: usize) -> Vec<f64> {
        let lobe = |other: usize| {
            let apart = own.abs_diff(other);
            let apart = apart.min(self.bins - apart);
            // Magnitude of the Hann window's side lobes, and some margin.
            if apart <= ALONE_BINS { f64::INFINITY } else { 4.0 / (apart as f64 - 1.0).powi(3) }
        };
        (0..self.bins).map(lobe).collect()
    }
}
