//! What panels draw with: axes, colours of the interface, buttons of commands, small drawn buttons, bars of progress, pictures on the graphics card.

pub mod axes;
pub mod entry;
pub mod icons;
pub mod progress;
pub mod textures;
pub mod theme;
