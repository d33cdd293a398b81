//! What a picture shows, and how.

use crate::app::shared::Shared;
use crate::app::state::{DifferenceView, Projection};
use crate::maps::RangeAngleMap;
use crate::picture::ColourMap;

/// How a map is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// Lambda in colours.
    Lambda(ColourMap),
    /// Cells above a threshold, in two colours.
    Above {
        /// The threshold.
        eta: f32,
        /// Whether the window is dark.
        dark: bool,
    },
    /// Cells above a threshold, told apart by whether the target has them too: flat fills, each with an outline.
    Detections {
        /// The threshold.
        eta: f32,
        /// Whether the window is dark.
        dark: bool,
    },
    /// Expected errors, from none to the next round number.
    Doubt(ColourMap),
    /// Differences from another map.
    Difference {
        /// On which scale, with a sign or without.
        view: DifferenceView,
        /// Colours of differences without a sign.
        colours: ColourMap,
        /// The largest of another difference that stands beside it: both have one scale.
        beside: f32,
    },
}

/// What one picture shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Subject {
    /// What is shown.
    pub map: Shared<RangeAngleMap>,
    /// Subtracted by [`Paint::Difference`]; the target of [`Paint::Detections`].
    pub minus: Option<Shared<RangeAngleMap>>,
    /// How.
    pub paint: Paint,
    /// Over which coordinates.
    pub projection: Projection,
}
