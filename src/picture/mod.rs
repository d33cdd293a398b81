//! Pictures of a scene and its maps, drawn without a display.
//!
//! [`render`] draws the same panels as the app: the scene on the left, the maps of both ends, of the whole array and of a reconstruction on the
//! right, and both after a threshold. Without the feature `pictures` there are only the colour maps.

pub mod colour;
mod detections;
mod finer;

#[cfg(feature = "pictures")]
mod canvas;
#[cfg(feature = "pictures")]
mod compose;
#[cfg(feature = "pictures")]
mod directions;
#[cfg(feature = "pictures")]
mod doppler;
#[cfg(feature = "pictures")]
mod error;
#[cfg(feature = "pictures")]
mod inputs;
#[cfg(feature = "pictures")]
mod lettering;
#[cfg(feature = "pictures")]
mod map_panel;
#[cfg(feature = "pictures")]
mod panels;
#[cfg(feature = "pictures")]
mod png;
#[cfg(feature = "pictures")]
mod recording;
#[cfg(feature = "pictures")]
mod scene_panel;
#[cfg(feature = "pictures")]
mod text;

pub use colour::ColourMap;
pub use detections::{CellVerdict, told_apart};
pub use finer::{finer, in_place};

#[cfg(feature = "pictures")]
pub use canvas::{Drawing, PictureError};
#[cfg(feature = "pictures")]
pub use compose::{PictureFormat, Style, compose};
#[cfg(feature = "pictures")]
pub use directions::{Curve, DirectionAxis, Mark};
#[cfg(feature = "pictures")]
pub use doppler::compose_range_doppler;
#[cfg(feature = "pictures")]
pub use error::ComposeError;
#[cfg(feature = "pictures")]
pub use inputs::InputMap;
#[cfg(feature = "pictures")]
pub use panels::{DetectedCells, Panels, render, render_svg};
#[cfg(feature = "pictures")]
pub use png::{encode_png, is_our_png};
#[cfg(feature = "pictures")]
pub use recording::{compose_recording, maps_of};
#[cfg(feature = "pictures")]
pub use text::register_fonts;
