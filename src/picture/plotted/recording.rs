//! Pictures of recordings: the panels of a scene, or curves over direction where there is one snapshot.

use super::compose::carrier_words;
use super::error::Composed;
use super::inputs::layout_samples;
use super::{ComposeError, Curve, DetectedCells, DirectionAxis, InputMap, Mark, Panels, PictureFormat, Style};
use crate::maps::{LogMap, LogMaps, Normalisation, Spectrum, channels_map};
use crate::radar::{BuiltArray, Decibels, End, LayoutKind, Radar};
use crate::reconstruct::found::reconstruct_and_find;
use crate::reconstruct::{Detection, NoisePrior, Reconstructor, Request};
use crate::recording::{Recorded, Recording};
use crate::scene::{Object, Point, Reflector, Scene};
use crate::signal::{BeatSignal, LayoutSamples};
use ndarray::{ArrayView1, ArrayView2, Axis};
use num_complex::Complex64;
use plotters::style::RGBColor;
use std::sync::Arc;

const MAX_DRAWN_DETECTIONS: usize = 64;

/// Columns that a snapshot's curves are padded to.
const FINE_COLUMNS: usize = 8192;

const CURVE_RANGE: Decibels = Decibels(60.0);

const ALL_ELEMENTS: RGBColor = RGBColor(120, 128, 138);
const ONE_END: RGBColor = RGBColor(226, 146, 38);
const METHOD: RGBColor = RGBColor(24, 92, 168);

/// Maps of both ends, and of the whole array where all its elements were recorded.
pub fn maps_of(recording: &Recording) -> ([LogMap; 2], Option<LogMap>) {
    let radar = &recording.radar;
    match &recording.samples {
        Recorded::All(signal) => {
            let LogMaps { first, last, full } = LogMaps::of_signal(radar, signal);
            ([first, last], Some(full))
        }
        Recorded::Ends(ends) => (End::BOTH.map(|end| channels_map(radar, ends.end(end).view()).log_magnitude()), None),
    }
}

/// Reconstructs from the recording's two ends and draws the panels or curves; the bytes of a file.
/// # Errors
/// [`ComposeError`] when the method fails or the picture can't be drawn.
pub fn compose_recording(
    recording: &Recording,
    method: &dyn Reconstructor,
    style: &Style,
    format: PictureFormat,
) -> Composed {
    let composed = if recording.is_snapshot() { curves } else { panels };
    composed(recording, method, style, format)
}

fn request(recording: &Recording, style: &Style, layout_samples: Option<Arc<LayoutSamples>>) -> Request {
    let (normalisation, snapshot_range_metres) = (style.normalisation, recording.range_metres);
    Request { noise: NoisePrior::UNKNOWN, normalisation, snapshot_range_metres, layout_samples, ..Request::default() }
}

fn panels(recording: &Recording, method: &dyn Reconstructor, style: &Style, format: PictureFormat) -> Composed {
    let radar = &recording.radar;
    let ([first, last], full) = maps_of(recording);
    let shown = (style.layout.as_ref(), style.normalisation);
    let (layout_samples, inputs) =
        InputMap::of(radar, &BuiltArray::default(), recording.signal(), [&first, &last], shown)?;
    let request = request(recording, style, layout_samples);
    let (output, found) = reconstruct_and_find(method, radar, &recording.two_ends(), &request)?;
    let target = full.as_ref().map(|map| map.normalise(style.normalisation));
    let detect = |cfar| {
        let (Some(full), Some(target)) = (&full, &target) else { return Err(ComposeError::DetectorAlone) };
        Ok(DetectedCells::of(cfar, full.scale(style.normalisation), [target, &output.lambda])?)
    };
    let detected = style.cfar.map(detect).transpose()?;
    let (name, notes) = (recording.name.clone(), recording.notes.clone());
    let objects = found.iter().take(MAX_DRAWN_DETECTIONS).map(|f| Object::Point(point(f))).collect();
    let scene = Scene { name, notes, objects, ..Scene::default() };
    let carrier = carrier_words(radar);
    let missing = match recording.missing.len() {
        0 => String::new(),
        n => format!(", {n} missing"),
    };
    let about =
        format!("recorded by {} elements{missing}, {carrier}, normalisation {}", radar.elements, style.normalisation);
    let panels = Panels {
        scene: &scene,
        found: Some(&found),
        radar,
        about: &about,
        inputs: &inputs,
        target: target.as_ref(),
        output: &output.lambda,
        method: method.name(),
        etas: [style.eta.unwrap_or_else(|| method.eta_of(&output)), style.target_eta],
        verdicts: None,
        detected: detected.as_ref(),
        colours: style.colours,
    };
    Ok(format.bytes_of(&panels)?)
}

fn point(found: &Detection) -> Point {
    let Reflector { x_metres, y_metres, .. } = found.reflector();
    Point::new(x_metres, y_metres)
}

