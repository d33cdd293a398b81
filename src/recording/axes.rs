//! Axes: from an array of any shape to `[elements, samples]`.

use super::analytic::analytic;
use super::numbers::Numbers;
use ndarray::{Array2, Array4, ArrayD, Axis, IxDyn};
use num_complex::Complex64;
use serde::Deserialize;
use std::fmt;

/// Most numbers whose chirps are joined.
const MOST_JOINED: usize = 1 << 23;

/// The quantity that an axis of an array counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AxisKind {
    /// Elements of the array, or of the two ends.
    Element,
    /// Transmitters of a MIMO array: with [`AxisKind::Receiver`] in place of elements, which count through the receivers first.
    Transmitter,
    /// Receivers of a MIMO array.
    Receiver,
    /// Samples of one chirp.
    Sample,
    /// Chirps or anything else that repeats: [`Chirp`] picks.
    Chirp,
    /// Frames, of which one is looked at.
    Frame,
    /// Real and imaginary part, in this order.
    Iq,
}

impl fmt::Display for AxisKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AxisKind::Element => "element",
            AxisKind::Transmitter => "transmitter",
            AxisKind::Receiver => "receiver",
            AxisKind::Sample => "sample",
            AxisKind::Chirp => "chirp",
            AxisKind::Frame => "frame",
            AxisKind::Iq => "iq",
        })
    }
}

/// The chirp or loop that is taken of several, or the way to join them all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a number from 0, \"mean\" or \"strongest\"")]
pub enum Chirp {
    /// The chirp or loop of this number, from 0.
    Number(usize),
    /// A way to join them all.
    Joined(Join),
}

impl Default for Chirp {
    fn default() -> Self {
        Chirp::Number(0)
    }
}

/// A way to join chirps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Join {
    /// Their complex mean: echoes that stand still stay, moving ones fade.
    Mean,
    /// Of each range bin the strongest Doppler cell and those that stand out beside it, transmitters in turn compensated for their velocities.
    Strongest,
}

/// An array that doesn't fit its axes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AxesError {
    /// The text names another number of axes than the array has.
    #[error("recording.axes names {named} axes, but the array has shape {shape:?}")]
    Count {
        /// Axes named.
        named: usize,
        /// Shape found.
        shape: Vec<usize>,
    },
    /// An axis is named twice, or too many or too few axes count the elements.
    #[error("recording.axes: {0}")]
    Kinds(String),
    /// The numbers are real, and no axis counts samples.
    #[error(
        "the array holds real numbers; expected complex ones, an axis \"iq\" of length 2, or real samples of an axis \"sample\""
    )]
    Real,
    /// There is no such frame.
    #[error("recording.frame is {asked}; expected 0 to {last}, the array has {frames} frames", last = frames.saturating_sub(1))]
    NoFrame {
        /// The frame asked for.
        asked: usize,
        /// Frames there are.
        frames: usize,
    },
    /// The numbers are complex already.
    #[error("the array holds complex numbers; expected no axis \"iq\"")]
    Complex,
    /// The axis of real and imaginary part has another length than 2.
    #[error("axis \"iq\" has length {0}; expected 2, real and imaginary part")]
    Iq(usize),
    /// An array of several chirps without a choice of one.
    #[error("the array has {0} chirps; expected recording.chirp = 0 to {last}, \"mean\" or \"strongest\"", last = .0.saturating_sub(1))]
    ChirpUnsaid(usize),
    /// There is no such chirp.
    #[error("recording.chirp is {asked}; expected 0 to {last}, the array has {chirps} chirps", last = chirps.saturating_sub(1))]
    NoChirp {
        /// The chirp asked for.
        asked: usize,
        /// Chirps there are.
        chirps: usize,
    },
}

/// Takes one frame of `numbers`, whose axis is then gone from `kinds`; the first where none is asked for.
///
/// # Errors
/// [`AxesError`] where `kinds` are not the array's axes, or there is no such frame.
pub(super) fn one_frame(
    numbers: Numbers,
    kinds: &mut Vec<AxisKind>,
    frame: Option<usize>,
) -> Result<Numbers, AxesError> {
    let Some(place) = kinds.iter().position(|k| *k == AxisKind::Frame) else {
        return match frame {
            None => Ok(numbers),
            Some(_) => Err(AxesError::Kinds("recording.frame picks, but no axis is \"frame\"".to_owned())),
        };
    };
    check(kinds, numbers.shape())?;
    let (frames, asked) = (numbers.shape()[place], frame.unwrap_or(0));
    if asked >= frames {
        return Err(AxesError::NoFrame { asked, frames });
    }
    kinds.remove(place);
    Ok(match numbers {
        Numbers::Real(values) => Numbers::Real(values.index_axis_move(Axis(place), asked)),
        Numbers::Complex(values) => Numbers::Complex(values.index_axis_move(Axis(place), asked)),
    })
}

