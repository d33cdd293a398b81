//! From maps to pictures, off the UI thread and only where something changed.

use crate::app::state::{MapKind, Projection};
use crate::app::widgets::textures::colour_table;
use crate::maps::RangeAngleMap;
use crate::maps::cartesian;
use crate::picture::ColourMap;
use crate::radar::Radar;
use eframe::egui::{Color32, ColorImage};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How a map is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// Lambda in colours.
    Lambda(ColourMap),
    /// Cells above a threshold, in two colours.
    Above(f32),
    /// Differences from another map.
    Difference,
}

/// What one picture shows.
#[derive(Debug, Clone)]
pub struct Subject {
    /// What is shown.
    pub map: Arc<RangeAngleMap>,
    /// Subtracted by [`Paint::Difference`].
    pub minus: Option<Arc<RangeAngleMap>>,
    /// How.
    pub paint: Paint,
    /// Over which coordinates.
    pub projection: Projection,
}

impl Subject {
    /// Whether both would give the same picture.
    fn same(&self, other: &Subject) -> bool {
        let minus = match (&self.minus, &other.minus) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        minus && Arc::ptr_eq(&self.map, &other.map) && self.paint == other.paint && self.projection == other.projection
    }
}

/// A painted map; row 0 is range (or y) 0.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Its cells.
    pub image: Arc<ColorImage>,
}

/// Paints pictures and keeps the last of each kind.
#[derive(Default)]
pub struct Painter {
    cache: BTreeMap<MapKind, (Subject, Picture)>,
    projector: Option<cartesian::Projector>,
    /// Pictures painted since the start: a test asks what was not painted.
    pub painted: u64,
}

/// Colour beyond the maximum range of a Cartesian map.
const OUTSIDE: Color32 = Color32::TRANSPARENT;

/// Cells above a threshold and below it.
pub const MASK: [Color32; 2] = [Color32::from_rgb(18, 22, 30), Color32::from_rgb(255, 214, 90)];

impl Painter {
    /// The picture of `subject`; the same [`Arc`] as before where nothing changed.
    pub fn paint(&mut self, radar: &Radar, kind: MapKind, subject: &Subject) -> Picture {
        if let Some((last, picture)) = self.cache.get(&kind)
            && last.same(subject)
        {
            return picture.clone();
        }
        let (rows, columns) = subject.map.lambda.dim();
        let pixels = match subject.projection {
            Projection::RangeAngle => colour(subject, &subject.map, subject.minus.as_deref()),
            Projection::Cartesian => {
                let projector = match &mut self.projector {
                    Some(projector) if projector.fits(radar, rows) => projector,
                    slot => slot.insert(cartesian::Projector::new(radar, rows)),
                };
                let flat = |map: &RangeAngleMap| RangeAngleMap { lambda: projector.project(map).lambda };
                let (map, minus) = (flat(&subject.map), subject.minus.as_deref().map(flat));
                colour(subject, &map, minus.as_ref())
            }
        };
        let size = match subject.projection {
            Projection::RangeAngle => [columns, rows],
            Projection::Cartesian => [2 * rows, rows],
        };
        self.painted += 1;
        let picture = Picture { image: Arc::new(ColorImage::new(size, pixels)) };
        self.cache.insert(kind, (subject.clone(), picture.clone()));
        picture
    }

    /// Forgets pictures that nobody looks at.
    pub fn keep(&mut self, shown: impl Fn(MapKind) -> bool) {
        self.cache.retain(|kind, _| shown(*kind));
    }
}

/// The colour of every cell.
fn colour(subject: &Subject, map: &RangeAngleMap, minus: Option<&RangeAngleMap>) -> Vec<Color32> {
    let cells = map.lambda.iter();
    // NaN marks cells beyond the maximum range of a Cartesian map.
    let shown = |v: f32, colour: Color32| if v.is_nan() { OUTSIDE } else { colour };
    match (subject.paint, minus) {
        (Paint::Lambda(colours), _) => {
            let table = colour_table(colours);
            cells.map(|&v| shown(v, table[(v * 255.0 + 0.5) as u8 as usize])).collect()
        }
        (Paint::Above(eta), _) => cells.map(|&v| shown(v, MASK[usize::from(v > eta)])).collect(),
        (Paint::Difference, Some(minus)) => {
            let table = colour_table(ColourMap::Diverging);
            cells
                .zip(&minus.lambda)
                .map(|(&v, &m)| shown(v, table[(127.5 * (1.0 + v - m) + 0.5) as u8 as usize]))
                .collect()
        }
        (Paint::Difference, None) => vec![OUTSIDE; map.lambda.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    fn subject(paint: Paint) -> Subject {
        let map = Arc::new(RangeAngleMap { lambda: array![[0.0f32, 1.0], [0.5, 0.95]] });
        Subject { minus: Some(map.clone()), map, paint, projection: Projection::RangeAngle }
    }

    #[test]
    fn unchanged_subjects_are_not_painted_again() {
        let (mut painter, radar) = (Painter::default(), Radar::default());
        let s = subject(Paint::Lambda(ColourMap::Grey));
        let a = painter.paint(&radar, MapKind::Target, &s);
        let b = painter.paint(&radar, MapKind::Target, &s);
        assert!(Arc::ptr_eq(&a.image, &b.image) && painter.painted == 1);
        painter.paint(&radar, MapKind::Target, &Subject { paint: Paint::Above(0.9), ..s });
        assert_eq!(painter.painted, 2);
    }

    #[test]
    fn masks_and_differences_have_their_colours() {
        let (mut painter, radar) = (Painter::default(), Radar::default());
        let mask = painter.paint(&radar, MapKind::TargetAbove, &subject(Paint::Above(0.9)));
        assert_eq!(mask.image.pixels, [MASK[0], MASK[1], MASK[0], MASK[1]]);
        let difference = painter.paint(&radar, MapKind::Difference, &subject(Paint::Difference));
        assert!(difference.image.pixels.iter().all(|p| *p == difference.image.pixels[0]), "equal maps differ nowhere");
    }
}