fn curves(recording: &Recording, method: &dyn Reconstructor, style: &Style, format: PictureFormat) -> Composed {
    let radar = &recording.radar;
    let ends = recording.two_ends();
    let in_decibels = Style { normalisation: Normalisation::DynamicRange(CURVE_RANGE), ..style.clone() };
    let of_layout = |layout: &LayoutKind| layout_samples(radar, recording.signal(), layout);
    let layout_samples = style.layout.as_ref().map(of_layout).transpose()?;
    let request = request(recording, &in_decibels, layout_samples);
    let (output, found) = reconstruct_and_find(method, radar, &ends, &request)?;
    let of_samples = |name, samples: ArrayView2<'_, Complex64>, colour| Curve {
        name,
        points: beam_pattern(radar, samples.index_axis_move(Axis(1), 0)),
        colour,
    };
    let all = |signal: &BeatSignal| {
        of_samples(format!("all {} elements", radar.elements), signal.samples.view(), ALL_ELEMENTS)
    };
    let mut curves: Vec<Curve> = recording.signal().map(all).into_iter().collect();
    curves.push(of_samples(format!("{} elements of one end", radar.end_elements), ends.first.view(), ONE_END));
    let row = output.lambda.lambda.index_axis(Axis(0), 0);
    let decibels = row.iter().map(|v| (f64::from(*v) - 1.0) * CURVE_RANGE.0).collect();
    let name = format!("{} of {} + {} elements", method.name(), radar.end_elements, radar.end_elements);
    curves.push(Curve { name, points: over_degrees(radar, decibels), colour: METHOD });
    let range = recording.range_metres.unwrap_or_default();
    let mark = |f: &Detection| Mark { angle_degrees: degrees(f.cos_theta), below_strongest_db: f.relative_power.0 };
    let found: Vec<Mark> = found.iter().map(mark).collect();
    let about =
        format!("one snapshot at about {range} m, {} elements; found by {}: stems", radar.elements, method.name());
    let picture = DirectionAxis { name: &recording.name, about: &about, curves: &curves, found: &found };
    Ok(format.bytes_of(&picture)?)
}

fn degrees(cos_theta: f64) -> f64 {
    cos_theta.clamp(-1.0, 1.0).asin().to_degrees()
}

/// Decibels over degrees, from one value a column of a map of so many columns; directions beyond end-fire are left out.
fn over_degrees(radar: &Radar, decibels: Vec<f64>) -> Vec<(f64, f64)> {
    let fine = Radar { elements: decibels.len(), ..radar.clone() };
    let place = |(column, db): (usize, f64)| (fine.cos_of_column(column as f64), db);
    let seen = decibels.into_iter().enumerate().map(place).filter(|(cos, _)| cos.abs() <= 1.0);
    let mut points: Vec<(f64, f64)> = seen.map(|(cos, db)| (degrees(cos), db)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// Decibels over degrees of plain beamforming with neighbouring elements, under the radar's window.
fn beam_pattern(radar: &Radar, samples: ArrayView1<'_, Complex64>) -> Vec<(f64, f64)> {
    let window = radar.window.weights(samples.len());
    let mut beams = Spectrum::new(FINE_COLUMNS).of(samples.iter().zip(window).map(|(v, w)| v * w));
    beams.rotate_right(FINE_COLUMNS / 2);
    let strongest = beams.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.norm()));
    over_degrees(radar, beams.iter().map(|v| 20.0 * (v.norm() / strongest).max(1e-20).log10()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::Baseline;
    use crate::recording::presets::Preset;

    #[test]
    fn only_the_whole_array_separates_both_directions() {
        let recording = Preset::by_id("cascade-86").unwrap().load().unwrap();
        let tops = |points: &[(f64, f64)]| -> Vec<f64> {
            let top = |w: &&[(f64, f64)]| w[1].1 > -6.0 && w[1].1 > w[0].1 && w[1].1 > w[2].1;
            points.windows(3).filter(top).map(|w| w[1].0).collect()
        };
        let signal = recording.signal().unwrap();
        let all = tops(&beam_pattern(&recording.radar, signal.samples.index_axis(Axis(1), 0)));
        assert_eq!(all.len(), 2, "{all:?}");
        assert!(all[0].abs() < 0.1 && (all[1] - 7.0).abs() < 0.1, "{all:?}");
        let end = tops(&beam_pattern(&recording.radar, recording.two_ends().first.index_axis(Axis(1), 0)));
        assert!(end.len() == 1 && (2.0..6.0).contains(&end[0]), "{end:?}");
    }

    #[test]
    fn recordings_are_drawn_with_or_without_a_target() {
        let mut recording = Preset::by_id("chip-8").unwrap().load().unwrap();
        let svg = |r: &Recording| {
            let bytes = compose_recording(r, &Baseline, &Style::default(), PictureFormat::Svg).unwrap();
            String::from_utf8(bytes).unwrap()
        };
        assert!(svg(&recording).contains("Target: all 8 elements"));
        recording.samples = Recorded::Ends(recording.two_ends());
        assert!(!svg(&recording).contains("Target"));
    }
}
