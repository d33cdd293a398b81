//! Figure 5-6: the fields of view of both ends, and their overlap.

use super::sheet::{Ink, Sheet, SheetPanel, SketchShape};
use super::source::{FigureError, SceneSource};

const HALF_ANGLE_DEGREES: f64 = 50.0;

/// Fields of view of both ends, the distance between them drawn forty times too large.
pub fn fields_of_view(_: &SceneSource) -> Result<Sheet, FigureError> {
    let (half_base, reach) = (10.0, 38.0);
    let sector = |x: f64| {
        let arc = (0..=40).map(move |i| (f64::from(i) / 20.0 - 1.0) * HALF_ANGLE_DEGREES.to_radians());
        let mut corners = vec![(x, 0.0)];
        corners.extend(arc.map(|a| (x + reach * a.sin(), reach * a.cos())));
        corners
    };
    let mut shapes = Vec::new();
    for (x, ink, name) in [(-half_base, Ink::Accent, "first end"), (half_base, Ink::Second, "last end")] {
        shapes.push(SketchShape::Area(sector(x), ink));
        shapes.push(SketchShape::Dot((x, 0.0), 7, ink));
        shapes.push(SketchShape::Words((x, -2.6), name.to_owned(), ink));
    }
    shapes.push(SketchShape::Words((0.0, 24.0), "seen by both".to_owned(), Ink::Dark));
    shapes.push(SketchShape::Words((-26.0, 21.0), "first end alone".to_owned(), Ink::Dark));
    shapes.push(SketchShape::Words((26.0, 21.0), "last end alone".to_owned(), Ink::Dark));
    shapes.push(SketchShape::Words((0.0, 4.0), "neither".to_owned(), Ink::Dark));
    let panel = SheetPanel::sketch("Fields of view of the two ends", -46.0..46.0, -4.5..40.0, shapes);
    Ok(Sheet::of(1, (820, 440), vec![panel]))
}
