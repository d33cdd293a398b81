//! Training examples. Example `i` depends on the request and `i` alone, in any order of calls.

use super::arrays::Arrays;
use super::constants::reverse_rows;
use super::features::{FeatureExtractor, LiveInput};
use super::radars::{DRAWN_LIMITS, Radars};
use crate::evaluate::Target;
use crate::evaluate::sets::SceneSet;
use crate::maps::focus::map_of;
use crate::maps::{Aperture, fast::whole_map, range_transform_in_place};
use crate::network::domain::Domain;
use crate::network::floors::Floors;
use crate::radar::{BuiltArray, Radar, check_layout};
use crate::reconstruct::ReconstructError;
use crate::scene::generate::{Generator, Kind, Mixture, Purpose, Reading};
use crate::scene::{Disturbances, Scene};
use crate::signal::{BeatSignal, Floor, TwoEnds, simulate_for};
use crate::task::Task;
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The examples to make.
#[derive(Debug, Clone, PartialEq)]
pub struct ExamplesRequest {
    /// Kinds of the scenes.
    pub mixture: Mixture,
    /// Purpose of the examples. The scenes of different purposes have different random streams.
    pub purpose: Purpose,
    /// Seed of the scenes.
    pub seed: u64,
    /// Floors of the scenes.
    pub floors: Floors,
    /// Arrays of the scenes.
    pub arrays: Arrays,
    /// Radars of the scenes.
    pub radars: Radars,
    /// The maps to learn, without repetition.
    pub targets: Vec<Target>,
    /// Whether examples have the live network's input.
    pub features: Features,
    /// Numbers of the elements with samples, in place of the two ends.
    pub layout: Option<Vec<usize>>,
}

/// Whether examples have the live network's input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Features {
    /// They have it; a radar that has none is refused.
    Needed,
    /// They have it where the radar has the shape of the shipped network.
    WherePossible,
    /// They don't have it.
    No,
}

impl Default for ExamplesRequest {
    fn default() -> Self {
        ExamplesRequest {
            mixture: Mixture::of(Kind::Set3),
            purpose: Purpose::Training,
            seed: 0,
            floors: Floors::Fixed(Floor::Thesis),
            arrays: Arrays::IDEAL,
            radars: Radars::default(),
            targets: vec![Target::Calibrated],
            features: Features::Needed,
            layout: None,
        }
    }
}

/// The examples of a request.
#[derive(Debug)]
pub struct Examples {
    request: ExamplesRequest,
    /// Tables of the features, where all scenes have the same radar.
    extractor: Option<FeatureExtractor>,
}

/// The samples of the sparse array.
#[derive(Debug, Clone, PartialEq)]
pub enum EndSamples {
    /// The two ends.
    Ends(TwoEnds),
    /// The elements of a layout, `[elements, samples]`.
    Elements(Array2<Complex64>),
}

/// Input and targets of one scene.
#[derive(Debug, Clone)]
pub struct Example {
    /// Kind of the scene; `None` for a scene of the caller.
    pub kind: Option<Kind>,
    /// Floor of the scene.
    pub floor: Floor,
    /// Radar of the scene.
    pub radar: Radar,
    /// The samples of the sparse array, with errors of its elements.
    pub end_samples: EndSamples,
    /// The live network's input.
    pub input: Option<LiveInput>,
    /// Half the log10 of the mean power of the samples.
    pub gain: f64,
    /// Maps of the whole array, `[range bins, columns]`: amplitudes relative to `gain`, decades. cos(theta) rises with the column in both conventions.
    pub targets: Vec<(Target, Array2<f32>)>,
}

impl Example {
    /// The samples of the two ends; `None` for a layout.
    pub fn ends(&self) -> Option<&TwoEnds> {
        match &self.end_samples {
            EndSamples::Ends(ends) => Some(ends),
            EndSamples::Elements(_) => None,
        }
    }

    /// The map of a target; `None` where it is not in the request.
    pub fn target(&self, target: Target) -> Option<&Array2<f32>> {
        self.targets.iter().find(|(name, _)| *name == target).map(|(_, map)| map)
    }
}

/// The reason why an example can't be made: its scene can't be simulated, the network can't use the samples, or the task was cancelled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("example {index}: {why}")]
pub struct ExampleError {
    index: u32,
    why: String,
}

impl Examples {
    /// The examples of `request`.
    /// # Errors
    /// A message that names the kind, the radar or the element that can't be used.
    pub fn new(mut request: ExamplesRequest) -> Result<Self, String> {
        let kinds = || request.mixture.shares().iter().map(|(kind, _)| *kind);
        if request.purpose == Purpose::Test && kinds().any(|kind| kind == Kind::World) {
            let expected = "expected a purpose of training or validation";
            return Err(format!("{} makes no scenes for tests; {expected}", Kind::World));
        }
        let found = request.radars.smallest_max_range_metres();
        kinds().try_for_each(|kind| kind.check_room_within(found)).map_err(|e| e.to_string())?;
        if let Some(layout) = &request.layout {
            check_layout(layout, request.radars.shape().elements).map_err(|e| e.to_string())?;
            match request.features {
                Features::Needed => {
                    return Err("the live network hears two ends; expected no layout, or no features".to_owned());
                }
                _ => request.features = Features::No,
            }
        }
        let mut extractor = None;
        if let Radars::Fixed(radar) = &request.radars {
            if request.features == Features::WherePossible && !DRAWN_LIMITS.has_shape(radar) {
                request.features = Features::No;
            }
            if request.features != Features::No {
                extractor = Some(FeatureExtractor::new(radar).map_err(|e| e.to_string())?);
            }
        }
        Ok(Examples { request, extractor })
    }

    /// The domain of a network that is trained on these examples.
    pub fn domain(&self) -> Domain {
        self.request.radars.domain()
    }

