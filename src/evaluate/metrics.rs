//! Squared error and detection rates of one scene (thesis section 4.2).

use crate::maps::RangeAngleMap;

/// Target cells are those where the whole array's Lambda exceeds this threshold.
pub const TARGET_ETA: f32 = 0.9;

/// The thesis' three figures for one scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metrics {
    /// SE: sum of squared differences over every cell.
    pub squared_error: f64,
    /// P_D: part of the target cells where the output exceeds eta; `None` where the target has no such cell, or nothing reflects.
    pub detection: Option<f64>,
    /// P_FA: part of the other cells where the output exceeds eta.
    pub false_alarm: f64,
}

impl Metrics {
    /// Compares `output`, thresholded at `eta`, with the whole array's map. Both `[range bins, columns]`.
    pub fn of(target: &RangeAngleMap, output: &RangeAngleMap, eta: f32) -> Metrics {
        let (detection, false_alarm) = detection_rates(target, output, eta);
        Metrics { squared_error: squared_error(target, output), detection, false_alarm }
    }

    /// The figures of a scene in which nothing reflects. Its target holds noise, or nothing: cells above 0.9 are no echoes, so that there is
    /// nothing to detect, and every cell of the output above eta is a false alarm.
    pub fn of_silence(target: &RangeAngleMap, output: &RangeAngleMap, eta: f32) -> Metrics {
        let alarms = output.above(eta).count() as f64;
        let false_alarm = alarms / output.lambda.len().max(1) as f64;
        Metrics { squared_error: squared_error(target, output), detection: None, false_alarm }
    }

    /// [`Metrics::of`] where something reflects, else [`Metrics::of_silence`].
    pub fn of_echoes(has_echoes: bool, target: &RangeAngleMap, output: &RangeAngleMap, eta: f32) -> Metrics {
        if has_echoes { Metrics::of(target, output, eta) } else { Metrics::of_silence(target, output, eta) }
    }
}

/// Sum of squared differences over every cell.
pub fn squared_error(target: &RangeAngleMap, output: &RangeAngleMap) -> f64 {
    target.lambda.iter().zip(&output.lambda).map(|(t, o)| f64::from(t - o).powi(2)).sum()
}

/// SE if every cell were off by its doubt ([`Reconstruction::doubt`](crate::reconstruct::Reconstruction::doubt), `[range bins, columns]`): the
/// sum of its squares over every cell. On scenes and over noise like those of the training nine of ten cells are nearer, so that it is mostly
/// larger than SE.
/// The sum ranks scenes by their SE as well as the mean of doubt does, and has the unit of SE.
pub fn squared_doubt(doubt: &RangeAngleMap) -> f64 {
    doubt.lambda.iter().map(|v| f64::from(*v).powi(2)).sum()
}

/// Part of the cells whose error is at most their doubt ([`Reconstruction::doubt`](crate::reconstruct::Reconstruction::doubt)). The error is the
/// distance of `output` from `target`; all three are `[range bins, columns]`. The aim is 0.9, on scenes and over noise like those of the training.
pub fn part_within(doubt: &RangeAngleMap, target: &RangeAngleMap, output: &RangeAngleMap) -> f64 {
    let cells = doubt.lambda.iter().zip(target.lambda.iter().zip(&output.lambda));
    let within = cells.filter(|(doubt, (target, output))| (*target - *output).abs() <= **doubt).count();
    within as f64 / doubt.lambda.len().max(1) as f64
}

/// A threshold as text, with all its digits, two at least, so that a typed one gives the same P_D and P_FA.
pub fn eta_text(eta: f32) -> String {
    let exact = eta.to_string();
    let decimals = exact.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    if decimals < 2 { format!("{eta:.2}") } else { exact }
}

/// (P_D, P_FA) of `output > eta` against `target > 0.9`; P_D is `None` without target cells.
pub fn detection_rates(target: &RangeAngleMap, output: &RangeAngleMap, eta: f32) -> (Option<f64>, f64) {
    let (mut hits, mut targets, mut alarms, mut others) = (0u64, 0u64, 0u64, 0u64);
    for (t, o) in target.lambda.iter().zip(&output.lambda) {
        let detected = u64::from(*o > eta);
        if *t > TARGET_ETA {
            targets += 1;
            hits += detected;
        } else {
            others += 1;
            alarms += detected;
        }
    }
    let part = |a: u64, b: u64| a as f64 / b as f64;
    ((targets > 0).then(|| part(hits, targets)), if others > 0 { part(alarms, others) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn hand_counted() {
        let target = RangeAngleMap { lambda: array![[0.95, 0.2], [1.0, 0.0]] };
        let output = RangeAngleMap { lambda: array![[0.95, 0.8], [0.5, 0.0]] };
        let m = Metrics::of(&target, &output, 0.7);
        assert_eq!((m.detection, m.false_alarm), (Some(0.5), 0.5));
        assert!((m.squared_error - (0.36 + 0.25)).abs() < 1e-6);
    }

    #[test]
    fn doubt_that_is_the_error_of_every_cell_is_the_squared_error() {
        let target = RangeAngleMap { lambda: array![[0.75, 0.25], [1.0, 0.0]] };
        let output = RangeAngleMap { lambda: array![[0.5, 0.75], [1.0, 0.0]] };
        let doubt = RangeAngleMap { lambda: (&target.lambda - &output.lambda).mapv(f32::abs) };
        assert_eq!(squared_doubt(&doubt), squared_error(&target, &output));
        let smaller = RangeAngleMap { lambda: &doubt.lambda * 0.5 };
        assert_eq!([&doubt, &smaller].map(|doubt| part_within(doubt, &target, &output)), [1.0, 0.5]);
    }

    #[test]
    fn noise_above_the_target_threshold_is_no_echo() {
        let noise = RangeAngleMap { lambda: array![[0.95, 0.8], [1.0, 0.0]] };
        let output = RangeAngleMap { lambda: array![[0.95, 0.8], [0.2, 0.0]] };
        let m = Metrics::of_echoes(false, &noise, &output, 0.9);
        assert_eq!((m.detection, m.false_alarm), (None, 0.25));
        assert_eq!(Metrics::of_echoes(true, &noise, &output, 0.9), Metrics::of(&noise, &output, 0.9));
    }

    #[test]
    fn no_target_cells_give_no_detection_rate() {
        let flat = RangeAngleMap { lambda: ndarray::Array2::zeros((2, 2)) };
        assert_eq!(detection_rates(&flat, &flat, 0.5), (None, 0.0));
    }

    #[test]
    fn a_shown_threshold_is_read_back_as_it_is() {
        for (eta, text) in [(0.9, "0.90"), (1.0, "1.00"), (0.845, "0.845"), (0.763_194_2, "0.7631942")] {
            assert_eq!((eta_text(eta).as_str(), eta_text(eta).parse()), (text, Ok(eta)));
        }
    }
}
