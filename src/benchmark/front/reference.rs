//! The reference of a front's rows: the judge's range profiles and the exact path's maps.

use super::{LambdaError, MapConvention};
use crate::engine::EngineFrame;
use crate::maps::{Aperture, LogMaps, RangeAngleMap, channels_range_transform};
use crate::radar::{End, Radar};
use crate::scene::Reflector;
use crate::signal::plan::BEST_TOLERANCE;
use crate::signal::{BeatSignal, SynthesisPlan, beat_signal, exact, floor, judge};
use ndarray::{Array2, ArrayView2};
use num_complex::Complex64;
use rayon::prelude::*;

/// Elements whose range profiles are compared with the judge's, spread over the array.
const JUDGED_ELEMENTS: usize = 4;
const APERTURES: [Aperture; 3] = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
/// Seed of the floor's noise in every measurement.
pub(in crate::benchmark) const SEED: u64 = 0;

/// Most reflectors for reference maps by the exact path: beyond, it takes too long, and f64's phasor split, the same to the last bits, gives them.
const MAX_EXACT_REFLECTORS: usize = 300;

pub(in crate::benchmark) struct Reference {
    pub reflectors: Vec<Reflector>,
    profiles: JudgedProfiles,
    /// The exact path's maps, one triple for each of [`MapConvention::BOTH`].
    maps: [[RangeAngleMap; 3]; 2],
    pub noise: UnitNoise,
}

impl Reference {
    pub fn new(radar: &Radar, reflectors: Vec<Reflector>) -> Self {
        let signal = match reflectors.len() {
            0..=MAX_EXACT_REFLECTORS => exact::beat_signal(radar, &reflectors),
            many => {
                let amplitude = crate::signal::plan::amplitude_bound(radar, &reflectors);
                beat_signal(radar, &reflectors, &SynthesisPlan::cheapest(many, amplitude, BEST_TOLERANCE))
            }
        };
        let noise = UnitNoise::new(radar);
        let maps = MapConvention::BOTH.map(|convention| noise.plain_maps(radar, &reflectors, &signal, convention));
        Reference { profiles: JudgedProfiles::new(radar, &reflectors), maps, noise, reflectors }
    }

    /// Largest error of range profiles given by `profile` for an element, relative to the largest judged cell.
    pub fn signal_error(&self, radar: &Radar, profile: impl Fn(usize) -> Option<Vec<Complex64>>) -> f64 {
        self.profiles.error(radar, profile, self.profiles.peak())
    }

    pub fn lambda_error(&self, convention: MapConvention, maps: [&RangeAngleMap; 3]) -> LambdaError {
        let [fixed_range, thesis] = &self.maps;
        let expected = if convention == MapConvention::THESIS { thesis } else { fixed_range };
        difference(convention, maps, expected.each_ref())
    }
}

/// Range profiles of a few elements, of the judge's samples.
pub(in crate::benchmark) struct JudgedProfiles {
    /// `[judged elements, range bins]`.
    profiles: Array2<Complex64>,
}

impl JudgedProfiles {
    pub fn new(radar: &Radar, reflectors: &[Reflector]) -> Self {
        let elements: Vec<usize> = elements(radar).collect();
        let signals: Vec<_> = elements.par_iter().map(|n| judge::element_signal(radar, reflectors, *n)).collect();
        let judged = Array2::from_shape_fn((JUDGED_ELEMENTS, radar.samples), |(i, n1)| signals[i][n1]);
        JudgedProfiles { profiles: channels_range_transform(radar, judged.view()).profiles }
    }

    pub fn peak(&self) -> f64 {
        self.profiles.iter().fold(0.0, |m: f64, v| m.max(v.norm()))
    }

    /// Largest error of range profiles given by `profile` for an element, in units of `scale`; infinite where it gives none or NaN.
    pub fn error(&self, radar: &Radar, profile: impl Fn(usize) -> Option<Vec<Complex64>>, scale: f64) -> f64 {
        let mut worst = 0.0f64;
        for (element, judged) in elements(radar).zip(self.profiles.outer_iter()) {
            let found = profile(element).unwrap_or_default();
            for (bin, judged) in judged.iter().enumerate() {
                let error = found.get(bin).map_or(f64::INFINITY, |v| (v - judged).norm());
                worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
            }
        }
        if worst == 0.0 { 0.0 } else { worst / scale }
    }
}

pub(in crate::benchmark) fn difference(
    convention: MapConvention,
    a: [&RangeAngleMap; 3],
    b: [&RangeAngleMap; 3],
) -> LambdaError {
    let differences =
        a.into_iter().zip(b).flat_map(|(a, b)| a.lambda.iter().zip(&b.lambda).map(|(a, b)| f64::from(a - b).abs()));
    let (max, sum, count) = differences.fold((0.0f64, 0.0, 0u32), |(m, s, n), d| (m.max(d), s + d * d, n + 1));
    LambdaError { convention, max, rms: (sum / f64::from(count.max(1))).sqrt() }
}

fn elements(radar: &Radar) -> impl Iterator<Item = usize> {
    let last = radar.elements.saturating_sub(1);
    (0..JUDGED_ELEMENTS).map(move |i| i * last / (JUDGED_ELEMENTS - 1))
}

/// White noise of unit variance, made once: making it takes longer than most maps, and every floor is a multiple of it.
pub(in crate::benchmark) struct UnitNoise {
    /// `[elements, samples]`.
    samples: Array2<Complex64>,
}

impl UnitNoise {
    pub fn new(radar: &Radar) -> Self {
        let mut silence = BeatSignal::silence(radar);
        floor::add_noise(&mut silence, &vec![1.0; radar.elements], SEED);
        UnitNoise { samples: silence.samples }
    }

    /// Maps of a noiseless `signal` over the floor of `convention`, by the plain transforms in f64.
    pub fn plain_maps(
        &self,
        radar: &Radar,
        reflectors: &[Reflector],
        signal: &BeatSignal,
        convention: MapConvention,
    ) -> [RangeAngleMap; 3] {
        let maps = match floor::noise_variance(radar, reflectors, convention.floor) {
            None => LogMaps::of_signal(radar, signal),
            Some(variance) => {
                let mut samples = signal.samples.clone();
                let rows = samples.outer_iter_mut().into_par_iter().zip(self.samples.outer_iter()).zip(&variance);
                rows.for_each(|((mut row, noise), variance)| row.scaled_add(variance.sqrt().into(), &noise));
                LogMaps::of_signal(radar, &BeatSignal { samples })
            }
        };
        [&maps.first, &maps.last, &maps.full].map(|m| m.normalise(convention.normalisation))
    }
}

pub(in crate::benchmark) fn profile(
    radar: &Radar,
    samples: ArrayView2<'_, Complex64>,
    element: usize,
) -> Option<Vec<Complex64>> {
    let row = samples.slice(ndarray::s![element..element + 1, ..]);
    Some(channels_range_transform(radar, row).profiles.into_iter().collect())
}

pub(in crate::benchmark) fn maps_of(frame: &EngineFrame) -> Option<[&RangeAngleMap; 3]> {
    let [a, b, c] = APERTURES.map(|a| frame.map(a).map(|m| m.lambda.as_ref()));
    Some([a?, b?, c?])
}
