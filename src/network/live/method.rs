//! The live network as a reconstruction method.

use super::constants::turn_columns;
use super::engine::{Decades, LiveEngine, LiveScratch};
use super::features::FeatureExtractor;
use super::size::LiveSize;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::network::domain::{Domain, is_alike};
use crate::network::weights::{WeightFile, WeightsError};
use crate::radar::{Decibels, Radar};
use crate::reconstruct::{About, Family, ReconstructError, Reconstruction, Reconstructor, Request, Weights};
use crate::reconstruct::{TrainedNoise, level_above_mean_decades, own_threshold};
use crate::signal::TwoEnds;
use crate::signal::simd::powers::each;
use ndarray::Array2;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Name of the network, on the command line and in weight files.
pub const NAME: &str = "live";

const DESCRIPTION: &str = "a small network that draws the whole array's map from matched filters of both ends";
const TRAINED_ON: &str = "for the radar of table 3.1: scenes drawn as the generators of all kinds draw them, a third of them over thermal noise \
    at signal-to-noise ratios of 10 to 60 dB, the others over the rounding of the thesis' program; for others of 1024 elements, weights that went \
    on from those, on one procedural world before radars drawn at random; for the cascade of 12 x 16 pairs, weights of the same world";

/// Buffers kept for later passes; each takes some 30 MB.
const MAX_IDLE_BUFFERS: usize = 2;

/// The live network with its weights.
#[derive(Debug)]
pub struct LiveMethod {
    name: &'static str,
    engine: LiveEngine,
    extractor: Mutex<Option<Arc<FeatureExtractor>>>,
    /// Idle buffers. A pass takes one out and holds no lock while it runs: other threads, and the same thread where rayon gives it another
    /// caller's work, take others.
    idle: Mutex<Vec<LiveScratch>>,
    eta: f32,
    weights: Weights,
    trained: Domain,
    /// Networks for radars for which this one wasn't trained; where none fits a radar, the error is the first one's.
    other_radars: Vec<LiveMethod>,
}

impl LiveMethod {
    /// The network of the weights of `file`.
    ///
    /// # Errors
    /// [`WeightsError`] when the file belongs to another network.
    pub fn new(file: WeightFile) -> Result<Self, WeightsError> {
        LiveMethod::named(file, NAME)
    }

    /// The network under a name of its own, beside the shipped weights. The name is never freed.
    ///
    /// # Errors
    /// As [`LiveMethod::new`].
    pub fn named(file: WeightFile, name: &str) -> Result<Self, WeightsError> {
        if !["", NAME].contains(&file.network()) {
            return Err(file.foreign(NAME));
        }
        let size = LiveSize::of(&file)?;
        let trained = file.provenance.domain(file.name())?;
        size.check_domain(file.name(), &trained)?;
        Ok(LiveMethod {
            name: if name == NAME { NAME } else { name.to_owned().leak() },
            engine: LiveEngine::new(&file, &size)?,
            extractor: Mutex::default(),
            idle: Mutex::default(),
            eta: file.provenance.eta().unwrap_or(0.8),
            weights: file.weights(),
            trained,
            other_radars: Vec::new(),
        })
    }

    /// The network with `others`, the first of which that was trained for a radar answers where this one wasn't.
    pub fn with_other_radars(self, others: Vec<LiveMethod>) -> Self {
        LiveMethod { other_radars: others, ..self }
    }

    fn on(&self, radar: &Radar) -> &LiveMethod {
        if self.trained.holds(radar) {
            return self;
        }
        let others = &self.other_radars;
        others.iter().find(|other| other.trained.holds(radar)).or(others.first()).unwrap_or(self)
    }

    /// The network without features and normalisation.
    pub fn engine(&self) -> &LiveEngine {
        &self.engine
    }

    fn extractor(&self, radar: &Radar) -> Result<Arc<FeatureExtractor>, ReconstructError> {
        // A panic elsewhere leaves the tables whole or absent.
        let kept = || self.extractor.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(extractor) = kept().as_ref().filter(|extractor| is_alike(extractor.radar(), radar)) {
            return Ok(Arc::clone(extractor));
        }
        self.trained.check(self.name, radar)?;
        let made = Arc::new(FeatureExtractor::new(radar)?);
        *kept() = Some(Arc::clone(&made));
        Ok(made)
    }

