//! The incremental engine, which computes only wanted maps and only their changed parts.
//!
//! [`Engine::update`] takes a scene and a [`MapRequest`] and returns an [`EngineFrame`]. Unchanged maps are the same [`Arc`](std::sync::Arc) as before, so
//! that a painter can skip them by `Arc::ptr_eq`.
//!
//! The sums kept between updates leave rounding errors in the maps, below the requested tolerance. The maps then don't have the same bits as from scratch. The
//! samples of the ends always do. For a scene at rest [`Engine::settle`] computes the maps as every command does: the same scene, seed and settings give the
//! same bits, after any earlier scene.

mod amplitudes;
mod bank;
mod change;
mod frame;
mod incremental;
mod report;
mod settled;
mod shown;

pub use frame::{EngineFrame, MapRequest, ReadyMap};
pub use incremental::{Engine, PlanOverrides};
pub use report::{EngineReport, EngineStage, StageOutcome, StageReport};
