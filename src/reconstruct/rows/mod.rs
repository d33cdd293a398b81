//! The methods that work on one end and one range row at a time.
//!
//! Each end's samples become range profiles; each range row is a snapshot of twelve elements from which a method estimates power
//! over angle. Both ends' estimates are laid onto the centre's grid and their geometric mean is taken: what only one end
//! believes in fades. Nothing of that uses the phase between the ends. A method draws that power, or its peaks: these are moved to where
//! their exact echoes explain the samples of both ends best, as those of the coherent methods are, and the exact map is drawn.

mod bartlett;
mod capon;
mod covariance;
mod esprit;
mod linear_prediction;
mod method;
mod music;
mod registered;
mod root_music;
mod row;

pub use bartlett::BARTLETT;
pub use capon::{CAPON, CAPON_PEAKS};
pub use esprit::ESPRIT;
pub use linear_prediction::{LINEAR_PREDICTION, LINEAR_PREDICTION_PEAKS};
pub use method::RowMethod;
pub use music::{MUSIC, MUSIC_PEAKS};
pub use root_music::{ROOT_MUSIC, ROOT_MUSIC_PEAKS};
