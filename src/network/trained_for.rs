//! The radar that networks were trained for.

use crate::radar::Radar;
use crate::reconstruct::ReconstructError;

/// Refuses every radar but table 3.1's with its one-way carrier and Hann window: the weights know no other, and what they would
/// draw of its samples means nothing.
///
/// # Errors
/// [`ReconstructError::Unusable`] names the radar that `method` needs.
pub(super) fn check_radar(method: &'static str, radar: &Radar) -> Result<(), ReconstructError> {
    if *radar == Radar::default() {
        return Ok(());
    }
    Err(ReconstructError::Unusable {
        method,
        reason: "the network works only with the default radar (table 3.1: 1024 elements, 512 samples, 2 GHz at 77 GHz, one-way carrier, \
                 Hann window)"
            .into(),
    })
}
