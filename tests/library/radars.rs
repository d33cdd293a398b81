//! Every method on every valid radar: a map with its echoes in their places, or at once a refusal with its reason.

use crate::prelude::*;
use proptest::prelude::*;

const NETWORKS: [&str; 4] = ["live", "thesis", "thesis-1", "unet"];

/// Longest that any method may take for one of these maps, even on a busy machine in an unoptimised build.
const MAX_RUN_TIME: Duration = Duration::from_secs(60);

fn array(elements: usize, end_elements: usize, carrier_hz: f64, wavelengths: f64) -> Radar {
    let element_spacing_metres = wavelengths * SPEED_OF_LIGHT / carrier_hz;
    Radar { elements, end_elements, carrier_hz, element_spacing_metres, samples: 128, ..Radar::default() }
}

fn radars() -> Vec<(&'static str, Radar)> {
    let half = 0.5;
    vec![
        ("86 elements at 77 GHz", array(86, 12, 77e9, half)),
        ("8 elements, 3 an end", array(8, 3, 77e9, half)),
        ("256 elements at 24 GHz", array(256, 12, 24e9, half)),
        ("two-way carrier", Radar { carrier: Carrier::TwoWay, ..array(128, 12, 77e9, half) }),
        ("one wavelength spacing", array(64, 8, 77e9, 1.0)),
        ("150 MHz", Radar { bandwidth_hz: 150e6, ..array(64, 12, 77e9, half) }),
        ("a snapshot", Radar { samples: 1, ..array(86, 12, 77e9, half) }),
    ]
}

fn one_reflector(radar: &Radar) -> Scene {
    let range = if radar.samples == 1 { 100.0 * radar.far_field_metres() } else { radar.max_range_metres() * 0.4 };
    Scene::of_points([(range * 0.28, range * 0.96)])
}

#[test]
fn a_reflector_is_where_the_whole_array_sees_it_or_is_refused() {
    let floor = Floor::Snr(Decibels(50.0));
    let mut misplaced = Vec::new();
    for (what, radar) in radars() {
        radar.validate().unwrap();
        let signal = simulate(&radar, &one_reflector(&radar), floor, 0).unwrap();
        let target = LogMaps::of_signal(&radar, &signal).full.normalise(Normalisation::DynamicRange(Decibels(30.0)));
        let request = Request {
            noise: floor.into(),
            normalisation: Normalisation::DynamicRange(Decibels(30.0)),
            ..Request::default()
        };
        for method in methods::all() {
            let name = method.name();
            let found = match method.reconstruct(&radar, &signal.two_ends(&radar), &request) {
                Ok(found) => found.lambda.lambda,
                Err(ReconstructError::Unusable { reason, .. }) => {
                    let searches = ["nomp", "hybrid"].contains(&name) && radar.samples == 1;
                    assert!(NETWORKS.contains(&name) || searches, "{name} on {what}: {reason}");
                    continue;
                }
                Err(error) => panic!("{name} on {what}: {error}"),
            };
            // Networks need not serve radars that they aren't trained for. The baseline is one end's map, which sees a near reflector elsewhere.
            if NETWORKS.contains(&name) || name == "baseline" {
                continue;
            }
            let (at, _) = found.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            let beam = radar.elements / radar.end_elements;
            let (bins, columns) = (radar.samples as isize, radar.elements as isize);
            let near = (-2..=2).flat_map(|i| (-(beam as isize)..=beam as isize).map(move |j| (i, j)));
            let seen = near
                .map(|(i, j)| {
                    let bin = (at.0 as isize + i).clamp(0, bins - 1) as usize;
                    target.lambda[[bin, (at.1 as isize + j).rem_euclid(columns) as usize]]
                })
                .fold(0.0f32, f32::max);
            if seen <= 0.9 {
                misplaced.push(format!("{name} on {what}: strongest at {at:?}, where the whole array sees {seen}"));
            }
        }
    }
    assert!(misplaced.is_empty(), "{misplaced:#?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn every_method_gives_a_finite_map_or_a_reason(
        samples in prop_oneof![Just(1usize), 2usize..64],
        elements in 6usize..64,
        end_part in 0.0f64..1.0,
        wavelengths in prop_oneof![4 => 0.1f64..3.0, 1 => 3.0f64..6.0],
        carrier_ghz in 1.0f64..120.0,
        bandwidth_log_hz in 7.0f64..9.7,
        two_way in any::<bool>(),
        places in prop::collection::vec((0.02f64..1.2, -1.0f64..1.0), 0..4),
        snr in 0.0f64..90.0,
    ) {
        let carrier_hz = carrier_ghz * 1e9;
        let end_elements = 3 + (end_part * (elements / 2 - 3) as f64) as usize;
        let radar = Radar {
            bandwidth_hz: 10f64.powf(bandwidth_log_hz),
            carrier: if two_way { Carrier::TwoWay } else { Carrier::OneWay },
            samples,
            ..array(elements, end_elements, carrier_hz, wavelengths)
        };
        prop_assert!(radar.validate().is_ok());
        let far = radar.max_range_metres().max(radar.aperture_metres());
        let points = places.iter().map(|(part, cos)| (part * far * cos, part * far * (1.0 - cos * cos).sqrt() + 1e-3));
        let scene = Scene::of_points(points.collect::<Vec<_>>());
        let floor = Floor::Snr(Decibels(snr));
        let ends = simulate(&radar, &scene, floor, 1).unwrap().two_ends(&radar);
        let request = Request { noise: floor.into(), ..Request::default() };
        for method in methods::all() {
            let start = Instant::now();
            match method.reconstruct(&radar, &ends, &request) {
                Ok(found) => {
                    prop_assert_eq!(found.lambda.lambda.dim(), (samples, elements), "{}", method.name());
                    prop_assert!(found.lambda.lambda.iter().all(|v| (0.0..=1.0).contains(v)), "{}", method.name());
                    for d in found.detections(&radar) {
                        prop_assert!(d.cos_theta.abs() <= 1.0 && d.range_metres.is_finite() && d.relative_power.0 <= 0.0);
                    }
                }
                Err(ReconstructError::Unusable { method: name, reason }) => {
                    prop_assert!(name == method.name() && !reason.is_empty());
                    prop_assert!(start.elapsed() < MAX_RUN_TIME / 4, "{name} takes {:?} to refuse", start.elapsed());
                }
                Err(error) => prop_assert!(false, "{}: {error}", method.name()),
            }
            prop_assert!(start.elapsed() < MAX_RUN_TIME, "{} took {:?}", method.name(), start.elapsed());
        }
    }
}

