//! A sentence about a map, for screen readers.

use super::subject::{Paint, Subject};
use crate::app::state::Cursor;
use crate::app::widgets::{angle_degrees, signed};
use crate::evaluate::TARGET_ETA;
use crate::picture::CellVerdict;
use crate::radar::{Radar, counted};
use ndarray::Array2;

/// Most peaks that a sentence names.
const MAX_NAMED_PEAKS: usize = 3;

/// Largest distance of a named peak below the highest cell, in Lambda.
const MAX_PEAK_DEPTH: f32 = 0.1;

/// Least distance between two named peaks, as ratios of the map's height and width.
const PEAK_DISTANCE_RATIO: [f32; 2] = [1.0 / 32.0, 1.0 / 10.0];

/// The peaks of a map, the number of detected cells, or the largest difference, as a sentence.
pub fn sentence(radar: &Radar, subject: &Subject) -> String {
    let (map, minus) = (&subject.map.lambda, subject.minus.as_ref().map(|m| &m.lambda));
    match (subject.paint, minus) {
        (Paint::Lambda(_), _) => peaks(radar, map),
        (Paint::Doubt(_), _) => doubt(radar, map),
        (Paint::Above { eta, .. }, None) => match map.iter().filter(|v| **v > eta).count() {
            0 => "No cell exceeds the threshold.".to_owned(),
            count => {
                format!("{} above the threshold; {}", counted(count, "cell", "cells"), lowered(&peaks(radar, map)))
            }
        },
        (Paint::Above { eta, .. }, Some(target)) => {
            let of = |kind| {
                map.iter().zip(target).filter(move |(v, t)| CellVerdict::of(**t > TARGET_ETA, **v > eta) == kind)
            };
            let [hits, alarms, misses] =
                [CellVerdict::Hit, CellVerdict::FalseAlarm, CellVerdict::Miss].map(|kind| of(kind).count());
            let alarms = counted(alarms, "false alarm", "false alarms");
            let hits = counted(hits, "cell", "cells");
            format!("{hits} hit, {alarms}, {misses} missed; {}", lowered(&peaks(radar, map)))
        }
        (Paint::Difference { .. }, Some(target)) => largest_difference(radar, map, target),
        (Paint::Difference { .. }, None) => "There is no target to compare with.".to_owned(),
    }
}

/// The mean of the expected errors and the places of the largest.
fn doubt(radar: &Radar, map: &Array2<f32>) -> String {
    let mean = map.mean().unwrap_or_default();
    format!("Expected errors of {mean:.3} on average; {}", lowered(&peaks(radar, map)))
}

fn lowered(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// A cell's range and direction in words.
fn place(radar: &Radar, (bin, column): (usize, usize)) -> String {
    let cursor = Cursor::at_cell(radar, bin as f64, column as f64);
    format!("{:.1} m, {}°", cursor.range_metres, signed(angle_degrees(cursor.cos_theta), 1))
}

/// The highest cells from the highest down, each away from the ones before it.
fn highest(map: &Array2<f32>) -> Vec<(usize, usize)> {
    let (rows, columns) = map.dim();
    let top = map.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let high: Vec<((usize, usize), f32)> =
        map.indexed_iter().filter(|(_, v)| **v >= top - MAX_PEAK_DEPTH).map(|(at, v)| (at, *v)).collect();
    let is_near = |a: (usize, usize), b: (usize, usize)| {
        a.0.abs_diff(b.0) as f32 <= PEAK_DISTANCE_RATIO[0] * rows as f32
            && a.1.abs_diff(b.1) as f32 <= PEAK_DISTANCE_RATIO[1] * columns as f32
    };
    let mut named: Vec<(usize, usize)> = Vec::new();
    while named.len() < MAX_NAMED_PEAKS {
        let free = high.iter().filter(|(at, _)| !named.iter().any(|before| is_near(*at, *before)));
        let Some((at, _)) = free.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        named.push(*at);
    }
    named
}

fn peaks(radar: &Radar, map: &Array2<f32>) -> String {
    let places: Vec<String> = highest(map).into_iter().map(|at| place(radar, at)).collect();
    match places.as_slice() {
        [] => "The map is empty.".to_owned(),
        [one] => format!("The peak is at {one}."),
        several => format!("Peaks, the highest first: {}.", several.join("; ")),
    }
}

fn largest_difference(radar: &Radar, map: &Array2<f32>, target: &Array2<f32>) -> String {
    let differences = map.indexed_iter().zip(target).map(|((at, v), t)| (at, v - t));
    match differences.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
        Some((at, by)) if by != 0.0 => {
            format!("The largest difference is {} at {}.", signed(f64::from(by), 2), place(radar, at))
        }
        _ => "Output and target are the same.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shared::Shared;
    use crate::app::state::{DifferenceView, Projection};
    use crate::maps::RangeAngleMap;
    use crate::picture::ColourMap;

    fn map(peaks: &[(usize, usize, f32)]) -> Shared<RangeAngleMap> {
        let mut lambda = Array2::from_elem((512, 1024), 0.2f32);
        peaks.iter().for_each(|(bin, column, value)| lambda[(*bin, *column)] = *value);
        Shared::new(RangeAngleMap { lambda })
    }

    fn said(paint: Paint, map: Shared<RangeAngleMap>, minus: Option<Shared<RangeAngleMap>>) -> String {
        let subject = Subject { map, minus, paint, projection: Projection::Cartesian, is_fine: false };
        sentence(&Radar::default(), &subject)
    }

    #[test]
    fn a_map_is_told_by_its_highest_peaks() {
        let radar = Radar::default();
        let bin = radar.bin_of_range(20.0).round() as usize;
        // The second peak is the flank of the first, and the last is too low to be named.
        let peaks = map(&[(bin, 512, 1.0), (bin + 1, 514, 0.99), (2 * bin / 3, 700, 0.95), (400, 100, 0.7)]);
        let told = said(Paint::Lambda(ColourMap::Grey), peaks, None);
        assert!(told.starts_with("Peaks, the highest first: 20.0 m, ±0.0°; 13.3 m, +2"), "{told}");
        assert_eq!(told.matches(" m, ").count(), 2, "{told}");
        let one = said(Paint::Lambda(ColourMap::Grey), map(&[(bin, 512, 1.0)]), None);
        assert_eq!(one, "The peak is at 20.0 m, ±0.0°.");
    }

    #[test]
    fn detections_are_counted() {
        let (output, target) = (map(&[(9, 9, 0.95), (99, 99, 0.9)]), map(&[(9, 9, 0.95), (200, 9, 1.0)]));
        let told = said(Paint::Above { eta: 0.8, dark: true }, output.clone(), Some(target));
        assert!(told.starts_with("1 cell hit, 1 false alarm, 1 missed; peaks"), "{told}");
        let told = said(Paint::Above { eta: 0.8, dark: true }, output, None);
        assert!(told.starts_with("2 cells above the threshold; peaks"), "{told}");
    }

    #[test]
    fn a_difference_is_told_where_it_is_largest() {
        let radar = Radar::default();
        let bin = radar.bin_of_range(10.0).round() as usize;
        let paint = Paint::Difference { view: DifferenceView::default(), colours: ColourMap::Grey, beside: 0.0 };
        let told = said(paint, map(&[(bin, 512, 0.1)]), Some(map(&[])));
        assert_eq!(told, "The largest difference is −0.10 at 10.0 m, ±0.0°.");
        assert_eq!(said(paint, map(&[]), Some(map(&[]))), "Output and target are the same.");
    }
}
