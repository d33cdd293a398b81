//! From maps to pictures, off the UI thread and only where something changed.

use super::settings::Projection;
use crate::maps::RangeAngleMap;
use crate::maps::cartesian;
use crate::picture::ColourMap;
use crate::radar::Radar;
use eframe::egui::{Color32, ColorImage};
use std::collections::BTreeMap;
use std::sync::Arc;

/// One of the maps on screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub enum MapKind {
    /// The first end's map.
    Input0,
    /// The last end's map.
    Input1,
    /// The whole array's map.
    Target,
    /// The map that the chosen method makes from the two ends.
    Output,
    /// Target > eta'.
    TargetAbove,
    /// Output > eta.
    OutputAbove,
    /// Output minus target.
    Difference,
}

impl MapKind {
    /// All of them, in reading order.
    pub const ALL: [MapKind; 7] = [
        MapKind::Input0,
        MapKind::Input1,
        MapKind::Target,
        MapKind::Output,
        MapKind::TargetAbove,
        MapKind::OutputAbove,
        MapKind::Difference,
    ];

    /// Title of its panel.
    pub fn title(self) -> &'static str {
        match self {
            MapKind::Input0 => "Input 0",
            MapKind::Input1 => "Input 1",
            MapKind::Target => "Target",
            MapKind::Output => "Output",
            MapKind::TargetAbove => "Target > η'",
            MapKind::OutputAbove => "Output > η",
            MapKind::Difference => "Difference",
        }
    }

    /// What it shows, for tooltips.
    pub fn describe(self) -> &'static str {
        match self {
            MapKind::Input0 => "What the 12 elements at the left end of the array see",
            MapKind::Input1 => "What the 12 elements at the right end of the array see",
            MapKind::Target => "What all 1024 elements see: the map that a reconstruction aims for",
            MapKind::Output => "What the chosen method makes of the two ends",
            MapKind::TargetAbove => "Cells where the target exceeds η'",
            MapKind::OutputAbove => "Cells where the output exceeds η: the detections",
            MapKind::Difference => "Output minus target: red where the output is too bright, blue where it is too dark",
        }
    }

    /// Whether it is made of the method's output.
    pub fn needs_output(self) -> bool {
        matches!(self, MapKind::Output | MapKind::OutputAbove | MapKind::Difference)
    }
}

/// How a map is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Paint {
    /// Lambda in colours.
    Lambda(ColourMap),
    /// Cells above a threshold, in two colours.
    Above(f32),
    /// Differences from another map.
    Difference,
}

/// What one picture shows.
#[derive(Debug, Clone)]
pub(super) struct Subject {
    pub map: Arc<RangeAngleMap>,
    /// Subtracted by [`Paint::Difference`].
    pub minus: Option<Arc<RangeAngleMap>>,
    pub paint: Paint,
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
pub(super) struct Picture {
    pub image: Arc<ColorImage>,
}

/// Paints pictures and keeps the last of each kind.
#[derive(Default)]
pub(super) struct Painter {
    cache: BTreeMap<MapKind, (Subject, Picture)>,
    projector: Option<cartesian::Projector>,
    /// Pictures painted since the start: a test asks what was not painted.
    pub painted: u64,
}

/// Colour beyond the maximum range of a Cartesian map.
const OUTSIDE: Color32 = Color32::TRANSPARENT;

/// Cells above a threshold and below it.
pub(super) const MASK: [Color32; 2] = [Color32::from_rgb(18, 22, 30), Color32::from_rgb(255, 214, 90)];

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
            let table = table(colours);
            cells.map(|&v| shown(v, table[(v * 255.0 + 0.5) as u8 as usize])).collect()
        }
        (Paint::Above(eta), _) => cells.map(|&v| shown(v, MASK[usize::from(v > eta)])).collect(),
        (Paint::Difference, Some(minus)) => {
            let table = table(ColourMap::Diverging);
            cells
                .zip(&minus.lambda)
                .map(|(&v, &m)| shown(v, table[(127.5 * (1.0 + v - m) + 0.5) as u8 as usize]))
                .collect()
        }
        (Paint::Difference, None) => vec![OUTSIDE; map.lambda.len()],
    }
}

/// The table of a colour map as egui's colours.
pub(super) fn table(colours: ColourMap) -> [Color32; 256] {
    colours.table().map(|[r, g, b]| Color32::from_rgb(r, g, b))
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
