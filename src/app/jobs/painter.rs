//! Pictures of maps, painted off the UI thread and only after a change.

use super::sentence::sentence;
use super::subject::{Paint, Subject};
use crate::app::state::{MapKind, Projection};
use crate::app::widgets::{colour_table, theme};
use crate::evaluate::TARGET_ETA;
use crate::maps::{RangeAngleMap, cartesian};
use crate::picture::{CellVerdict, ColourMap, finer, in_place, told_apart};
use crate::radar::Radar;
use eframe::egui::{Color32, ColorImage};
use ndarray::{Array2, ArrayView2};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A painted map; row 0 is range (or y) 0, and the first pixel of a row its leftmost direction.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Pixels: one per cell, or interpolated columns between cells.
    pub image: Arc<ColorImage>,
    /// End of the scale: 1, except for differences and doubt.
    pub end: f32,
    pub projection: Projection,
    /// Sentence for screen readers.
    pub sentence: Arc<str>,
}

/// A painter that keeps the last picture of each kind.
#[derive(Default)]
pub struct Painter {
    cache: BTreeMap<MapKind, (Subject, Picture)>,
    projector: Option<cartesian::Projector>,
    /// Pictures painted since the start, for tests.
    pub painted: u64,
}

/// Colour beyond the maximum range of a Cartesian map.
const OUTSIDE_COLOUR: Color32 = Color32::TRANSPARENT;

/// Approximate numbers of columns and rows that a map on screen has room for.
const SCREEN_CELLS: [usize; 2] = [340, 128];

impl Painter {
    /// The picture of `subject`; the same [`Arc`] as before where nothing changed.
    pub fn paint(&mut self, radar: &Radar, kind: MapKind, subject: &Subject) -> Picture {
        if let Some((last, picture)) = self.cache.get(&kind)
            && *last == *subject
        {
            return picture.clone();
        }
        let (rows, mut columns) = subject.map.lambda.dim();
        let is_mask = matches!(subject.paint, Paint::Above { .. });
        let end = end_of(subject);
        let pixels = match subject.projection {
            Projection::RangeAngle => {
                let minus = subject.minus.as_ref().map(|minus| radar.left_to_right(&minus.lambda));
                let map = radar.left_to_right(&subject.map.lambda);
                match finer(radar, map).filter(|_| subject.is_fine && !is_mask) {
                    None => {
                        let cells = Array2::from_shape_vec((rows, columns), colour(subject, map, minus, end));
                        let cells = cells.unwrap_or_default();
                        let placed = in_place(radar, cells.view()).unwrap_or(cells);
                        columns = placed.ncols();
                        placed.into_raw_vec_and_offset().0
                    }
                    Some(fine) => {
                        columns = fine.ncols();
                        let minus = minus.and_then(|minus| finer(radar, minus));
                        colour(subject, fine.view(), minus.as_ref().map(|minus| minus.view()), end)
                    }
                }
            }
            Projection::Cartesian => {
                let projector = match &mut self.projector {
                    Some(projector) if projector.fits(radar, rows) => projector,
                    slot => slot.insert(cartesian::Projector::new(radar, rows)),
                };
                let flat = |map: &RangeAngleMap| projector.project(map).lambda;
                let (map, minus) = (flat(&subject.map), subject.minus.as_ref().map(|minus| flat(minus)));
                colour(subject, map.view(), minus.as_ref().map(|minus| minus.view()), end)
            }
        };
        let size = match subject.projection {
            Projection::RangeAngle => [columns, rows],
            Projection::Cartesian => [2 * rows, rows],
        };
        self.painted += 1;
        let image = Arc::new(ColorImage::new(size, pixels));
        let sentence = sentence(radar, subject).into();
        let picture = Picture { image, end, projection: subject.projection, sentence };
        self.cache.insert(kind, (subject.clone(), picture.clone()));
        picture
    }

    /// Drops pictures for which `shown` is false.
    pub fn keep(&mut self, shown: impl Fn(MapKind) -> bool) {
        self.cache.retain(|kind, _| shown(*kind));
    }
}

/// End of a picture's scale. For a difference it is the smallest of 1, 2, 5, 10 ... that is not exceeded: its labels are round, and a drag seldom changes it.
fn end_of(subject: &Subject) -> f32 {
    let round = |most: f32| SCALE_ENDS.into_iter().find(|end| *end >= most).unwrap_or(1.0);
    if let Paint::Doubt(_) = subject.paint {
        return round(subject.map.lambda.iter().copied().fold(0.0, f32::max));
    }
    let (Paint::Difference { view, beside, .. }, Some(minus)) = (subject.paint, &subject.minus) else { return 1.0 };
    if view.whole || minus.lambda.dim() != subject.map.lambda.dim() {
        return 1.0;
    }
    round(largest_difference(&subject.map, minus).max(beside))
}

