//! How good a map is: the thesis' squared error, detection and false-alarm rates, ROC and tables.

pub mod campaign;
mod metrics;
mod placement;
mod roc;
pub mod tables;

pub use metrics::{Metrics, TARGET_ETA, detection_rates, squared_error};
pub use placement::{Placement, placement};
pub use roc::{Roc, RocPoint};
