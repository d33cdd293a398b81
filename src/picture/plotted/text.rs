//! Text on pictures, in fonts that come with the program: a picture looks the same on every machine.

use super::canvas::{Painted, PanelArea, PictureError};
use super::lettering::{BOLD, NORMAL};
use crate::platform::register_font;
use plotters::prelude::*;
use plotters::style::FontStyle;
use std::sync::OnceLock;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Weight {
    Normal,
    Bold,
}

pub(super) const FAMILY: &str = "sans-serif";

/// Makes the embedded fonts known to plotters; does nothing the second time.
/// # Errors
/// [`PictureError`] when an embedded font can't be read.
pub fn register_fonts() -> Painted {
    static DONE: OnceLock<Painted> = OnceLock::new();
    DONE.get_or_init(|| {
        let broken = |_| PictureError::new("the embedded font is broken");
        register_font(FAMILY, FontStyle::Normal, NORMAL).map_err(broken)?;
        register_font(FAMILY, FontStyle::Bold, BOLD).map_err(broken)
    })
    .clone()
}

pub(super) fn style(size: i32, weight: Weight, colour: &RGBColor) -> TextStyle<'static> {
    let style = match weight {
        Weight::Normal => FontStyle::Normal,
        Weight::Bold => FontStyle::Bold,
    };
    FontDesc::new(FontFamily::Name(FAMILY), f64::from(size), style).color(colour)
}

pub(super) fn line<B: DrawingBackend>(
    area: &PanelArea<B>,
    at: (i32, i32),
    text: &str,
    size: i32,
    weight: Weight,
    colour: &RGBColor,
) -> Painted {
    Ok(area.draw(&Text::new(text.to_owned(), at, style(size, weight, colour)))?)
}

pub(super) fn fitted<B: DrawingBackend>(
    area: &PanelArea<B>,
    text: &str,
    size: i32,
    weight: Weight,
    width: u32,
) -> Result<String, PictureError> {
    let style = style(size, weight, &RGBColor(0, 0, 0));
    let mut shown = text.to_owned();
    let mut kept = text.chars().count();
    while area.estimate_text_size(&shown, &style)?.0 > width && kept > 0 {
        kept -= 1;
        shown = text.chars().take(kept).chain(['\u{2026}']).collect();
    }
    Ok(shown)
}

pub(super) fn paragraphs<B: DrawingBackend>(
    area: &PanelArea<B>,
    at: (i32, i32),
    text: &str,
    size: i32,
    colour: &RGBColor,
) -> Painted {
    let (width, height) = area.dim_in_pixel();
    let style = style(size, Weight::Normal, colour);
    let step = size * 4 / 3;
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut current = String::new();
        for word in paragraph.split_whitespace() {
            let word = fitted(area, word, size, Weight::Normal, width.saturating_sub(at.0 as u32))?;
            let longer = if current.is_empty() { word.clone() } else { format!("{current} {word}") };
            let (needed, _) = area.estimate_text_size(&longer, &style)?;
            if needed + at.0 as u32 > width && !current.is_empty() {
                lines.push(std::mem::replace(&mut current, word));
            } else {
                current = longer;
            }
        }
        lines.push(current);
    }
    let room = ((height as i32 - at.1) / step).max(1) as usize;
    if lines.len() > room {
        lines.truncate(room);
        if let Some(last) = lines.last_mut() {
            last.push_str(" \u{2026}");
        }
    }
    for (number, text) in lines.iter().enumerate() {
        let place = (at.0, at.1 + number as i32 * step);
        area.draw(&Text::new(text.as_str(), place, style.clone()))?;
    }
    Ok(())
}
