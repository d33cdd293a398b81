//! What rows of an evaluation allow to say: whether one method is better than another, what the bad rows have in common, and whether doubt
//! finds them.

mod chance;
mod doubt;
mod paired;
mod shared;

pub use doubt::{DoubtArea, ONE_OF, RocArea};
pub use paired::{MAX_RESAMPLED_SCENES, Paired, RESAMPLES};
pub use shared::{DISCOVERY_RATE, Rule, SharedTrait, USUALLY_BAD, rules};
