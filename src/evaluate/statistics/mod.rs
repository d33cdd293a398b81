//! Statistics of rows: the comparison of two methods, common traits of bad rows, and doubt as a predictor of failures.

mod chance;
mod doubt;
mod paired;
mod shared;

pub use doubt::{DoubtArea, ONE_OF, RocArea};
pub use paired::{MAX_RESAMPLED_SCENES, Paired, RESAMPLES};
pub use shared::{DISCOVERY_RATE, Rule, SharedTrait, USUALLY_BAD, rules};
