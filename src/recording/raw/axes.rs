//! The quantities that the axes of an array count, by evidence: lengths, sameness along an axis, sharp spectra, usual orders, and the `.cfg`.

use crate::recording::AxisKind::{self, Chirp, Element, Frame, Iq, Receiver, Sample, Transmitter};
use crate::recording::layout::Spectrum;
use crate::recording::numbers::Numbers;
use crate::recording::profile::RadarProfile;
use ndarray::{Array2, ArrayD, Axis, s};
use num_complex::Complex64;

/// Most lines along an axis, and most numbers of each, that it is judged by.
const LINES: usize = 128;
const LINE_NUMBERS: usize = 1 << 12;
/// Least chirps of one transmitter that tell whether they are the same.
const LEAST_IN_TURN: usize = 4;
/// Log-odds of a `.cfg` that says a count, and of one that says another.
const OF_SAID_COUNT: f64 = 8.0;
/// Log-odds of an axis along which all is the same that it counts chirps; and of a sharp spectrum that it counts samples, for each decibel.
const OF_SAME: f64 = 6.0;
const OF_SHARP_DB: f64 = 0.5;
const MOST_SHARP_DB: f64 = 12.0;

/// Log-odds of an axis of two real numbers that they are real and imaginary part.
const OF_PARTS: f64 = 5.0;

/// Kinds of axes that an array may have, by the number of axes.
const TOGETHER: [&[AxisKind]; 6] = [
    &[Element, Sample],
    &[Chirp, Element, Sample],
    &[Transmitter, Receiver, Sample],
    &[Frame, Chirp, Element, Sample],
    &[Chirp, Transmitter, Receiver, Sample],
    &[Frame, Chirp, Transmitter, Receiver, Sample],
];

/// One way to name the axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    pub kinds: Vec<AxisKind>,
    /// Natural logarithm of its odds.
    pub log_odds: f64,
    /// Mean power of each range bin.
    pub power: Vec<f64>,
    pub reasons: Vec<String>,
}

impl Reading {
    /// The axes and their lengths in a sentence's words.
    pub fn described(&self, shape: &[usize]) -> String {
        let axis = |(kind, len): (&AxisKind, &usize)| match kind {
            Iq => "real and imaginary part".to_owned(),
            kind => format!("{len} {kind}s"),
        };
        self.kinds.iter().zip(shape).map(axis).collect::<Vec<_>>().join(" × ")
    }

    /// Length of the axis of this kind; 1 where there is none.
    pub fn len(&self, kind: AxisKind, shape: &[usize]) -> usize {
        self.kinds.iter().position(|k| *k == kind).map_or(1, |place| shape[place])
    }
}

/// Figures of one axis, from the numbers alone.
struct Look {
    /// Part of the power that is the same along it, 0 to 1.
    same: f64,
    flatness_db: f64,
    power: Vec<f64>,
}

/// Ways to name the axes of `numbers`, the most likely first; none where there are too few or too many.
pub(super) fn readings(numbers: &Numbers, profile: Option<&RadarProfile>) -> Vec<Reading> {
    let shape = numbers.shape();
    let mut all = Vec::new();
    let is_real = matches!(numbers, Numbers::Real(_));
    let pairs = (0..shape.len()).filter(|axis| is_real && shape[*axis] == 2).map(Some);
    for iq in std::iter::once(None).chain(pairs) {
        let axes: Vec<usize> = (0..shape.len()).filter(|axis| Some(*axis) != iq).collect();
        let sets = TOGETHER.into_iter().filter(|kinds| kinds.len() == axes.len());
        let sets: Vec<&[AxisKind]> = sets.collect();
        if sets.is_empty() || shape.contains(&0) {
            continue;
        }
        let looks: Vec<Look> = axes.iter().map(|axis| look(numbers, iq, *axis)).collect();
        let lengths: Vec<usize> = axes.iter().map(|axis| shape[*axis]).collect();
        for kinds in sets.into_iter().flat_map(orders) {
            let mut reading = judged(&kinds, &lengths, &looks, profile);
            if let Some(iq) = iq {
                reading.kinds.insert(iq, Iq);
                reading.log_odds += OF_PARTS;
            }
            all.push(reading);
        }
    }
    all.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    all
}

fn orders(kinds: &[AxisKind]) -> Vec<Vec<AxisKind>> {
    if kinds.is_empty() {
        return vec![Vec::new()];
    }
    let with = |n: usize| {
        let others: Vec<AxisKind> = kinds.iter().enumerate().filter(|(i, _)| *i != n).map(|(_, k)| *k).collect();
        orders(&others).into_iter().map(move |rest| [vec![kinds[n]], rest].concat())
    };
    (0..kinds.len()).flat_map(with).collect()
}

