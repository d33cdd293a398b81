//! The maps of a step's scene, on which questions and challenges are checked.

use crate::maps::cfar::Cfar;
use crate::maps::{LogMaps, Normalisation, RangeAngleMap};
use crate::methods;
use crate::radar::Radar;
use crate::reconstruct::Request;
use crate::scene::{Object, Scene, SceneError};
use crate::signal::{self, Floor};
use serde::{Deserialize, Serialize};

/// Floor, normalisation, method and detector of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StepView {
    pub floor: Floor,
    pub seed: u64,
    pub normalisation: Normalisation,
    /// Whether all maps have one scale of brightness.
    pub one_scale: bool,
    pub method: String,
    /// The detector in the place of thresholds, if one is in use.
    pub cfar: Option<Cfar>,
}

impl Default for StepView {
    /// No floor and 100 dB, so that noise hides no effect; `live` reconstructs.
    fn default() -> Self {
        let normalisation = Normalisation::DynamicRange(crate::radar::Decibels(100.0));
        let (floor, method) = (Floor::Exact, "live".to_owned());
        StepView { floor, seed: 0, normalisation, one_scale: false, method, cfar: None }
    }
}

/// A map, as lessons call it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapName {
    /// The first end's.
    #[serde(rename = "input-0")]
    Input0,
    /// The last end's.
    #[serde(rename = "input-1")]
    Input1,
    /// The whole array's.
    Target,
    Output,
}

/// A cell of a map; fractions lie between cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    pub bin: f64,
    pub column: f64,
}

/// A scene simulated for checking.
#[derive(Debug, Clone)]
pub struct Stage {
    pub radar: Radar,
    /// The scene; its [`Scene::noise_seed`] picks the floor's noise.
    pub scene: Scene,
    maps: [RangeAngleMap; 3],
    output: Result<RangeAngleMap, String>,
}

impl Stage {
    /// Simulates `scene` and, where `with_output`, reconstructs it.
    /// # Errors
    /// [`SceneError`] when the scene can't be simulated. A method that fails leaves its reason in [`Stage::map`].
    pub fn new(radar: &Radar, scene: &Scene, view: &StepView, with_output: bool) -> Result<Stage, SceneError> {
        let signal = signal::simulate(radar, scene, view.floor, view.seed)?;
        let log = LogMaps::of_signal(radar, &signal);
        let maps = [log.first, log.last, log.full].map(|m| m.normalise(view.normalisation));
        let output = if with_output {
            let request = Request { noise: view.floor.into(), normalisation: view.normalisation, ..Request::default() };
            methods::by_name(&view.method).map_err(|e| e.to_string()).and_then(|method| {
                let answer = method.reconstruct(radar, &signal.two_ends(radar), &request);
                Ok(answer.map_err(|e| e.to_string())?.lambda)
            })
        } else {
            Err("the output was not asked for".to_owned())
        };
        Ok(Stage { radar: radar.clone(), scene: scene.clone(), maps, output })
    }

    /// A map.
    /// # Errors
    /// The reason for which the method has no output.
    pub fn map(&self, name: MapName) -> Result<&RangeAngleMap, String> {
        match name {
            MapName::Input0 => Ok(&self.maps[0]),
            MapName::Input1 => Ok(&self.maps[1]),
            MapName::Target => Ok(&self.maps[2]),
            MapName::Output => self.output.as_ref().map_err(Clone::clone),
        }
    }

    /// Cell of the middle of an object in every map: range wrapped, angle squinted.
    pub fn expected(&self, object: &Object) -> Cell {
        let [x_metres, y_metres] = object.centre_metres();
        let blob = self.radar.blob_of(0.0, x_metres, y_metres);
        let bin = self.radar.bin_of_range(blob.range_metres).rem_euclid(self.radar.samples as f64);
        Cell { bin, column: self.radar.column_of_cos(blob.cos_theta) }
    }

    /// The brightest cell of a map within some bins and columns of a place; columns wrap around.
    pub fn peak_near(&self, map: &RangeAngleMap, at: Cell, bins: usize, columns: usize) -> Cell {
        let (rows, width) = map.lambda.dim();
        let (row, column) = (at.bin.round() as isize, at.column.round() as isize);
        let (bins, columns) = (bins as isize, columns as isize);
        let mut best = (f32::NEG_INFINITY, at);
        for bin in (row - bins).max(0)..=(row + bins).min(rows as isize - 1) {
            for offset in -columns..=columns {
                let c = (column + offset).rem_euclid(width as isize) as usize;
                let value = map.lambda[[bin as usize, c]];
                if value > best.0 {
                    best = (value, Cell { bin: bin as f64, column: c as f64 });
                }
            }
        }
        best.1
    }

    /// Place and Lambda of an object's blob: the brightest cell near its expected place.
    pub fn blob(&self, map: &RangeAngleMap, object: &Object) -> (Cell, f32) {
        self.blob_within(map, object, 8, self.radar.elements / 48)
    }

    fn blob_within(&self, map: &RangeAngleMap, object: &Object, bins: usize, columns: usize) -> (Cell, f32) {
        let cell = self.peak_near(map, self.expected(object), bins, columns);
        (cell, map.lambda[[cell.bin as usize, cell.column as usize]])
    }

    /// Place and Lambda of two objects' blobs, each within its own half of the distance between them.
    pub fn blobs_apart(&self, map: &RangeAngleMap, [a, b]: [&Object; 2]) -> [(Cell, f32); 2] {
        let (at, other) = (self.expected(a), self.expected(b));
        let (bins, columns) = (8, self.radar.elements / 48);
        let (bins_apart, columns_apart) = ((at.bin - other.bin).abs(), (at.column - other.column).abs());
        let half = |distance: f64| (distance / 2.0 - 0.5).max(0.0) as usize;
        let (bins, columns) = if bins_apart * columns as f64 >= columns_apart * bins as f64 {
            (bins.min(half(bins_apart)), columns)
        } else {
            (bins, columns.min(half(columns_apart)))
        };
        [a, b].map(|object| self.blob_within(map, object, bins, columns))
    }

    pub fn brightest(&self, map: &RangeAngleMap) -> Cell {
        let (rows, columns) = map.lambda.dim();
        let middle = Cell { bin: rows as f64 / 2.0, column: columns as f64 / 2.0 };
        self.peak_near(map, middle, rows, columns / 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blob_stands_where_it_is_expected_even_at_end_fire() {
        for (x, y) in [(0.0, 20.0), (-16.6, 11.0), (25.0, 6.0), (3.0, 60.0)] {
            let stage =
                Stage::new(&Radar::default(), &Scene::of_points([(x, y)]), &StepView::default(), false).unwrap();
            let map = stage.map(MapName::Target).unwrap();
            let (expected, (found, lambda)) =
                (stage.expected(&stage.scene.objects[0]), stage.blob(map, &stage.scene.objects[0]));
            assert!(lambda > 0.98, "({x}, {y}): {lambda}");
            // A point is a plateau of some tens of columns; its middle is meant.
            assert!((expected.bin - found.bin).abs() <= 4.0, "({x}, {y}): {expected:?} {found:?}");
            assert!((expected.column - found.column).abs() <= 24.0, "({x}, {y}): {expected:?} {found:?}");
        }
    }
}
