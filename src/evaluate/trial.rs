//! One scene for all methods, and the measures of their answers.

use super::echoes::{self, EchoCounts, EchoTally};
use super::rows::Row;
use super::verdict::{Footprints, ObjectVerdict, OutputVerdicts};
use super::{Metrics, Roc, Target, part_within, squared_doubt, squared_error};
use crate::maps::cfar::{Cfar, CfarError, DETECTION_THRESHOLD};
use crate::maps::{self, Aperture, LambdaScale, LogMap, Normalisation, RangeAngleMap};
use crate::platform::Instant;
use crate::radar::{BuiltArray, Radar};
use crate::reconstruct::{ReconstructError, Reconstruction, Reconstructor, Request};
use crate::scene::{Disturbances, Reflector, Scene, SceneError};
use crate::signal::{self, Floor, LayoutSamples, TwoEnds};
use std::sync::{Arc, OnceLock};

/// A simulated scene: the samples for methods, and the map against which answers are compared.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The radar.
    pub radar: Radar,
    /// The samples of the two ends.
    pub ends: TwoEnds,
    /// The samples of the elements of another layout, for methods that use them.
    pub layout_samples: Option<Arc<LayoutSamples>>,
    /// Lambda against which answers are compared.
    pub target: RangeAngleMap,
    scene: Scene,
    scale: LambdaScale,
    footprints: OnceLock<Footprints>,
}

/// A method's answer for a [`Trial`], timed and judged.
#[derive(Debug, Clone)]
pub struct TimedAnswer {
    /// The method's reconstruction.
    pub found: Reconstruction,
    /// Duration of the reconstruction.
    pub milliseconds: f64,
    /// SE, and P_D and P_FA at the method's threshold.
    pub metrics: Metrics,
    /// The method's threshold.
    pub eta: f32,
}

impl Trial {
    /// Simulates `scene` over `floor`; the scene's seed picks the noise.
    /// # Errors
    /// [`SceneError`] when the radar can't see the scene.
    pub fn new(radar: &Radar, scene: &Scene, floor: Floor, normalisation: Normalisation) -> Result<Trial, SceneError> {
        Trial::against(Target::Measured, None, radar, scene, floor, normalisation)
    }

    /// [`Trial::new`] with another target, and with the samples of the elements of `layout` beside those of the ends.
    /// # Errors
    /// As [`Trial::new`].
    pub fn against(
        target: Target,
        layout: Option<&[usize]>,
        radar: &Radar,
        scene: &Scene,
        floor: Floor,
        normalisation: Normalisation,
    ) -> Result<Trial, SceneError> {
        let signal = signal::simulate(radar, scene, floor, scene.noise_seed)?;
        let elements = &scene.disturbances.elements;
        let full = match target {
            Target::Calibrated if !elements.is_ideal() => calibrated(radar, scene, floor)?,
            Target::Ideal => calibrated(radar, scene, Floor::Exact)?,
            Target::Measured | Target::Calibrated => {
                maps::focus::map_of(radar, elements, &signal, Aperture::Full).log_magnitude()
            }
        };
        let target = full.normalise(normalisation);
        let ends = signal.two_ends(radar);
        let of_layout = |layout: &[usize]| Arc::new(signal.of_layout(layout));
        let layout_samples = layout.map(of_layout);
        let (radar, scene, scale) = (radar.clone(), scene.clone(), full.scale(normalisation));
        Ok(Trial { radar, ends, layout_samples, target, scene, scale, footprints: OnceLock::new() })
    }

    /// Runs `method` on the scene, and judges its answer.
    /// # Errors
    /// [`ReconstructError`] of the method.
    pub fn ask(&self, method: &dyn Reconstructor, request: &Request) -> Result<TimedAnswer, ReconstructError> {
        request.task.check()?;
        let start = Instant::now();
        let found = match &self.layout_samples {
            None => method.reconstruct(&self.radar, &self.ends, request)?,
            layout_samples => method.reconstruct(
                &self.radar,
                &self.ends,
                &Request { layout_samples: layout_samples.clone(), ..request.clone() },
            )?,
        };
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let eta = method.eta_of(&found);
        Ok(TimedAnswer {
            metrics: Metrics::of_echoes(!self.scene.is_silent(), &self.target, &found.lambda, eta),
            found,
            milliseconds,
            eta,
        })
    }

