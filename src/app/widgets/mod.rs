//! What panels draw with: axes, charts, colours of the interface, buttons of commands, small drawn buttons, bars of progress, pictures on the graphics card.

pub mod axes;
pub mod chart;
pub mod colour_bar;
pub mod entry;
pub mod icons;
pub mod inline;
pub mod legend;
pub mod numbers;
pub mod progress;
#[cfg(test)]
pub mod seen;
pub mod textures;
pub mod theme;
