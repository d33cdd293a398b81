//! Receiver operating characteristic: P_D against P_FA over every threshold.

use super::TARGET_ETA;
use crate::maps::RangeAngleMap;

/// Thresholds at which a [`Roc`] is sampled: eta = i / `THRESHOLD_STEPS`.
const THRESHOLD_STEPS: usize = 4096;

/// P_D and P_FA at one threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RocPoint {
    /// The threshold.
    pub eta: f32,
    /// P_D.
    pub detection: f64,
    /// P_FA.
    pub false_alarm: f64,
}

/// Rates over 4097 thresholds from 0 to 1, of one scene or averaged over scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct Roc {
    detection: Vec<f64>,
    false_alarm: Vec<f64>,
    scenes: usize,
}

impl Default for Roc {
    fn default() -> Self {
        Roc { detection: vec![0.0; THRESHOLD_STEPS + 1], false_alarm: vec![0.0; THRESHOLD_STEPS + 1], scenes: 0 }
    }
}

impl Roc {
    /// The characteristic of one scene.
    pub fn of(target: &RangeAngleMap, output: &RangeAngleMap) -> Roc {
        let mut roc = Roc::default();
        roc.add(target, output);
        roc
    }

    /// [`Roc::of`] where something reflects; else the characteristic of no scene, since there is no P_D.
    pub fn of_echoes(has_echoes: bool, target: &RangeAngleMap, output: &RangeAngleMap) -> Roc {
        if has_echoes { Roc::of(target, output) } else { Roc::default() }
    }

    /// Adds a scene to the average. A scene without target cells has no P_D and is left out.
    pub fn add(&mut self, target: &RangeAngleMap, output: &RangeAngleMap) {
        // A cell with output o exceeds eta_i = i/THRESHOLD_STEPS for i < o * THRESHOLD_STEPS: it is counted in the last such i, and counts are summed from the top.
        let (mut hits, mut alarms) = (vec![0u64; THRESHOLD_STEPS + 2], vec![0u64; THRESHOLD_STEPS + 2]);
        for (t, o) in target.lambda.iter().zip(&output.lambda) {
            let slot = (o.clamp(0.0, 1.0) * THRESHOLD_STEPS as f32).ceil() as usize;
            if *t > TARGET_ETA { hits[slot] += 1 } else { alarms[slot] += 1 }
        }
        let (targets, others) = (hits.iter().sum::<u64>(), alarms.iter().sum::<u64>());
        if targets == 0 || others == 0 {
            return;
        }
        let (mut hit, mut alarm) = (0, 0);
        for i in (0..=THRESHOLD_STEPS).rev() {
            hit += hits[i + 1];
            alarm += alarms[i + 1];
            self.detection[i] += hit as f64 / targets as f64;
            self.false_alarm[i] += alarm as f64 / others as f64;
        }
        self.scenes += 1;
    }

    /// Number of scenes averaged.
    pub fn scenes(&self) -> usize {
        self.scenes
    }