/// The largest difference between the cells of two maps.
pub fn largest_difference(map: &RangeAngleMap, minus: &RangeAngleMap) -> f32 {
    map.lambda.iter().zip(&minus.lambda).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Ends of scales below 1.
const SCALE_ENDS: [f32; 9] = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5];

fn colour(subject: &Subject, map: ArrayView2<'_, f32>, minus: Option<ArrayView2<'_, f32>>, end: f32) -> Vec<Color32> {
    let cells = map.iter();
    // NaN marks cells beyond the maximum range of a Cartesian map.
    let shown = |v: f32, colour: Color32| if v.is_nan() { OUTSIDE_COLOUR } else { colour };
    match (subject.paint, minus) {
        (Paint::Lambda(colours) | Paint::Doubt(colours), _) => {
            let table = colour_table(colours);
            cells.map(|&v| shown(v, table[(v / end * 255.0 + 0.5) as u8 as usize])).collect()
        }
        (Paint::Above { eta, dark }, None) => {
            let mask = theme::mask(dark);
            cells.map(|&v| shown(v, mask[usize::from(v > eta)])).collect()
        }
        // False alarms are drawn over the picture, once the output is judged.
        (Paint::Above { eta, dark }, Some(target)) => {
            let verdicts = told_apart(map, target, [eta, TARGET_ETA], &[]);
            let colours = fills(&verdicts.into_raw_vec_and_offset().0, map.dim(), dark);
            cells.zip(colours).map(|(&v, colour)| shown(v, colour)).collect()
        }
        (Paint::Difference { view, colours, .. }, Some(minus)) if view.absolute => {
            let table = colour_table(colours);
            let part = |v: f32, m: f32| 255.0 * (v - m).abs() / end + 0.5;
            cells.zip(&minus).map(|(&v, &m)| shown(v, table[part(v, m) as u8 as usize])).collect()
        }
        (Paint::Difference { .. }, Some(minus)) => {
            let table = colour_table(ColourMap::Diverging);
            cells
                .zip(&minus)
                .map(|(&v, &m)| shown(v, table[(127.5 * (1.0 + (v - m) / end) + 0.5) as u8 as usize]))
                .collect()
        }
        (Paint::Difference { .. }, None) => vec![OUTSIDE_COLOUR; map.len()],
    }
}

