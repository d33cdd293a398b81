//! Scenes built to break numerics: nothing infinite, every promise kept, incremental sums where a fresh build ends.

use apertura::benchmark::stress::{self, StressRequest, StressScene, random_edits, scene_cases};
use apertura::engine::MapRequest;
use apertura::maps::Normalisation;
use apertura::radar::{Decibels, Radar};
use apertura::scene::{Object, Point, Scene};
use apertura::signal::{Algorithm, Floor};
use proptest::prelude::*;

fn small() -> Radar {
    Radar { elements: 48, samples: 32, end_elements: 6, ..Radar::default() }
}

#[test]
fn every_scene_holds_on_a_small_radar() {
    let request = StressRequest { coincident: 300, edits: 200, seed: 1 };
    let report = stress::run(&small(), &small(), &request, |_| {}).unwrap();
    report.numbers().unwrap();
    assert_eq!(report.refused.len(), 1, "one scene lies on an element");
    assert!(report.cases.len() > 100, "{} cases", report.cases.len());
    // A run that can't see an error proves nothing: the plain formula's rounding and f32's must show.
    assert!(report.cases.iter().any(|c| c.algorithm == Algorithm::Direct && c.signal_error > 1e-14));
    let changes = report.cases.iter().flat_map(|c| &c.ulp_change);
    assert!(changes.clone().any(|u| u.max > 0.0) && changes.clone().all(|u| u.max.is_finite()));
}

#[test]
#[ignore = "takes minutes: the whole radar, ten thousand points in one place, ten thousand edits"]
fn every_scene_holds_on_the_whole_radar() {
    let report = stress::run(&Radar::default(), &small(), &StressRequest::default(), |_| {}).unwrap();
    report.numbers().unwrap();
}

/// Where only the rows that changed are recomputed, edits end at a fresh build too.
#[test]
fn edits_over_no_floor_end_within_their_tolerance() {
    let radar = Radar { samples: 256, ..small() };
    let normalisation = Normalisation::DynamicRange(Decibels(100.0));
    let wanted = MapRequest { floor: Floor::Exact, normalisation, ends: false, ..MapRequest::default() };
    let report = random_edits(&radar, &wanted, 200, 3).unwrap();
    assert!((report.most_difference / 2.5e-6 - 1.0).abs() < 1e-12);
    assert!(report.worst_difference <= report.most_difference, "{:e}", report.worst_difference);
    assert_eq!(report.cache_bytes_early, report.cache_bytes);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// On any points, every algorithm stays finite and keeps its promise.
    #[test]
    fn any_points_are_summed_as_promised(
        points in prop::collection::vec((-60.0..60.0f64, -60.0..60.0f64, -32.0..32.0f64, any::<bool>()), 0..7),
    ) {
        let object = |(x_metres, y_metres, decades, negative): (f64, f64, f64, bool)| {
            let reflectivity = 10f64.powf(decades) * if negative { -1.0 } else { 1.0 };
            Object::Point(Point { reflectivity, ..Point::new(x_metres, y_metres) })
        };
        let scene = Scene { objects: points.into_iter().map(object).collect(), ..Scene::default() };
        let scene = StressScene { name: "random points", scene, refused: false };
        for algorithm in Algorithm::ALL {
            for case in scene_cases(&small(), &scene, algorithm).unwrap() {
                prop_assert!(case.holds(), "{case:?}");
            }
        }
    }
}
