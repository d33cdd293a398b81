//! Figures 2-1 to 2-3, 2-6, 2-7 and 2-10: chirps, windows, plane waves and the angle spectrum.

use super::sheet::{Ink, Series, Sheet, SheetAxis, SheetPanel, SketchShape, Stroke};
use super::source::{FigureError, SceneSource};
use crate::maps::{Aperture, Spectrum, angle_transform, range_transform};
use crate::radar::{End, SPEED_OF_LIGHT, WindowFunction};
use crate::scene::Scene;
use crate::signal::Floor;
use num_complex::Complex64;

fn decibels(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let values: Vec<f64> = values.into_iter().collect();
    let peak = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    values.into_iter().map(|v| 20.0 * (v.max(1e-18 * peak) / peak).log10()).collect()
}

/// Transmitted and received chirp, and the difference frequency at the mixer's output.
pub fn chirps(source: &SceneSource) -> Result<Sheet, FigureError> {
    let (range, bandwidth, carrier) = (21.0, source.radar.bandwidth_hz / 1e9, source.radar.carrier_hz / 1e9);
    // A chirp of 1 microsecond, so that the delay is wider than the line.
    let (chirp, delay) = (1.0, 2.0 * range / SPEED_OF_LIGHT * 1e6);
    let ramp = |start: f64| [(start, carrier), (start + chirp, carrier + bandwidth)];
    let sent = Series::line("transmitted", ramp(0.0));
    let received = Series::line("received", ramp(delay)).with(Stroke::Dashed);
    let time = || SheetAxis::new("time (µs)", 0.0, chirp + delay);
    let sweep = SheetAxis::new("frequency (GHz)", carrier - 0.1, carrier + bandwidth + 0.4);
    let top = SheetPanel::chart("Chirp and its echo from 21 m", time(), sweep, vec![sent, received]);
    let beat = bandwidth * 1e3 * delay / chirp;
    let mixer = Series::line("", [(delay, beat), (chirp, beat)]);
    let bottom =
        SheetPanel::chart("Mixer output", time(), SheetAxis::new("frequency (MHz)", 0.0, 1.5 * beat), vec![mixer]);
    Ok(Sheet::of(1, (760, 300), vec![top, bottom]))
}

pub fn range_profile(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.see_over(Scene::of_points([(0.0, 21.0)]), Floor::Exact)?;
    let profiles = range_transform(&source.radar, &seen.signal).profiles;
    let profile = decibels(profiles.row(source.radar.elements / 2).iter().map(|v| v.norm()));
    let points = profile.into_iter().enumerate().map(|(k, db)| (source.radar.range_of_bin_metres(k as f64), db));
    let y = SheetAxis::new("magnitude (dB)", -120.0, 5.0);
    let series = vec![Series::line("", points)];
    let panel = SheetPanel::chart("One element, Hann window, 512 samples", source.range_axis(), y, series);
    Ok(Sheet::of(1, (760, 380), vec![panel]))
}

pub fn plane_wave(_: &SceneSource) -> Result<Sheet, FigureError> {
    let angle = 60f64.to_radians();
    let (ux, uy) = (angle.cos(), angle.sin());
    let mut shapes = vec![SketchShape::Line(vec![(-0.6, 0.0), (5.6, 0.0)], Ink::Pale)];
    for n in 0..6 {
        let x = f64::from(n);
        shapes.push(SketchShape::Arrow((x + 3.0 * ux, 3.0 * uy), (x + 0.06 * ux, 0.06 * uy), Ink::Second));
        shapes.push(SketchShape::Dot((x, 0.0), 7, Ink::Dark));
    }
    // The wavefront through element 1 meets element 0's ray d cos(theta) before that element.
    shapes.push(SketchShape::Line(vec![(0.0, 0.0), (ux * ux, ux * uy)], Ink::Accent));
    shapes.push(SketchShape::Line(vec![(1.0, 0.0), (ux * ux, ux * uy)], Ink::Pale));
    shapes.push(SketchShape::Words((-0.35, 0.42), "d cos θ".to_owned(), Ink::Accent));
    shapes.push(SketchShape::Words((0.5, -0.22), "d".to_owned(), Ink::Dark));
    let arc = (0..=20).map(|i| f64::from(i) / 20.0 * angle).map(|a| (5.0 + 0.6 * a.cos(), 0.6 * a.sin()));
    shapes.push(SketchShape::Line(arc.collect(), Ink::Dark));
    shapes.push(SketchShape::Words((5.75, 0.45), "θ".to_owned(), Ink::Dark));
    let panel = SheetPanel::sketch("A plane wave reaches one element after the other", -1.0..7.2, -0.5..3.0, shapes);
    Ok(Sheet::of(1, (760, 360), vec![panel]))
}

