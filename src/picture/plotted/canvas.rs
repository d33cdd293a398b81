//! Drawing tools shared by all panels of a picture.

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

pub(super) type Painted = Result<(), PictureError>;

pub(super) type PanelArea<B> = DrawingArea<B, Shift>;

pub(super) const INK: RGBColor = RGBColor(28, 32, 38);
pub(super) const FAINT_INK: RGBColor = RGBColor(104, 112, 122);
pub(super) const HAIRLINE: RGBColor = RGBColor(206, 211, 217);
pub(super) const PAPER: RGBColor = RGBColor(252, 252, 250);

/// A drawing for bitmaps and SVG.
pub trait Drawing {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws itself.
    /// # Errors
    /// [`PictureError`] when plotters can't draw.
    fn draw<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Painted;
}
