//! Axes: from an array of any shape to `[elements, samples]`.

use super::Fault;
use super::analytic::analytic;
use super::numbers::Numbers;
use ndarray::{Array2, Array4, ArrayD, Axis, IxDyn};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display};

/// Most numbers of the chirps that are joined: they are in memory several times.
const MAX_JOINED_NUMBERS: usize = 1 << 23;

/// The quantity that an axis of an array counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AxisKind {
    Element,
    /// Transmitters of a MIMO array: with [`AxisKind::Receiver`] in place of elements, which count through the receivers first.
    Transmitter,
    Receiver,
    Sample,
    /// Chirps or other repetitions, of which [`ChirpChoice`] selects.
    Chirp,
    Frame,
    /// Real and imaginary part, in this order.
    Iq,
}

impl Display for AxisKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
}

/// The number of the chirp or loop that is read, or the way to join all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number from 0, \"mean\" or \"strongest\"")]
pub enum ChirpChoice {
    Number(usize),
    Joined(Join),
}

impl Default for ChirpChoice {
    fn default() -> Self {
        ChirpChoice::Number(0)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Join {
    /// The complex mean of the chirps. Echoes at rest keep their amplitude, and moving ones cancel.
    Mean,
    /// The strong Doppler cells of each range bin. The phase that a moving echo gains between transmitters that send in turn is removed.
    Strongest,
}

/// Selects one frame of `numbers`, the first where `frame` is `None`, and removes the axis of frames from `kinds`.
pub(super) fn frame_of(numbers: Numbers, kinds: &mut Vec<AxisKind>, frame: Option<usize>) -> Result<Numbers, Fault> {
    let Some(place) = kinds.iter().position(|k| *k == AxisKind::Frame) else {
        return match frame {
            None => Ok(numbers),
            Some(_) => Err(unfit("recording.frame picks, but no axis is \"frame\"")),
        };
    };
    check_kinds(kinds, numbers.shape())?;
    let (frames, frame) = (numbers.shape()[place], frame.unwrap_or(0));
    if frame >= frames {
        let last = frames.saturating_sub(1);
        let message = format!("recording.frame is {frame}; expected 0 to {last}, the array has {frames} frames");
        return Err(Fault::Data(message));
    }
    kinds.remove(place);
    Ok(match numbers {
        Numbers::Real(values) => Numbers::Real(values.index_axis_move(Axis(place), frame)),
        Numbers::Complex(values) => Numbers::Complex(values.index_axis_move(Axis(place), frame)),
    })
}

/// Splits the axis of chirps into loops and `transmitters` that send in turn. An axis of elements becomes one of receivers.
pub(super) fn split_turns(
    numbers: Numbers,
    kinds: &mut Vec<AxisKind>,
    transmitters: Option<usize>,
) -> Result<Numbers, Fault> {
    let Some(transmitters) = transmitters else { return Ok(numbers) };
    let place = kinds.iter().position(|k| *k == AxisKind::Chirp);
    let shape = numbers.shape().to_vec();
    let (Some(place), false) = (place, kinds.contains(&AxisKind::Transmitter) || kinds.len() != shape.len()) else {
        let expected = "expected an axis \"chirp\" and none \"transmitter\" beside recording.transmitters_in_turn";
        return Err(unfit(expected));
    };
    if transmitters == 0 || !shape[place].is_multiple_of(transmitters) {
        let message = format!("{} chirps are no multiple of {transmitters} transmitters in turn", shape[place]);
        return Err(unfit(message));
    }
    let split = [&shape[..place], &[shape[place] / transmitters, transmitters], &shape[place + 1..]].concat();
    kinds.insert(place + 1, AxisKind::Transmitter);
    kinds.iter_mut().filter(|kind| **kind == AxisKind::Element).for_each(|kind| *kind = AxisKind::Receiver);
    Ok(match numbers {
        Numbers::Real(values) => Numbers::Real(values.to_shape(split).map_err(unfit)?.into_owned()),
        Numbers::Complex(values) => Numbers::Complex(values.to_shape(split).map_err(unfit)?.into_owned()),
    })
}

/// Sorts `numbers` into `[loops, transmitters, receivers, samples]`. Loops beyond [`MAX_JOINED_NUMBERS`] are left out.
pub(super) fn into_loops(numbers: Numbers, kinds: &[AxisKind]) -> Result<Array4<Complex64>, Fault> {
    let mut kinds = kinds.to_vec();
    check_kinds(&kinds, numbers.shape())?;
    let values = complex(numbers, &mut kinds)?;
    let place = |kind| kinds.iter().position(|k| *k == kind);
    let len = |kind| place(kind).map_or(1, |p| values.shape()[p]);
    let receivers = len(AxisKind::Receiver) * len(AxisKind::Element);
    let loop_numbers = len(AxisKind::Transmitter) * receivers * len(AxisKind::Sample);
    let max_loops = (MAX_JOINED_NUMBERS / loop_numbers.max(1)).max(1);
    let shape = (len(AxisKind::Chirp).min(max_loops), len(AxisKind::Transmitter), receivers, len(AxisKind::Sample));
    let sorted = values.view().permuted_axes(sorted_axes(&kinds));
    let numbers = sorted.iter().copied().take(shape.0 * loop_numbers).collect();
    Array4::from_shape_vec(shape, numbers).map_err(unfit)
}

/// Sorts `numbers` into `[elements, samples]`. Real samples become their analytic signal of as many samples, with an empty far half of the range axis.
pub(super) fn arrange(
    numbers: Numbers,
    kinds: &[AxisKind],
    chirp: Option<ChirpChoice>,
) -> Result<Array2<Complex64>, Fault> {
    let mut kinds = kinds.to_vec();
    check_kinds(&kinds, numbers.shape())?;
    let values = complex(numbers, &mut kinds)?;
    let values = select_chirp(values, &mut kinds, chirp)?;
    let samples = kinds.iter().position(|k| *k == AxisKind::Sample).map_or(1, |place| values.shape()[place]);
    let elements = values.len().checked_div(samples).unwrap_or(0);
    let sorted = values.permuted_axes(sorted_axes(&kinds));
    Array2::from_shape_vec((elements, samples), sorted.iter().copied().collect()).map_err(unfit)
}

fn unfit(message: impl Display) -> Fault {
    Fault::Data(format!("recording.axes: {message}"))
}

/// Indices of the axes in the order from loops to samples.
fn sorted_axes(kinds: &[AxisKind]) -> IxDyn {
    let all = [AxisKind::Chirp, AxisKind::Transmitter, AxisKind::Receiver, AxisKind::Element, AxisKind::Sample];
    let places: Vec<usize> = all.iter().filter_map(|kind| kinds.iter().position(|k| k == kind)).collect();
    IxDyn(&places)
}

fn check_kinds(kinds: &[AxisKind], shape: &[usize]) -> Result<(), Fault> {
    if kinds.len() != shape.len() {
        let named = kinds.len();
        return Err(Fault::Data(format!("recording.axes names {named} axes, but the array has shape {shape:?}")));
    }
    let has = |kind| kinds.contains(&kind);
    if let Some((_, kind)) = kinds.iter().enumerate().find(|(i, kind)| kinds[..*i].contains(kind)) {
        return Err(unfit(format!("\"{kind}\" stands twice; expected each axis once")));
    }
    let counts_elements = has(AxisKind::Element) && !has(AxisKind::Transmitter) && !has(AxisKind::Receiver);
    let counts_pairs = !has(AxisKind::Element) && has(AxisKind::Transmitter) && has(AxisKind::Receiver);
    if !(counts_elements || counts_pairs) {
        return Err(unfit("expected either \"element\", or both \"transmitter\" and \"receiver\""));
    }
    Ok(())
}

/// The array as complex numbers: joins real and imaginary parts, whose axis is removed from `kinds`, or makes real samples analytic.
fn complex(numbers: Numbers, kinds: &mut Vec<AxisKind>) -> Result<ArrayD<Complex64>, Fault> {
    let place = kinds.iter().position(|k| *k == AxisKind::Iq);
    match (numbers, place) {
        (Numbers::Complex(values), None) => Ok(values),
        (Numbers::Complex(_), Some(_)) => {
            Err(Fault::Data("the array holds complex numbers; expected no axis \"iq\"".to_owned()))
        }
        (Numbers::Real(values), None) => {
            let samples = kinds.iter().position(|k| *k == AxisKind::Sample).ok_or_else(|| {
                let expected = "complex ones, an axis \"iq\" of length 2, or real samples of an axis \"sample\"";
                Fault::Data(format!("the array holds real numbers; expected {expected}"))
            })?;
            let mut values = values.mapv(Complex64::from);
            for mut row in values.lanes_mut(Axis(samples)) {
                let signal = analytic(&row.to_vec(), row.len());
                row.iter_mut().zip(signal).for_each(|(to, v)| *to = v);
            }
            Ok(values)
        }
        (Numbers::Real(values), Some(place)) => {
            let parts = values.shape()[place];
            if parts != 2 {
                let message = format!("axis \"iq\" has length {parts}; expected 2, real and imaginary part");
                return Err(Fault::Data(message));
            }
            kinds.remove(place);
            let part = |i| values.index_axis(Axis(place), i);
            Ok(ndarray::Zip::from(part(0)).and(part(1)).map_collect(|re, im| Complex64::new(*re, *im)))
        }
    }
}

/// Selects or joins chirps, and removes their axis from `kinds`.
fn select_chirp(
    values: ArrayD<Complex64>,
    kinds: &mut Vec<AxisKind>,
    chirp: Option<ChirpChoice>,
) -> Result<ArrayD<Complex64>, Fault> {
    let Some(place) = kinds.iter().position(|k| *k == AxisKind::Chirp) else {
        return match chirp {
            None => Ok(values),
            Some(_) => Err(unfit("recording.chirp picks, but no axis is \"chirp\"")),
        };
    };
    kinds.remove(place);
    let chirps = values.shape()[place];
    let last = chirps.saturating_sub(1);
    let no_such =
        |chirp| Fault::Data(format!("recording.chirp is {chirp}; expected 0 to {last}, the array has {chirps} chirps"));
    match chirp {
        // Without a transform over loops, the Doppler cell of static echoes stands for the strongest: the mean.
        Some(ChirpChoice::Joined(_)) => values.mean_axis(Axis(place)).ok_or_else(|| no_such(0)),
        Some(ChirpChoice::Number(number)) if number >= chirps => Err(no_such(number)),
        Some(ChirpChoice::Number(number)) => Ok(values.index_axis_move(Axis(place), number)),
        None if chirps == 1 => Ok(values.index_axis_move(Axis(place), 0)),
        None => Err(Fault::Data(format!(
            "the array has {chirps} chirps; expected recording.chirp = 0 to {last}, \"mean\" or \"strongest\""
        ))),
    }
}

#[cfg(test)]
mod tests;