pub fn windows(_: &SceneSource) -> Result<Sheet, FigureError> {
    const POINTS: usize = 64;
    const PADDED_LENGTH: usize = 4096;
    let strokes = [Stroke::Solid, Stroke::Dashed, Stroke::Solid, Stroke::Dashed];
    let spectrum = Spectrum::new(PADDED_LENGTH);
    let (mut weights, mut transforms) = (Vec::new(), Vec::new());
    for (window, stroke) in WindowFunction::ALL.into_iter().zip(strokes) {
        let values = window.weights(POINTS);
        let lobes = decibels(spectrum.of(values.iter().map(|w| Complex64::from(*w))).into_iter().map(|v| v.norm()));
        let bins = POINTS as f64 / PADDED_LENGTH as f64;
        let shown =
            lobes.into_iter().take(PADDED_LENGTH / 4).enumerate().map(|(k, db)| (k as f64 * bins, db.max(-120.0)));
        weights
            .push(Series::line(window.name(), values.into_iter().enumerate().map(|(n, w)| (n as f64, w))).with(stroke));
        transforms.push(Series::line(window.name(), shown).with(stroke));
    }
    let (x, y) = (SheetAxis::new("n", 0.0, 63.0), SheetAxis::new("weight", 0.0, 1.4));
    let left = SheetPanel::chart("Windows of 64 points", x, y, weights);
    let (x, y) = (SheetAxis::new("frequency, in bins", 0.0, 16.0), SheetAxis::new("magnitude (dB)", -120.0, 5.0));
    Ok(Sheet::of(2, (560, 380), vec![left, SheetPanel::chart("Their transforms", x, y, transforms)]))
}

/// Angle spectrum at one range with 12 and with 1024 elements: two points at cos(theta) 0.35 and 0.5.
pub fn angle_spectra(source: &SceneSource) -> Result<Sheet, FigureError> {
    let range = 20.0;
    let place = |cos: f64| (range * cos, range * (1.0 - cos * cos).sqrt());
    let seen = source.see_over(Scene::of_points([place(0.35), place(0.5)]), Floor::Exact)?;
    let profiles = range_transform(&source.radar, &seen.signal);
    let row = source.radar.bin_of_range(range).round() as usize;
    let panel = |title: &str, aperture| {
        let map = angle_transform(&source.radar, &profiles, aperture).cells;
        let spectrum = decibels(map.row(row).iter().map(|v| v.norm()));
        let points = spectrum.into_iter().enumerate().map(|(k, db)| (source.radar.cos_of_column(k as f64), db));
        let y = SheetAxis::new("magnitude (dB)", -80.0, 5.0);
        SheetPanel::chart(title, SheetAxis::new("cos θ", -1.0, 1.0), y, vec![Series::line("", points)])
    };
    let panels = vec![panel("12 elements", Aperture::End(End::First)), panel("1024 elements", Aperture::Full)];
    Ok(Sheet::of(2, (560, 360), panels))
}

pub fn near_paths(source: &SceneSource) -> Result<Sheet, FigureError> {
    let half = source.radar.aperture_metres() / 2.0;
    let at = (0.9, 2.2);
    let elements: Vec<f64> = (0..9).map(|i| half * (f64::from(i) / 4.0 - 1.0)).collect();
    let array = || elements.iter().map(|x| SketchShape::Dot((*x, 0.0), 6, Ink::Dark));
    let mut assumed: Vec<SketchShape> =
        elements.iter().map(|x| SketchShape::Line(vec![(*x, 0.0), (x + at.0, at.1)], Ink::Second)).collect();
    assumed.extend(array());
    let mut true_paths: Vec<SketchShape> =
        elements.iter().map(|x| SketchShape::Line(vec![(*x, 0.0), at], Ink::Accent)).collect();
    true_paths.extend(array());
    true_paths.push(SketchShape::Dot(at, 8, Ink::Accent));
    let panels = vec![
        SheetPanel::sketch("Assumed: one direction for all elements", -1.3..2.1, -0.2..2.5, assumed),
        SheetPanel::sketch("True: a reflector at (0.9, 2.2) m before a 2 m array", -1.3..2.1, -0.2..2.5, true_paths),
    ];
    Ok(Sheet::of(2, (560, 400), panels))
}
