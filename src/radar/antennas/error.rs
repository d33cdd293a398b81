//! Errors of an array of antennas.

pub(super) const MIN_ELEMENTS: usize = 2;
pub(super) const MAX_ELEMENTS: usize = 65536;
/// Largest distance of a pair's midpoint from an evenly spaced line, as a fraction of the spacing.
pub(super) const MAX_OFF_LINE_PART: f64 = 0.01;
pub(super) const MAX_Y_METRES: f64 = 1.0;

/// A reason for which transmitters and receivers form no uniform array.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum AntennasError {
    #[error("{list} has {found}; expected finite numbers, at least one")]
    Places { list: &'static str, found: String },
    #[error("{list} has {found} numbers; expected {expected}, one for each antenna")]
    Length { list: &'static str, found: usize, expected: usize },
    #[error("number {} of {list} is {found}; expected at most {MAX_Y_METRES} m off the line, either way", index + 1)]
    OffLine { list: &'static str, index: usize, found: f64 },
    #[error("{transmitters} transmitters and {receivers} receivers make {} elements; expected {MIN_ELEMENTS} to {MAX_ELEMENTS}", transmitters.saturating_mul(*receivers))]
    Count { transmitters: usize, receivers: usize },
    #[error(
        "the midpoint of transmitter {} and receiver {} stands {:.3} mm off the even line, whose places are {:.3} mm apart; expected at most {:.3} mm",
        transmitter + 1, receiver + 1, off_metres * 1e3, spacing_metres * 1e3, MAX_OFF_LINE_PART * spacing_metres * 1e3
    )]
    Uneven { transmitter: usize, receiver: usize, off_metres: f64, spacing_metres: f64 },
    #[error("all pairs have one midpoint; expected a line of them")]
    OnePlace,
    #[error(
        "the pairs stand on a line of {elements} places; expected as many as such antennas make, {MIN_ELEMENTS} to {MAX_ELEMENTS}"
    )]
    Line { elements: usize },
}