fn judged(kinds: &[AxisKind], lengths: &[usize], looks: &[Look], profile: Option<&RadarProfile>) -> Reading {
    let mut log_odds = order(kinds);
    let mut reasons = Vec::new();
    let mut power = Vec::new();
    for (n, (kind, len)) in kinds.iter().zip(lengths).enumerate() {
        log_odds += length(*kind, *len);
        let look = &looks[n];
        match kind {
            Sample => {
                log_odds += OF_SHARP_DB * look.flatness_db.clamp(0.0, MOST_SHARP_DB);
                reasons.push(format!(
                    "Axis {n} counts samples: its spectrum lies {:.1} dB below a flat one.",
                    look.flatness_db
                ));
                power.clone_from(&look.power);
            }
            Frame if *len > 1 => log_odds += OF_SAME / 2.0 * look.same,
            Chirp if *len > 1 => {
                log_odds += OF_SAME * look.same;
                reasons.push(format!(
                    "Axis {n} counts chirps: {:.0} % of the power is the same along it or along every second or third.",
                    100.0 * look.same
                ));
            }
            _ => {}
        }
        if let Some(profile) = profile
            && let Some(agrees) = said(*kind, *len, profile, kinds.contains(&Transmitter))
        {
            log_odds += if agrees { OF_SAID_COUNT } else { -OF_SAID_COUNT };
            reasons.extend(agrees.then(|| format!("The .cfg says {len} {kind}s.")));
        }
    }
    Reading { kinds: kinds.to_vec(), log_odds, power, reasons }
}

/// Log-odds of an axis of this length.
fn length(kind: AxisKind, len: usize) -> f64 {
    let usual = if len.is_power_of_two() { 0.5 } else { 0.0 };
    match (kind, len) {
        (Sample, 0..16) => -8.0,
        (Sample, 16..32) => -2.0,
        (Sample, _) => usual,
        (Element | Receiver, 1) => -6.0,
        (Element | Receiver, 2..=4) => 1.0,
        (Element | Receiver, 5..=16) => 0.5,
        (Element | Receiver, 17..=64) => -1.0,
        (Element | Receiver, 65..=256) => -2.0,
        (Element | Receiver, _) => -8.0,
        (Transmitter, 1..=3) => 0.0,
        (Transmitter, 4..=16) => -1.0,
        (Transmitter, _) => -8.0,
        (Chirp, 1) => -3.0,
        (Chirp, 0..8) => -1.0,
        (Chirp, _) => usual,
        (Frame | Iq, _) => 0.0,
    }
}

/// Log-odds of an order: most programs write frames, chirps, receivers and samples from the slowest to the fastest.
fn order(kinds: &[AxisKind]) -> f64 {
    let place = |kind: AxisKind| kinds.iter().position(|k| *k == kind);
    let before = |a: AxisKind, b: AxisKind| place(a).zip(place(b)).map_or(0.0, |(a, b)| f64::from(u8::from(a < b)));
    let last = kinds.last().map_or(0.0, |kind| match kind {
        Sample => 1.5,
        Element | Receiver => 0.7,
        _ => 0.0,
    });
    let first = if kinds.first() == Some(&Frame) { 1.0 } else { 0.0 };
    let several = if kinds.contains(&Transmitter) { -1.0 } else { 0.0 };
    last + first + several + 0.5 * (before(Chirp, Element) + before(Chirp, Receiver) + before(Transmitter, Receiver))
}

/// Whether the `.cfg` gives this count; `None` where it gives none.
fn said(kind: AxisKind, len: usize, profile: &RadarProfile, has_transmitters: bool) -> Option<bool> {
    let transmitters = profile.chirp_transmitters.len();
    Some(match kind {
        Sample => len == profile.samples,
        Receiver => len == profile.receivers,
        Element => [profile.receivers, profile.receivers * transmitters].contains(&len),
        Transmitter => len == transmitters,
        Chirp if has_transmitters => len == profile.loops,
        Chirp => [profile.loops, profile.loops * transmitters].contains(&len),
        Frame if profile.frames > 0 => len == profile.frames,
        Frame | Iq => return None,
    })
}

