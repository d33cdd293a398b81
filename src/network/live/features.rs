//! The input of the live network: tensors from the samples of the two ends.
//!
//! Twelve elements resolve about twelve angles, so no feature has more than 256 columns. The rows are range bins, as many as a chirp has samples. The
//! polar grid of each end is centred on it. The ranges of a reflector differ by up to 27 bins between the two. So both ends are also *registered*:
//! interpolated on the polar grid around the array's centre. On the fine grid an end has its Capon spectrum, row by row. At low noise it separates
//! reflectors within the end's beam width.
//!
//! In columns and range bins the beams of an end are the same for every radar. The place of a reflector in the other end's grid depends on the radar's
//! constants. All features have a Hann window, whichever window the radar has.
//!
//! All tensors are relative to the mean power of the samples (the *gain*), so that they don't depend on the receiver's gain.

use super::capon::Capon;
use super::coarse::Coarse;
use super::constants::{constants, in_thesis_convention};
use super::floors::{measured_floor, rounding_floor};
use super::grid::{CONSTANTS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS, SCALARS};
use super::registration::Registration;
use crate::maps::windowed_range_transform;
use crate::radar::{End, Radar, hann};
use crate::reconstruct::{ReconstructError, check_ends};
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;

/// Least samples of a chirp whose features can be registered.
pub const MIN_CHIRP_SAMPLES: usize = 8;

/// The tensors of one scene, row-major.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveInput {
    /// `[4, samples, 256]`, decades: minimum and maximum of both ends' Capon spectra on the centre's grid, and their minimum on each end's grid.
    pub fine: Vec<f32>,
    /// `[10, samples, 64]`: log-magnitude of each end's beams, the same registered, for each end cosine and sine of the phase step
    /// from the row before, and cosine and sine of twice the phase between the registered ends.
    pub coarse: Vec<f32>,
    /// `[6, samples]`: for each end real and imaginary part of the mean phase step between elements, then each end's power in decades.
    pub rows: Vec<f32>,
    /// Two estimates of the noise floor in decades: from the rounding of the thesis' samples, and as measured.
    pub scalars: [f32; SCALARS],
    /// The radar's constants, all 0 for table 3.1: a quarter of the octaves of its migration in range bins from end to end, its spacing, a 1 for a
    /// Hamming, Blackman or rectangular window, and the loss by the elements' pattern at 60 degrees off broadside, decades.
    pub constants: [f32; CONSTANTS],
    /// Half the log10 of the samples' mean power: the reference of all decades.
    pub gain: f64,
}

/// Computes [`LiveInput`]s by tables of one radar.
#[derive(Debug)]
pub struct FeatureExtractor {
    radar: Radar,
    constants: [f32; CONSTANTS],
    window: Vec<f64>,
    /// Registrations of the fine grid: of each end on the centre's grid; of the last end on the first's, and of the first on the last's.
    fine_centre: [Registration<FINE_COLUMNS>; 2],
    fine_other: [Registration<FINE_COLUMNS>; 2],
    coarse: Coarse,
    capon: Capon,
}

impl FeatureExtractor {
    /// Tables for `radar`.
    /// # Errors
    /// [`ReconstructError::Unusable`] for ends of a single element or fewer than [`MIN_CHIRP_SAMPLES`] samples.
    pub fn new(radar: &Radar) -> Result<Self, ReconstructError> {
        if radar.end_elements < 2 || radar.samples < MIN_CHIRP_SAMPLES {
            let (elements, samples) = (radar.end_elements, radar.samples);
            let reason = format!(
                "its input needs ends of 2 elements or more and {MIN_CHIRP_SAMPLES} samples or more; this radar has {elements} and {samples}"
            );
            return Err(ReconstructError::Unusable { method: "live", reason });
        }
        let ends = End::BOTH.map(|end| radar.end_centre_metres(end));
        let table = |from: f64, to: f64| Registration::new(radar, from, to);
        Ok(FeatureExtractor {
            fine_centre: ends.map(|x| table(0.0, x)),
            fine_other: [table(ends[0], ends[1]), table(ends[1], ends[0])],
            coarse: Coarse::new(radar),
            capon: Capon::new(radar.end_elements),
            constants: constants(radar),
            window: hann(radar.samples),
            radar: radar.clone(),
        })
    }

