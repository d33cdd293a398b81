//! Maps, colours and coordinates of one picture.

use crate::app::shared::Shared;
use crate::app::state::{DifferenceView, Projection};
use crate::maps::RangeAngleMap;
use crate::picture::ColourMap;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    Lambda(ColourMap),
    /// Cells above a threshold; beside a target by their verdict against it: flat fills with an outline around each patch.
    Above {
        eta: f32,
        dark: bool,
    },
    /// Expected errors, from 0 to the next round number.
    Doubt(ColourMap),
    /// Differences from another map.
    Difference {
        /// Sign and scale of the differences.
        view: DifferenceView,
        /// Colours of differences without a sign.
        colours: ColourMap,
        /// Largest difference in the picture beside this one: both have one scale.
        beside: f32,
    },
}

#[derive(Debug, Clone, PartialEq)]
pub struct Subject {
    pub map: Shared<RangeAngleMap>,
    /// The map that [`Paint::Difference`] subtracts, or the target that cells above a threshold are compared with ([`Paint::Above`]).
    pub minus: Option<Shared<RangeAngleMap>>,
    pub paint: Paint,
    pub projection: Projection,
    /// Whether a map of few columns is painted on more of them. Masks are not: their verdicts are per cell.
    pub is_fine: bool,
}
