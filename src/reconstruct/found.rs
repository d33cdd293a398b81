//! What a method found, as a list: its reflectors, or the peaks of its map.

use super::{ReconstructError, Reconstruction, Reconstructor, Request};
use crate::maps::Normalisation;
use crate::maps::peaks::peaks;
use crate::radar::{Decibels, Radar};
use crate::scene::Reflector;
use crate::signal::TwoEnds;

/// A direction and a range that something was found in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Cosine of the angle between the array's axis (+x) and the place.
    pub cos_theta: f64,
    /// Distance from the centre of the array, metres; of a snapshot (`radar.samples` = 1) without meaning.
    pub range_metres: f64,
    /// Strength of its echo relative to the strongest found, 0 and below.
    pub relative_db: Decibels,
}

/// A map's peaks are listed this far below its strongest.
const SPAN: Decibels = Decibels(20.0);

/// Dynamic range of the map whose peaks are looked for.
const MAP_RANGE: Decibels = Decibels(60.0);

/// Most peaks of a map that are listed.
const MOST_PEAKS: usize = 256;

/// Reconstructs, and lists what was found as [`find`] does.
///
/// # Errors
/// As [`Reconstructor::reconstruct`].
pub fn reconstruct_and_find(
    method: &dyn Reconstructor,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
) -> Result<(Reconstruction, Vec<Found>), ReconstructError> {
    let answer = method.reconstruct(radar, ends, request)?;
    let found = find(method, radar, ends, request, &answer)?;
    Ok((answer, found))
}

/// What `method` found where `answer` is its answer to `request`, the strongest first: its own reflectors, or the peaks of its map
/// within 20 dB of the strongest. A map that `request` stretches by its smallest cell knows no decibels: its peaks come from a second
/// one.
///
/// # Errors
/// As [`Reconstructor::reconstruct`].
pub fn find(
    method: &dyn Reconstructor,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
    answer: &Reconstruction,
) -> Result<Vec<Found>, ReconstructError> {
    let normalisation = Normalisation::DynamicRange(MAP_RANGE);
    if !answer.reflectors.is_empty() {
        Ok(found_reflectors(radar, &answer.reflectors))
    } else if request.normalisation == normalisation {
        Ok(found_in_map(radar, answer))
    } else {
        let in_decibels = Request { normalisation, ..request.clone() };
        Ok(found_in_map(radar, &method.reconstruct(radar, ends, &in_decibels)?))
    }
}

/// The reflectors by the strength of their echoes, which fall with the square of the range.
fn found_reflectors(radar: &Radar, reflectors: &[Reflector]) -> Vec<Found> {
    let mut found: Vec<(f64, Found)> = reflectors
        .iter()
        .map(|r| {
            let place = radar.polar_of(r.x_metres, r.y_metres);
            let strength = r.reflectivity.abs() / place.range_metres.powi(2).max(f64::MIN_POSITIVE);
            let (cos_theta, range_metres) = (place.cos_theta, place.range_metres);
            (strength, Found { cos_theta, range_metres, relative_db: Decibels(0.0) })
        })
        .filter(|(strength, _)| *strength > 0.0)
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let strongest = found.first().map_or(1.0, |f| f.0);
    found.into_iter().map(|(s, f)| Found { relative_db: Decibels(20.0 * (s / strongest).log10()), ..f }).collect()
}

/// The peaks of a map whose Lambda spans [`MAP_RANGE`].
fn found_in_map(radar: &Radar, answer: &Reconstruction) -> Vec<Found> {
    let decibels = answer.lambda.lambda.mapv(|v| (f64::from(v) - 1.0) * MAP_RANGE.0);
    let peaks = peaks(decibels.view(), SPAN.0, MOST_PEAKS);
    let strongest = peaks.first().map_or(0.0, |p| p.value);
    let place = |column: f64| radar.cos_of_column(column).clamp(-1.0, 1.0);
    peaks
        .into_iter()
        .map(|p| Found {
            cos_theta: place(p.column),
            range_metres: radar.range_of_bin_metres(p.range_bin.rem_euclid(radar.samples as f64)),
            relative_db: Decibels(p.value - strongest),
        })
        .collect()
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
                let near = |f: &&Found| {
                    (f.range_metres - place.range_metres).abs() < 0.1 && (f.cos_theta - place.cos_theta).abs() < 0.1
                };
                assert!(found.iter().take(4).any(|f| near(&f)), "{}: {place:?} in {found:?}", method.name());
            }
            assert_eq!(found[0].relative_db, Decibels(0.0), "{}", method.name());
            assert!(found.windows(2).all(|w| w[0].relative_db >= w[1].relative_db), "{}", method.name());
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
