//! Gains of the ends' elements, estimated beside the objects: self-calibration.
//!
//! Elements that are off by some tenths of a decibel and some degrees leave a residual that no object explains. The search is told of loud noise
//! first, so that it finds the strongest objects alone; each element's gain is fitted to them by least squares, and the noise that the search is told
//! of falls, level by level. The gains are believed where they explain nearly all that was left without them.

use super::element_gains::ElementGains;
use super::finish::Found;
use super::rungs::MAX_ROUND_RESIDUAL_PART;
use super::settings::Settings;
use super::state::NEARLY_COMPLETE_RESIDUAL_PART;
use super::trace::{CALIBRATION, MAX_ATTEMPTS, decades};
use crate::radar::{Radar, hann};
use crate::reconstruct::attempt::{Attempt, Verdict};
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Limits, Samples, Tie};
use crate::reconstruct::hearing::range_energy;
use crate::reconstruct::{NoisePrior, ReconstructError, Request};
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Noise that the search is told of, as a part of the samples' power, level by level. After the first two an offset and a slope of phase are taken
/// from each end's gains: while places are rough, both are a place of all objects.
const NOISE_LEVELS: [f64; 5] = [1.0, 1e-1, 1e-2, 1e-3, 1e-4];

/// Part of a search's work that is granted to a level: what takes longer is no scene of a few objects.
const WORK_SHARE: usize = 4;

/// Turns of fitting the objects' gains and the elements' in a level.
const TURNS: usize = 6;

/// Maximum energy that a level leaves, as a part of the samples' energy.
const MAX_LEVEL_ENERGY_RATIO: f64 = 0.3;

/// Most turns of places, gains of objects and of elements after the last level.
const MAX_LAST_TURNS: usize = 30;

/// Maximum energy that calibrated objects leave over the rounding floor, as a part of the samples' energy. More than that is an echo.
const MAX_ROUNDING_ENERGY_RATIO: f64 = 1e-6;

/// Noise over what is left, as a ratio of powers: a level leaves at most that over the noise that its search was told of, and the last search is told of that
/// over what the gains leave.
const NOISE_MARGIN_RATIO: f64 = 3.0;

/// Least gain of an object that elements are fitted to, as a part of the strongest.
const MIN_GAIN_RATIO: f64 = 0.03;

/// Price of an object's gain, as a part of its echo's energy.
const OBJECT_RIDGE: f64 = 1e-4;

/// Mean square of an element's error before anything is known of it: 0.8 dB and 6 degrees.
const EXPECTED_SQUARE: f64 = 0.02;

/// Gains that differ more from 1 in the mean square's root are no tolerances.
const MAX_DEVIATION: f64 = 0.3;

/// Maximum energy that calibrated objects leave over noise, as a part of the samples' energy.
const MAX_ENERGY_RATIO: f64 = 1e-2;

/// Maximum residual energy with gains of the elements, relative to the residual energy without them.
const MAX_PLAIN_RATIO: f64 = 0.1;

/// Whether the residual of objects found in samples is larger than equal elements would leave.
pub(super) fn asks_for_gains(plain: &Found) -> bool {
    !plain.complete && !plain.atoms.is_empty() && plain.drawn_residual_part() > NEARLY_COMPLETE_RESIDUAL_PART
}

/// The objects in samples of equal elements, starting from those of an answer where there is one.
///
/// # Errors
/// [`ReconstructError::Cancelled`].
pub type SearchFn<'a> = &'a dyn Fn(Option<&Found>, &TwoEnds, &Request, &Settings) -> Result<Found, ReconstructError>;

/// The input of an estimate of the elements' gains.
pub(super) struct Calibration<'a> {
    /// Searches without gains.
    pub search: SearchFn<'a>,
    pub radar: &'a Radar,
    /// Samples of a peak between 1 and 2.
    pub ends: &'a TwoEnds,
    pub request: &'a Request,
    /// Limits of a search.
    pub settings: &'a Settings,
    /// The answer without gains.
    pub plain: &'a Found,
}

/// Gains of the elements, the objects in samples without them, and the remaining part of the samples' energy.
struct Fitted {
    gains: ElementGains,
    fit: Fit,
    left: f64,
}