    /// The footprints of the objects, computed at the first call.
    pub fn footprints(&self) -> &Footprints {
        self.footprints.get_or_init(|| Footprints::new(&self.radar, &self.scene, &self.target, self.scale))
    }

    /// The verdicts on an answer.
    pub fn verdicts(&self, answer: &TimedAnswer) -> OutputVerdicts {
        self.footprints().judge(&self.target, &answer.found.lambda, answer.eta)
    }

    /// Counts of the echoes that stand out in the target, and of those that an answer shows.
    pub fn echoes(&self, answer: &TimedAnswer) -> EchoTally {
        echoes::tally(&self.radar, &self.scene, &self.target, &answer.found.lambda, &self.scale)
    }

    /// SE of an answer, and P_D and P_FA of the cells that `cfar` detects in it against those that `cfar` detects in the target, in the place of
    /// both thresholds. Lambda is converted to power on the target's scale.
    /// # Errors
    /// [`CfarError`] where the detector can't work on the radar's maps.
    pub fn cfar_metrics(&self, answer: &TimedAnswer, cfar: &Cfar) -> Result<Metrics, CfarError> {
        let detected = |map: &RangeAngleMap| Ok(cfar.detect_lambda(map, self.scale)?.as_map());
        let (target, output) = (detected(&self.target)?, detected(&answer.found.lambda)?);
        let by_cfar = Metrics::of_echoes(!self.scene.is_silent(), &target, &output, DETECTION_THRESHOLD);
        Ok(Metrics { squared_error: squared_error(&self.target, &answer.found.lambda), ..by_cfar })
    }

    /// The row of an answer: `row`, which has the origin, with all figures but those of a detector of constant false-alarm rate.
    /// `false_alarm` is the rate at which [`Row::detection_at_printed`] is taken.
    pub fn filled(&self, row: Row, answer: &TimedAnswer, false_alarm: f64) -> Row {
        let roc = Roc::of_echoes(!self.scene.is_silent(), &self.target, &answer.found.lambda);
        let verdicts = self.verdicts(answer);
        let has_bodies = self.scene.objects.iter().any(|object| object.body().is_some());
        let echoes = has_bodies.then(|| self.echoes(answer));
        Row {
            eta: answer.eta,
            squared_error: answer.metrics.squared_error,
            detection: answer.metrics.detection,
            false_alarm: answer.metrics.false_alarm,
            detection_at_printed: roc.at_false_alarm(false_alarm).map(|p| p.detection),
            milliseconds: answer.milliseconds,
            missed: verdicts.missed(),
            ghosts: verdicts.ghosts.len(),
            found: Some(verdicts.count(|verdict| verdict == ObjectVerdict::Found)),
            merged: Some(verdicts.count(|verdict| matches!(verdict, ObjectVerdict::Merged { .. }))),
            wrong_tooth: Some(verdicts.count(|verdict| matches!(verdict, ObjectVerdict::WrongTooth { .. }))),
            doubt: answer.found.doubt.as_ref().map(squared_doubt),
            within_doubt: answer.found.doubt.as_ref().map(|d| part_within(d, &self.target, &answer.found.lambda)),
            echoes: echoes.map(|tally| EchoCounts(tally.there)),
            echoes_found: echoes.map(|tally| EchoCounts(tally.found)),
            ..with_facts(row, &self.radar, &self.scene)
        }
    }
}

fn calibrated(radar: &Radar, scene: &Scene, floor: Floor) -> Result<LogMap, SceneError> {
    let elements = BuiltArray::default();
    let disturbances = Disturbances { elements: elements.clone(), ..scene.disturbances.clone() };
    let signal = signal::simulate(radar, &Scene { disturbances, ..scene.clone() }, floor, scene.noise_seed)?;
    Ok(maps::focus::map_of(radar, &elements, &signal, Aperture::Full).log_magnitude())
}

/// Place of a reflector in a map: (column, range bin), neither rounded, and the index of its object.
type Spot = ([f64; 2], usize);

