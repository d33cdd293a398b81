//! The kinds of an array's axes by evidence: lengths, sameness along an axis, spectra, usual orders, and the `.cfg`.

use crate::radar::counted;
use crate::recording::AxisKind::{self, Chirp, Element, Frame, Iq, Receiver, Sample, Transmitter};
use crate::recording::layout::Spectrum;
use crate::recording::numbers::Numbers;
use crate::recording::profile::RadarProfile;
use ndarray::{Array2, ArrayD, Axis, s};
use num_complex::Complex64;

/// Most rows along an axis, and most numbers of each, that the evidence on it is computed from.
const MAX_AXIS_ROWS: usize = 128;
const MAX_ROW_NUMBERS: usize = 1 << 12;
/// Least number of chirps of a transmitter whose sameness is measured.
const MIN_CHIRPS: usize = 4;
/// Log-odds of a length that agrees with the `.cfg`; minus this for one that contradicts it.
const CONFIG_COUNT_LOG_ODDS: f64 = 8.0;
/// Log-odds of chirps for an axis along which all is the same. Log-odds of samples for each decibel of the mean level below a flat spectrum, and most
/// decibels that count.
const SAMENESS_LOG_ODDS: f64 = 6.0;
const FLATNESS_LOG_ODDS_PER_DB: f64 = 0.5;
const MAX_FLATNESS_DB: f64 = 12.0;
/// Least level below a flat spectrum, decibels, and least part of power that is the same, that are named as evidence: less would be printed as 0.
const MIN_NAMED_FLATNESS_DB: f64 = 0.05;
const MIN_NAMED_SAMENESS: f64 = 0.005;

/// Log-odds of real and imaginary part for an axis of two real numbers.
const IQ_LOG_ODDS: f64 = 5.0;

/// Sets of kinds that the axes of an array may have.
const AXIS_SETS: [&[AxisKind]; 6] = [
    &[Element, Sample],
    &[Chirp, Element, Sample],
    &[Transmitter, Receiver, Sample],
    &[Frame, Chirp, Element, Sample],
    &[Chirp, Transmitter, Receiver, Sample],
    &[Frame, Chirp, Transmitter, Receiver, Sample],
];

/// Kinds of all axes, with the evidence for them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    pub kinds: Vec<AxisKind>,
    /// Natural logarithm of the odds, up to a constant of the file.
    pub log_odds: f64,
    /// Mean power of each range bin, in the square of the file's unit.
    pub power: Vec<f64>,
    /// Evidence, a sentence each.
    pub reasons: Vec<String>,
}

impl Reading {
    /// The axes and their lengths, as a part of a sentence.
    pub fn description(&self, shape: &[usize]) -> String {
        let axis = |(kind, len): (&AxisKind, &usize)| match kind {
            Iq => "real and imaginary part".to_owned(),
            kind => counted(*len, &kind.to_string(), &format!("{kind}s")),
        };
        self.kinds.iter().zip(shape).map(axis).collect::<Vec<_>>().join(" × ")
    }

    /// Length of the axis of this kind; 1 where there is none.
    pub fn len(&self, kind: AxisKind, shape: &[usize]) -> usize {
        self.kinds.iter().position(|k| *k == kind).map_or(1, |place| shape[place])
    }
}

/// Figures on one axis, from the numbers alone.
struct AxisFigures {
    /// Part of the power in the mean along the axis, 0 to 1.
    same: f64,
    /// Mean level of the spectrum along the axis below a flat one, decibels, and its power.
    flatness_db: f64,
    power: Vec<f64>,
}

/// Readings of the axes of `numbers`, the most likely first; none for arrays of other than 2 to 5 axes.
pub(super) fn readings(numbers: &Numbers, profile: Option<&RadarProfile>) -> Vec<Reading> {
    let shape = numbers.shape();
    let mut all = Vec::new();
    let is_real = matches!(numbers, Numbers::Real(_));
    let pairs = (0..shape.len()).filter(|axis| is_real && shape[*axis] == 2).map(Some);
    for iq in std::iter::once(None).chain(pairs) {
        let axes: Vec<usize> = (0..shape.len()).filter(|axis| Some(*axis) != iq).collect();
        let sets = AXIS_SETS.into_iter().filter(|kinds| kinds.len() == axes.len());
        let sets: Vec<&[AxisKind]> = sets.collect();
        if sets.is_empty() || shape.contains(&0) {
            continue;
        }
        let figures: Vec<AxisFigures> = axes.iter().map(|axis| measure_axis(numbers, iq, *axis)).collect();
        let lengths: Vec<usize> = axes.iter().map(|axis| shape[*axis]).collect();
        for kinds in sets.into_iter().flat_map(permutations) {
            let mut reading = judge(&kinds, &lengths, &figures, profile);
            if let Some(iq) = iq {
                reading.kinds.insert(iq, Iq);
                reading.log_odds += IQ_LOG_ODDS;
            }
            all.push(reading);
        }
    }
    all.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    all
}