impl Calibration<'_> {
    /// The objects with gains of the elements, where these explain most of the residual without them.
    ///
    /// # Errors
    /// [`ReconstructError::Cancelled`].
    pub fn found(&self) -> Result<Option<Found>, ReconstructError> {
        let Some(Fitted { gains, fit, left }) = self.fitted()? else { return Ok(None) };
        tracing::debug!(left, deviation = gains.deviation(), "gains");
        if gains.deviation() > MAX_DEVIATION {
            return Ok(None);
        }
        let told = match self.request.noise.is_white() {
            true => self.request.clone(),
            false if left > MAX_ROUNDING_ENERGY_RATIO => return Ok(None),
            false => self.over_noise(NOISE_MARGIN_RATIO * left),
        };
        let start = Found { complete: true, atoms: fit.atoms, gains: fit.gains, ..self.plain.clone() };
        let found = (self.search)(Some(&start), &gains.taken_from(self.ends), &told, self.settings)?;
        let (left, before) = (found.drawn_residual_part(), self.plain.drawn_residual_part());
        tracing::debug!(left, before, deviation = gains.deviation(), complete = found.complete, "calibrated");
        let is_certain = found.complete || self.request.noise.is_white();
        if !is_certain || left >= MAX_ENERGY_RATIO.min(MAX_PLAIN_RATIO * before) {
            return Ok(None);
        }
        let kept = Attempt {
            rung: CALIBRATION,
            tried: gains.tried(),
            gain_decades: decades(before, left),
            verdict: Verdict::Kept,
            work: 0,
        };
        let trace = std::iter::once(kept).chain(found.trace).take(MAX_ATTEMPTS).collect();
        Ok(Some(Found { element_gains: Some(gains), trace, ..found }))
    }

    fn over_noise(&self, part: f64) -> Request {
        let sigma = Some((part * self.plain.sample_power).sqrt());
        Request { noise: NoisePrior::White { sigma }, ..self.request.clone() }
    }

    /// Gains of the elements after all levels; `None` where a level leaves much more than its noise.
    fn fitted(&self) -> Result<Option<Fitted>, ReconstructError> {
        let &Calibration { radar, ends, request, plain, .. } = self;
        let window = hann(radar.samples);
        let fitter = Fitter::new(radar, &window, &request.task, usize::MAX).with_channels_of(&ends.flat());
        let quick = Settings { max_work: self.settings.max_work / WORK_SHARE, ..*self.settings };
        let noise = if request.noise.is_white() { plain.noise_variance / plain.sample_power } else { 0.0 };
        let mut gains = ElementGains::ones(radar);
        let mut last = None;
        for level in NOISE_LEVELS.iter().filter(|level| **level > noise) {
            let found = (self.search)(None, &gains.taken_from(ends), &self.over_noise(*level), &quick)?;
            let atoms = strongest(&found);
            if atoms.is_empty() {
                return Ok(None);
            }
            for _ in 0..TURNS {
                let turned = turned(radar, &fitter, ends, &atoms, &gains, false);
                gains = turned.gains.clone().normalised(*level >= NOISE_LEVELS[1]);
                last = Some(turned);
            }
            if last
                .as_ref()
                .is_some_and(|last| last.left > MAX_LEVEL_ENERGY_RATIO.min(NOISE_MARGIN_RATIO * level) + noise)
            {
                return Ok(None);
            }
        }
        let Some(mut last) = last else { return Ok(None) };
        for _ in 0..MAX_LAST_TURNS {
            request.task.check()?;
            let before = last.left;
            last = turned(radar, &fitter, ends, &last.fit.atoms, &last.gains.normalised(false), true);
            if last.left > MAX_ROUND_RESIDUAL_PART * before {
                break;
            }
        }
        Ok(Some(Fitted { gains: last.gains.normalised(false), ..last }))
    }
}

/// The objects of `found` whose gains are not much less than the strongest.
fn strongest(found: &Found) -> Vec<Atom> {
    let gain = |gains: &[Complex64; 2]| gains[0].norm().max(gains[1].norm());
    let most = found.gains.iter().map(gain).fold(0.0, f64::max);
    let is_strong = |gains: &[Complex64; 2]| gain(gains) >= MIN_GAIN_RATIO * most;
    found.atoms.iter().zip(&found.gains).filter(|(_, gains)| is_strong(gains)).map(|(atom, _)| *atom).collect()
}

/// The gains of elements that fit `atoms` best. The atoms' own gains, and with `moves` their places, are fitted to samples without `gains`.
fn turned(radar: &Radar, fitter: &Fitter, ends: &TwoEnds, atoms: &[Atom], gains: &ElementGains, moves: bool) -> Fitted {
    let corrected = gains.taken_from(ends).flat();
    let samples = Samples::new(&fitter.sensor, &corrected);
    let fit = match moves {
        false => fitter.solve(&samples, atoms.to_vec(), Tie::Both, OBJECT_RIDGE),
        true => fitter.refine(&samples, atoms.to_vec(), vec![Gains::default(); atoms.len()], Tie::Both, Limits::ROUGH),
    };
    let residual = fit.residual.flat(&fitter.sensor);
    let drawn: Vec<Complex64> = corrected.iter().zip(&residual).map(|(c, r)| c - r).collect();
    let price = fit.cost() / gains.0.len() as f64 / independent_bins(radar, &residual) / EXPECTED_SQUARE;
    let raw = ends.flat();
    let of_element = |(raw, drawn): (&[Complex64], &[Complex64])| {
        let weighted = raw.iter().zip(drawn).zip(&fitter.squared);
        let (product, power) = weighted.fold((Complex64::ZERO, 0.0), |(product, power), ((d, m), w)| {
            (product + m.conj() * d * w, power + m.norm_sqr() * w)
        });
        let gain = (product + price) / (power + price).max(f64::MIN_POSITIVE);
        if gain.norm_sqr() > 0.0 { gain } else { Complex64::ONE }
    };
    let gains = raw.chunks(radar.samples).zip(drawn.chunks(radar.samples)).map(of_element).collect();
    let all = fitter.energy(&samples);
    Fitted { gains: ElementGains(gains), left: fit.cost() / all.max(f64::MIN_POSITIVE), fit }
}

/// Range bins that a residual's energy is spread over: the square of the sum over the sum of the squares.
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
        assert!(!found.complete && found.element_gains.is_none());
    }
}
