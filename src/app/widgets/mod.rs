//! Widgets of panels: axes, charts, directions and levels as text, colours, buttons of commands, drawn buttons, boxes of scene kinds, number fields, progress
//! bars, the focus ring, textures.

pub mod axes;
pub mod chart;
pub mod colour_bar;
pub mod direction;
pub mod entry;
pub mod focus_ring;
pub mod icons;
pub mod inline;
pub mod kind_boxes;
pub mod labelled;
pub mod legend;
pub mod levels;
pub mod list_rows;
pub mod method_menu;
#[cfg(feature = "live")]
mod networks;
pub mod nudge;
pub mod number_field;
pub mod numbers;
pub mod padded;
pub mod progress;
#[cfg(test)]
pub mod seen;
pub mod setting_row;
pub mod textures;
pub mod theme;
