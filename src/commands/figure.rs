//! Charts as files: every figure is drawn once as SVG and once as PNG.

use super::{CommandError, write_file};
use crate::picture::{self, encode_png};
use image::RgbImage;
use plotters::coord::Shift;
use plotters::prelude::*;
use serde::Serialize;
use std::path::Path;

/// The result of drawing a figure.
pub type DrawingResult<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// A figure that can be drawn on any of plotters' areas.
pub trait Plot {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> DrawingResult<B>;
}

/// Writes `STEM.svg` and `STEM.png` into `folder`, which is made where it is missing.
pub fn save(figure: &impl Plot, folder: &Path, stem: &str) -> Result<(), CommandError> {
    ready(folder)?;
    let mut svg = String::new();
    on_white(figure, SVGBackend::with_string(&mut svg, figure.size())).map_err(|e| undrawn(stem, &e))?;
    write(folder, stem, "svg", svg.as_bytes())?;
    save_bitmap(figure, folder, stem)
}

/// Writes `STEM.png` alone: for figures of so many cells that an SVG would be larger than its pixels.
pub fn save_bitmap(figure: &impl Plot, folder: &Path, stem: &str) -> Result<(), CommandError> {
    ready(folder)?;
    let (width, height) = figure.size();
    let mut pixels = vec![0; (3 * width * height) as usize];
    on_white(figure, BitMapBackend::with_buffer(&mut pixels, (width, height))).map_err(|e| undrawn(stem, &e))?;
    let bitmap = RgbImage::from_raw(width, height, pixels).ok_or_else(|| undrawn(stem, &"its size is out of range"))?;
    write(folder, stem, "png", &encode_png(&bitmap)?)
}

pub fn save_numbers(numbers: &impl Serialize, folder: &Path, stem: &str) -> Result<(), CommandError> {
    let text = serde_json::to_string_pretty(numbers)?;
    write(folder, stem, "json", text.as_bytes())
}

/// A number beside an axis, as short as possible: 0.3 and not 0.30000000000000004.
pub fn tick(value: &f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) {
        return format!("{value:.1e}").replace(".0e", "e");
    }
    let text = format!("{value:.6}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

fn ready(folder: &Path) -> Result<(), CommandError> {
    std::fs::create_dir_all(folder).map_err(CommandError::on(folder))?;
    Ok(picture::register_fonts()?)
}

fn write(folder: &Path, stem: &str, extension: &str, bytes: &[u8]) -> Result<(), CommandError> {
    write_file(&folder.join(format!("{stem}.{extension}")), bytes)
}

fn undrawn(stem: &str, error: &dyn std::fmt::Display) -> CommandError {
    CommandError(format!("can't draw {stem}: {error}"))
}

fn on_white<B: DrawingBackend>(figure: &impl Plot, backend: B) -> DrawingResult<B> {
    let area = backend.into_drawing_area();
    area.fill(&WHITE)?;
    figure.draw(&area)?;
    area.present()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beside_an_axis_are_short() {
        let numbers = [0.1 + 0.2, 100.0, 0.0, -0.0, -2.5, 1e-12, 3e7, 2.5e6, 0.0001, 70.0 * 0.01];
        let texts = ["0.3", "100", "0", "0", "-2.5", "1e-12", "3e7", "2.5e6", "0.0001", "0.7"];
        assert_eq!(numbers.map(|n| tick(&n)), texts);
    }
}
