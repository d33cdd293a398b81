//! Figures 3-2, 4-1 to 4-8, 5-3 to 5-5 and 5-7: outputs of methods; 6-1, a cylinder and a cube, and a wall that casts a shadow.

use super::sheet::{Sheet, SheetPanel};
use super::source::{FigureError, ScenePictures, SceneSource};
use crate::evaluate::{Metrics, TARGET_ETA};
use crate::maps::RangeAngleMap;
use crate::picture::ColourMap;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::scene::{Object, Point, Scene, Wall};

const PANEL: (u32, u32) = (460, 380);
pub const EXPERIMENT_1: &str = "thesis-1";
pub const EXPERIMENT_2: &str = "thesis";

fn title(method: &str, seen: &ScenePictures, output: &RangeAngleMap) -> String {
    let metrics = Metrics::of(&seen.lambda[2], output, TARGET_ETA);
    format!("{method}: SE {:.0}", metrics.squared_error)
}

/// A scene's inputs and target, then the thesis' network, `live` and `hybrid` on it.
pub fn beside(source: &SceneSource, seen: &ScenePictures, network: &str) -> Result<Sheet, FigureError> {
    let mut panels = source.map_panels(seen);
    for method in [network, "live", "hybrid"] {
        let output = source.output(method, seen)?;
        panels.push(source.lambda_panel(title(method, seen, &output), &output));
    }
    Ok(Sheet::of(3, PANEL, panels))
}

pub fn unet_on_training(source: &SceneSource) -> Result<Sheet, FigureError> {
    let generator = Generator::new(&source.radar, Reading::Program, Purpose::Training, 0);
    let seen = source.see(generator.scene(Kind::Points(3), 0))?;
    let [first, last, full] = &seen.lambda;
    let output = source.output("unet", &seen)?;
    let above = |map: &RangeAngleMap| RangeAngleMap { lambda: map.lambda.mapv(|v| f32::from(v > TARGET_ETA)) };
    let largest = output.lambda.iter().fold(0.0f32, |m, v| m.max(*v));
    let panel = |name: String, map: &RangeAngleMap| source.cartesian_panel(name, map, ColourMap::Grey);
    let panels = vec![
        panel("Input 0 > 0.9".to_owned(), &above(first)),
        panel("Input 1 > 0.9".to_owned(), &above(last)),
        panel("Target > 0.9".to_owned(), &above(full)),
        panel(format!("U-Net's output, at most {largest:.3}"), &output),
    ];
    Ok(Sheet::of(2, (560, 340), panels))
}

pub fn merged_and_apart(source: &SceneSource) -> Result<Sheet, FigureError> {
    let place = |cos: f64| (31.0 * cos, 31.0 * (1.0 - cos * cos).sqrt());
    let seen = source.see(Scene::of_points([place(0.30), place(0.40)]))?;
    let mut panels = vec![source.lambda_panel("Target", &seen.lambda[2])];
    for method in [EXPERIMENT_1, EXPERIMENT_2, "live", "hybrid"] {
        let output = source.output(method, &seen)?;
        panels.push(source.lambda_panel(title(method, &seen, &output), &output));
    }
    Ok(Sheet::of(3, PANEL, panels))
}

pub fn thresholds(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.test_scene(Kind::Set3, 0)?;
    let row = |name: &str, map: &RangeAngleMap| -> Vec<SheetPanel> {
        let above = |eta: f32| source.above_panel(format!("{name} > {eta}"), map, eta);
        vec![source.lambda_panel(name, map), above(0.7), above(TARGET_ETA)]
    };
    let mut panels = row("target", &seen.lambda[2]);
    for method in [EXPERIMENT_2, "live", "hybrid"] {
        panels.extend(row(method, &source.output(method, &seen)?));
    }
    Ok(Sheet::of(3, (420, 330), panels))
}

pub fn baseline(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.test_scene(Kind::Set3, 0)?;
    let panels = vec![
        source.above_panel("Baseline: Λ0 > 0.9", &seen.lambda[0], TARGET_ETA),
        source.above_panel("Target: Λ > 0.9", &seen.lambda[2], TARGET_ETA),
    ];
    Ok(Sheet::of(2, (560, 420), panels))
}

/// Inputs of two points a tenth of a radian apart: alike in the middle, different at the edges.
pub fn a_tenth_of_a_radian(source: &SceneSource) -> Result<Sheet, FigureError> {
    let ahead = source.preset("one-at-20-m")?;
    let off = source.preset("one-at-20-m-a-tenth-of-a-radian-off")?;
    let (a, b) = (&ahead.lambda[0], &off.lambda[0]);
    let difference = ndarray::Zip::from(&a.lambda).and(&b.lambda).map_collect(|a, b| 0.5 + (b - a).clamp(-0.5, 0.5));
    let panels = vec![
        source.lambda_panel("Λ0 of a point at (0, 20) m", a),
        source.lambda_panel("Λ0 of one a tenth of a radian off", b),
        source.cells_panel("Their difference", difference, ColourMap::Diverging, Some(("-0.5", "+0.5"))),
    ];
    Ok(Sheet::of(3, PANEL, panels))
}

/// A point hidden behind a line for one end; below, behind a wall that casts a shadow.
pub fn hidden(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.preset("point-behind-a-line")?;
    let mut panels = source.panels_of(&seen, "A line, and a point behind it");
    panels.extend(behind_a_wall(source)?);
    Ok(Sheet::of(2, (520, 400), panels))
}

/// A cylinder and a cube at an angle, as both ends and the whole array see them.
pub fn cylinder_and_cube(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.preset("cylinder-and-cube")?;
    Ok(Sheet::of(2, (520, 400), source.panels_of(&seen, "A cylinder and a cube")))
}

/// A wall that hides a point from the last end and not from the first.
fn behind_a_wall(source: &SceneSource) -> Result<Vec<SheetPanel>, FigureError> {
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