    /// The radar of the tables.
    pub fn radar(&self) -> &Radar {
        &self.radar
    }

    /// The tensors of the samples of two ends.
    /// # Errors
    /// [`ReconstructError`] for samples of the wrong shape, non-finite samples, and zeros alone.
    pub fn extract(&self, ends: &TwoEnds) -> Result<LiveInput, ReconstructError> {
        check_ends(&self.radar, ends)?;
        let samples = (2 * self.radar.end_elements * self.radar.samples) as f64;
        let power = ends.first.iter().chain(&ends.last).map(|v| v.norm_sqr()).sum::<f64>() / samples;
        if power == 0.0 {
            return Err(ReconstructError::Unusable {
                method: "live",
                reason: "the samples are silent; put a reflector into the scene".into(),
            });
        }
        let scale = power.sqrt().recip();
        let ends = End::BOTH.map(|end| in_thesis_convention(&self.radar, ends.end(end).mapv(|v| v * scale)));
        let profiles: [Array2<Complex64>; 2] = ends
            .each_ref()
            .map(|e| windowed_range_transform(&self.radar, e.view(), &self.window).profiles.reversed_axes());

        let capon = profiles.each_ref().map(|p| self.capon.decades(p.view()));
        let mut fine = vec![0.0; FINE_CHANNELS * self.radar.samples * FINE_COLUMNS];
        self.fill_fine(&capon, &mut fine);
        Ok(LiveInput {
            fine,
            coarse: self.coarse.features(&profiles),
            rows: row_features(&profiles),
            constants: self.constants,
            scalars: [rounding_floor(&self.radar, &profiles), measured_floor(&self.radar, &ends)],
            gain: 0.5 * power.log10(),
        })
    }

    fn fill_fine(&self, capon: &[Vec<f32>; 2], fine: &mut [f32]) {
        let plane = self.radar.samples * FINE_COLUMNS;
        let (minima, rest) = fine.split_at_mut(plane);
        let (maxima, rest) = rest.split_at_mut(plane);
        let (first, last) = rest.split_at_mut(plane);
        let rows = |plane| <[f32]>::par_chunks_mut(plane, FINE_COLUMNS);
        rows(minima).zip(rows(maxima)).zip(rows(first).zip(rows(last))).enumerate().for_each(
            |(row, ((minima, maxima), (first, last)))| {
                let [centre_first, centre_last] = [0, 1].map(|e| self.fine_centre[e].row(&capon[e], row));
                let both = centre_first.zip(centre_last);
                minima
                    .iter_mut()
                    .zip(maxima)
                    .zip(both)
                    .for_each(|((minima, maxima), (a, b))| (*minima, *maxima) = (a.min(b), a.max(b)));
                for (e, to) in [first, last].into_iter().enumerate() {
                    let own = &capon[e][row * FINE_COLUMNS..];
                    let other = self.fine_other[e].row(&capon[1 - e], row);
                    to.iter_mut().zip(own).zip(other).for_each(|((to, own), other)| *to = own.min(other));
                }
            },
        );
    }
}