/// Splits the axis of chirps into loops and `transmitters` that send in turn; elements are their receivers then.
///
/// # Errors
/// [`AxesError`] where the axes are others, or the chirps don't divide.
pub(super) fn in_turn(
    numbers: Numbers,
    kinds: &mut Vec<AxisKind>,
    transmitters: Option<usize>,
) -> Result<Numbers, AxesError> {
    let Some(transmitters) = transmitters else { return Ok(numbers) };
    let place = kinds.iter().position(|k| *k == AxisKind::Chirp);
    let shape = numbers.shape().to_vec();
    let (Some(place), false) = (place, kinds.contains(&AxisKind::Transmitter) || kinds.len() != shape.len()) else {
        let expected = "expected an axis \"chirp\" and none \"transmitter\" beside recording.transmitters_in_turn";
        return Err(AxesError::Kinds(expected.to_owned()));
    };
    if transmitters == 0 || !shape[place].is_multiple_of(transmitters) {
        let message = format!("{} chirps are no multiple of {transmitters} transmitters in turn", shape[place]);
        return Err(AxesError::Kinds(message));
    }
    let split = [&shape[..place], &[shape[place] / transmitters, transmitters], &shape[place + 1..]].concat();
    kinds.insert(place + 1, AxisKind::Transmitter);
    kinds.iter_mut().filter(|kind| **kind == AxisKind::Element).for_each(|kind| *kind = AxisKind::Receiver);
    let failed = |e: ndarray::ShapeError| AxesError::Kinds(e.to_string());
    Ok(match numbers {
        Numbers::Real(values) => Numbers::Real(values.to_shape(split).map_err(failed)?.into_owned()),
        Numbers::Complex(values) => Numbers::Complex(values.to_shape(split).map_err(failed)?.into_owned()),
    })
}

/// Sorts `numbers` into `[loops, transmitters, receivers, samples]`, where there are chirps to join. At most [`MOST_JOINED`] numbers are
/// taken, since they are held several times: further chirps are left out.
///
/// # Errors
/// [`AxesError`] where `kinds` are not the array's axes.
pub(super) fn loops(numbers: Numbers, kinds: &[AxisKind]) -> Result<Array4<Complex64>, AxesError> {
    let mut kinds = kinds.to_vec();
    check(&kinds, numbers.shape())?;
    let values = complex(numbers, &mut kinds)?;
    let place = |kind| kinds.iter().position(|k| *k == kind);
    let len = |kind| place(kind).map_or(1, |p| values.shape()[p]);
    let receivers = len(AxisKind::Receiver) * len(AxisKind::Element);
    let of_a_loop = len(AxisKind::Transmitter) * receivers * len(AxisKind::Sample);
    let held = (MOST_JOINED / of_a_loop.max(1)).clamp(1, len(AxisKind::Chirp).max(1));
    let shape = (len(AxisKind::Chirp).min(held), len(AxisKind::Transmitter), receivers, len(AxisKind::Sample));
    let sorted = values.view().permuted_axes(order(&kinds));
    let numbers = sorted.iter().copied().take(shape.0 * of_a_loop).collect();
    Array4::from_shape_vec(shape, numbers).map_err(|e| AxesError::Kinds(e.to_string()))
}

/// Sorts `numbers` into `[elements, samples]`. Real samples become the analytic signal of as many samples: the far half of the range axis is
/// empty then.
///
/// # Errors
/// [`AxesError`] where `kinds` are not the array's axes, or `chirp` none of its chirps.
pub(super) fn arrange(
    numbers: Numbers,
    kinds: &[AxisKind],
    chirp: Option<Chirp>,
) -> Result<Array2<Complex64>, AxesError> {
    let mut kinds = kinds.to_vec();
    check(&kinds, numbers.shape())?;
    let values = complex(numbers, &mut kinds)?;
    let values = one_chirp(values, &mut kinds, chirp)?;
    let samples = kinds.iter().position(|k| *k == AxisKind::Sample).map_or(1, |place| values.shape()[place]);
    let elements = values.len().checked_div(samples).unwrap_or(0);
    let sorted = values.permuted_axes(order(&kinds));
    // The same numbers in the same order: the shape can't fail to fit.
    Array2::from_shape_vec((elements, samples), sorted.iter().copied().collect())
        .map_err(|e| AxesError::Kinds(e.to_string()))
}