/// Echoes that `method` finds of points at these ranges (metres) and cosines, over 40 dB.
fn found(method: &str, radar: &Radar, places: &[(f64, f64)]) -> Result<Vec<Detection>, ReconstructError> {
    let scene = Scene::of_points(places.iter().map(|(range, cos)| (range * cos, range * (1.0 - cos * cos).sqrt())));
    let floor = Floor::Snr(Decibels(40.0));
    let ends = simulate(radar, &scene, floor, 1).unwrap().two_ends(radar);
    let request = Request { noise: floor.into(), ..Request::default() };
    Ok(methods::by_name(method).unwrap().reconstruct(radar, &ends, &request)?.detections(radar))
}

/// Whether `found` begins with those places, in any order: within `bins` of range and `cos` of direction.
fn begins_with(found: &[Detection], radar: &Radar, places: &[(f64, f64)], (bins, cos): (f64, f64)) -> bool {
    let is_there = |d: &Detection| {
        let apart =
            |(range, c): &(f64, f64)| (radar.bin_of_range((d.range_metres - range).abs()), (d.cos_theta - c).abs());
        places.iter().map(apart).any(|apart| apart.0 < bins && apart.1 < cos)
    };
    found.len() >= places.len() && found[..places.len()].iter().all(is_there)
}

#[test]
fn steps_scale_with_the_radar() {
    let kilometres = Radar { bandwidth_hz: 1e6, ..array(64, 12, 77e9, 0.5) };
    let places = [(3000.0, 0.2), (9000.0, -0.4)];
    let millimetres = Radar { bandwidth_hz: 10e9, ..array(32, 8, 300e9, 0.5) };
    let near = [(0.6, 0.2), (1.1, -0.4)];
    for (radar, places) in [(kilometres, places), (millimetres, near)] {
        for name in ["nomp", "hybrid", "iaa", "sbl"] {
            let found = found(name, &radar, &places).unwrap();
            assert!(begins_with(&found, &radar, &places, (0.05, 0.002)), "{name}: {found:?}");
            assert!(found[2..].iter().all(|d| d.relative_power.0 < -30.0), "{name}: {found:?}");
        }
    }
}

#[test]
fn a_cluster_at_600_metres_of_a_coarse_radar_is_answered_soon() {
    let radar = Radar { bandwidth_hz: 50e6, samples: 256, ..array(64, 8, 77e9, 0.5) };
    let places: Vec<(f64, f64)> =
        (0..12).map(f64::from).map(|i| (600.0 + 4.0 * (1.7 * i).cos(), 0.3 + 0.003 * (2.1 * i).sin())).collect();
    for name in ["omp", "nomp", "iaa", "sbl"] {
        let start = Instant::now();
        let found = found(name, &radar, &places).unwrap();
        assert!(found.first().is_some_and(|d| (d.range_metres - 600.0).abs() < 10.0), "{name}: {found:?}");
        assert!(start.elapsed() < MAX_RUN_TIME, "{name} took {:?}", start.elapsed());
    }
}

#[test]
fn ends_that_nothing_is_far_away_from_are_refused_at_once() {
    let radar = Radar { element_spacing_metres: 1.0, bandwidth_hz: 5e8, ..array(32, 6, 77e9, 0.5) };
    for name in ["iaa", "sbl", "capon"] {
        let reason = found(name, &radar, &[(20.0, 0.2)]).unwrap_err().to_string();
        assert!(reason.contains("far field"), "{name}: {reason}");
    }
}

#[test]
fn an_element_that_measured_nothing_makes_no_ghosts() {
    let radar = array(64, 10, 77e9, 0.5);
    let places = [(4.2f64, 0.3f64), (6.1, -0.45)];
    let scene = Scene::of_points(places.map(|(range, cos)| (range * cos, range * (1.0 - cos * cos).sqrt())));
    let floor = Floor::Snr(Decibels(40.0));
    let mut ends = simulate(&radar, &scene, floor, 1).unwrap().two_ends(&radar);
    ends.first.row_mut(3).fill(Default::default());
    ends.last.row_mut(9).fill(Default::default());
    let request = Request { noise: floor.into(), ..Request::default() };
    for name in ["nomp", "iaa", "sbl"] {
        let found = methods::by_name(name).unwrap().reconstruct(&radar, &ends, &request).unwrap().detections(&radar);
        assert!(begins_with(&found, &radar, &places, (0.1, 0.002)), "{name}: {found:?}");
        assert!(found[2..].iter().all(|d| d.relative_power.0 < -30.0), "{name}: {found:?}");
    }
}
