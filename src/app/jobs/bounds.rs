//! Bounds of one reflector: the least position error of any unbiased estimator, and places with a similar echo.

use super::derived::{Failure, Query};
use crate::app::state::{BoundsSettings, State};
use crate::app::widgets::colour_table;
use crate::bounds::{
    Ambiguity, BoundsError, Gains, PositionBound, ambiguity, cramer_rao, cramer_rao_of, noise_variance,
};
use crate::picture::ColourMap;
use crate::radar::{Layout, Polar, Radar};
use crate::scene::{Object, Reflector};
use crate::task::Task;
use eframe::egui::{Color32, ColorImage};
use std::sync::Arc;

#[derive(Debug, Clone, PartialEq)]
pub struct BoundsRequest {
    pub radar: Radar,
    /// Elements, noise and extent of the picture.
    pub settings: BoundsSettings,
    pub name: String,
    pub reflector: Reflector,
}

impl BoundsRequest {
    /// The bounds of the first selected object's centre, or of the first object's; `None` where there is none away from the array's middle.
    pub fn of(state: &State) -> Option<Self> {
        let index = state.editor.selection().iter().next().unwrap_or(0);
        let object = state.editor.scene().objects.get(index)?;
        let [x_metres, y_metres] = object.centre_metres();
        let reflector = Reflector { x_metres, y_metres, reflectivity: object.reflectivity() };
        let what = if matches!(object, Object::Point(_)) { "" } else { "middle of " };
        let name = format!("{what}{}", object.called(index));
        let (radar, settings) = (state.radar().clone(), state.settings.bounds);
        (x_metres.hypot(y_metres) > 0.0).then_some(BoundsRequest { radar, settings, name, reflector })
    }
}

pub struct BoundsResult {
    pub request: BoundsRequest,
    pub layout: Layout,
    /// Range and direction of the reflector.
    pub centre: Polar,
    pub bound: Result<PositionBound, BoundsError>,
    /// The bound with one unknown complex gain for either half of the elements.
    pub gain_per_end: Option<PositionBound>,
    /// Likeness of other places' echoes to the reflector's.
    pub ambiguity: Ambiguity,
    /// Picture of that likeness, the farthest range on top.
    pub image: Arc<ColorImage>,
}

/// Echoes compared for one picture, which take a few tenths of a second.
const MAX_COMPARED_ECHOES: f64 = 2.0e6;

impl Query for BoundsRequest {
    type Value = BoundsResult;
    type State = ();
    const WHAT: &'static str = "Computing the bounds";
    const ADVICE: &'static str = "Move the reflector to try again.";

    fn compute(&self, (): &mut (), _: &Task) -> Result<BoundsResult, Failure> {
        let BoundsRequest { radar, settings, reflector, .. } = self;
        let BoundsSettings { elements, seed, snr, columns, bins } = *settings;
        let layout = elements.layout(radar, seed)?;
        let centre = radar.polar_of(reflector.x_metres, reflector.y_metres.abs());
        let variance = noise_variance(radar, &layout, reflector, snr);
        let bound = cramer_rao(radar, &layout, std::slice::from_ref(reflector), variance).map(|bounds| bounds[0]);
        let per_end = cramer_rao_of(radar, &layout, std::slice::from_ref(reflector), variance, Gains::PerEnd);
        let gain_per_end = per_end.ok().and_then(|bounds| bounds.first().copied());
        let cells = (MAX_COMPARED_ECHOES / layout.len().max(1) as f64).clamp(1e3, 8e4);
        // Odd numbers, so that the reflector itself is a cell.
        let across = 2 * ((cells * 2.0).sqrt() / 2.0) as i32 + 1;
        let up = 2 * ((cells / 2.0).sqrt() / 2.0) as i32 + 1;
        let around =
            |half: f64, count: i32| (0..count).map(move |i| half * (2.0 * f64::from(i) / f64::from(count - 1) - 1.0));
        let column = 2.0 / radar.elements as f64;
        let ranges: Vec<f64> = around(bins * radar.range_resolution_metres(), up)
            .map(|d| (centre.range_metres + d).max(radar.aperture_metres() / 100.0))
            .collect();
        let cosines: Vec<f64> = around(columns * column, across).map(|d| centre.cos_theta + d).collect();
        let mut found = ambiguity(radar, &layout, centre, &ranges, &cosines);
        // There is no direction beyond end-fire.
        for (mut cells, cos) in found.likeness.columns_mut().into_iter().zip(&cosines) {
            if cos.abs() > 1.0 {
                cells.fill(f64::NAN);
            }
        }
        let table = colour_table(ColourMap::Viridis);
        let paint = |v: &f64| if v.is_nan() { Color32::TRANSPARENT } else { table[(v * 255.0) as usize] };
        // The top row is the farthest.
        let pixels =
            found.likeness.rows().into_iter().rev().flat_map(|row| row.into_iter().map(paint).collect::<Vec<_>>());
        let image = Arc::new(ColorImage::new([across as usize, up as usize], pixels.collect()));
        Ok(BoundsResult { layout, centre, bound, gain_per_end, ambiguity: found, image, request: self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::Elements;

    #[test]
    fn likeness_is_one_at_the_reflector_and_none_beyond_end_fire() {
        let shown = BoundsSettings { columns: 16.0, bins: 3.0, ..BoundsSettings::default() };
        let request = BoundsRequest {
            radar: Radar { elements: 64, samples: 32, ..Radar::default() },
            // So far to the side that the picture reaches beyond end fire.
            reflector: Reflector { x_metres: 1.5, y_metres: 0.2, reflectivity: 1.0 },
            settings: BoundsSettings { elements: Elements::OneEnd, ..shown },
            name: String::new(),
        };
        let found = request.compute(&mut (), &Task::default()).unwrap();
        let (rows, columns) = found.ambiguity.likeness.dim();
        assert!((found.ambiguity.likeness[[rows / 2, columns / 2]] - 1.0).abs() < 1e-9);
        assert_eq!(found.image.size, [columns, rows]);
        assert!(found.bound.unwrap().x_metres > 0.0);
        assert!(found.ambiguity.likeness[[0, columns - 1]].is_nan());
    }
}