fn look(numbers: &Numbers, iq: Option<usize>, axis: usize) -> Look {
    let rows = lines(numbers, iq, axis);
    let len = rows.ncols().max(1) as f64;
    let all: f64 = rows.iter().map(|v| v.norm_sqr()).sum();
    // Transmitters in turn make every second or third chirp the same.
    let alike = |step: usize| -> f64 {
        let count = rows.ncols().div_ceil(step) as f64;
        let kept = rows.slice(s![.., ..;step as isize]);
        kept.outer_iter().map(|row| row.sum().norm_sqr() / count).sum::<f64>() * len / count
    };
    let same = (1..=3).filter(|step| *step == 1 || rows.ncols() >= LEAST_IN_TURN * step).map(alike).fold(0.0, f64::max);
    let is_real = rows.iter().all(|v| v.im == 0.0);
    let spectrum = Spectrum::of(&rows, 1);
    let spectrum = if is_real { spectrum.of_real() } else { spectrum };
    let flatness_db = if is_real { spectrum.flatness_db() + 10.0 * 2f64.log10() } else { spectrum.flatness_db() };
    Look { same: if all > 0.0 { (same / all).min(1.0) } else { 0.0 }, flatness_db, power: spectrum.power }
}

/// Some lines along an axis, `[lines, numbers]`.
fn lines(numbers: &Numbers, iq: Option<usize>, axis: usize) -> Array2<Complex64> {
    match (numbers, iq) {
        (Numbers::Complex(values), _) => picked(values, axis, |v| *v),
        (Numbers::Real(values), None) => picked(values, axis, |v| Complex64::from(*v)),
        (Numbers::Real(values), Some(iq)) => {
            let axis = if axis > iq { axis - 1 } else { axis };
            let part = |n: usize| picked(&values.index_axis(Axis(iq), n).to_owned(), axis, |v| Complex64::from(*v));
            part(0) + part(1) * Complex64::I
        }
    }
}

fn picked<T>(values: &ArrayD<T>, axis: usize, number: impl Fn(&T) -> Complex64) -> Array2<Complex64> {
    let lanes = values.lanes(Axis(axis)).into_iter();
    let (count, len) = (values.len() / values.shape()[axis].max(1), values.shape()[axis].min(LINE_NUMBERS));
    let step = count.div_ceil(LINES).max(1);
    let taken: Vec<Complex64> = lanes.step_by(step).flat_map(|lane| lane.into_iter().take(len)).map(number).collect();
    let rows = taken.len() / len.max(1);
    // As many numbers as rows and columns make: the shape can't fail to fit.
    Array2::from_shape_vec((rows, len), taken).unwrap_or_else(|_| Array2::zeros((0, len)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::IxDyn;
    use std::f64::consts::TAU;

    /// An echo that stands still, and noise, at 3 frames of 32 chirps, 4 receivers and 64 samples.
    fn cube() -> ArrayD<Complex64> {
        let mut state = 7u32;
        ArrayD::from_shape_fn(IxDyn(&[3, 32, 4, 64]), |at| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state >> 16) / 65536.0 - 0.5;
            let turns = 9.3 * at[3] as f64 / 64.0 + 0.2 * at[2] as f64;
            Complex64::from_polar(20.0, TAU * turns) + Complex64::new(noise, -noise)
        })
    }

    fn named(numbers: &Numbers) -> Vec<AxisKind> {
        readings(numbers, None)[0].kinds.clone()
    }

    #[test]
    fn axes_are_named_in_any_order() {
        let kinds = [Frame, Chirp, Element, Sample];
        for order in [[0, 1, 2, 3], [0, 1, 3, 2], [3, 1, 2, 0], [0, 3, 1, 2], [3, 2, 1, 0]] {
            let cube = cube().permuted_axes(IxDyn(&order)).as_standard_layout().into_owned();
            assert_eq!(named(&Numbers::Complex(cube)), order.map(|n| kinds[n]), "{order:?}");
        }
        let one = cube().index_axis_move(Axis(0), 0);
        assert_eq!(named(&Numbers::Complex(one.clone())), [Chirp, Element, Sample]);
        assert_eq!(named(&Numbers::Complex(one.index_axis_move(Axis(0), 0))), [Element, Sample]);
    }

    #[test]
    fn an_axis_of_two_parts_is_found_last_or_first() {
        let cube = cube().index_axis_move(Axis(0), 0);
        let parts = ArrayD::from_shape_fn(IxDyn(&[32, 4, 64, 2]), |at| {
            let v = cube[[at[0], at[1], at[2]]];
            if at[3] == 0 { v.re } else { v.im }
        });
        assert_eq!(named(&Numbers::Real(parts.clone())), [Chirp, Element, Sample, Iq]);
        let first = parts.permuted_axes(IxDyn(&[3, 0, 1, 2])).as_standard_layout().into_owned();
        assert_eq!(named(&Numbers::Real(first)), [Iq, Chirp, Element, Sample]);
        assert_eq!(named(&Numbers::Real(cube.mapv(|v| v.re))), [Chirp, Element, Sample]);
        assert!(readings(&Numbers::Real(ArrayD::zeros(IxDyn(&[5]))), None).is_empty());
    }
}