/// `row` with the figures that are known of a scene before a method answers.
fn with_facts(row: Row, radar: &Radar, scene: &Scene) -> Row {
    let of_objects = scene.objects.iter().enumerate().map(|(i, object)| (i, object.marks()));
    let reflectors: Vec<(usize, Reflector)> =
        of_objects.flat_map(|(i, all)| all.into_iter().map(move |r| (i, r))).collect();
    let range = |r: &Reflector| r.x_metres.hypot(r.y_metres);
    // Strengths as seen from the middle of the array; a reflector of reflectivity 0 has no echo.
    let echoes = reflectors.iter().map(|(_, r)| r.reflectivity.abs() / range(r).powi(2)).filter(|e| *e > 0.0);
    let (weakest, strongest) = echoes.fold((f64::INFINITY, 0.0f64), |(a, b), e| (a.min(e), b.max(e)));
    let half = radar.elements as f64 / 2.0;
    let spots = reflectors.iter().map(|(object, r)| {
        let cosine = r.x_metres / range(r).max(f64::MIN_POSITIVE);
        ([half * (1.0 + cosine), range(r) / radar.range_resolution_metres()], *object)
    });
    let (columns, bins) = nearest_pair(spots.collect()).map(|[columns, bins]| (columns, bins)).unzip();
    Row {
        objects: scene.objects.len(),
        reflectors: reflectors.len(),
        nearest_pair_columns: columns,
        nearest_pair_bins: bins,
        min_range_metres: reflectors.iter().map(|(_, r)| range(r)).reduce(f64::min),
        strongest_over_weakest_db: (strongest > 0.0).then(|| 20.0 * (strongest / weakest).log10()),
        ..row
    }
}

/// Columns and bins between the nearest two spots of different objects, in cells.
fn nearest_pair(mut spots: Vec<Spot>) -> Option<[f64; 2]> {
    spots.sort_by(|a, b| a.0[1].total_cmp(&b.0[1]));
    let mut nearest: Option<([f64; 2], f64)> = None;
    for (i, ([column, bin], object)) in spots.iter().enumerate() {
        for ([other_column, other_bin], other) in &spots[i + 1..] {
            let apart = [(other_column - column).abs(), other_bin - bin];
            if nearest.is_some_and(|(_, distance)| apart[1] >= distance) {
                break;
            }
            let distance = apart[0].hypot(apart[1]);
            if object != other && nearest.is_none_or(|(_, least)| distance < least) {
                nearest = Some((apart, distance));
            }
        }
    }
    nearest.map(|(apart, _)| apart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Object, Point};

    #[test]
    fn facts_of_a_known_scene() {
        let radar = Radar::default();
        let bin = radar.range_resolution_metres();
        let point = |x: f64, y: f64, reflectivity| Object::Point(Point { reflectivity, ..Point::new(x, y) });
        // At broadside a column is 1 / 512 of the cosine.
        let objects = vec![point(0.0, 100.0 * bin, 1.0), point(0.0, 103.0 * bin, 1.0), point(0.0, 200.0 * bin, 0.04)];
        let facts = with_facts(Row::default(), &radar, &Scene { objects, ..Scene::default() });
        assert!(facts.nearest_pair_columns == Some(0.0) && (facts.nearest_pair_bins.unwrap() - 3.0).abs() < 1e-9);
        assert!((facts.min_range_metres.unwrap() - 100.0 * bin).abs() < 1e-9);
        assert!((facts.strongest_over_weakest_db.unwrap() - 40.0).abs() < 1e-9, "a factor of 100 in amplitude");
        assert_eq!(with_facts(Row::default(), &radar, &Scene::default()), Row::default());
    }

    #[test]
    fn the_nearest_pair_is_the_one_that_trying_all_finds() {
        let spots: Vec<Spot> =
            (0..60).map(|i| ([f64::from(i * 37 % 61) * 3.3, f64::from(i * 53 % 59) * 1.7], i as usize % 7)).collect();
        let pairs = spots.iter().flat_map(|a| spots.iter().map(move |b| (a, b))).filter(|(a, b)| a.1 != b.1);
        let least = pairs.map(|((a, _), (b, _))| (a[0] - b[0]).hypot(a[1] - b[1])).fold(f64::INFINITY, f64::min);
        let [columns, bins] = nearest_pair(spots).unwrap();
        assert_eq!(columns.hypot(bins), least);
    }
}
