//! Self-calibration: gains of the ends' elements, estimated together with the objects.
//!
//! Elements with errors of some tenths of a decibel and some degrees cause a residual that no object explains. The search is given a high noise level
//! first, so that it finds the strongest objects alone, and each element's gain is fitted to them by least squares. The level is lowered in steps. The
//! gains are accepted where they remove nearly all of the residual.

use super::element_gains::ElementGains;
use super::explained::NOISE_MARGIN;
use super::finish::Found;
use super::rungs::MAX_ROUND_RESIDUAL_PART;
use super::settings::Settings;
use super::state::NEARLY_COMPLETE_RESIDUAL_PART;
use super::trace::{CALIBRATION, MAX_ATTEMPTS, decades};
use crate::radar::{Radar, hann};
use crate::reconstruct::attempt::{Attempt, AttemptVerdict};
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Limits, Samples, Tie};
use crate::reconstruct::noise_model::range_energy;
use crate::reconstruct::{NoisePrior, ReconstructError, Request};
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Noise levels that the search is given, as parts of the samples' power. From the second on an offset and a slope of phase are subtracted from each
/// end's gains: while places are inexact, both are a shift of all objects.
const NOISE_LEVELS: [f64; 5] = [1.0, 1e-1, 1e-2, 1e-3, 1e-4];

/// Divisor of a search's budget for a level: only a scene of a few objects is calibrated.
const LEVEL_WORK_DIVISOR: usize = 4;

/// Alternating fits of the objects' gains and the elements' in a level.
const LEVEL_TURNS: usize = 6;

/// Largest residual of a level, as a part of the samples' energy.
const MAX_LEVEL_ENERGY_RATIO: f64 = 0.3;

/// Largest residual of inexact places over the rounding floor, as a part of the samples' energy. A larger one contains an echo.
pub const MAX_ROUNDING_RESIDUAL_PART: f64 = 1e-6;

/// Minimum gain of the objects that the elements' gains are fitted to, over the largest, as a ratio.
const MIN_GAIN_RATIO: f64 = 0.03;

/// Ridge on objects' gains ([`Limits::ridge`]).
const OBJECT_RIDGE: f64 = 1e-4;

/// Prior mean square of an element's error: 0.8 dB and 6 degrees.
const EXPECTED_SQUARED_ERROR: f64 = 0.02;

/// Largest root mean square of the gains' differences from 1 that are tolerances of elements.
const MAX_DEVIATION: f64 = 0.3;

/// Largest residual of calibrated objects over white noise, as a part of the samples' energy.
const MAX_ENERGY_RATIO: f64 = 1e-2;

/// Largest residual energy with gains of the elements, over that without them.
const MAX_PLAIN_RATIO: f64 = 0.1;

/// Whether the residual of `plain` is larger than that of equal elements.
pub(super) fn asks_for_gains(plain: &Found) -> bool {
    !plain.is_complete && !plain.atoms.is_empty() && plain.drawn_residual_part() > NEARLY_COMPLETE_RESIDUAL_PART
}

/// The objects in samples of equal elements, from those of a previous answer if there is one.
pub type SearchFn<'a> = &'a dyn Fn(Option<&Found>, &TwoEnds, &Request, &Settings) -> Result<Found, ReconstructError>;

/// The input of an estimate of the elements' gains.
pub(super) struct Calibration<'a> {
    pub search: SearchFn<'a>,
    pub radar: &'a Radar,
    /// Samples of a peak between 1 and 2.
    pub ends: &'a TwoEnds,
    pub request: &'a Request,
    pub settings: &'a Settings,
    /// The answer without gains.
    pub plain: &'a Found,
}

/// Gains of the elements, and the objects in samples without them.
struct Fitted {
    gains: ElementGains,
    fit: Fit,
    /// Residual, as a part of the samples' energy.
    residual_part: f64,
}

