//! What the rows of a front are measured against.

use super::{Convention, LambdaError};
use crate::live::Frame;
use crate::maps::{Aperture, LogMaps, RangeAngleMap, channels_range_transform};
use crate::radar::{End, Radar};
use crate::scene::Reflector;
use crate::signal::{BeatSignal, Floor, exact, floor, judge};
use ndarray::{Array2, ArrayView2};
use num_complex::Complex64;

/// Elements whose range profiles are compared with the judge's, spread over the array.
const JUDGED: usize = 4;
/// Apertures in the order of every triple of maps.
const APERTURES: [Aperture; 3] = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
/// Picks the floor's noise in every measurement.
pub(super) const SEED: u64 = 0;

/// The truth about one scene.
pub(super) struct Reference {
    /// The scene's reflectors.
    pub reflectors: Vec<Reflector>,
    /// Judged range profiles, `[judged elements, range bins]`.
    profiles: Array2<Complex64>,
    /// The exact path's maps, one triple for each of [`Convention::BOTH`].
    maps: [[RangeAngleMap; 3]; 2],
}

impl Reference {
    pub fn new(radar: &Radar, reflectors: Vec<Reflector>) -> Self {
        let judged = elements(radar).flat_map(|n| judge::element_signal(radar, &reflectors, n)).collect();
        let judged = Array2::from_shape_vec((JUDGED, radar.samples), judged);
        let judged = judged.unwrap_or_else(|_| unreachable!("the judge gives one value a sample"));
        let signal = exact::beat_signal(radar, &reflectors);
        let maps = Convention::BOTH.map(|convention| plain_maps(radar, &reflectors, &signal, convention));
        Reference { profiles: channels_range_transform(radar, judged.view()).profiles, maps, reflectors }
    }

    /// Largest error of range profiles given by `profile` for an element, relative to the largest judged cell.
    pub fn signal_error(&self, radar: &Radar, profile: impl Fn(usize) -> Option<Vec<Complex64>>) -> f64 {
        let (mut error, mut peak) = (0.0f64, f64::MIN_POSITIVE);
        for (element, judged) in elements(radar).zip(self.profiles.outer_iter()) {
            let found = profile(element).unwrap_or_default();
            for (bin, judged) in judged.iter().enumerate() {
                error = error.max((found.get(bin).copied().unwrap_or_default() - judged).norm());
                peak = peak.max(judged.norm());
            }
        }
        error / peak
    }

    /// Errors of three maps drawn by `convention`.
    pub fn lambda_error(&self, convention: Convention, maps: [&RangeAngleMap; 3]) -> LambdaError {
        let [fixed_range, thesis] = &self.maps;
        let expected = if convention == Convention::THESIS { thesis } else { fixed_range };
        let differences = maps
            .into_iter()
            .zip(expected)
            .flat_map(|(a, b)| a.lambda.iter().zip(&b.lambda).map(|(a, b)| f64::from(a - b).abs()));
        let (max, sum, count) = differences.fold((0.0f64, 0.0, 0u32), |(m, s, n), d| (m.max(d), s + d * d, n + 1));
        LambdaError { convention, max, rms: (sum / f64::from(count.max(1))).sqrt() }
    }
}

fn elements(radar: &Radar) -> impl Iterator<Item = usize> {
    let last = radar.elements.saturating_sub(1);
    (0..JUDGED).map(move |i| i * last / (JUDGED - 1))
}

/// Maps of a noiseless `signal` over the floor of `convention`, by the plain transforms in f64.
pub(super) fn plain_maps(
    radar: &Radar,
    reflectors: &[Reflector],
    signal: &BeatSignal,
    convention: Convention,
) -> [RangeAngleMap; 3] {
    let mut signal = signal.clone();
    match convention.floor {
        Floor::Exact => {}
        Floor::Thesis => floor::add_noise(&mut signal, &floor::thesis_noise_variance(radar, reflectors), SEED),
        Floor::Snr(snr) => floor::add_noise(&mut signal, &floor::snr_noise_variance(radar, reflectors, snr), SEED),
    }
    let maps = LogMaps::of_signal(radar, &signal);
    [&maps.first, &maps.last, &maps.full].map(|m| m.normalise(convention.normalisation))
}

/// Range profile of one channel's samples.
pub(super) fn profile(radar: &Radar, samples: ArrayView2<'_, Complex64>, element: usize) -> Option<Vec<Complex64>> {
    let row = samples.slice(ndarray::s![element..element + 1, ..]);
    Some(channels_range_transform(radar, row).profiles.into_iter().collect())
}

/// The three maps of a frame; `None` if one was not wanted.
pub(super) fn maps_of(frame: &Frame) -> Option<[&RangeAngleMap; 3]> {
    let [a, b, c] = APERTURES.map(|a| frame.map(a).map(|m| m.lambda.as_ref()));
    Some([a?, b?, c?])
}
