//! How good a map is: the thesis' squared error, detection and false-alarm rates, ROC and tables; and run time against error, and numerical stress.

pub mod campaign;
pub mod front;
mod metrics;
mod placement;
mod roc;
pub mod stress;
pub mod tables;

pub use metrics::{Metrics, TARGET_ETA, detection_rates, squared_error};
pub use placement::{Placement, placement};
pub use roc::{Roc, RocPoint};