impl Calibration<'_> {
    /// The objects with gains of the elements; `None` unless these explain most of the residual.
    pub fn found(&self) -> Result<Option<Found>, ReconstructError> {
        let Some(Fitted { gains, fit, residual_part }) = self.fitted()? else { return Ok(None) };
        tracing::debug!(residual_part, deviation = gains.deviation(), "gains");
        if gains.deviation() > MAX_DEVIATION {
            return Ok(None);
        }
        let request = match self.request.noise.is_white() {
            true => self.request.clone(),
            false if residual_part > MAX_ROUNDING_RESIDUAL_PART => return Ok(None),
            false => self.over_noise(NOISE_MARGIN * residual_part),
        };
        let start = Found { is_complete: true, atoms: fit.atoms, gains: fit.gains, ..self.plain.clone() };
        let found = (self.search)(Some(&start), &gains.taken_from(self.ends), &request, self.settings)?;
        let (after, before) = (found.drawn_residual_part(), self.plain.drawn_residual_part());
        tracing::debug!(after, before, deviation = gains.deviation(), is_complete = found.is_complete, "calibrated");
        let is_certain = found.is_complete || self.request.noise.is_white();
        if !is_certain || after >= MAX_ENERGY_RATIO.min(MAX_PLAIN_RATIO * before) {
            return Ok(None);
        }
        let attempt = Attempt {
            rung: CALIBRATION,
            tried: gains.tried(),
            gain_decades: decades(before, after),
            verdict: AttemptVerdict::Kept,
            work: 0,
        };
        let trace = std::iter::once(attempt).chain(found.trace).take(MAX_ATTEMPTS).collect();
        Ok(Some(Found { element_gains: Some(gains), trace, ..found }))
    }

    /// The request over white noise whose power is `part` of the samples'.
    fn over_noise(&self, part: f64) -> Request {
        let sigma = Some((part * self.plain.sample_power).sqrt());
        Request { noise: NoisePrior::White { sigma }, ..self.request.clone() }
    }

    /// Gains of the elements after all levels; `None` where the residual of a level is much larger than its noise.
    fn fitted(&self) -> Result<Option<Fitted>, ReconstructError> {
        let &Calibration { radar, ends, request, plain, .. } = self;
        let window = hann(radar.samples);
        let fitter = Fitter::new(radar, &window, &request.task, usize::MAX).with_channels_of(&ends.flat());
        let quick = Settings { max_work: self.settings.max_work / LEVEL_WORK_DIVISOR, ..*self.settings };
        let noise = if request.noise.is_white() { plain.noise_variance / plain.sample_power } else { 0.0 };
        let mut gains = ElementGains::ones(radar);
        let mut last = None;
        for level in NOISE_LEVELS.iter().filter(|level| **level > noise) {
            let found = (self.search)(None, &gains.taken_from(ends), &self.over_noise(*level), &quick)?;
            let atoms = strongest(&found);
            if atoms.is_empty() {
                return Ok(None);
            }
            for _ in 0..LEVEL_TURNS {
                let turned = turned(radar, &fitter, ends, &atoms, &gains, false);
                gains = turned.gains.clone().normalised(*level >= NOISE_LEVELS[1]);
                last = Some(turned);
            }
            let max_part = MAX_LEVEL_ENERGY_RATIO.min(NOISE_MARGIN * level) + noise;
            if last.as_ref().is_some_and(|last| last.residual_part > max_part) {
                return Ok(None);
            }
        }
        let Some(mut last) = last else { return Ok(None) };
        loop {
            request.task.check()?;
            let before = last.residual_part;
            last = turned(radar, &fitter, ends, &last.fit.atoms, &last.gains.normalised(false), true);
            // False where the residual is no number.
            let is_progress = last.residual_part < MAX_ROUND_RESIDUAL_PART * before;
            if !is_progress {
                return Ok(Some(Fitted { gains: last.gains.normalised(false), ..last }));
            }
        }
    }
}

/// The objects of `found` with gains of at least [`MIN_GAIN_RATIO`].
fn strongest(found: &Found) -> Vec<Atom> {
    let gain = |gains: &[Complex64; 2]| gains[0].norm().max(gains[1].norm());
    let max_gain = found.gains.iter().map(gain).fold(0.0, f64::max);
    let is_strong = |gains: &[Complex64; 2]| gain(gains) >= MIN_GAIN_RATIO * max_gain;
    found.atoms.iter().zip(&found.gains).filter(|(_, gains)| is_strong(gains)).map(|(atom, _)| *atom).collect()
}

