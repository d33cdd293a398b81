//! Methods that use one end and one range row at a time.
//!
//! Each end's samples become range profiles; each range row is a snapshot of twelve elements from which a method estimates power over angle.
//! Both ends' estimates are interpolated on the centre's grid and their geometric mean is taken, which weakens peaks of one end alone. This uses
//! no phase between the ends. A method draws that power, or its peaks: these are moved to where their exact echoes explain the samples of both
//! ends best, as those of the coherent methods are, and the exact map of these echoes is drawn.

mod capon;
mod covariance;
mod esprit;
mod linear_prediction;
mod method;
mod music;
mod registered;
mod root_music;
mod row;

pub use capon::{CAPON, CAPON_PEAKS};
pub use esprit::ESPRIT;
pub use linear_prediction::{LINEAR_PREDICTION, LINEAR_PREDICTION_PEAKS};
pub use method::{BARTLETT, RowMethod};
pub use music::{MUSIC, MUSIC_PEAKS};
pub use root_music::{ROOT_MUSIC, ROOT_MUSIC_PEAKS};