    /// The curve from eta = 0 to eta = 1; empty without scenes.
    pub fn points(&self) -> impl Iterator<Item = RocPoint> + '_ {
        let scenes = self.scenes as f64;
        (0..=THRESHOLD_STEPS).filter(move |_| scenes > 0.0).map(move |i| RocPoint {
            eta: i as f32 / THRESHOLD_STEPS as f32,
            detection: self.detection[i] / scenes,
            false_alarm: self.false_alarm[i] / scenes,
        })
    }

    /// The largest P_D reached with P_FA at most `false_alarm`, or `None` without scenes.
    pub fn at_false_alarm(&self, false_alarm: f64) -> Option<RocPoint> {
        self.points().find(|p| p.false_alarm <= false_alarm)
    }

    /// The lowest threshold that keeps P_FA at most `false_alarm` on further scenes, or `None` where the scenes are too few for that
    /// ([`Roc::fewest_scenes`]).
    ///
    /// Conformal risk control (Angelopoulos et al., *Conformal risk control*, ICLR 2024, theorem 1): P_FA of a scene falls with the threshold
    /// and is at most 1. Where the `n` scenes averaged and a further one are exchangeable, the mean of P_FA over all such draws is at most
    /// `false_alarm` at the lowest threshold with (n P_FA + 1) / (n + 1) at most `false_alarm`. It is a mean over scenes and draws: in a
    /// single scene P_FA may be higher.
    pub fn keeping_false_alarm(&self, false_alarm: f64) -> Option<RocPoint> {
        let scenes = self.scenes as f64;
        self.points().find(|p| scenes * p.false_alarm + 1.0 <= false_alarm * (scenes + 1.0))
    }

    /// The fewest scenes with which [`Roc::keeping_false_alarm`] can keep the rate.
    pub fn fewest_scenes(false_alarm: f64) -> f64 {
        (1.0 / false_alarm - 1.0).ceil()
    }

    /// The mean P_FA that is left to `scenes` scenes by keeping the rate: `((n + 1) false_alarm - 1) / n`. A further scene may have P_FA 1, and
    /// fewer scenes leave less of the rate. Below 0 where the scenes are too few.
    pub fn left_to_scenes(scenes: usize, false_alarm: f64) -> f64 {
        let scenes = scenes as f64;
        ((scenes + 1.0) * false_alarm - 1.0) / scenes
    }

    /// The fewest scenes to which [`Roc::left_to_scenes`] leaves nine tenths of the rate.
    pub fn scenes_within_a_tenth(false_alarm: f64) -> u64 {
        // (n + 1) r - 1 >= 0.9 n r; the 1e-6 covers rounding.
        (10.0 * (1.0 - false_alarm) / false_alarm - 1e-6).ceil() as u64
    }

    /// The highest threshold with P_D at least `detection`, or `None` where no threshold reaches it and without scenes.
    pub fn at_detection(&self, detection: f64) -> Option<RocPoint> {
        self.points().filter(|p| p.detection >= detection).last()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::detection_rates;
    use ndarray::Array2;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn agrees_with_counting_at_each_threshold() {
        let target =
            RangeAngleMap { lambda: Array2::from_shape_fn((40, 50), |(i, j)| ((i * 7 + j) % 97) as f32 / 96.0) };
        let output =
            RangeAngleMap { lambda: Array2::from_shape_fn((40, 50), |(i, j)| ((i * 5 + j) % 89) as f32 / 88.0) };
        for point in Roc::of(&target, &output).points().step_by(311) {
            let (pd, pfa) = detection_rates(&target, &output, point.eta);
            assert_eq!((pd, pfa), (Some(point.detection), point.false_alarm), "eta {}", point.eta);
        }
    }

    /// A map of 100 cells of which ten are targets, and an output with false alarms of random heights beside the detected targets.
    fn scene(rng: &mut impl RngExt) -> [RangeAngleMap; 2] {
        let target = Array2::from_shape_fn((10, 10), |(i, _)| if i == 9 { 1.0 } else { 0.0 });
        let highest: f32 = rng.random();
        let output = target.mapv(|t| if t > 0.0 { 1.0 } else { highest * rng.random::<f32>() });
        [target, output].map(|lambda| RangeAngleMap { lambda })
    }

    #[test]
    fn a_threshold_keeps_the_mean_false_alarms_of_other_scenes() {
        let rng = &mut rand_chacha::ChaCha8Rng::seed_from_u64(7);
        const WANTED: f64 = 0.1;
        const DRAWS: usize = 400;
        let (mut kept, mut by_mean) = (0.0, 0.0);
        for _ in 0..DRAWS {
            let mut roc = Roc::default();
            for _ in 0..20 {
                let [target, output] = scene(rng);
                roc.add(&target, &output);
            }
            let [target, output] = scene(rng);
            let alarms = |point: Option<RocPoint>| detection_rates(&target, &output, point.unwrap().eta).1;
            kept += alarms(roc.keeping_false_alarm(WANTED)) / DRAWS as f64;
            by_mean += alarms(roc.at_false_alarm(WANTED)) / DRAWS as f64;
        }
        // The standard error of either mean is about 0.006.
        assert!(kept < WANTED, "{kept}");
        assert!(by_mean > kept + 0.02, "the mean alone keeps less: {by_mean} against {kept}");
    }

    #[test]
    fn many_scenes_are_left_nearly_all_of_the_rate() {
        for rate in [0.001, 0.005, 0.01, 0.4] {
            let fewest = Roc::scenes_within_a_tenth(rate) as usize;
            let left = |scenes| Roc::left_to_scenes(scenes, rate) / rate;
            assert!(left(fewest) > 0.9 - 1e-9 && left(fewest - 1) < 0.9, "{rate}: {fewest}");
            // The mean over the scenes tried and one more with P_FA 1 is the rate.
            let scenes = Roc::fewest_scenes(rate) + 7.0;
            let mean = (scenes * Roc::left_to_scenes(scenes as usize, rate) + 1.0) / (scenes + 1.0);
            assert!((mean - rate).abs() < 1e-12, "{rate}: {mean}");
        }
        assert_eq!(Roc::scenes_within_a_tenth(0.01), 990);
    }

    #[test]
    fn the_highest_threshold_that_detects_enough_is_found() {
        let target = RangeAngleMap { lambda: Array2::from_shape_fn((10, 10), |(i, _)| if i == 9 { 1.0 } else { 0.0 }) };
        // One of the ten target cells answers 0.5, the others 0.75.
        let output = RangeAngleMap {
            lambda: Array2::from_shape_fn((10, 10), |(i, j)| match (i, j) {
                (9, 0) => 0.5,
                (9, _) => 0.75,
                _ => 0.0,
            }),
        };
        let roc = Roc::of(&target, &output);
        let below = |eta: f32| eta - 1.0 / THRESHOLD_STEPS as f32;
        assert_eq!(roc.at_detection(1.0).unwrap().eta, below(0.5));
        assert_eq!(roc.at_detection(0.9).unwrap().eta, below(0.75));
        assert_eq!(Roc::of(&target, &RangeAngleMap { lambda: Array2::zeros((10, 10)) }).at_detection(0.9), None);
    }
}
