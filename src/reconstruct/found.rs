//! Lists of detections: a method's reflectors, or the peaks of its map.

use super::error::Result;
use super::{Detection, Reconstruction, Reconstructor, Request};
use crate::maps::peaks::peaks;
use crate::maps::{Normalisation, channels_range_transform};
use crate::radar::{Decibels, End, Radar};
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis, concatenate};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Level below its strongest to which a map's peaks are listed.
const MAX_PEAK_DEPTH: Decibels = Decibels(20.0);

/// Dynamic range of the map in which peaks are searched.
const MAP_RANGE: Decibels = Decibels(60.0);

const MAX_LISTED_PEAKS: usize = 256;

/// Most elements of an array with columns wider than the fringes between its ends: a peak's direction is then searched between the columns.
pub const MAX_COARSE_ELEMENTS: usize = 128;

/// Distance within which peaks of one range bin are one, as a part of a column.
const MAX_SAME_PEAK_COLUMNS: f64 = 0.5;

/// Reconstructs, and lists the detections of [`find`].
/// # Errors
/// As [`Reconstructor::reconstruct`].
pub fn reconstruct_and_find(
    method: &dyn Reconstructor,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
) -> Result<(Reconstruction, Vec<Detection>)> {
    let answer = method.reconstruct(radar, ends, request)?;
    let found = find(method, radar, ends, request, &answer)?;
    Ok((answer, found))
}

/// The detections in `answer`, the answer of `method` to `request`, the strongest first: the method's own reflectors, or the peaks of its map
/// within 20 dB of the strongest; nothing on few elements for a method whose places are those of cells. A map that `request` normalises by its
/// smallest cell has no decibels: the peaks are those of a second map.
/// # Errors
/// As [`Reconstructor::reconstruct`].
pub fn find(
    method: &dyn Reconstructor,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
    answer: &Reconstruction,
) -> Result<Vec<Detection>> {
    let normalisation = Normalisation::DynamicRange(MAP_RANGE);
    // Beside another layout the ends have no samples.
    let heard = request.layout_samples.is_none().then_some(ends);
    if radar.elements <= MAX_COARSE_ELEMENTS && !method.lists_few_elements() {
        Ok(Vec::new())
    } else if !answer.reflectors.is_empty() {
        Ok(answer.detections(radar))
    } else if request.normalisation == normalisation {
        Ok(found_in_map(radar, heard, answer))
    } else {
        let in_decibels = Request { normalisation, ..request.clone() };
        Ok(found_in_map(radar, heard, &method.reconstruct(radar, ends, &in_decibels)?))
    }
}

fn found_in_map(radar: &Radar, ends: Option<&TwoEnds>, answer: &Reconstruction) -> Vec<Detection> {
    let decibels = answer.lambda.lambda.mapv(|v| (f64::from(v) - 1.0) * MAP_RANGE.0);
    let peaks = peaks(decibels.view(), MAX_PEAK_DEPTH.0, MAX_LISTED_PEAKS);
    let strongest = peaks.first().map_or(0.0, |p| p.value);
    let place = |column: f64| radar.cos_of_column(column).clamp(-1.0, 1.0);
    let found = peaks.into_iter().map(|p| Detection {
        cos_theta: place(p.column),
        range_metres: radar.range_of_bin_metres(p.range_bin.rem_euclid(radar.samples as f64)),
        relative_power: Decibels(p.value - strongest),
        confidence: None,
    });
    match ends.filter(|_| radar.elements <= MAX_COARSE_ELEMENTS) {
        Some(ends) => between_columns(radar, ends, found),
        None => found.collect(),
    }
}

