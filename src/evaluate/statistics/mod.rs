//! Statistics of rows: the comparison of two methods, and doubt as a predictor of failures.

mod doubt;
mod paired;

pub use doubt::{DoubtArea, ONE_OF, RocArea};
pub use paired::{MAX_RESAMPLED_SCENES, Paired, RESAMPLES};
