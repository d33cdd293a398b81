//! Whole pictures: panels, curves and their lettering, as PNG or SVG.

mod canvas;
mod compose;
mod directions;
mod doppler;
mod error;
mod inputs;
mod lettering;
mod map_panel;
mod panels;
mod png;
mod recording;
mod scene_panel;
mod text;

pub use canvas::{Drawing, Painted, PanelArea, PictureError, painted};
pub use compose::{PictureFormat, Style, compose};
pub use directions::{Curve, DirectionAxis, Mark};
pub use doppler::compose_range_doppler;
pub use error::ComposeError;
pub use inputs::InputMap;
pub use panels::{DetectedCells, Panels, render, render_svg};
pub use png::{encode_png, is_our_png};
pub use recording::{compose_recording, maps_of};
