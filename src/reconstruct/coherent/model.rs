//! The linear model of a place: steering vectors of both ends together, and their powers.

use super::ends::{Ends, distances_metres};
use super::linear::{Lane, Steering, W, whitened};
use super::places::Place;
use super::sectors::Sectors;
use crate::radar::{Pair, Radar};
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::profiles::range_response_near;
use crate::signal::path::PairBlocks;
use crate::signal::simd::{Kernel, Lanes, Simd};
use crate::task::Task;
use num_complex::Complex64;

/// Number of plane waves at one end alone in each of its beam widths.
const WAVES_PER_BEAM_WIDTH: f64 = 2.0;

/// Beam widths beside the sector without such waves: its steering vectors are similar there.
const GUARD_BEAM_WIDTHS: f64 = 0.2;

/// Largest change of a power over the largest power at which the iteration ends.
const MAX_CONVERGED_CHANGE: f32 = 1e-3;

/// Power, as a part of the samples' mean, below which it is set to 0: denormal numbers are slow.
const MIN_POWER: f32 = 1e-20;

/// The range profiles of both ends at a place, and their steering vectors.
pub(super) struct Model {
    /// First the sector's directions, then plane waves at one end alone, 0 at the other. The padding is 0.
    steering: Steering,
    /// The profile of each element at the place.
    snapshot: Vec<Complex64>,
    directions: usize,
    /// Mean power of the noise of an element.
    noise: f64,
}

/// Figures of one steering vector, in units of the mean power of the profiles.
#[derive(Debug, Clone, Copy)]
pub(super) struct VectorFigures {
    pub power: f32,
    /// `|a^H R^-1 z|^2` of the vector a, the covariance R of all powers and noise, and the profiles z.
    pub matched: f32,
    /// `a^H R^-1 a`.
    pub norm: f32,
}

/// The iteration of a method.
#[derive(Debug, Clone, Copy)]
pub(super) struct Update {
    /// The next power of a vector.
    pub next: fn(VectorFigures) -> f32,
    /// Largest number of updates of all powers.
    pub max_iterations: usize,
    /// Least noise of the model, as a part of the mean power of the profiles: steering vectors have errors.
    pub min_noise: f64,
}

impl Model {
    /// The model of `place`; `noise_power` is that of one element's profile.
    pub fn new(radar: &Radar, ends: &Ends, sectors: &Sectors, place: &Place, noise_power: f64) -> Self {
        Simd::chosen().run(Make { radar, ends, sectors, place, noise_power })
    }

    /// Powers of the sector's directions, iterated by `update` from those of the matched filter.
    pub fn powers(&self, update: &Update, task: &Task) -> Result<Vec<f64>, ReconstructError> {
        let mean = self.snapshot.iter().map(Complex64::norm_sqr).sum::<f64>() / self.snapshot.len() as f64;
        let noise = (self.noise / mean).max(update.min_noise);
        let scale = 1.0 / mean.sqrt();
        if !scale.is_finite() {
            return Ok(vec![0.0; self.directions]);
        }
        let snapshot: Vec<Complex64> = self.snapshot.iter().map(|h| h * scale).collect();
        let mut powers = vec![0.0; self.steering.vectors()];
        // The covariance of noise alone gives the powers of the matched filter.
        if let Some(start) = whitened(&self.steering, &powers, noise, &snapshot) {
            for ((power, matched), norm) in powers.iter_mut().zip(start.matched).zip(start.norm) {
                *power = if norm > 0.0 { matched / (norm * norm) } else { 0.0 };
            }
        }
        for _ in 0..update.max_iterations {
            task.check()?;
            let Some(now) = whitened(&self.steering, &powers, noise, &snapshot) else { break };
            let (mut change, mut largest) = (0.0f32, 0.0f32);
            for ((power, matched), norm) in powers.iter_mut().zip(now.matched).zip(now.norm) {
                let next = (update.next)(VectorFigures { power: *power, matched, norm });
                let next = if next.is_finite() && next > MIN_POWER { next } else { 0.0 };
                change = change.max((next - *power).abs());
                largest = largest.max(next);
                *power = next;
            }
            if change <= MAX_CONVERGED_CHANGE * largest {
                break;
            }
        }
        Ok(powers[..self.directions].iter().map(|p| f64::from(*p) * mean).collect())
    }
}

struct Make<'a> {
    radar: &'a Radar,
    ends: &'a Ends,
    sectors: &'a Sectors,
    place: &'a Place,
    noise_power: f64,
}

