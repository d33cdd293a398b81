//! See what a 1024-element automotive radar sees, and how much of it 24 of those elements recover.
#![warn(missing_docs)]

pub mod bounds;
pub mod commands;
pub mod evaluate;
pub mod files;
pub mod interact;
pub mod live;
pub mod maps;
pub mod methods;
pub mod picture;
pub mod radar;
pub mod reconstruct;
pub mod scene;
pub mod signal;
