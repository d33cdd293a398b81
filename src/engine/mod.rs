//! The incremental engine: what changed, what is looked at, and nothing else computed.
//!
//! [`Engine::update`] takes a scene and a [`MapRequest`] and gives a [`EngineFrame`]. Results that did not change are the same
//! [`Arc`](std::sync::Arc) as before, so that a painter tells with `Arc::ptr_eq` that nothing needs drawing.
//!
//! What it keeps between updates leaves its rounding in the maps: less than the tolerance asked for, but not the same bits as from scratch. The
//! samples of the ends are exempt from that, and once a scene rests [`Engine::settle`] computes its maps as every command does: the same
//! scene, seed and settings are the same bits, after any earlier scene.

mod amplitudes;
mod bank;
mod change;
mod frame;
mod incremental;
mod report;
mod settled;
mod shown;

pub use frame::{EngineFrame, MapRequest, ReadyMap};
pub use incremental::{Engine, Forced};
pub use report::{EngineReport, EngineStage, StageOutcome, StageReport};