fn permutations(kinds: &[AxisKind]) -> Vec<Vec<AxisKind>> {
    if kinds.is_empty() {
        return vec![Vec::new()];
    }
    let with = |n: usize| {
        let others: Vec<AxisKind> = kinds.iter().enumerate().filter(|(i, _)| *i != n).map(|(_, k)| *k).collect();
        permutations(&others).into_iter().map(move |rest| [vec![kinds[n]], rest].concat())
    };
    (0..kinds.len()).flat_map(with).collect()
}

fn judge(kinds: &[AxisKind], lengths: &[usize], figures: &[AxisFigures], profile: Option<&RadarProfile>) -> Reading {
    let mut log_odds = order_log_odds(kinds);
    let mut reasons = Vec::new();
    let mut power = Vec::new();
    for (n, (kind, len)) in kinds.iter().zip(lengths).enumerate() {
        log_odds += length_log_odds(*kind, *len);
        let of_axis = &figures[n];
        match kind {
            Sample => {
                log_odds += FLATNESS_LOG_ODDS_PER_DB * of_axis.flatness_db.clamp(0.0, MAX_FLATNESS_DB);
                let is_named = of_axis.flatness_db >= MIN_NAMED_FLATNESS_DB;
                reasons.extend(is_named.then(|| {
                    let flatness_db = of_axis.flatness_db;
                    format!("Axis {n} counts samples: its spectrum lies {flatness_db:.1} dB below a flat one.")
                }));
                power.clone_from(&of_axis.power);
            }
            Frame if *len > 1 => log_odds += SAMENESS_LOG_ODDS / 2.0 * of_axis.same,
            Chirp if *len > 1 => {
                log_odds += SAMENESS_LOG_ODDS * of_axis.same;
                let percent = 100.0 * of_axis.same;
                reasons.extend((of_axis.same >= MIN_NAMED_SAMENESS).then(|| {
                    format!(
                        "Axis {n} counts chirps: {percent:.0} % of the power is the same along it or along every second or third."
                    )
                }));
            }
            _ => {}
        }
        if let Some(profile) = profile
            && let Some(agrees) = agrees_with_config(*kind, *len, profile, kinds.contains(&Transmitter))
        {
            log_odds += if agrees { CONFIG_COUNT_LOG_ODDS } else { -CONFIG_COUNT_LOG_ODDS };
            reasons.extend(agrees.then(|| format!("The .cfg says {len} {kind}s.")));
        }
    }
    Reading { kinds: kinds.to_vec(), log_odds, power, reasons }
}

