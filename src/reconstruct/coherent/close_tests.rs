//! Echoes that stand close together, on an array whose ends are eight elements each.

use super::{CoherentMethod, IAA, SBL};
use crate::radar::{Decibels, Radar};
use crate::reconstruct::{Detection, Reconstructor, Request};
use crate::scene::Scene;
use crate::signal::{Floor, simulate};

/// An angle from broadside in degrees, and a range in metres.
type Place = (f64, f64);

/// Ranges of three points at -21.80, 14.04 and 15.64 degrees, metres: alike, apart, and the last two within two range bins of 15 cm.
const RANGES: [[f64; 3]; 4] = [[20.0, 20.0, 20.0], [15.0, 17.0, 20.0], [15.0, 20.0, 20.3], [17.0, 15.5, 15.5]];

/// Ranges of which the last two differ by a third of a range bin. The rounding floor is enough to hide that they are two.
const NEARLY_ALIKE: [f64; 3] = [16.0, 18.0, 18.05];

/// Confidence beneath which an echo counts as doubtful.
const DOUBTFUL: f64 = 0.5;

fn radar() -> Radar {
    Radar { elements: 192, end_elements: 8, bandwidth_hz: 1e9, ..Radar::default() }
}

fn found(method: CoherentMethod, places: &[Place], floor: Floor) -> Vec<Detection> {
    let at = |(degrees, range): &Place| (range * degrees.to_radians().sin(), range * degrees.to_radians().cos());
    let scene = Scene::of_points(places.iter().map(at));
    let ends = simulate(&radar(), &scene, floor, 1).unwrap().two_ends(&radar());
    let answer = method.reconstruct(&radar(), &ends, &Request { noise: floor.into(), ..Request::default() }).unwrap();
    answer.detections(&radar())
}

fn apart(echo: &Detection, (degrees, range): &Place) -> (f64, f64) {
    ((echo.cos_theta.asin().to_degrees() - degrees).abs(), (echo.range_metres - range).abs())
}

#[test]
fn no_echo_is_invented_at_full_confidence_beside_close_ones() {
    for ranges in RANGES {
        let places: Vec<Place> = [-21.80, 14.04, 15.64].into_iter().zip(ranges).collect();
        for floor in [Floor::Thesis, Floor::Exact] {
            let of_sbl = found(SBL, &places, floor).len();
            assert!(of_sbl <= 12, "sbl: {of_sbl} echoes over {floor} at {ranges:?}");
            let found = found(IAA, &places, floor);
            let what = format!("iaa over {floor} at {ranges:?}: {found:#?}");
            for place in &places {
                let is_it = |echo: &&Detection| apart(echo, place).0 < 0.1 && apart(echo, place).1 < 0.05;
                let echo = found.iter().find(is_it);
                assert!(echo.is_some_and(|e| e.confidence.unwrap() > 0.9), "{place:?}: {what}");
            }
            let is_there = |echo: &Detection| places.iter().any(|p| apart(echo, p).0 < 0.5 && apart(echo, p).1 < 0.1);
            assert!(found.len() <= 5, "{what}");
            let invented: Vec<&Detection> = found.iter().filter(|echo| !is_there(echo)).collect();
            assert!(invented.iter().all(|echo| echo.confidence.unwrap() < DOUBTFUL), "{what}");
        }
    }
}

/// Over noise a close pair may be placed on other teeth of the comb, 0.6 degrees apart, but it must not become two dozen echoes.
#[test]
fn close_echoes_over_noise_do_not_become_dozens() {
    for ranges in RANGES.into_iter().chain([NEARLY_ALIKE]) {
        let places: Vec<Place> = [-21.80, 14.04, 15.64].into_iter().zip(ranges).collect();
        for decibels in [40.0, 20.0] {
            let count = found(IAA, &places, Floor::Snr(Decibels(decibels))).len();
            assert!((2..=8).contains(&count), "{count} echoes at {decibels} dB, {ranges:?}");
        }
    }
}