    /// Whether examples have the live network's input.
    pub fn has_features(&self) -> bool {
        self.request.features != Features::No
    }

    /// The radar of example `index`.
    pub fn radar(&self, index: u32) -> Radar {
        self.request.radars.of(self.request.seed, self.request.purpose, index)
    }

    /// Example `index`.
    /// # Errors
    /// [`ExampleError`], also after a cancellation of `task`.
    pub fn example(&self, index: u32, task: &Task) -> Result<Example, ExampleError> {
        let ExamplesRequest { mixture, purpose, seed, .. } = &self.request;
        let (kind, radar) = (mixture.kind(*seed, index), self.radar(index));
        let scene = Generator::new(&radar, Reading::Program, *purpose, *seed).scene(kind, index);
        self.make(Some(kind), radar, scene, index, task)
    }

    /// Example `index` of the given scene, with noise by seed, purpose and `index`.
    /// # Errors
    /// As [`Examples::example`].
    pub fn example_of(&self, scene: Scene, index: u32, task: &Task) -> Result<Example, ExampleError> {
        let noise_seed = self.noise_seed(index);
        self.make(None, self.radar(index), Scene { noise_seed, ..scene }, index, task)
    }

    fn noise_seed(&self, index: u32) -> u64 {
        let mut key = [0u8; 32];
        key[..8].copy_from_slice(&self.request.seed.to_le_bytes());
        // 6: no random stream of scenes, kinds or radars has this number.
        key[8..10].copy_from_slice(&[6, self.request.purpose.number()]);
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(index.into());
        rng.random::<u64>() >> 11
    }

    fn make(
        &self,
        kind: Option<Kind>,
        radar: Radar,
        mut scene: Scene,
        index: u32,
        task: &Task,
    ) -> Result<Example, ExampleError> {
        let ExamplesRequest { floors, arrays, targets, layout, .. } = &self.request;
        let floor = floors.of(scene.noise_seed);
        let floor = kind.map_or(floor, |kind| SceneSet::Generated(kind).floor(floor));
        let failed = |why: String| ExampleError { index, why };
        let simulate = |scene: &Scene, floor: Floor| {
            simulate_for(task, &radar, scene, floor, scene.noise_seed).map_err(|e| failed(e.to_string()))
        };
        let drawn = arrays.of(scene.noise_seed, &radar, targets.contains(&Target::Measured));
        if !drawn.is_ideal() {
            scene.disturbances.elements = drawn;
        }
        let measured = simulate(&scene, floor)?;
        let end_samples = match layout {
            None => EndSamples::Ends(measured.two_ends(&radar)),
            Some(layout) => EndSamples::Elements(measured.samples.select(Axis(0), layout)),
        };
        let silent = || failed("the samples are silent; put a reflector into the scene".to_owned());
        let gain = end_samples.gain().ok_or_else(silent)?;
        let input = self.input(&radar, &end_samples).map_err(|e| failed(e.to_string()))?;
        let elements = &scene.disturbances.elements;
        let is_measured =
            |target: &Target| *target == Target::Measured || (*target == Target::Calibrated && elements.is_ideal());
        let measured_map = targets.iter().any(is_measured).then(|| target_map(&radar, elements, measured, gain));
        let other_map = |target: Target| {
            let disturbances = Disturbances { elements: BuiltArray::default(), ..scene.disturbances.clone() };
            let floor = if target == Target::Ideal { Floor::Exact } else { floor };
            let signal = simulate(&Scene { disturbances, ..scene.clone() }, floor)?;
            Ok(target_map(&radar, &BuiltArray::default(), signal, gain))
        };
        let of = |target: &Target| match &measured_map {
            Some(map) if is_measured(target) => Ok((*target, map.clone())),
            _ => other_map(*target).map(|map| (*target, map)),
        };
        let maps = targets.iter().map(of).collect::<Result<_, _>>()?;
        Ok(Example { kind, floor, end_samples, input, gain, targets: maps, radar })
    }

    fn input(&self, radar: &Radar, end_samples: &EndSamples) -> Result<Option<LiveInput>, ReconstructError> {
        let EndSamples::Ends(ends) = end_samples else { return Ok(None) };
        match &self.extractor {
            _ if !self.has_features() => Ok(None),
            Some(extractor) => extractor.extract(ends).map(Some),
            None => FeatureExtractor::new(radar)?.extract(ends).map(Some),
        }
    }
}

impl EndSamples {
    /// Half the log10 of the samples' mean power; `None` of silence.
    fn gain(&self) -> Option<f64> {
        let mean = |power: f64, samples: usize| (power > 0.0).then(|| 0.5 * (power / samples as f64).log10());
        match self {
            // The same bits as in [`FeatureExtractor::extract`].
            EndSamples::Ends(ends) => {
                let power = ends.first.iter().chain(&ends.last).map(|v| v.norm_sqr()).sum::<f64>();
                mean(power, ends.first.len() + ends.last.len())
            }
            EndSamples::Elements(samples) => mean(samples.iter().map(|v| v.norm_sqr()).sum::<f64>(), samples.len()),
        }
    }
}

/// The whole array's map, decades relative to `gain`. cos(theta) rises with the column.
fn target_map(radar: &Radar, elements: &BuiltArray, signal: BeatSignal, gain: f64) -> Array2<f32> {
    let mut decades = match radar.focus_off_line {
        true => map_of(radar, elements, &signal, Aperture::Full).log_magnitude().decades().mapv(|v| v as f32),
        false => whole_map(radar, &range_transform_in_place(radar, signal)),
    };
    decades.mapv_inplace(|v| (f64::from(v) - gain) as f32);
    reverse_rows(radar, &mut decades.view_mut());
    decades
}

#[cfg(test)]
mod tests;