fn length_log_odds(kind: AxisKind, len: usize) -> f64 {
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

/// Log-odds of an order of axes: most programs write frames, chirps, receivers and samples from the slowest to the fastest.
fn order_log_odds(kinds: &[AxisKind]) -> f64 {
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

/// Whether the `.cfg` has this length; `None` where it has none.
fn agrees_with_config(kind: AxisKind, len: usize, profile: &RadarProfile, has_transmitters: bool) -> Option<bool> {
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

fn measure_axis(numbers: &Numbers, iq: Option<usize>, axis: usize) -> AxisFigures {
    let mut rows = rows_along(numbers, iq, axis);
    let scale = word_scale(&rows);
    rows.mapv_inplace(|v| v * scale);
    let len = rows.ncols().max(1) as f64;
    let all: f64 = rows.iter().map(|v| v.norm_sqr()).sum();
    // With transmitters in turn every second or third chirp is the same.
    let power = |step: usize| -> f64 {
        let count = rows.ncols().div_ceil(step) as f64;
        let strided = rows.slice(s![.., ..;step as isize]);
        strided.outer_iter().map(|row| row.sum().norm_sqr() / count).sum::<f64>() * len / count
    };
    let same = (1..=3).filter(|step| *step == 1 || rows.ncols() >= MIN_CHIRPS * step).map(power).fold(0.0, f64::max);
    let is_real = rows.iter().all(|v| v.im == 0.0);
    let spectrum = Spectrum::of(&rows, 1);
    let spectrum = if is_real { spectrum.of_real() } else { spectrum };
    let flatness_db = if is_real { spectrum.flatness_db() + 10.0 * 2f64.log10() } else { spectrum.flatness_db() };
    let power = spectrum.power.iter().map(|p| p / (scale * scale)).collect();
    AxisFigures { same: if all > 0.0 { (same / all).min(1.0) } else { 0.0 }, flatness_db, power }
}

/// Factor to the scale of 16-bit words, whose rounding a spectrum counts with: numbers that are not whole may have any unit. 1 for whole or larger numbers.
fn word_scale(rows: &Array2<Complex64>) -> f64 {
    if rows.iter().all(|v| v.re.fract() == 0.0 && v.im.fract() == 0.0) {
        return 1.0;
    }
    let peak = rows.iter().fold(0.0f64, |peak, v| peak.max(v.re.abs()).max(v.im.abs()));
    let scale = f64::from(i16::MAX) / peak;
    if scale.is_finite() { scale.max(1.0) } else { 1.0 }
}

/// At most [`MAX_AXIS_ROWS`] rows along an axis, `[rows, numbers]`.
fn rows_along(numbers: &Numbers, iq: Option<usize>, axis: usize) -> Array2<Complex64> {
    match (numbers, iq) {
        (Numbers::Complex(values), _) => rows_of(values, axis, |v| *v),
        (Numbers::Real(values), None) => rows_of(values, axis, |v| Complex64::from(*v)),
        (Numbers::Real(values), Some(iq)) => {
            let axis = if axis > iq { axis - 1 } else { axis };
            let part = |n: usize| rows_of(&values.index_axis(Axis(iq), n).to_owned(), axis, |v| Complex64::from(*v));
            part(0) + part(1) * Complex64::I
        }
    }
}

fn rows_of<T>(values: &ArrayD<T>, axis: usize, number: impl Fn(&T) -> Complex64) -> Array2<Complex64> {
    let lanes = values.lanes(Axis(axis)).into_iter();
    let (count, len) = (values.len() / values.shape()[axis].max(1), values.shape()[axis].min(MAX_ROW_NUMBERS));
    let step = count.div_ceil(MAX_AXIS_ROWS).max(1);
    let taken: Vec<Complex64> = lanes.step_by(step).flat_map(|lane| lane.into_iter().take(len)).map(number).collect();
    let rows = taken.len() / len.max(1);
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
    fn the_unit_of_an_array_changes_no_evidence() {
        let reading = |gain: f64| readings(&Numbers::Complex(cube().mapv(|v| gain * v)), None).swap_remove(0);
        let (quiet, loud) = (reading(1e-4), reading(100.0));
        assert_eq!((&quiet.kinds, &quiet.reasons), (&loud.kinds, &loud.reasons));
        assert!((quiet.log_odds - loud.log_odds).abs() < 1e-6, "{} and {}", quiet.log_odds, loud.log_odds);
        for (quiet, loud) in quiet.power.iter().zip(&loud.power) {
            assert!((1e12 * quiet / loud - 1.0).abs() < 1e-6, "{quiet} and {loud}");
        }
    }

    #[test]
    fn what_tells_nothing_is_no_evidence() {
        let mut flat = ArrayD::from_elem(IxDyn(&[3, 32, 64]), Complex64::new(1.0, 1.0));
        let all = readings(&Numbers::Complex(flat.clone()), None);
        // The same along every axis: no echo is seen along any.
        assert!(all.iter().all(|reading| reading.reasons.iter().all(|r| !r.contains("samples"))), "{all:?}");
        assert!(all.iter().any(|reading| reading.reasons.iter().any(|r| r.contains("100 % of the power"))), "{all:?}");
        flat.fill(Complex64::ZERO);
        let all = readings(&Numbers::Complex(flat), None);
        assert!(all.iter().all(|reading| reading.reasons.iter().all(|r| !r.contains("chirps"))), "{all:?}");
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
