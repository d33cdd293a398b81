//! Measures of maps: the thesis' squared error, detection and false-alarm rates, ROC and tables; methods over many scenes, row by row; kinds of
//! failure; and the search for worse scenes.

mod blobs;
pub mod campaign;
pub mod echoes;
mod estimate;
pub mod filter;
mod metrics;
mod offset;
mod placement;
mod robustness;
mod roc;
pub mod rows;
pub mod sets;
mod shard;
pub mod statistics;
pub mod tables;
mod target;
pub mod threshold;
pub mod trial;
pub mod verdict;
pub mod worsen;

pub use blobs::{Blobs, blobs, dip_between};
pub use estimate::{Estimate, upper_median};
pub use metrics::{Metrics, TARGET_ETA, detection_rates, eta_text, part_within, squared_doubt, squared_error};
pub use offset::{median_bound_metres, median_offset_metres};
pub use placement::{Placement, placement};
pub use robustness::{Robustness, RobustnessRow};
pub use roc::{Roc, RocPoint};
pub use target::Target;
