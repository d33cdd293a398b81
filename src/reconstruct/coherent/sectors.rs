//! Sectors: directions that share one registration.

use super::ends::Ends;
use crate::radar::Radar;

/// Largest difference of a range at an element between a sector's edge and its middle, range bins.
const MAX_MIGRATION_BINS: f64 = 0.5;

/// Directions of a model in each period of the fringes between the two ends, where there are many sectors.
const DIRECTIONS_PER_FRINGE: f64 = 4.0;

/// The same where one model has all directions.
const SINGLE_MODEL_DIRECTIONS_PER_FRINGE: f64 = 12.0;

/// Largest number of directions of a model; beyond it the grid is coarser.
const MAX_DIRECTIONS: usize = 1536;

/// Width of an end's beam in cos(theta).
pub(super) fn end_beam_cos(radar: &Radar) -> f64 {
    radar.beam_cos(radar.end_elements as f64 * radar.element_spacing_metres)
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sector {
    /// The direction at which models are exact.
    pub middle_cos: f64,
    pub half_width_cos: f64,
}

pub(super) struct Sectors {
    /// From cos(theta) = -1 to 1.
    pub all: Vec<Sector>,
    /// Directions of a model, relative to the sector's middle, in rising order.
    pub steps_cos: Vec<f64>,
    /// Period in cos(theta) of the fringes between the outermost elements.
    pub fringe_cos: f64,
}

impl Sectors {
    /// The fewest sectors that keep every element's range within half a bin.
    pub fn new(radar: &Radar, ends: &Ends) -> Self {
        let reach_metres = ends.x_metres.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let span_metres = ends.x_metres.last().unwrap_or(&0.0) - ends.x_metres.first().unwrap_or(&0.0);
        let widest = if radar.samples == 1 {
            1.0 // one sample has no range bins
        } else {
            MAX_MIGRATION_BINS * radar.range_resolution_metres() / reach_metres.max(f64::MIN_POSITIVE)
        };
        let count = (1.0 / widest.min(1.0)).ceil() as usize;
        let half_width_cos = 1.0 / count as f64;
        let sector = |i: usize| Sector { middle_cos: (2 * i + 1) as f64 * half_width_cos - 1.0, half_width_cos };
        let turns_per_cos = span_metres * radar.carrier_turns_per_metre().abs();
        let per_fringe = if count == 1 { SINGLE_MODEL_DIRECTIONS_PER_FRINGE } else { DIRECTIONS_PER_FRINGE };
        let fringe_cos = 1.0 / turns_per_cos.max(f64::MIN_POSITIVE);
        // Directions reach one fringe beyond either edge, so that no maximum lies on an edge.
        let reach_cos = half_width_cos + fringe_cos.min(half_width_cos);
        let directions = (2.0 * reach_cos * turns_per_cos * per_fringe).ceil().max(8.0) as usize;
        let directions = directions.min(MAX_DIRECTIONS);
        let step = |i: usize| ((2 * i + 1) as f64 / directions as f64 - 1.0) * reach_cos;
        Sectors { all: (0..count).map(sector).collect(), steps_cos: (0..directions).map(step).collect(), fringe_cos }
    }
}
