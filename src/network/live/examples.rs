//! Training examples: example `i` is a function of the request and `i` alone, in any order of calls.

use super::arrays::Arrays;
use super::constants::turn_rows;
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
use std::fmt;

/// The examples to make.
#[derive(Debug, Clone, PartialEq)]
pub struct ExamplesRequest {
    /// Kinds of the scenes.
    pub mixture: Mixture,
    /// Purpose of the examples, which picks the streams of the scenes: those of different purposes never meet.
    pub purpose: Purpose,
    /// Seed of the scenes.
    pub seed: u64,
    /// Floors of the scenes.
    pub floors: Floors,
    /// Arrays of the scenes.
    pub arrays: Arrays,
    /// Radars of the scenes.
    pub radars: Radars,
    /// The maps to learn, each once.
    pub targets: Vec<Target>,
    /// Whether the live network's input is made.
    pub features: Features,
    /// Numbers of the elements whose samples replace those of the two ends.
    pub layout: Option<Vec<usize>>,
}

/// Whether the live network's input is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Features {
    /// The input is made in the radar's shape; a radar without one is refused.
    Needed,
    /// The input is made where the radar has the shape of the shipped network.
    WherePossible,
    /// The input isn't made.
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

/// Makes examples.
#[derive(Debug)]
pub struct Examples {
    request: ExamplesRequest,
    /// Tables of the radar, where all scenes have the same.
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
    /// Kind of the scene; none where the caller made it.
    pub kind: Option<Kind>,
    /// Floor of the scene.
    pub floor: Floor,
    /// Radar of the scene.
    pub radar: Radar,
    /// The samples of the sparse array, whose elements may be off.
    pub heard: EndSamples,
    /// The live network's input, where it is made.
    pub input: Option<LiveInput>,
    /// Half the log10 of the mean power of the samples.
    pub gain: f64,
    /// Maps of the whole array, `[range bins, columns]`: decades of amplitude relative to `gain`. cos(theta) rises with the column in both
    /// conventions.
    pub targets: Vec<(Target, Array2<f32>)>,
}

impl Example {
    /// The samples of the two ends; `None` where a layout was asked for.
    pub fn ends(&self) -> Option<&TwoEnds> {
        match &self.heard {
            EndSamples::Ends(ends) => Some(ends),
            EndSamples::Elements(_) => None,
        }
    }

