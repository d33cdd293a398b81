//! The panels, one a file: each draws its input and returns commands.

pub mod bounds;
mod captions;
pub mod chirp;
pub mod compare;
pub mod controls;
pub mod cuts;
pub mod disturbances;
pub mod doppler;
pub mod elements;
pub mod evaluation;
pub mod failures;
pub mod found;
pub mod guide;
pub mod inspector;
pub mod lesson;
pub mod map;
pub mod objects;
pub mod phasors;
pub mod radar;
pub mod recording;
pub mod roc;
pub mod run_time;
pub mod scene;
pub mod several;
pub mod timing;
pub mod training;
pub mod values;