/// The peaks moved to the nearby directions in which both ends together have most power, and merged where they become one. Each has the power of
/// both ends, since a pseudo-spectrum's heights are not strengths.
fn between_columns(radar: &Radar, ends: &TwoEnds, peaks: impl Iterator<Item = Detection>) -> Vec<Detection> {
    let beam = Beam::new(radar, ends);
    let column = (radar.cos_of_column(1.0) - radar.cos_of_column(0.0)).abs();
    let mut found: Vec<(f64, Detection)> = Vec::new();
    for peak in peaks {
        let (cos_theta, power) = beam.strongest_near(peak.range_metres, peak.cos_theta, 1.5 * column);
        let is_new = |(_, f): &(f64, Detection)| {
            let bins = (f.range_metres - peak.range_metres).abs() / radar.range_resolution_metres();
            bins > 1.5 || (f.cos_theta - cos_theta).abs() > MAX_SAME_PEAK_COLUMNS * column
        };
        if found.iter().all(is_new) {
            found.push((power, Detection { cos_theta, ..peak }));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let strongest = found.first().map_or(0.0, |(power, _)| *power).max(f64::MIN_POSITIVE);
    let level = |power: f64| Decibels(10.0 * (power / strongest).max(f64::MIN_POSITIVE).log10());
    let all = found.into_iter().map(|(power, f)| Detection { relative_power: level(power), ..f });
    all.filter(|f| f.relative_power.0 > -MAX_PEAK_DEPTH.0).collect()
}

const BEAM_STEPS: i32 = 48;

/// The beam of both ends together, between the columns of a map.
struct Beam<'a> {
    radar: &'a Radar,
    elements: Vec<usize>,
    profiles: Array2<Complex64>,
}

impl<'a> Beam<'a> {
    fn new(radar: &'a Radar, ends: &TwoEnds) -> Self {
        let elements = End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).collect();
        let rows = concatenate(Axis(0), &[ends.first.view(), ends.last.view()]).unwrap_or_else(|_| ends.first.clone());
        Beam { radar, elements, profiles: channels_range_transform(radar, rows.view()).profiles }
    }

    /// The cosine within `within` of `about` from which the power at this range is largest, all elements added in phase; and that power.
    fn strongest_near(&self, range_metres: f64, about: f64, within: f64) -> (f64, f64) {
        let bin = self.radar.bin_of_range(range_metres).round().rem_euclid(self.radar.samples as f64) as usize;
        let cosine = |step: i32| (about + within * f64::from(step) / f64::from(BEAM_STEPS)).clamp(-1.0, 1.0);
        let power = |step: i32| self.power(bin, range_metres, cosine(step));
        // The nearest of equal cosines: silence keeps `about`.
        let (step, power) = (1..=BEAM_STEPS).flat_map(|n| [n, -n]).fold((0, power(0)), |best, step| {
            let found = power(step);
            if found > best.1 { (step, found) } else { best }
        });
        (cosine(step), power)
    }

    fn power(&self, bin: usize, range_metres: f64, cosine: f64) -> f64 {
        let (x, y) = (range_metres * cosine, range_metres * (1.0 - cosine * cosine).max(0.0).sqrt());
        let turns = self.radar.middle_turns_per_metre();
        let heard = self.elements.iter().zip(self.profiles.outer_iter()).map(|(element, profile)| {
            let ways = self.radar.pair(*element).places_metres().map(|[px, py]| (x - px).hypot(y - py));
            let longer = (ways[0] + ways[1]) / 2.0 - range_metres;
            profile.get(bin).copied().unwrap_or_default() * Complex64::from_polar(1.0, -TAU * turns * longer)
        });
        heard.sum::<Complex64>().norm_sqr()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::{MatchedFilter, Omp};
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn maps_and_lists_of_reflectors_name_the_same_places() {
        let radar = Radar { elements: 64, samples: 128, ..Radar::default() };
        let scene = Scene::of_points([(0.0, 4.0), (3.0, 6.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let methods: [&dyn Reconstructor; 2] = [&MatchedFilter::Incoherent, &Omp::default()];
        for method in methods {
            let (_, found) = reconstruct_and_find(method, &radar, &ends, &Request::default()).unwrap();
            for reflector in scene.reflectors() {
                let place = radar.polar_of(reflector.x_metres, reflector.y_metres);
                let near = |f: &&Detection| {
                    (f.range_metres - place.range_metres).abs() < 0.1 && (f.cos_theta - place.cos_theta).abs() < 0.1
                };
                assert!(found.iter().take(4).any(|f| near(&f)), "{}: {place:?} in {found:?}", method.name());
            }
            assert_eq!(found[0].relative_power, Decibels(0.0), "{}", method.name());
            assert!(found.windows(2).all(|w| w[0].relative_power >= w[1].relative_power), "{}", method.name());
        }
    }

    #[test]
    fn nothing_is_found_in_silence() {
        let radar = Radar { elements: 64, samples: 128, ..Radar::default() };
        let ends = crate::signal::BeatSignal::silence(&radar).two_ends(&radar);
        let (_, found) = reconstruct_and_find(&MatchedFilter::Coherent, &radar, &ends, &Request::default()).unwrap();
        assert_eq!(found, []);
    }
}