impl Kernel for Make<'_> {
    type Output = Model;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Model {
        let Make { ends, place, .. } = self;
        let range = place.range_metres;
        let middle = Lanes([place.sector.middle_cos]);
        let own = |pair: &Pair| distances_metres(PairBlocks::from(*pair), range, middle).0[0];
        let own: Vec<f64> = ends.pairs.iter().map(own).collect();
        let mut snapshot = vec![Complex64::default(); ends.len()];
        ends.fill_snapshot::<FMA>(range, place.sector.middle_cos, &mut snapshot);
        let mut noise = 0.0;
        for (snapshot, own) in snapshot.iter_mut().zip(&own) {
            // Amplitudes, which fall with the square of the distance, are scaled to the same distance.
            let nearer = (own / range).powi(2);
            *snapshot *= nearer;
            noise += self.noise_power * nearer * nearer / ends.len() as f64;
        }
        let directions = self.sectors.steps_cos.len();
        let waves = if self.sectors.all.len() > 1 { waves_outside(self.radar, place) } else { Vec::new() };
        let (own_lanes, wave_lanes) = (directions.div_ceil(W), waves.len().div_ceil(W));
        let mut steering = Steering::zero(ends.len(), own_lanes + 2 * wave_lanes);
        for (lane, steps) in self.sectors.steps_cos.chunks(W).enumerate() {
            self.add_directions::<FMA>(steps, &own, lane, &mut steering);
        }
        for (lane, steps) in waves.chunks(W).enumerate() {
            let turns: Lanes<f64, W> = Lanes(std::array::from_fn(|i| steps.get(i).copied().unwrap_or(0.0)));
            for (n, x) in ends.x_metres.iter().enumerate() {
                let wave = ends.profiles.phases::<f32, W, FMA>(turns * Lanes::splat(-x));
                let end = if n < ends.first_count { 0 } else { wave_lanes };
                *steering.lane_mut(n, own_lanes + end + lane) = only(wave, |i| i < steps.len());
            }
        }
        Model { steering, snapshot, directions, noise }
    }
}

impl Make<'_> {
    /// Adds the vectors of directions that are `steps` off the sector's middle; `own` are the elements' distances from that middle.
    #[inline(always)]
    fn add_directions<const FMA: bool>(&self, steps: &[f64], own: &[f64], lane: usize, steering: &mut Steering) {
        let Make { radar, ends, place, .. } = self;
        let middle = place.sector.middle_cos;
        let cosines: Lanes<f64, W> = Lanes(std::array::from_fn(|i| middle + steps.get(i).unwrap_or(&0.0)));
        let exists = |i: usize| i < steps.len() && cosines.0[i].abs() <= 1.0;
        let inside = cosines.map(|cos| cos.clamp(-1.0, 1.0));
        let per_bin = if radar.samples == 1 { 0.0 } else { 1.0 / radar.range_resolution_metres() };
        for (n, (pair, own)) in ends.pairs.iter().zip(own).enumerate() {
            let distances = distances_metres(PairBlocks::<W>::new(|_| *pair), place.range_metres, inside);
            let further = distances - Lanes::splat(*own);
            let response = range_response_near::<W, FMA>(further * Lanes::splat(per_bin)).round_to();
            let wave = ends.profiles.phases::<f32, W, FMA>(further).scaled(response);
            *steering.lane_mut(n, lane) = only(wave, exists);
        }
    }
}

/// `wave` with zeros in the lanes that don't exist.
#[inline(always)]
fn only(mut wave: Lane, exists: impl Fn(usize) -> bool) -> Lane {
    for i in (0..W).filter(|i| !exists(*i)) {
        (wave.re.0[i], wave.im.0[i]) = (0.0, 0.0);
    }
    wave
}

/// Directions of plane waves at one end, relative to the sector's middle and outside of it, one for each set of phases at the elements.
fn waves_outside(radar: &Radar, place: &Place) -> Vec<f64> {
    let turns_per_metre = radar.carrier_turns_per_metre().abs();
    let period_cos = 1.0 / (turns_per_metre * radar.element_spacing_metres);
    let width_cos = period_cos / radar.end_elements as f64;
    let clear_cos = place.sector.half_width_cos + GUARD_BEAM_WIDTHS * width_cos;
    let reach_cos = period_cos.min(2.0);
    let count = (WAVES_PER_BEAM_WIDTH * reach_cos / width_cos).round() as usize;
    let cosines = (0..count).map(|i| reach_cos * ((i as f64 + 0.5) / count as f64 - 0.5));
    let step = |cos: f64| {
        let step = cos - place.sector.middle_cos;
        // For elements further apart than half a wavelength, directions a period apart have the same phases.
        if period_cos < 1.999 { step - (step / period_cos).round() * period_cos } else { step }
    };
    cosines.map(step).filter(|step| step.abs() > clear_cos).collect()
}
