//! The beat of one element and its spectrum.

use super::derived::{Failure, Query};
use super::source::{KeptSignal, Source};
use crate::app::state::State;
use crate::maps::channels_range_transform;
use crate::task::Task;
use ndarray::s;
use num_complex::Complex64;

#[derive(Clone, PartialEq)]
pub struct ChirpQuery {
    source: Source,
    element: usize,
}

impl ChirpQuery {
    pub fn of(state: &State) -> Self {
        let element = state.settings.chirp.element.min(state.radar().elements - 1);
        ChirpQuery { source: Source::of(state), element }
    }
}

pub struct ChirpResult {
    pub element: usize,
    pub samples: Vec<Complex64>,
    /// Amplitude of each range bin of the beat's spectrum under the radar's window.
    pub spectrum: Vec<f64>,
}

impl Query for ChirpQuery {
    type Value = ChirpResult;
    type State = KeptSignal;
    const WHAT: &'static str = "Computing the beat";

    fn compute(&self, kept: &mut KeptSignal, _: &Task) -> Result<ChirpResult, Failure> {
        let ChirpQuery { source, element } = self;
        let row = kept.try_of(source.clone(), Source::every_element)?.samples.slice(s![*element..element + 1, ..]);
        let profile = channels_range_transform(&source.radar, row).profiles;
        let samples = row.iter().copied().collect();
        let spectrum = profile.iter().map(|cell| cell.norm()).collect();
        Ok(ChirpResult { element: *element, samples, spectrum })
    }
}
