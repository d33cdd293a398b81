//! Figures 5-1 and 5-2: differences that the squared error does not show.

use super::sheet::{Series, Sheet, SheetAxis, SheetPanel, Stroke};
use super::source::{FigureError, SceneSource};

const LENGTH: usize = 512;

fn deltas(places: &[usize], height: f64) -> Vec<f64> {
    (0..LENGTH).map(|n| if places.contains(&n) { height } else { 0.0 }).collect()
}

fn squared_error(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

fn stems(name: &'static str, values: &[f64], from: usize, to: usize) -> Series {
    let shown = values.iter().enumerate().skip(from).take(to - from).filter(|(_, v)| **v != 0.0);
    Series::line(name, shown.map(|(n, v)| (n as f64, *v)).collect::<Vec<_>>()).with(Stroke::Stems)
}

/// Two deltas, an estimate shifted by one sample and a flat one: equal squared errors.
pub fn equal_errors(_: &SceneSource) -> Result<Sheet, FigureError> {
    let truth = deltas(&[200, 250], 1.0);
    let shifted = deltas(&[201, 251], 1.0);
    // N c^2 - 4 c + 2 = 4: the flat estimate whose squared error is 4 too.
    let n = LENGTH as f64;
    let level = (4.0 + (16.0 + 8.0 * n).sqrt()) / (2.0 * n);
    let flat = vec![level; LENGTH];
    let panel = |title: String, series| {
        SheetPanel::chart(title, SheetAxis::new("n", 180.0, 270.0), SheetAxis::new("y", -0.1, 1.3), vec![series])
    };
    let line =
        Series::line("", flat.iter().enumerate().map(|(n, v)| (n as f64, *v)).skip(180).take(91).collect::<Vec<_>>());
    let error = |estimate: &[f64]| format!("squared error {:.2}", squared_error(&truth, estimate));
    let panels = vec![
        panel("y = δ[n-200] + δ[n-250]".to_owned(), stems("", &truth, 180, 271)),
        panel(format!("Shifted by one sample: {}", error(&shifted)), stems("", &shifted, 180, 271)),
        panel(format!("Flat, {level:.4}: {}", error(&flat)), line),
    ];
    Ok(Sheet::of(3, (460, 340), panels))
}

pub fn denser_costs_more(_: &SceneSource) -> Result<Sheet, FigureError> {
    let sparse: Vec<usize> = vec![205, 240];
    let dense: Vec<usize> = (0..10).map(|i| 194 + 7 * i).collect();
    let panel = |name: &str, places: &[usize]| {
        let (truth, estimate) = (deltas(places, 1.0), deltas(places, 1.2));
        let title = format!("{name}: squared error {:.2}", squared_error(&truth, &estimate));
        let series = vec![stems("estimate", &estimate, 180, 271), stems("truth", &truth, 180, 271)];
        SheetPanel::chart(title, SheetAxis::new("n", 180.0, 270.0), SheetAxis::new("y", -0.1, 1.7), series)
    };
    Ok(Sheet::of(2, (520, 360), vec![panel("Two points", &sparse), panel("Ten points", &dense)]))
}
