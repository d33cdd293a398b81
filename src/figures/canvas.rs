//! Drawing tools shared by all panels of a sheet.

use plotters::coord::Shift;
use plotters::prelude::*;

pub(super) type SheetDrawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

pub(super) type SheetArea<B> = DrawingArea<B, Shift>;

pub(super) fn words(size: f64, colour: &RGBColor) -> TextStyle<'static> {
    FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal).color(colour)
}
