//! Directions that one registration serves.

use super::ends::Ends;
use crate::radar::Radar;

/// Range bins by which an element may hear a direction of the sector nearer or further than the sector's middle.
const MOST_MIGRATION_BINS: f64 = 0.5;

/// Directions of a model for each period of the fringes that the two ends make together, where sectors are many.
const PER_FRINGE: f64 = 4.0;

/// The same where one model serves all directions.
const PER_FRINGE_ALONE: f64 = 12.0;

/// Most directions of one model, beyond which the grid gets coarser.
const MOST_DIRECTIONS: usize = 1536;

/// Neighbouring directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sector {
    /// The direction it is registered for.
    pub middle_cos: f64,
    /// How far it reaches to either side.
    pub half_width_cos: f64,
}

/// All sectors of a radar, from -1 to 1.
pub(super) struct Sectors {
    /// The sectors, in rising order of cos(theta).
    pub all: Vec<Sector>,
    /// Directions of one model, relative to the sector's middle, in rising order.
    pub steps_cos: Vec<f64>,
    /// Period of the fringes that the outermost elements make together.
    pub fringe_cos: f64,
}

impl Sectors {
    /// As few as keep every element's range within half a bin.
    pub fn new(radar: &Radar, ends: &Ends) -> Self {
        let reach_metres = ends.x_metres.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let span_metres = ends.x_metres.last().unwrap_or(&0.0) - ends.x_metres.first().unwrap_or(&0.0);
        let widest = if radar.samples == 1 {
            1.0 // one sample has no ranges to migrate through
        } else {
            MOST_MIGRATION_BINS * radar.range_resolution_metres() / reach_metres.max(f64::MIN_POSITIVE)
        };
        let count = (1.0 / widest.min(1.0)).ceil() as usize;
        let half_width_cos = 1.0 / count as f64;
        let sector = |i: usize| Sector { middle_cos: (2 * i + 1) as f64 * half_width_cos - 1.0, half_width_cos };
        let turns_per_cos = span_metres * radar.carrier_turns_per_metre().abs();
        let per_fringe = if count == 1 { PER_FRINGE_ALONE } else { PER_FRINGE };
        let fringe_cos = 1.0 / turns_per_cos.max(f64::MIN_POSITIVE);
        // A fringe more to either side, so that no maximum stands on an edge.
        let reach_cos = half_width_cos + fringe_cos.min(half_width_cos);
        let directions = (2.0 * reach_cos * turns_per_cos * per_fringe).ceil().max(8.0) as usize;
        let directions = directions.min(MOST_DIRECTIONS);
        let step = |i: usize| ((2 * i + 1) as f64 / directions as f64 - 1.0) * reach_cos;
        Sectors { all: (0..count).map(sector).collect(), steps_cos: (0..directions).map(step).collect(), fringe_cos }
    }
}