/// Fills of hits, rims, misses and false alarms, and an outline around each patch.
fn fills(kinds: &[CellVerdict], (rows, columns): (usize, usize), dark: bool) -> Vec<Color32> {
    // A map of many cells is shrunk on screen, where a thinner outline would vanish.
    let [wide, high] = [(columns / SCREEN_CELLS[0]).max(1), (rows / SCREEN_CELLS[1]).max(1)];
    let mut around = vec![CellVerdict::Nothing; kinds.len()];
    let near = |at: usize, by: usize, end: usize| at.saturating_sub(by)..(at + by + 1).min(end);
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let kind = kinds[row * columns + column];
        let is_edge = || {
            let mut beside = near(row, 1, rows).flat_map(|r| near(column, 1, columns).map(move |c| r * columns + c));
            beside.any(|at| kinds[at] == CellVerdict::Nothing)
        };
        if kind != CellVerdict::Nothing && is_edge() {
            for at in near(row, high, rows).flat_map(|r| near(column, wide, columns).map(move |c| r * columns + c)) {
                around[at] = around[at].max(kind);
            }
        }
    }
    let colour = |(kind, around): (CellVerdict, CellVerdict)| {
        let [r, g, b] = if kind == CellVerdict::Nothing { around.outline(dark) } else { kind.fill(dark) };
        Color32::from_rgb(r, g, b)
    };
    kinds.iter().copied().zip(around).map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shared::Shared;
    use crate::app::state::DifferenceView;
    use ndarray::array;

    fn subject(paint: Paint) -> Subject {
        let map = lambda(array![[0.0, 1.0], [0.5, 0.95]]);
        Subject { minus: Some(map.clone()), map, paint, projection: Projection::RangeAngle, is_fine: false }
    }

    #[test]
    fn unchanged_subjects_are_not_painted_again() {
        let (mut painter, radar) = (Painter::default(), Radar::default());
        let s = subject(Paint::Lambda(ColourMap::Grey));
        let a = painter.paint(&radar, MapKind::Target, &s);
        let b = painter.paint(&radar, MapKind::Target, &s);
        assert!(Arc::ptr_eq(&a.image, &b.image) && painter.painted == 1);
        painter.paint(&radar, MapKind::Target, &Subject { paint: Paint::Above { eta: 0.9, dark: true }, ..s });
        assert_eq!(painter.painted, 2);
    }

    #[test]
    fn masks_are_light_in_a_light_window() {
        let (mut painter, radar) = (Painter::default(), Radar::default());
        for (dark, [below, above]) in [true, false].map(|dark| (dark, theme::mask(dark))) {
            let subject = Subject { minus: None, ..subject(Paint::Above { eta: 0.9, dark }) };
            let mask = painter.paint(&radar, MapKind::TargetAbove, &subject);
            assert_eq!(mask.image.pixels, [below, above, below, above]);
            assert_eq!(below.intensity() < 0.5, dark);
        }
    }

    fn lambda(cells: Array2<f32>) -> Shared<RangeAngleMap> {
        Shared::new(RangeAngleMap { lambda: cells })
    }

    #[test]
    fn hits_rims_and_misses_are_told_apart_by_the_target() {
        let (mut painter, radar) = (Painter::default(), Radar::default());
        for dark in [true, false] {
            let (map, minus) = (lambda(array![[0.0, 0.0], [0.8, 0.8]]), lambda(array![[0.0, 0.95], [0.89, 0.95]]));
            let subject = Subject { map, minus: Some(minus), ..subject(Paint::Above { eta: 0.5, dark }) };
            let painted = painter.paint(&radar, MapKind::OutputAbove, &subject).image.pixels.clone();
            let colour = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
            // The cell of neither map is beside a hit, so it has the hit's outline.
            let [miss, rim, hit] = [CellVerdict::Miss, CellVerdict::Rim, CellVerdict::Hit].map(|kind| kind.fill(dark));
            assert_eq!(painted, [CellVerdict::Hit.outline(dark), miss, rim, hit].map(colour));
        }
    }

    #[test]
    fn a_patch_of_hits_is_flat_with_an_outline_around_it() {
        let mut target = Array2::from_elem((9, 9), 0.0f32);
        target.slice_mut(ndarray::s![3..6, 2..7]).fill(0.95);
        let verdicts = told_apart(target.view(), target.view(), [0.5, TARGET_ETA], &[]);
        let colours = fills(&verdicts.into_raw_vec_and_offset().0, target.dim(), true);
        let of = |[r, g, b]: [u8; 3]| colours.iter().filter(|c| **c == Color32::from_rgb(r, g, b)).count();
        let [inside, around, beside] =
            [CellVerdict::Hit.fill(true), CellVerdict::Hit.outline(true), CellVerdict::Nothing.fill(true)].map(of);
        assert_eq!([inside, around, beside], [15, 5 * 7 - 15, 81 - 5 * 7]);
    }

    /// Differences of 0, -0.03, 0.03 and 0.02.
    fn difference(absolute: bool, whole: bool, beside: f32) -> Picture {
        let view = DifferenceView { absolute, whole };
        let paint = Paint::Difference { view, colours: ColourMap::Grey, beside };
        let (map, minus) = (lambda(array![[0.5, 0.5, 0.5, 0.5]]), lambda(array![[0.5, 0.53, 0.47, 0.48]]));
        let subject = Subject { map, minus: Some(minus), ..subject(paint) };
        Painter::default().paint(&Radar::default(), MapKind::Difference, &subject)
    }

    #[test]
    fn a_difference_fills_its_scale_and_shares_it() {
        let table = colour_table(ColourMap::Diverging);
        let [signed, whole, beside] = [(false, 0.0), (true, 0.0), (false, 0.15)].map(|(w, b)| difference(false, w, b));
        assert_eq!([signed.end, whole.end, beside.end], [0.05, 1.0, 0.2]);
        assert_eq!(signed.image.pixels[..2], [table[128], table[51]], "the middle, and three fifths of the way down");
        assert_eq!(whole.image.pixels[2], table[131], "hardly to be seen on the whole scale");
    }

    #[test]
    fn an_absolute_difference_has_no_sign() {
        let absolute = difference(true, false, 0.0);
        assert_eq!(absolute.end, 0.05);
        assert_eq!(absolute.image.pixels[1], absolute.image.pixels[2]);
        assert_eq!(absolute.image.pixels[0], colour_table(ColourMap::Grey)[0]);
    }
}
