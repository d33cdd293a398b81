//! Figures 1-2, 2-2, 2-6 and 2-7: sparse bands, a range profile, windows and the angle spectrum.

use super::sheet::{Series, Sheet, SheetAxis, SheetPanel, Stroke};
use super::source::{FigureError, SceneSource};
use crate::maps::{Aperture, Spectrum, angle_transform, range_transform};
use crate::radar::{End, WindowFunction};
use crate::scene::{Object, Point, Scene};
use crate::signal::Floor;
use num_complex::Complex64;

fn decibels(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let values: Vec<f64> = values.into_iter().collect();
    let peak = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    values.into_iter().map(|v| 20.0 * (v.max(1e-18 * peak) / peak).log10()).collect()
}

/// A signal that is non-zero in a few bands: one element's beat signal of three groups of points.
pub fn band_sparsity(source: &SceneSource) -> Result<Sheet, FigureError> {
    let groups = [(7.0, 3), (18.0, 6), (31.0, 4)];
    let points = groups.iter().flat_map(|(start, count)| (0..*count).map(move |i| start + 0.4 * f64::from(i)));
    // Reflectivities undo the fall of 1/R^2, so that all bands are equally high.
    let object = |range: f64| Object::Point(Point { reflectivity: range * range / 100.0, ..Point::new(0.0, range) });
    let scene = Scene { objects: points.map(object).collect(), ..Scene::default() };
    let seen = source.see_over(scene, Floor::Exact)?;
    let profiles = range_transform(&source.radar, &seen.signal).profiles;
    let middle = source.radar.elements / 2;
    let peak = profiles.row(middle).iter().map(|v| v.norm()).fold(0.0, f64::max);
    let samples = source.radar.samples as f64;
    let spectrum =
        profiles.row(middle).iter().enumerate().map(|(k, v)| (k as f64 / samples, v.norm() / peak)).collect::<Vec<_>>();
    let x = SheetAxis::new("frequency, in parts of the sampling rate", 0.0, 1.0);
    let y = SheetAxis::new("magnitude", 0.0, 1.1);
    let title = "Beat signal of three groups of points: three bands";
    Ok(Sheet::of(1, (760, 380), vec![SheetPanel::chart(title, x, y, vec![Series::line("", spectrum)])]))
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

pub fn windows(_: &SceneSource) -> Result<Sheet, FigureError> {
    const WAVE_POINTS: usize = 64;
    const PADDED_LENGTH: usize = 4096;
    let strokes = [Stroke::Solid, Stroke::Dashed, Stroke::Solid, Stroke::Dashed];
    let spectrum = Spectrum::new(PADDED_LENGTH);
    let (mut weights, mut transforms) = (Vec::new(), Vec::new());
    for (window, stroke) in WindowFunction::ALL.into_iter().zip(strokes) {
        let values = window.weights(WAVE_POINTS);
        let lobes = decibels(spectrum.of(values.iter().map(|w| Complex64::from(*w))).into_iter().map(|v| v.norm()));
        let bins = WAVE_POINTS as f64 / PADDED_LENGTH as f64;
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
