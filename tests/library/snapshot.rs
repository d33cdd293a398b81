//! The thesis' question answered on hardware: do twelve elements at either end of 86 see what all 86 see?

use crate::prelude::*;
use apertura::recording::presets::Preset;

/// Directions in degrees that come within 8 dB of the strongest, rising, as `method` sees them with `end_elements` at either end.
fn seen(recording: &Recording, method: &str, end_elements: usize) -> Vec<f64> {
    let radar = Radar { end_elements, ..recording.radar.clone() };
    let ends = recording.signal().unwrap().two_ends(&radar);
    let found = found_by(method, &radar, &ends);
    let strong = found.iter().filter(|f| f.relative_power.0 > -8.0);
    let mut degrees: Vec<f64> = strong.map(|f| f.cos_theta.asin().to_degrees()).collect();
    degrees.sort_by(f64::total_cmp);
    degrees
}

#[test]
fn twelve_elements_at_either_end_see_what_all_86_see() {
    let recording = Preset::by_id("cascade-86").unwrap().load().unwrap();
    for method in ["iaa", "sbl"] {
        let (all, ends) = (seen(&recording, method, 43), seen(&recording, method, 12));
        assert_eq!((all.len(), ends.len()), (2, 2), "{method}: {all:?} {ends:?}");
        for (direction, expected) in all.iter().zip([0.0, 6.96]) {
            assert!((direction - expected).abs() < 0.1, "{method}: all 86 see {all:?}");
        }
        for (a, b) in all.iter().zip(&ends) {
            assert!((a - b).abs() < 0.1, "{method}: {all:?} {ends:?}");
        }
    }
}

#[test]
fn one_end_alone_sees_one_direction_between_the_two() {
    let recording = Preset::by_id("cascade-86").unwrap().load().unwrap();
    let degrees = seen(&recording, "baseline", 12);
    assert!(degrees.len() == 1 && (2.0..6.0).contains(&degrees[0]), "{degrees:?}");
}