/// The features of rows, `[6, samples]` of [`LiveInput::rows`].
fn row_features(profiles: &[Array2<Complex64>; 2]) -> Vec<f32> {
    let (rows, elements) = profiles[0].dim();
    let mut out = vec![0.0; ROW_CHANNELS * rows];
    for (e, z) in profiles.iter().enumerate() {
        for (row, z) in z.axis_iter(Axis(0)).enumerate() {
            let step: Complex64 = (1..elements).map(|n| z[n] * z[n - 1].conj()).sum();
            let power: f64 = z.iter().map(|v| v.norm_sqr()).sum();
            let step = step / (power + 1e-300);
            out[2 * e * rows + row] = step.re as f32;
            out[(2 * e + 1) * rows + row] = step.im as f32;
            out[(4 + e) * rows + row] = (0.5 * (power / elements as f64 + 1e-300).log10()) as f32;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::grid::COARSE_COLUMNS;
    use crate::radar::Convention;
    use crate::scene::Reflector;
    use crate::signal::exact;

    fn row(input: &LiveInput, channel: usize) -> f64 {
        let rows = input.rows.len() / ROW_CHANNELS;
        let plane = &input.coarse[channel * rows * COARSE_COLUMNS..][..rows * COARSE_COLUMNS];
        let strongest = plane.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(i, _)| i);
        (strongest / COARSE_COLUMNS) as f64
    }

    #[test]
    fn registered_ends_have_a_reflector_at_one_range() {
        let migrating = Radar { carrier_hz: 60e9, bandwidth_hz: 3.6e9, ..Radar::default() };
        let dense = Radar { element_spacing_metres: 1.6e-3, ..Radar::default() };
        let radars = [
            Radar::default(),
            Radar::default().in_convention(Convention::Physical),
            migrating.clone().in_convention(Convention::Thesis),
            migrating.in_convention(Convention::Physical),
            Radar { carrier_hz: 24e9, bandwidth_hz: 250e6, ..Radar::default() }.in_convention(Convention::Thesis),
            dense,
        ];
        for radar in radars {
            let extractor = FeatureExtractor::new(&radar).unwrap();
            let range = 300.0 * radar.range_resolution_metres();
            for cos in [-0.75f64, 0.1, 0.75] {
                let (x_metres, y_metres) = (range * cos, range * (1.0 - cos * cos).sqrt());
                let reflectors = [Reflector { x_metres, y_metres, reflectivity: 1.0 }];
                let input = extractor.extract(&exact::beat_signal(&radar, &reflectors).two_ends(&radar)).unwrap();
                let apart = row(&input, 0) - row(&input, 1);
                let migrated = radar.aperture_metres() * cos / radar.range_resolution_metres();
                assert!((apart - migrated).abs() < 0.1 * migrated.abs() + 1.5, "{radar:?}: {apart} for {migrated}");
                for channel in [2, 3] {
                    let found = row(&input, channel);
                    assert!((found - 300.0).abs() <= 2.0, "{radar:?}, {cos}, end {channel}: row {found}");
                }
            }
        }
    }

    #[test]
    fn radars_of_other_shapes_have_a_reflector_at_its_range() {
        for (elements, end_elements, samples) in [(86, 8, 128), (192, 16, 100), (64, 2, 64), (256, 30, 256)] {
            let radar = Radar { elements, end_elements, samples, ..Radar::default() };
            let range = 0.6 * radar.max_range_metres();
            let reflectors = [Reflector { x_metres: 0.5 * range, y_metres: 0.75f64.sqrt() * range, reflectivity: 1.0 }];
            let ends = exact::beat_signal(&radar, &reflectors).two_ends(&radar);
            let input = FeatureExtractor::new(&radar).unwrap().extract(&ends).unwrap();
            let expected = (4 * samples * FINE_COLUMNS, 10 * samples * COARSE_COLUMNS);
            assert_eq!((input.fine.len(), input.coarse.len()), expected);
            assert!(input.fine.iter().chain(&input.coarse).chain(&input.rows).all(|v| v.is_finite()));
            for channel in [2, 3] {
                let found = row(&input, channel);
                assert!((found - 0.6 * samples as f64).abs() <= 2.0, "{radar:?}: row {found}");
            }
        }
    }

    #[test]
    fn radars_with_too_few_elements_or_samples_are_refused() {
        for radar in [Radar { samples: 4, ..Radar::default() }, Radar { end_elements: 1, ..Radar::default() }] {
            let error = FeatureExtractor::new(&radar).unwrap_err().to_string();
            assert!(error.contains("2 elements or more and 8 samples or more"), "{error}");
        }
    }
}
