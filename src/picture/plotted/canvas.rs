//! Drawing tools shared by all panels of a picture.

use crate::picture::colour::Rgb;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::fmt::Display;

/// A picture could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("can't draw the picture: {0}")]
pub struct PictureError(String);

impl PictureError {
    pub(crate) fn new(error: impl Display) -> Self {
        PictureError(error.to_string())
    }
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for PictureError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        PictureError::new(error)
    }
}

pub type Painted = Result<(), PictureError>;

pub type PanelArea<B> = DrawingArea<B, Shift>;

pub(super) const INK: RGBColor = RGBColor(28, 32, 38);
pub(super) const FAINT_INK: RGBColor = RGBColor(104, 112, 122);
pub(super) const HAIRLINE: RGBColor = RGBColor(206, 211, 217);
pub(super) const PAPER: RGBColor = RGBColor(252, 252, 250);

/// A drawing for bitmaps and SVG, on paper.
pub trait Drawing {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws itself.
    /// # Errors
    /// [`PictureError`] when plotters can't draw.
    fn draw<B: DrawingBackend>(&self, root: &PanelArea<B>) -> Painted;
}

/// RGB pixels, the top row first, of cells `[rows from below, columns]`. `colour` gives a pixel its colour from the cells under it, one at least.
pub fn painted(
    [width, height]: [usize; 2],
    (rows, columns): (usize, usize),
    colour: impl Fn(&mut dyn Iterator<Item = [usize; 2]>) -> Rgb,
) -> Vec<u8> {
    let under = |i: usize, n: usize, cells: usize| {
        let start = i * cells / n;
        start..((i + 1) * cells / n).max(start + 1)
    };
    let mut pixels = Vec::with_capacity(width * height * 3);
    for row in (0..height).rev() {
        for column in 0..width {
            let across = under(column, width, columns);
            let mut cells = under(row, height, rows).flat_map(|row| across.clone().map(move |column| [row, column]));
            pixels.extend(colour(&mut cells));
        }
    }
    pixels
}
