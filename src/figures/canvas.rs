//! Drawing tools shared by all panels of a sheet.

use plotters::coord::Shift;
use plotters::prelude::*;

/// What drawing gives back.
pub(super) type SheetDrawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// A part of the drawing.
pub(super) type SheetArea<B> = DrawingArea<B, Shift>;

/// A text style of this size in pixels.
pub(super) fn words(size: f64, colour: &RGBColor) -> TextStyle<'static> {
    FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal).color(colour)
}
