//! Pictures of a scene and its maps, drawn without a display.
//!
//! [`render`] draws the same panels as the app: the scene on the left, the maps of both ends, of the whole array and of a reconstruction on the
//! right, and both after a threshold. Without the feature `pictures` there are only the colour maps.

pub mod colour;
mod detections;
mod finer;
#[cfg(feature = "pictures")]
mod plotted;

pub use colour::ColourMap;
pub use detections::{CellVerdict, told_apart};
pub use finer::{finer, in_place};
#[cfg(feature = "pictures")]
pub use plotted::*;
