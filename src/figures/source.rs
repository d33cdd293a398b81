//! The data of figures: the thesis' radar, this program's simulation, maps and methods.

use super::sheet::{Series, SheetAxis, SheetCells, SheetPanel, Stroke};
use crate::maps::cartesian::project;
use crate::maps::{LogMaps, Normalisation, RangeAngleMap};
use crate::methods;
use crate::picture::{ColourMap, PictureError};
use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Request};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::scene::presets::Preset;
use crate::scene::{Object, Scene, SceneError};
use crate::signal::{self, BeatSignal, Floor};
use ndarray::Array2;

#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Reconstruct(#[from] ReconstructError),
    #[error("{0}")]
    Missing(String),
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// The thesis' radar and conventions: table 3.1, its floor, min-max.
#[derive(Default)]
pub struct SceneSource {
    pub radar: Radar,
}

pub struct ScenePictures {
    pub scene: Scene,
    pub signal: BeatSignal,
    /// Lambda of the first end, the last end and the whole array.
    pub lambda: [RangeAngleMap; 3],
}

impl SceneSource {
    /// The scene over `floor`, seed 0.
    /// # Errors
    /// [`FigureError::Scene`].
    pub fn see_over(&self, scene: Scene, floor: Floor) -> Result<ScenePictures, FigureError> {
        let signal = signal::simulate(&self.radar, &scene, floor, 0)?;
        let maps = LogMaps::of_signal(&self.radar, &signal);
        let lambda = [maps.first, maps.last, maps.full].map(|m| m.normalise(Normalisation::MinMax));
        Ok(ScenePictures { scene, signal, lambda })
    }

    /// The scene over the thesis' floor.
    /// # Errors
    /// [`FigureError::Scene`].
    pub fn see(&self, scene: Scene) -> Result<ScenePictures, FigureError> {
        self.see_over(scene, Floor::Thesis)
    }

    /// A preset over the thesis' floor.
    /// # Errors
    /// [`FigureError`] when there is no such preset or it can't be simulated.
    pub fn preset(&self, id: &str) -> Result<ScenePictures, FigureError> {
        self.see(preset(id)?)
    }

    /// Test scene `number` of a set (seed 0) over the thesis' floor.
    /// # Errors
    /// [`FigureError::Scene`].
    pub fn test_scene(&self, kind: Kind, number: u32) -> Result<ScenePictures, FigureError> {
        self.see(Generator::new(&self.radar, Reading::Program, Purpose::Test, 0).scene(kind, number))
    }

    /// A method's output.
    /// # Errors
    /// [`FigureError`] when there is no such method or it fails.
    pub fn output(&self, method: &str, seen: &ScenePictures) -> Result<RangeAngleMap, FigureError> {
        let method = methods::by_name(method).map_err(|e| FigureError::Missing(e.to_string()))?;
        let ends = seen.signal.two_ends(&self.radar);
        Ok(method.reconstruct(&self.radar, &ends, &Request::default())?.lambda)
    }

    pub fn range_axis(&self) -> SheetAxis {
        SheetAxis::new("range (m)", 0.0, self.radar.max_range_metres())
    }

    pub fn lambda_panel(&self, title: impl Into<String>, map: &RangeAngleMap) -> SheetPanel {
        self.cells_panel(title, map.lambda.clone(), ColourMap::default(), Some(("Λ 0", "Λ 1")))
    }

    pub fn above_panel(&self, title: impl Into<String>, map: &RangeAngleMap, eta: f32) -> SheetPanel {
        self.cells_panel(title, map.lambda.mapv(|v| f32::from(v > eta)), ColourMap::Grey, None)
    }

    /// Values in [0, 1] over cos(theta) and range.
    pub fn cells_panel(
        &self,
        title: impl Into<String>,
        values: Array2<f32>,
        colours: ColourMap,
        ends_of_bar: Option<(&'static str, &'static str)>,
    ) -> SheetPanel {
        let x = SheetAxis::new("cos θ", -1.0, 1.0);
        let values = self.radar.left_to_right(&values).to_owned();
        let cells = SheetCells { x, y: self.range_axis(), values, colours, ends_of_bar, rings: Vec::new() };
        SheetPanel::cells(title, cells)
    }

    pub fn cartesian_panel(&self, title: impl Into<String>, map: &RangeAngleMap, colours: ColourMap) -> SheetPanel {
        let extent = self.radar.max_range_metres();
        let values = project(&self.radar, map, 300).lambda;
        let (x, y) = (SheetAxis::new("x (m)", -extent, extent), SheetAxis::new("y (m)", 0.0, extent));
        SheetPanel::cells(title, SheetCells { x, y, values, colours, ends_of_bar: None, rings: Vec::new() })
    }

    /// Outlines of bodies, and the reflectors; those behind the array are drawn ahead.
    pub fn scene_panel(&self, title: &str, scene: &Scene) -> SheetPanel {
        let extent = self.radar.max_range_metres();
        let bodies = scene.objects.iter().filter_map(Object::body);
        let mut series: Vec<Series> = bodies.map(|body| Series::line("", body.shape.line_around())).collect();
        let points = scene.reflectors().into_iter().map(|r| (r.x_metres, r.y_metres.abs()));
        series.push(Series::line("", points).with(Stroke::Dots));
        SheetPanel::chart(title, SheetAxis::new("x (m)", -extent, extent), SheetAxis::new("y (m)", 0.0, extent), series)
    }

    pub fn panels_of(&self, seen: &ScenePictures, title: &str) -> Vec<SheetPanel> {
        [vec![self.scene_panel(title, &seen.scene)], self.map_panels(seen)].concat()
    }

    pub fn map_panels(&self, seen: &ScenePictures) -> Vec<SheetPanel> {
        let titled = ["Input 0", "Input 1", "Target"].into_iter().zip(&seen.lambda);
        titled.map(|(title, map)| self.lambda_panel(title, map)).collect()
    }
}

/// The scene of a preset.
/// # Errors
/// [`FigureError::Missing`] when there is none of that name.
pub fn preset(id: &str) -> Result<Scene, FigureError> {
    let missing = || FigureError::Missing(format!("there is no preset \"{id}\""));
    let preset = Preset::by_id(id).ok_or_else(missing)?;
    preset.load().map(|file| file.scene).map_err(|e| FigureError::Missing(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::super::sheet::PanelContent;
    use super::*;
    use crate::radar::Convention;

    #[test]
    fn left_is_left_in_a_figure_of_either_convention() {
        for convention in Convention::ALL {
            let source = SceneSource { radar: Radar::default().in_convention(convention) };
            let mut lambda = Array2::zeros((512, 1024));
            lambda[[200, source.radar.column_of_cos(-0.5) as usize]] = 1.0;
            let panel = source.lambda_panel("", &RangeAngleMap { lambda });
            let PanelContent::Cells(cells) = panel.content else { panic!("cells") };
            let ((_, column), _) = cells.values.indexed_iter().find(|(_, v)| **v == 1.0).unwrap();
            // The columns of the physical convention are those of the carrier, 1.3 % below the middle of the chirp.
            assert!((255..261).contains(&column), "{convention:?}: column {column}");
        }
    }
}
