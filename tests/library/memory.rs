//! The memory of every method stays below `Radar::memory_bytes`.
//!
//! Each measurement has a process of its own: this test program again, asked for the test called `child`.

use crate::prelude::*;
use apertura::files::memory::{peak_resident_bytes, reset_peak_resident, resident_bytes};
use apertura::reconstruct::Fista;

/// Variable with the child's work: `WORK ELEMENTS SAMPLES END`.
const CHILD_VARIABLE: &str = "APERTURA_TEST_MEMORY";

/// Memory of the program and its threads beside the maps, bytes.
const OVERHEAD: u64 = 32 << 20;

#[test]
#[ignore = "the child of the tests below"]
fn child() {
    let Ok(asked) = std::env::var(CHILD_VARIABLE) else { return };
    let words: Vec<&str> = asked.split(' ').collect();
    let [work, numbers @ ..] = words.as_slice() else { panic!("{asked}") };
    let numbers: Vec<usize> = numbers.iter().map(|n| n.parse().unwrap()).collect();
    let radar = Radar { elements: numbers[0], samples: numbers[1], end_elements: numbers[2], ..Radar::default() };
    radar.validate().unwrap();
    let range = radar.max_range_metres();
    let scene = Scene::of_points((0..12).map(|i| (0.05 * range * f64::from(i - 6), 0.03 * range * f64::from(i + 8))));
    // The list of methods holds weights; they are no part of a map.
    let methods = methods::all();
    reset_peak_resident();
    let before = resident_bytes().unwrap_or(0);
    match *work {
        "export" => {
            let signal = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
            let folder = tempfile::tempdir().unwrap();
            write_maps(&folder.path().join("maps.npz"), &radar, &scene, &signal, None, None).unwrap();
        }
        "engine" => {
            let mut engine = Engine::new(radar.clone());
            for floor in [Floor::Thesis, Floor::Exact] {
                engine.update(&scene, &MapRequest { floor, ..MapRequest::default() }).unwrap();
            }
        }
        "candidates" => {
            let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
            let fista = Fista { candidates: 10_000, iterations: 2, ..Fista::default() };
            fista.reconstruct(&radar, &ends, &Request::default()).unwrap();
        }
        name => {
            let method = methods.iter().find(|m| m.name() == name).unwrap();
            let signal = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
            let _maybe_refused = method.reconstruct(&radar, &signal.two_ends(&radar), &Request::default());
        }
    }
    if let Some(peak) = peak_resident_bytes() {
        println!("\nheld {}", peak.saturating_sub(before));
    }
}

fn held(work: &str, radar: &Radar) -> Option<u64> {
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.args(["--exact", "memory::child", "--ignored", "--nocapture"]);
    child.env(CHILD_VARIABLE, format!("{work} {} {} {}", radar.elements, radar.samples, radar.end_elements));
    let output = child.output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{work}: {said} {}", String::from_utf8_lossy(&output.stderr));
    said.lines().find_map(|l| l.strip_prefix("held ")?.parse().ok())
}

fn check(work: &str, radar: &Radar, least: u64) {
    let Some(held) = held(work, radar) else {
        assert_ne!(std::env::consts::OS, "linux", "{work}: the peak was not told");
        return println!("skipped: the system tells no peaks");
    };
    let (cells, counted) = (radar.elements * radar.samples, radar.memory_bytes());
    println!(
        "{work}: {} elements, {} samples, ends of {}: {held} bytes held, {:.0} a cell, {counted} counted",
        radar.elements,
        radar.samples,
        radar.end_elements,
        held as f64 / cells as f64
    );
    assert!((least..=counted + OVERHEAD).contains(&held), "{work} held {held} bytes where {counted} are counted");
}

#[test]
fn memory_stays_below_what_is_counted() {
    let radar = Radar { elements: 1024, samples: 1024, ..Radar::default() };
    for work in ["export", "engine"] {
        // The samples of the whole array, or one map and its decades.
        check(work, &radar, 8 << 20);
    }
}

/// Candidates' Gram matrix is bounded at 268 MB; ten thousand would take 1600.
#[test]
fn ten_thousand_candidates_fit_into_bounded_memory() {
    let Some(held) = held("candidates", &Radar::default()) else { return };
    assert!((200_000_000..600_000_000).contains(&held), "{held} bytes");
}

#[test]
#[ignore = "long: every method on larger radars"]
fn every_method_stays_below_what_is_counted() {
    let large = Radar { elements: 2048, samples: 1024, ..Radar::default() };
    let wide_ends = Radar { elements: 1024, samples: 64, end_elements: 512, ..Radar::default() };
    for radar in [large, wide_ends] {
        for work in ["export", "engine"].into_iter().chain(methods::all().iter().map(|m| m.name())) {
            // A method may refuse the radar, and hold nothing.
            check(work, &radar, 0);
        }
    }
}