    fn with_doubt(&self, radar: &Radar, ends: &TwoEnds) -> Result<(Decades, Option<RangeAngleMap>), ReconstructError> {
        let input = self.extractor(radar)?.extract(ends)?;
        // A panic elsewhere can't spoil the buffers: every pass overwrites them.
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut scratch = taken.unwrap_or_default();
        let mut decades = self.engine.forward(&input, &mut scratch);
        let mut doubt = self.engine.doubt(&scratch);
        turn_columns(radar, &mut decades.map);
        if let Some(cells) = doubt.as_mut().and_then(|doubt| doubt.lambda.as_slice_mut()) {
            turn_columns(radar, cells);
        }
        let mut idle = idle();
        if idle.len() < MAX_IDLE_BUFFERS {
            idle.push(scratch);
        }
        drop(idle);
        let gain = input.gain as f32;
        decades.map.par_iter_mut().for_each(|v| *v += gain);
        decades.minimum += gain;
        Ok((decades, doubt))
    }
}

/// Signal-to-noise ratios of the third of the training scenes that had thermal noise (`--snr` of `training/train_live.py`).
const TRAINED_DECIBELS: [Decibels; 2] = [Decibels(10.0), Decibels(60.0)];

const CELLS_A_LOOK: usize = 17;

/// A level that no noise cell exceeds, decades of the network's own map. It lies above the median cell, which is the network's mean of noise
/// where most cells hold noise; over the rounding floor it lies far below every echo.
fn noise_level_decades(map: &[f32]) -> f64 {
    let mut cells: Vec<f32> = map.iter().copied().step_by(CELLS_A_LOOK).collect();
    if cells.is_empty() {
        return f64::NEG_INFINITY;
    }
    let middle = cells.len() / 2;
    let median = *cells.select_nth_unstable_by(middle, f32::total_cmp).1;
    f64::from(median) + level_above_mean_decades(map.len())
}

/// The `doubt` of Lambda normalised from the smallest to the largest cell, converted to `scale`.
fn on_scale(mut doubt: RangeAngleMap, [minimum, peak]: [f32; 2], scale: LambdaScale) -> RangeAngleMap {
    let wider = (f64::from(peak - minimum) / (scale.peak - scale.floor)) as f32;
    if wider != 1.0 && wider.is_finite() {
        doubt.lambda.par_mapv_inplace(|v| (v * wider).min(1.0));
    }
    doubt
}

impl Reconstructor for LiveMethod {
    fn family(&self) -> Family {
        Family::Network
    }

    fn about(&self) -> About {
        let is_shipped = self.name == NAME;
        About {
            name: self.name,
            description: if is_shipped { DESCRIPTION } else { "the live network with weights from a file" },
            told: if is_shipped { TRAINED_ON } else { "what its weights were trained on, which their file says" },
            eta: self.eta,
        }
    }

    fn reads_eta(&self) -> bool {
        true
    }

    fn weights(&self, radar: &Radar) -> Option<Weights> {
        Some(self.on(radar).weights.clone())
    }

    fn trained_noise(&self) -> Option<TrainedNoise> {
        Some(TrainedNoise::RoundingAndSnr(TRAINED_DECIBELS[0], TRAINED_DECIBELS[1]))
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        self.on(radar).trained.check(self.name, radar)
    }

    fn knows_pairs(&self) -> bool {
        std::iter::once(self).chain(&self.other_radars).any(|network| network.trained.is_of_pairs())
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let (Decades { mut map, minimum, .. }, doubt) = self.on(radar).with_doubt(radar, ends)?;
        let peak = map.par_iter().copied().reduce(|| f32::NEG_INFINITY, f32::max);
        let scale = LambdaScale::new(minimum.into(), peak.into(), request.normalisation);
        let least_eta = scale.lambda(noise_level_decades(&map)) as f32;
        let doubt = doubt.map(|doubt| on_scale(doubt, [minimum, peak], scale));
        map.par_chunks_mut(radar.elements).for_each(|line| each(line, |v| scale.lambda(v.into()) as f32));
        let lambda = Array2::from_shape_vec((radar.samples, radar.elements), map)
            .map_err(|e| ReconstructError::Unusable { method: self.name, reason: e.to_string() })?;
        let lambda = RangeAngleMap { lambda };
        let (eta, least_eta) = (Some(own_threshold(&lambda, doubt.as_ref())), Some(least_eta));
        Ok(Reconstruction { eta, least_eta, doubt, ..Reconstruction::of_map(lambda) })
    }
}
