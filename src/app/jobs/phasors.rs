//! The contributions of all elements to the cell under the cursor.

use super::Pipeline;
use super::derived::{Failure, Query};
use super::source::{KeptSignal, Source};
use crate::app::state::{PhasorSettings, State};
use crate::interact::Place;
use crate::scene::{Object, Point, Reflector, Scene};
use crate::signal::{self, BeatSignal, Floor};
use crate::task::Task;
use crate::theory::Phasors as Chain;

#[derive(Clone, PartialEq)]
pub struct PhasorsQuery {
    source: Source,
    cell: [usize; 2],
    /// Place of a point whose blob peaks in the cell.
    place: Place,
    settings: PhasorSettings,
    found: Vec<Reflector>,
}

impl PhasorsQuery {
    /// The query of the cell under the cursor, where the map has one.
    pub fn of(state: &State, pipeline: &Pipeline) -> Option<Self> {
        let cursor = state.cut_cursor();
        let (bin, column) = cursor.cell(state.radar())?;
        let settings = state.settings.phasors;
        let found = pipeline.output_of(state).filter(|_| settings.residual).map(|output| output.reflectors.clone());
        let (source, found) = (Source::of(state), found.unwrap_or_default());
        Some(PhasorsQuery { source, cell: [bin, column], place: cursor.place, settings, found })
    }
}

/// Chains of phasors of one cell.
pub struct PhasorsResult {
    pub cell: [usize; 2],
    pub measured: Chain,
    /// The contributions without the curvature of a wave from the cell's place.
    pub focused: Option<Chain>,
    pub echoes: Option<Chain>,
    /// Contributions left after subtracting the found reflectors.
    pub residual: Option<Chain>,
}

impl Query for PhasorsQuery {
    type Value = PhasorsResult;
    type State = KeptSignal;
    const WHAT: &'static str = "Computing the phasors";
    const ADVICE: &'static str = "Move the pointer to try again.";

    fn compute(&self, kept: &mut KeptSignal, _: &Task) -> Result<PhasorsResult, Failure> {
        let PhasorsQuery { source, cell, place, settings, found } = self;
        let radar = &source.radar;
        let chain = |signal: &BeatSignal| {
            Chain::of(radar, signal.samples.view(), settings.map.aperture(), *cell, settings.windowed)
        };
        let exact = |scene: &Scene| {
            signal::simulate(radar, scene, Floor::Exact, 0).map_err(|e| e.to_string()).map(|signal| chain(&signal))
        };
        let measured = chain(kept.try_of(source.clone(), Source::every_element)?);
        let focused = match settings.focused {
            true => Some(measured.focused(&exact(&Scene::of_points([(place.x_metres, place.y_metres)]))?)),
            false => None,
        };
        let echoes = if settings.echoes && source.recording.is_none() { Some(exact(&source.scene)?) } else { None };
        let residual = if settings.residual { Some(less(&measured, &exact(&scene_of(found))?)) } else { None };
        Ok(PhasorsResult { cell: *cell, measured, focused, echoes, residual })
    }
}

/// The contributions of `chain` minus those of `other`.
fn less(chain: &Chain, other: &Chain) -> Chain {
    let contributions = chain.contributions.iter().zip(&other.contributions).map(|(a, b)| a - b).collect();
    Chain { first_element: chain.first_element, contributions }
}

fn scene_of(reflectors: &[Reflector]) -> Scene {
    let point =
        |r: &Reflector| Object::Point(Point { reflectivity: r.reflectivity, ..Point::new(r.x_metres, r.y_metres) });
    Scene { objects: reflectors.iter().map(point).collect(), ..Scene::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shared::Shared;
    use crate::radar::Radar;

    #[test]
    fn nothing_is_left_where_the_method_found_the_reflector() {
        let settings = PhasorSettings { residual: true, echoes: true, focused: true, ..PhasorSettings::default() };
        let found = vec![Reflector { x_metres: 0.2, y_metres: 0.9, reflectivity: 1.0 }];
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let scene = Shared::new(Scene::of_points([(0.2, 0.9)]));
        let source = Source { radar, scene, recording: None, floor: Floor::Thesis };
        let query = PhasorsQuery { source, cell: [12, 40], place: Place::new(0.2, 0.9), settings, found };
        let result = query.compute(&mut KeptSignal::default(), &Task::default()).unwrap();
        let measured = result.measured.sum().norm();
        assert!(result.residual.unwrap().sum().norm() < 1e-9 * measured);
        assert!((result.echoes.unwrap().sum().norm() - measured).abs() < 1e-9 * measured);
        assert!(result.focused.unwrap().sum().norm() >= measured * (1.0 - 1e-9), "a straight chain reaches farther");
    }
}
