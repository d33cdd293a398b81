//! Charts as files: every figure is drawn once as SVG and once as PNG.

use super::{CommandError, write_file};
use crate::files::make_folder;
use crate::picture::{Drawing, PictureFormat};
use serde::Serialize;
use std::path::Path;

/// Writes `STEM.svg` and `STEM.png` into `folder`, which is made where it is missing.
pub fn save(figure: &impl Drawing, folder: &Path, stem: &str) -> Result<(), CommandError> {
    make_folder(folder).map_err(CommandError::on(folder))?;
    write(folder, stem, "svg", &PictureFormat::Svg.bytes_of(figure)?)?;
    save_bitmap(figure, folder, stem)
}

/// Writes `STEM.png` alone: for figures of so many cells that an SVG would be larger than its pixels.
pub fn save_bitmap(figure: &impl Drawing, folder: &Path, stem: &str) -> Result<(), CommandError> {
    make_folder(folder).map_err(CommandError::on(folder))?;
    write(folder, stem, "png", &PictureFormat::Png.bytes_of(figure)?)
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

fn write(folder: &Path, stem: &str, extension: &str, bytes: &[u8]) -> Result<(), CommandError> {
    write_file(&folder.join(format!("{stem}.{extension}")), bytes)
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