/// The places of the axes from loops to samples.
fn order(kinds: &[AxisKind]) -> IxDyn {
    let all = [AxisKind::Chirp, AxisKind::Transmitter, AxisKind::Receiver, AxisKind::Element, AxisKind::Sample];
    let places: Vec<usize> = all.iter().filter_map(|kind| kinds.iter().position(|k| k == kind)).collect();
    IxDyn(&places)
}

fn check(kinds: &[AxisKind], shape: &[usize]) -> Result<(), AxesError> {
    if kinds.len() != shape.len() {
        return Err(AxesError::Count { named: kinds.len(), shape: shape.to_vec() });
    }
    let has = |kind| kinds.contains(&kind);
    if let Some(twice) = kinds.iter().enumerate().find(|(i, kind)| kinds[..*i].contains(kind)) {
        return Err(AxesError::Kinds(format!("\"{}\" stands twice; expected each axis once", twice.1)));
    }
    let whole = has(AxisKind::Element) && !has(AxisKind::Transmitter) && !has(AxisKind::Receiver);
    let pairs = !has(AxisKind::Element) && has(AxisKind::Transmitter) && has(AxisKind::Receiver);
    if !(whole || pairs) {
        let expected = "expected either \"element\", or both \"transmitter\" and \"receiver\"";
        return Err(AxesError::Kinds(expected.to_owned()));
    }
    Ok(())
}

/// Real and imaginary parts joined; the axis they stood on is gone from `kinds`.
fn complex(numbers: Numbers, kinds: &mut Vec<AxisKind>) -> Result<ArrayD<Complex64>, AxesError> {
    let place = kinds.iter().position(|k| *k == AxisKind::Iq);
    match (numbers, place) {
        (Numbers::Complex(values), None) => Ok(values),
        (Numbers::Complex(_), Some(_)) => Err(AxesError::Complex),
        (Numbers::Real(values), None) => {
            let samples = kinds.iter().position(|k| *k == AxisKind::Sample).ok_or(AxesError::Real)?;
            let mut values = values.mapv(Complex64::from);
            for mut line in values.lanes_mut(Axis(samples)) {
                let signal = analytic(&line.to_vec(), line.len());
                line.iter_mut().zip(signal).for_each(|(to, v)| *to = v);
            }
            Ok(values)
        }
        (Numbers::Real(values), Some(place)) => {
            let parts = values.shape()[place];
            if parts != 2 {
                return Err(AxesError::Iq(parts));
            }
            kinds.remove(place);
            let part = |i| values.index_axis(Axis(place), i);
            Ok(ndarray::Zip::from(part(0)).and(part(1)).map_collect(|re, im| Complex64::new(*re, *im)))
        }
    }
}

/// The chirp asked for; the axis of chirps is gone from `kinds`.
fn one_chirp(
    values: ArrayD<Complex64>,
    kinds: &mut Vec<AxisKind>,
    chirp: Option<Chirp>,
) -> Result<ArrayD<Complex64>, AxesError> {
    let Some(place) = kinds.iter().position(|k| *k == AxisKind::Chirp) else {
        return match chirp {
            None => Ok(values),
            Some(_) => Err(AxesError::Kinds("recording.chirp picks, but no axis is \"chirp\"".to_owned())),
        };
    };
    kinds.remove(place);
    let chirps = values.shape()[place];
    let number = match chirp {
        // Where no loops are joined, the strongest cell is that of the echoes that stand still: the mean.
        Some(Chirp::Joined(Join::Mean | Join::Strongest)) => {
            return values.mean_axis(Axis(place)).ok_or(AxesError::NoChirp { asked: 0, chirps });
        }
        Some(Chirp::Number(number)) => number,
        None if chirps == 1 => 0,
        None => return Err(AxesError::ChirpUnsaid(chirps)),
    };
    if number >= chirps {
        return Err(AxesError::NoChirp { asked: number, chirps });
    }
    Ok(values.index_axis_move(Axis(place), number))
}

#[cfg(test)]
mod tests;