    /// The map of a target; `None` where it wasn't requested.
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
    /// The examples of a request.
    /// # Errors
    /// Where a kind, a radar or an element can't be used, a message that names it.
    pub fn new(mut request: ExamplesRequest) -> Result<Self, String> {
        let kinds = || request.mixture.shares().iter().map(|(kind, _)| *kind);
        if request.purpose == Purpose::Test && kinds().any(|kind| kind == Kind::World) {
            let expected = "expected a purpose of training or validation";
            return Err(refused(format!("{} makes no scenes for tests; {expected}", Kind::World)));
        }
        let found = request.radars.least_max_range_metres();
        kinds().try_for_each(|kind| kind.check_room_within(found)).map_err(refused)?;
        if let Some(layout) = &request.layout {
            check_layout(layout, request.radars.shape().elements).map_err(refused)?;
            match request.features {
                Features::Needed => {
                    return Err(refused("the live network hears two ends; expected no layout, or no features"));
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
                extractor = Some(FeatureExtractor::new(radar).map_err(refused)?);
            }
        }
        Ok(Examples { request, extractor })
    }

    /// The radars for which a network is trained by these examples.
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
    /// [`ExampleError`], also soon after `task` was cancelled.
    pub fn example(&self, index: u32, task: &Task) -> Result<Example, ExampleError> {
        let ExamplesRequest { mixture, purpose, seed, .. } = &self.request;
        let (kind, radar) = (mixture.kind(*seed, index), self.radar(index));
        let scene = Generator::new(&radar, Reading::Program, *purpose, *seed).scene(kind, index);
        self.made(Some(kind), radar, scene, index, task)
    }

    /// Example `index` of a given scene. Seed, purpose and `index` pick its noise.
    ///
    /// # Errors
    /// As [`Examples::example`].
    pub fn example_of(&self, scene: Scene, index: u32, task: &Task) -> Result<Example, ExampleError> {
        let noise_seed = self.noise_seed(index);
        self.made(None, self.radar(index), Scene { noise_seed, ..scene }, index, task)
    }

    fn noise_seed(&self, index: u32) -> u64 {
        let mut key = [0u8; 32];
        key[..8].copy_from_slice(&self.request.seed.to_le_bytes());
        // No stream of generated scenes, of kinds or of radars has the number 6.
        key[8..10].copy_from_slice(&[6, self.request.purpose.number()]);
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(index.into());
        rng.random::<u64>() >> 11
    }

    fn made(
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
        let simulated = |scene: &Scene, floor: Floor| {
            simulate_for(task, &radar, scene, floor, scene.noise_seed).map_err(|e| failed(e.to_string()))
        };
        let drawn = arrays.of(scene.noise_seed, &radar, targets.contains(&Target::Measured));
        if !drawn.is_ideal() {
            scene.disturbances.elements = drawn;
        }
        let measured = simulated(&scene, floor)?;
        let heard = match layout {
            None => EndSamples::Ends(measured.two_ends(&radar)),
            Some(layout) => EndSamples::Elements(measured.samples.select(Axis(0), layout)),
        };
        let silent = || failed("the samples are silent; put a reflector into the scene".to_owned());
        let gain = heard.gain().ok_or_else(silent)?;
        let input = self.input(&radar, &heard).map_err(|e| failed(e.to_string()))?;
        let elements = &scene.disturbances.elements;
        let is_measured =
            |target: &Target| *target == Target::Measured || (*target == Target::Calibrated && elements.is_ideal());
        let of_measured = targets.iter().any(is_measured).then(|| map(&radar, elements, measured, gain));
        let of_other = |target: Target| {
            let disturbances = Disturbances { elements: BuiltArray::default(), ..scene.disturbances.clone() };
            let floor = if target == Target::Ideal { Floor::Exact } else { floor };
            let signal = simulated(&Scene { disturbances, ..scene.clone() }, floor)?;
            Ok(map(&radar, &BuiltArray::default(), signal, gain))
        };
        let of = |target: &Target| match &of_measured {
            Some(map) if is_measured(target) => Ok((*target, map.clone())),
            _ => of_other(*target).map(|map| (*target, map)),
        };
        let maps = targets.iter().map(of).collect::<Result<_, _>>()?;
        Ok(Example { kind, floor, heard, input, gain, targets: maps, radar })
    }

    fn input(&self, radar: &Radar, heard: &EndSamples) -> Result<Option<LiveInput>, ReconstructError> {
        let EndSamples::Ends(ends) = heard else { return Ok(None) };
        match &self.extractor {
            _ if !self.has_features() => Ok(None),
            Some(extractor) => extractor.extract(ends).map(Some),
            None => FeatureExtractor::new(radar)?.extract(ends).map(Some),
        }
    }
}

fn refused(why: impl fmt::Display) -> String {
    why.to_string()
}

impl EndSamples {
    /// Half the log10 of the samples' mean power; `None` of silence.
    fn gain(&self) -> Option<f64> {
        let mean = |power: f64, samples: usize| (power > 0.0).then(|| 0.5 * (power / samples as f64).log10());
        match self {
            // The sum of [`FeatureExtractor::extract`], to the bit.
            EndSamples::Ends(ends) => {
                let power = ends.first.iter().chain(&ends.last).map(|v| v.norm_sqr()).sum::<f64>();
                mean(power, ends.first.len() + ends.last.len())
            }
            EndSamples::Elements(samples) => mean(samples.iter().map(|v| v.norm_sqr()).sum::<f64>(), samples.len()),
        }
    }
}

/// The whole array's map, decades over `gain`; cos(theta) rises with the column.
fn map(radar: &Radar, elements: &BuiltArray, signal: BeatSignal, gain: f64) -> Array2<f32> {
    let mut decades = match radar.focus_off_line {
        true => map_of(radar, elements, &signal, Aperture::Full).log_magnitude().decades().mapv(|v| v as f32),
        false => whole_map(radar, &range_transform_in_place(radar, signal)),
    };
    decades.mapv_inplace(|v| (f64::from(v) - gain) as f32);
    turn_rows(radar, &mut decades.view_mut());
    decades
}

#[cfg(test)]
mod tests;
