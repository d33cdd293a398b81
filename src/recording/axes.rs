//! Axes: from an array of any shape to `[elements, samples]`.

use super::analytic::analytic;
use super::numbers::Numbers;
use ndarray::{Array2, ArrayD, Axis, IxDyn};
use num_complex::Complex64;
use serde::Deserialize;
use std::fmt;

/// What an axis of an array counts.
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

/// Which of several chirps are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a chirp's number from 0, or \"mean\"")]
pub enum Chirp {
    /// One, from 0.
    Number(usize),
    /// A way to join them all.
    Joined(Join),
}

/// How chirps are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Join {
    /// Their complex mean: what stands still stays, what moves fades.
    Mean,
}

/// Why an array is not what its axes say.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AxesError {
    /// Another number of axes.
    #[error("recording.axes names {named} axes, but the array has shape {shape:?}")]
    Count {
        /// Axes named.
        named: usize,
        /// Shape found.
        shape: Vec<usize>,
    },
    /// An axis stands twice, or too many or too few say what the elements are.
    #[error("recording.axes: {0}")]
    Kinds(String),
    /// The numbers are real and no chirps.
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
    /// The axis of real and imaginary part is none.
    #[error("axis \"iq\" has length {0}; expected 2, real and imaginary part")]
    Iq(usize),
    /// Which chirp was not said.
    #[error("the array has {0} chirps; expected recording.chirp = 0 to {last} or \"mean\"", last = .0.saturating_sub(1))]
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
    let place = |kind| kinds.iter().position(|k| *k == kind);
    let len = |place: Option<usize>| place.map_or(1, |p| values.shape()[p]);
    let order: Vec<usize> = [AxisKind::Transmitter, AxisKind::Receiver, AxisKind::Element, AxisKind::Sample]
        .into_iter()
        .filter_map(place)
        .collect();
    let samples = len(place(AxisKind::Sample));
    let elements = values.len().checked_div(samples).unwrap_or(0);
    let sorted = values.permuted_axes(IxDyn(&order));
    // The same numbers in the same order: the shape can't fail to fit.
    Array2::from_shape_vec((elements, samples), sorted.iter().copied().collect())
        .map_err(|e| AxesError::Kinds(e.to_string()))
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
        Some(Chirp::Joined(Join::Mean)) => {
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
mod tests {
    use super::*;
    use AxisKind::{Element, Iq, Receiver, Sample, Transmitter};
    use ndarray::array;

    /// `shape` numbered from 0 in C order, as complex numbers.
    fn numbered(shape: &[usize]) -> Numbers {
        let count: usize = shape.iter().product();
        let values = (0..count).map(|v| Complex64::from(v as f64)).collect();
        Numbers::Complex(ArrayD::from_shape_vec(IxDyn(shape), values).unwrap())
    }

    fn reals(values: Array2<Complex64>) -> Array2<f64> {
        values.mapv(|v| v.re)
    }

    #[test]
    fn axes_are_put_in_order() {
        let straight = arrange(numbered(&[2, 3]), &[Element, Sample], None).unwrap();
        assert_eq!(reals(straight), array![[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]);
        let turned = arrange(numbered(&[2, 3]), &[Sample, Element], None).unwrap();
        assert_eq!(reals(turned), array![[0.0, 3.0], [1.0, 4.0], [2.0, 5.0]]);
        let snapshot = arrange(numbered(&[3]), &[Element], None).unwrap();
        assert_eq!(reals(snapshot), array![[0.0], [1.0], [2.0]]);
    }

    #[test]
    fn pairs_count_through_the_receivers_first() {
        let found = arrange(numbered(&[2, 1, 3]), &[Receiver, Sample, Transmitter], None).unwrap();
        assert_eq!(reals(found), array![[0.0], [3.0], [1.0], [4.0], [2.0], [5.0]]);
    }

    #[test]
    fn chirps_are_picked_or_joined_but_never_guessed() {
        let of = |chirp| arrange(numbered(&[2, 2, 1]), &[AxisKind::Chirp, Element, Sample], chirp);
        assert_eq!(reals(of(Some(Chirp::Number(1))).unwrap()), array![[2.0], [3.0]]);
        assert_eq!(reals(of(Some(Chirp::Joined(Join::Mean))).unwrap()), array![[1.0], [2.0]]);
        assert!(of(None).unwrap_err().to_string().contains("recording.chirp = 0 to 1 or \"mean\""));
        assert!(of(Some(Chirp::Number(2))).unwrap_err().to_string().contains("expected 0 to 1"));
        let needless = arrange(numbered(&[2, 1]), &[Element, Sample], Some(Chirp::Number(0)));
        assert!(needless.unwrap_err().to_string().contains("no axis is \"chirp\""));
    }

    #[test]
    fn iq_may_have_its_own_axis() {
        let parts = array![[[1.0, 2.0]], [[3.0, 4.0]]].into_dyn();
        let found = arrange(Numbers::Real(parts.clone()), &[Element, Sample, Iq], None).unwrap();
        assert_eq!(found, array![[Complex64::new(1.0, 2.0)], [Complex64::new(3.0, 4.0)]]);
        let without = arrange(Numbers::Real(array![1.0, 2.0].into_dyn()), &[Element], None).unwrap_err();
        assert!(without.to_string().contains("axis \"iq\""), "{without}");
        assert_eq!(arrange(Numbers::Real(parts), &[Element, Iq, Sample], None), Err(AxesError::Iq(1)));
        assert_eq!(arrange(numbered(&[1, 2]), &[Element, Iq], None), Err(AxesError::Complex));
    }

    #[test]
    fn one_frame_is_picked() {
        let of = |frame| {
            let mut kinds = vec![AxisKind::Frame, Element, Sample];
            let numbers = one_frame(numbered(&[2, 2, 1]), &mut kinds, frame)?;
            arrange(numbers, &kinds, None).map(reals)
        };
        assert_eq!((of(None).unwrap(), of(Some(1)).unwrap()), (array![[0.0], [1.0]], array![[2.0], [3.0]]));
        assert!(of(Some(2)).unwrap_err().to_string().contains("recording.frame is 2; expected 0 to 1"));
        let needless = one_frame(numbered(&[2, 1]), &mut vec![Element, Sample], Some(0));
        assert!(needless.unwrap_err().to_string().contains("no axis is \"frame\""));
    }

    #[test]
    fn real_samples_become_the_positive_half_of_their_spectrum() {
        let turn = |n: usize| std::f64::consts::TAU * 3.0 * n as f64 / 16.0;
        let waves = Array2::from_shape_fn((1, 16), |(_, n)| turn(n).cos());
        let found = arrange(Numbers::Real(waves.into_dyn()), &[Element, Sample], None).unwrap();
        for (n, v) in found.iter().enumerate() {
            assert!((v - Complex64::from_polar(1.0, turn(n))).norm() < 1e-12, "{n}: {v}");
        }
    }

    #[test]
    fn wrong_axes_are_told() {
        for (kinds, part) in [
            (vec![Element], "shape [2, 3]"),
            (vec![Element, Element], "\"element\" stands twice"),
            (vec![Sample, Iq], "expected either"),
            (vec![Transmitter, Sample], "both \"transmitter\" and \"receiver\""),
            (vec![Transmitter, Element], "expected either"),
        ] {
            let message = arrange(numbered(&[2, 3]), &kinds, None).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        assert_eq!(arrange(numbered(&[0, 3]), &[Element, Sample], None).unwrap().dim(), (0, 3));
        assert_eq!(arrange(numbered(&[3, 0]), &[Element, Sample], None).unwrap().dim(), (0, 0));
    }
}
