//! The shipped live network on fresh scenes.

use crate::prelude::*;
use rayon::prelude::*;

const OTHER_RADARS_ERROR: f64 = 900.0;

fn rows(campaign: &Campaign, kind: Kind, methods: &[&dyn Reconstructor]) -> Vec<Row> {
    let campaign = Campaign { purpose: Purpose::Validation, seed: 77, ..campaign.clone() };
    let sets = [SceneSet::Generated(kind)];
    campaign.run(&sets, methods, &Task::default(), |_| ()).expect("validation scenes are valid")
}

fn tally(floor: Floor, kind: Kind, count: u32) -> Tally {
    let live = methods::by_name("live").expect("the live network ships with the program");
    Tally::of(&rows(&Campaign { count, floor, ..Campaign::default() }, kind, &[live.as_ref()]))
}

#[test]
fn is_as_good_on_every_set_as_when_it_was_trained() {
    let sets = [(Kind::Set1, 270.0), (Kind::Set2, 390.0), (Kind::Set3, 600.0)];
    for (kind, at_most) in sets.into_iter().chain([(Kind::Crowd, 930.0), (Kind::Near, 640.0)]) {
        let tally = tally(Floor::Thesis, kind, 4);
        let error = tally.squared_error().mean;
        assert!(error < at_most, "{kind:?}: SE {error}");
        assert!(tally.detection().mean > 0.97, "{kind:?}: P_D {}", tally.detection().mean);
    }
}

fn other_radars() -> [(&'static str, Radar); 3] {
    let radar = Radar::default;
    [
        ("1 GHz", Radar { bandwidth_hz: 1e9, ..radar() }),
        ("24 GHz", Radar { carrier_hz: 24e9, bandwidth_hz: 250e6, ..radar() }.in_convention(Convention::Thesis)),
        ("physical", radar().in_convention(Convention::Physical)),
    ]
}

#[test]
fn other_radars_have_weights_of_their_own() {
    let live = methods::by_name("live").unwrap();
    for (name, radar) in other_radars() {
        assert!(live.check_array(&radar).is_ok(), "{name}");
        assert_ne!(live.weights(&radar), live.weights(&Radar::default()), "{name}");
        let campaign = Campaign { count: 3, radar, ..Campaign::default() };
        let rows = rows(&campaign, Kind::Set2, &[live.as_ref()]);
        let tally = Tally::of(&rows);
        let error = tally.squared_error().mean;
        assert!(error < OTHER_RADARS_ERROR && tally.detection().mean > 0.97, "{name}: SE {error}");
        assert_eq!(rows[0].weights.to_string(), live.weights(&campaign.radar).unwrap().sha256);
    }
    for (radar, words) in [
        (Radar { bandwidth_hz: 8e9, ..Radar::default() }, "0.1 to 6 GHz of bandwidth"),
        (Radar { window: WindowFunction::Rectangular, ..Radar::default() }, "the hann window"),
    ] {
        let refused = live.check_array(&radar).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn the_cascade_has_weights_of_its_own() {
    let live = methods::by_name("live").unwrap();
    let radar = RadarPreset::by_id("cascade-12x16").unwrap().radar.clone();
    assert_ne!(live.weights(&radar), live.weights(&Radar::default()));
    let campaign = Campaign { count: 6, radar, ..Campaign::default() };
    let rows = rows(&campaign, Kind::Set2, &[live.as_ref(), &Baseline]);
    let error = |method: &str| {
        Tally::of(&rows.iter().filter(|row| row.method == method).cloned().collect::<Vec<_>>()).squared_error().mean
    };
    assert!(4.0 * error("live") < error("baseline"), "{} {}", error("live"), error("baseline"));
    // The weights are for one radar, and no other of its shape.
    let other = Radar { bandwidth_hz: 1.1e9, ..campaign.radar };
    assert!(live.check_array(&other).is_err());
}

#[test]
fn its_threshold_follows_the_floor() {
    let thermal = tally(Floor::Snr(Decibels(40.0)), Kind::Set2, 3);
    assert!(thermal.eta() < tally(Floor::Thesis, Kind::Set2, 3).eta() - 0.03, "{}", thermal.eta());
    let (detection, false_alarm) = (thermal.detection().mean, thermal.false_alarm().mean);
    assert!(detection > 0.9 && false_alarm < 0.02, "P_D {detection}, P_FA {false_alarm}");
}

/// A caller's own parallel loop hands a thread that waits inside one map the next map to make.
#[test]
fn callers_in_a_parallel_loop_do_not_block_each_other() {
    let (done, finished) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let radar = Radar::default();
        let live = methods::by_name("live").unwrap();
        let signal = simulate(&radar, &Scene::of_points([(4.0, 15.0)]), Floor::Exact, 0);
        let ends = signal.unwrap().two_ends(&radar);
        let threads = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let request = Request::default();
        let made: Vec<_> = threads.install(|| {
            (0..8).into_par_iter().map(|_| live.reconstruct(&radar, &ends, &request).unwrap().lambda).collect()
        });
        let _receiver_is_gone = done.send(made);
    });
    let made = finished.recv_timeout(Duration::from_secs(120)).expect("eight maps take seconds");
    assert!(made.iter().all(|map| *map == made[0]), "the same samples give the same map on every thread");
}