/// One alternating fit: first of the gains of `atoms`, and with `moves` of their places, to samples without `gains`; then of the elements' gains.
fn turned(radar: &Radar, fitter: &Fitter, ends: &TwoEnds, atoms: &[Atom], gains: &ElementGains, moves: bool) -> Fitted {
    let corrected = gains.taken_from(ends).flat();
    let samples = Samples::new(&fitter.sensor, &corrected);
    let fit = match moves {
        false => fitter.solve(&samples, atoms.to_vec(), Tie::Both, OBJECT_RIDGE),
        true => {
            fitter.refine(&samples, atoms.to_vec(), vec![Gains::default(); atoms.len()], Tie::Both, Limits::ROUGH_FIT)
        }
    };
    let residual = fit.residual.flat(&fitter.sensor);
    let drawn: Vec<Complex64> = corrected.iter().zip(&residual).map(|(c, r)| c - r).collect();
    let ridge = fit.cost() / gains.0.len() as f64 / independent_bins(radar, &residual) / EXPECTED_SQUARED_ERROR;
    let raw = ends.flat();
    let of_element = |(raw, drawn): (&[Complex64], &[Complex64])| {
        let weighted = raw.iter().zip(drawn).zip(&fitter.squared);
        let (product, power) = weighted.fold((Complex64::ZERO, 0.0), |(product, power), ((d, m), w)| {
            (product + m.conj() * d * w, power + m.norm_sqr() * w)
        });
        let gain = (product + ridge) / (power + ridge).max(f64::MIN_POSITIVE);
        if gain.norm_sqr() > 0.0 { gain } else { Complex64::ONE }
    };
    let gains = raw.chunks(radar.samples).zip(drawn.chunks(radar.samples)).map(of_element).collect();
    let all = fitter.energy(&samples);
    Fitted { gains: ElementGains(gains), residual_part: fit.cost() / all.max(f64::MIN_POSITIVE), fit }
}

/// Effective number of range bins of a residual's energy, the mean of both ends: the square of the sum over the sum of the squares.
fn independent_bins(radar: &Radar, residual: &[Complex64]) -> f64 {
    let ends = TwoEnds::of_flat(radar, residual);
    let energy: Vec<f64> = [&ends.first, &ends.last].iter().flat_map(|end| range_energy(radar, end.view())).collect();
    let [sum, square] = energy.iter().fold([0.0; 2], |[sum, square], e| [sum + e, square + e * e]);
    if square > 0.0 { sum * sum / square / 2.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Decibels, Tolerances};
    use crate::reconstruct::search::find;
    use crate::scene::{GaussianCluster, Object, Scene};
    use crate::signal::{Floor, simulate, simulate_built};

    #[test]
    fn gains_of_elements_that_are_off_are_found_with_the_points() {
        let radar = Radar::default();
        let scene = Scene::of_points([(3.0, 11.0), (-9.0, 20.0), (6.0, 25.0), (-2.0, 7.0)]);
        let array = Tolerances { gain: Decibels(0.3), phase_degrees: 3.0, position_millimetres: 0.0 }.build(&radar, 5);
        let ends = simulate_built(&radar, &scene, &array, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let found = find(&radar, &ends, &Request::default(), &Settings::default()).unwrap();
        let gains = found.element_gains.as_ref().expect("gains");
        assert!((0.02..0.09).contains(&gains.deviation()), "{}", gains.deviation());
        assert_eq!(found.atoms.len(), 4);
        assert!(found.drawn_residual_part() < 1e-4, "{}", found.drawn_residual_part());
    }

    #[test]
    fn elements_that_are_alike_have_no_gains() {
        let radar = Radar::default();
        let cloud = GaussianCluster { seed: 1, ..GaussianCluster::new([2.0, 15.0], [3.0, 3.0], 150) };
        let scene = Scene { objects: vec![Object::Gaussian(cloud)], ..Scene::default() };
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let found = find(&radar, &ends, &Request::default(), &Settings::default()).unwrap();
        assert!(!found.is_complete && found.element_gains.is_none());
    }
}
