//! The part of the maps in which a scene's method fails, shown when a preset of failures is opened.

use crate::app::jobs::{Jobs, JudgedOutput, judged_output};
use crate::app::state::{MapView, MethodSlot, State};
use crate::evaluate::verdict::ObjectVerdict;
use crate::maps::Aperture;
use crate::radar::Radar;
use crate::theory::blob_cell;
use eframe::egui::{Pos2, Vec2, pos2, vec2};

/// Least part of a map shown to either side of a failure, as ratios of the map's width and height.
const MIN_SHOWN_RATIO: Vec2 = vec2(0.12, 0.1);

/// Zooms the maps to the failure of an opened preset, once the verdicts on its output are known; shows whole maps again with the next document.
pub fn follow(state: &mut State, jobs: &Jobs) {
    let document = state.editor.document().id();
    let shown = &mut state.map_views.range_angle;
    if let Some((_, view)) = state.failures.shown.take_if(|(of, _)| *of != document)
        && view == *shown
    {
        *shown = MapView::default();
    }
    if state.failures.wanted != Some(document) {
        return;
    }
    let Some((judged, true)) = judged_output(&jobs.kinds, MethodSlot::First, &jobs.pipeline) else { return };
    state.failures.wanted = None;
    if let Some(view) = around(state.editor.radar(), judged) {
        *shown = view;
        state.failures.shown = Some((document, view));
    }
}

/// The part of a map with all objects that are not found, and all ghosts.
fn around(radar: &Radar, judged: &JudgedOutput) -> Option<MapView> {
    let at = |bin: f64, column: f64| {
        pos2(radar.across_of_column(column) as f32, ((bin + 0.5) / radar.samples as f64) as f32)
    };
    let place = |mark: &crate::app::jobs::VerdictMark| match mark.object {
        Some(index) => {
            let verdict = judged.verdicts.objects.get(index)?;
            let [x, y] = judged.scene.objects.get(index)?.centre_metres();
            let cell = blob_cell(radar, x, y, Aperture::Full);
            (!matches!(verdict, ObjectVerdict::Found | ObjectVerdict::Hidden)).then(|| at(cell.bin, cell.column))
        }
        None => mark.brightest.map(|[bin, column]| at(bin as f64, column as f64)),
    };
    let places: Vec<Pos2> = judged.marks.iter().filter_map(place).collect();
    let (first, rest) = places.split_first()?;
    let (low, high) = rest.iter().fold((*first, *first), |(low, high), at| (low.min(*at), high.max(*at)));
    let half = ((high - low) / 2.0 + MIN_SHOWN_RATIO / 2.0).max(MIN_SHOWN_RATIO);
    Some(MapView::around(low + (high - low) / 2.0, half))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn the_part_holds_what_failed_and_little_else() {
        let radar = Radar::default();
        let scene = Scene::of_points([(-8.0, 12.0), (4.0, 16.0), (0.0, 30.0)]);
        let objects = [ObjectVerdict::Missed, ObjectVerdict::Found, ObjectVerdict::Found];
        let judged = JudgedOutput::made_up(scene.clone(), &objects, &[]);
        let view = around(&radar, &judged).unwrap();
        let across = radar.across_of_column(radar.column_of_cos(-8.0 / 8f64.hypot(12.0))) as f32;
        assert!(view.low.x < across && across < view.high.x && view.high.x - view.low.x < 0.3, "{view:?}");
        let judged = JudgedOutput::made_up(scene, &[ObjectVerdict::Found; 3], &[]);
        assert_eq!(around(&radar, &judged), None, "nothing failed");
    }
}
