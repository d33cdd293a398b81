//! The linear model of one place: steering vectors of both ends together, and the powers that explain what was heard.

use super::ends::Ends;
use super::linear::{Steering, explained};
use super::places::Place;
use super::sectors::Sectors;
use crate::radar::Radar;
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::profiles::range_response;
use crate::task::Task;
use num_complex::Complex64;

/// Plane waves that one end alone hears, for each of its beam widths.
const BEAMS_PER_WIDTH: f64 = 2.0;

/// Beam widths around the sector from which no such waves are taken: both ends' own vectors account for them.
const CLEAR_WIDTHS: f64 = 0.2;

/// What both ends heard from a place, and the vectors that may explain it.
pub(super) struct Model {
    steering: Steering,
    /// What each element heard.
    heard: Vec<Complex64>,
    /// Squared norms of the vectors: first those of the sector's directions, then of one end's plane waves.
    squares: Vec<f64>,
    /// Power of the noise in an element.
    noise: f64,
}

/// What one steering vector has to do with the samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    /// Power so far.
    pub power: f64,
    /// `|a^H R^-1 z|^2` of the vector a, the covariance R of all powers and noise, and the samples z.
    pub matched: f64,
    /// `a^H R^-1 a`.
    pub held: f64,
}

/// How powers are found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Update {
    /// The next power of a vector.
    pub next: fn(Share) -> f64,
    /// How often all powers are updated.
    pub iterations: usize,
    /// Least noise that is reckoned with, as a part of the mean power heard: what steering vectors leave of a real echo.
    pub least_noise: f64,
}

impl Model {
    /// The model of `place`; `noise_power` is that of one element's profile.
    pub fn new(radar: &Radar, ends: &Ends, sectors: &Sectors, place: &Place, noise_power: f64) -> Self {
        let (range, middle) = (place.range_metres, place.sector.middle_cos);
        let own: Vec<f64> = ends.distances_metres(range, middle).collect();
        // Amplitudes fall with the square of the distance: as if all elements stood equally far.
        let nearer: Vec<f64> = own.iter().map(|distance| (distance / range).powi(2)).collect();
        let heard: Vec<Complex64> = ends.heard_from(range, middle).zip(&nearer).map(|(h, n)| h * n).collect();
        let noise = noise_power * nearer.iter().map(|n| n * n).sum::<f64>() / nearer.len() as f64;
        let resolution = radar.range_resolution_metres();
        let mut vectors: Vec<Vec<Complex64>> = sectors
            .steps_cos
            .iter()
            .map(|step| {
                let further =
                    ends.distances_metres(range, (middle + step).clamp(-1.0, 1.0)).zip(&own).map(|(d, own)| d - own);
                let response = |metres: f64| if radar.samples == 1 { 1.0 } else { range_response(metres / resolution) };
                further.map(|metres| ends.profiles.phase(metres) * response(metres)).collect()
            })
            .collect();
        if sectors.all.len() > 1 {
            vectors.extend(one_end_waves(radar, ends, place));
        }
        let squares = vectors.iter().map(|v| v.iter().map(Complex64::norm_sqr).sum()).collect();
        let steering = Steering::new(ends.len(), vectors.len(), |n, k| vectors[k][n]);
        Model { steering, heard, squares, noise }
    }

    /// Powers of all vectors, the sector's directions first, by `update` from those of the matched filter.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn powers(&self, update: &Update, task: &Task) -> Result<Vec<f64>, ReconstructError> {
        let mean = self.heard.iter().map(Complex64::norm_sqr).sum::<f64>() / self.heard.len() as f64;
        let noise = self.noise.max(mean * update.least_noise);
        let count = self.squares.len();
        // Without any power the covariance is the noise alone: the matched filter.
        let Some(start) = explained(&self.steering, &vec![0.0; count], noise, &self.heard) else {
            return Ok(vec![0.0; count]);
        };
        let mut powers: Vec<f64> = (0..count).map(|k| start.matched[k] * (noise / self.squares[k]).powi(2)).collect();
        for _ in 0..update.iterations {
            task.check()?;
            let Some(now) = explained(&self.steering, &powers, noise, &self.heard) else { break };
            for (k, power) in powers.iter_mut().enumerate() {
                let next = (update.next)(Share { power: *power, matched: now.matched[k], held: now.held[k] });
                *power = if next.is_finite() { next } else { 0.0 };
            }
        }
        Ok(powers)
    }
}

/// Plane waves from beside the sector that only one end hears at the place's range.
fn one_end_waves(radar: &Radar, ends: &Ends, place: &Place) -> Vec<Vec<Complex64>> {
    let turns_per_metre = radar.carrier.turns_per_wavelength().abs() / radar.wavelength_metres();
    let width_cos = 1.0 / (turns_per_metre * radar.end_elements as f64 * radar.element_spacing_metres);
    let clear_cos = place.sector.half_width_cos + CLEAR_WIDTHS * width_cos;
    let count = (2.0 * BEAMS_PER_WIDTH / width_cos).ceil() as usize;
    let cosines = (0..count).map(|i| (2 * i + 1) as f64 / count as f64 - 1.0);
    let beside = cosines.map(|cos| cos - place.sector.middle_cos).filter(|step| step.abs() > clear_cos);
    let wave = |step: f64, first: bool| {
        let value = |(n, x): (usize, &f64)| {
            if (n < ends.first_count) == first { ends.profiles.phase(-x * step) } else { Complex64::default() }
        };
        ends.x_metres.iter().enumerate().map(value).collect::<Vec<_>>()
    };
    beside.flat_map(|step| [wave(step, true), wave(step, false)]).collect()
}
