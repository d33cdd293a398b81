//! Figure 6-1, a cylinder and a cube, and section 5.4's hidden point behind a wall that casts a shadow.

use super::sheet::{Sheet, SheetPanel};
use super::source::{FigureError, SceneSource};
use crate::scene::{Object, Point, Scene, Wall};

const PANEL: (u32, u32) = (520, 400);

/// A cylinder and a cube at an angle, as both ends and the whole array see them.
pub fn cylinder_and_cube(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.preset("cylinder-and-cube")?;
    Ok(Sheet::of(2, PANEL, source.panels_of(&seen, "A cylinder and a cube")))
}

/// A wall that hides a point from the last end and not from the first.
/// # Errors
/// [`FigureError::Scene`].
pub fn behind_a_wall(source: &SceneSource) -> Result<Vec<SheetPanel>, FigureError> {
    let seen = source.see(hidden_from_one_end())?;
    Ok(source.panels_of(&seen, "A wall, and a point that it hides from the last end"))
}

/// The ways to the point pass the wall's near end 0.6 m to the left from the first end of the array, and 0.6 m to the right from the last.
/// No foot of a perpendicular lies on the wall, so that no glint outshines the point.
fn hidden_from_one_end() -> Scene {
    let objects = vec![Object::Wall(Wall::new(4.0, 4.8, 4.0, 0.0)), Object::Point(Point::new(5.0, 12.0))];
    Scene { objects, ..Scene::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::End;

    #[test]
    fn the_hidden_point_is_dim_in_the_last_ends_map_alone() {
        let source = SceneSource::default();
        let seen = source.see(hidden_from_one_end()).unwrap();
        let bright = |end: End| {
            let map = &seen.lambda[if end == End::First { 0 } else { 1 }];
            let blob = source.radar.blob_of(source.radar.end_centre_metres(end), 5.0, 12.0);
            let bin = source.radar.bin_of_range(blob.range_metres).round() as usize;
            let column = source.radar.column_of_cos(blob.cos_theta) as usize;
            let cells = (bin - 1..=bin + 1).flat_map(|b| (column - 20..column + 20).map(move |c| (b, c)));
            cells.map(|(b, c)| map.lambda[[b, c]]).fold(0.0f32, f32::max)
        };
        let [first, last] = End::BOTH.map(bright);
        // Each map is normalised by itself, over some 200 dB: a shadow of 40 dB is a fifth of Lambda.
        assert!(first > 0.99 && last < 0.85, "{first} {last}");
        assert_eq!(behind_a_wall(&source).unwrap().len(), 4);
    }

    #[test]
    fn bodies_are_drawn_by_their_outlines() {
        let sheet = cylinder_and_cube(&SceneSource::default()).unwrap();
        let super::super::sheet::PanelContent::Chart(chart) = &sheet.panels[0].content else { panic!("a chart") };
        let counts: Vec<usize> = chart.series.iter().map(|s| s.points.len()).collect();
        assert_eq!(counts, [49, 5, 0]);
    }
}
