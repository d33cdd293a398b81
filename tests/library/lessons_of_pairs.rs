//! The numbers that the lesson on pairs of antennas teaches, computed again: each must stand in its text as it comes out here.

use crate::prelude::*;
use crate::taught::{lesson, taught};
use apertura::lesson::Step;

const PAIRS: &str = "pairs-of-antennas";

fn target(radar: &Radar, step: &Step) -> LogMap {
    LogMaps::of_signal(radar, &simulate(radar, &step.scene(), Floor::Exact, 0).unwrap()).full
}

/// Columns of the brightest row that are within 10 dB of its peak.
fn width_columns(map: &LogMap) -> usize {
    let row = map.decades().outer_iter().find(|row| row.iter().any(|v| *v == map.max())).unwrap();
    row.iter().filter(|v| 20.0 * (**v - map.max()) > -10.0).count()
}

fn right_option(step: &Step) -> &str {
    match &step.predict.as_ref().unwrap().answer {
        Answer::Choice { options, right } => &options[*right - 1],
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_antennas_are_as_many_as_the_lesson_says() {
    let lesson = lesson(PAIRS);
    let radar = lesson.steps[0].radar.clone();
    let antennas = radar.antennas.as_ref().unwrap();
    for (what, x) in [("transmitters", antennas.transmitter_x_metres()), ("receivers", antennas.receiver_x_metres())] {
        taught(PAIRS, &format!("{} {what} on {:.0} cm", x.len(), 100.0 * (x[x.len() - 1] - x[0])));
    }
    taught(PAIRS, &format!("fill a line of {:.0} cm", 100.0 * radar.aperture_metres()));
    assert_eq!(right_option(&lesson.steps[0]), radar.elements.to_string());
}

#[test]
fn the_blob_of_a_near_point_is_as_wide_as_the_lesson_says() {
    let lesson = lesson(PAIRS);
    let step = &lesson.steps[1];
    let pairs = step.radar.clone();
    let alone = Radar { antennas: None, ..pairs.clone() };
    taught(PAIRS, &format!("blob is {} columns wide at -10 dB", width_columns(&target(&alone, step))));
    assert_eq!(right_option(step), format!("{} columns", width_columns(&target(&pairs, step))));
}

#[test]
fn the_far_field_of_the_pairs_begins_where_the_lesson_says() {
    let lesson = lesson(PAIRS);
    let step = &lesson.steps[2];
    let alone = Radar { antennas: None, ..step.radar.clone() };
    taught(PAIRS, &format!("4 D² / λ = {:.0} m", alone.far_field_metres()));
    assert_eq!(right_option(step), format!("{:.0} m", step.radar.far_field_metres()));
}
