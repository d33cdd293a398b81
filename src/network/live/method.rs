//! The live network as a reconstruction method.

use super::constants::reverse_columns;
use super::engine::{Decades, LiveEngine, LiveScratch};
use super::features::FeatureExtractor;
use super::size::LiveSize;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::network::domain::{Domain, is_alike};
use crate::network::weights::{WeightFile, WeightsError};
use crate::radar::{Decibels, Radar};
use crate::reconstruct::{Family, MethodInfo, ReconstructError, Reconstruction, Reconstructor, Request, Weights};
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

/// Most idle buffers that are kept for later passes, about 30 MB each.
const MAX_IDLE_BUFFERS: usize = 2;

/// The live network with its weights.
#[derive(Debug)]
pub struct LiveMethod {
    name: &'static str,
    engine: LiveEngine,
    extractor: Mutex<Option<Arc<FeatureExtractor>>>,
    /// Idle buffers. A pass removes one and holds no lock: other threads use others, as does this one where rayon gives it another caller's work.
    idle: Mutex<Vec<LiveScratch>>,
    eta: f32,
    weights: Weights,
    trained: Domain,
    /// Networks for radars for which this one was not trained. The first one refuses radars that none was trained for.
    other_radars: Vec<LiveMethod>,
}

impl LiveMethod {
    /// The network of the weights of `file`.
    /// # Errors
    /// [`WeightsError`] when the file belongs to another network.
    pub fn new(file: WeightFile) -> Result<Self, WeightsError> {
        LiveMethod::named(file, NAME)
    }

    /// The network under another name than that of the shipped weights. The memory of the name is never freed.
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

    /// The network with `others` for radars for which it was not trained. The first that was trained for a radar is used.
    pub fn with_other_radars(self, others: Vec<LiveMethod>) -> Self {
        LiveMethod { other_radars: others, ..self }
    }

    fn network_for(&self, radar: &Radar) -> &LiveMethod {
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

    /// The tables for `radar`, from the last call where it had an equivalent radar.
    fn extractor(&self, radar: &Radar) -> Result<Arc<FeatureExtractor>, ReconstructError> {
        // A panic of another thread leaves the tables complete or `None`.
        let cache = || self.extractor.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(extractor) = cache().as_ref().filter(|extractor| is_alike(extractor.radar(), radar)) {
            return Ok(Arc::clone(extractor));
        }
        self.trained.check(self.name, radar)?;
        let extractor = Arc::new(FeatureExtractor::new(radar)?);
        *cache() = Some(Arc::clone(&extractor));
        Ok(extractor)
    }

    /// The map in decades, and its doubt, in the radar's order of columns.
    fn run(&self, radar: &Radar, ends: &TwoEnds) -> Result<(Decades, Option<RangeAngleMap>), ReconstructError> {
        let input = self.extractor(radar)?.extract(ends)?;
        // A panic of another thread does no harm: every pass overwrites the buffers.
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut scratch = taken.unwrap_or_default();
        let mut decades = self.engine.forward(&input, &mut scratch);
        let mut doubt = self.engine.doubt(&scratch);
        reverse_columns(radar, &mut decades.map);
        if let Some(cells) = doubt.as_mut().and_then(|doubt| doubt.lambda.as_slice_mut()) {
            reverse_columns(radar, cells);
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

/// Range of signal-to-noise ratios of the training scenes with thermal noise, a third of all (`--snr` of `training/train_live.py`).
const TRAINED_SNR: [Decibels; 2] = [Decibels(10.0), Decibels(60.0)];

/// Every cell of this number is used for the median.
const MEDIAN_CELL_STEP: usize = 17;

/// A level that no noise cell exceeds, decades of the network's map. It is above the median cell, which is the mean of noise by the network where most
/// cells are noise. Over the rounding floor it is far below every echo.
fn noise_level_decades(map: &[f32]) -> f64 {
    let mut cells: Vec<f32> = map.iter().copied().step_by(MEDIAN_CELL_STEP).collect();
    if cells.is_empty() {
        return f64::NEG_INFINITY;
    }
    let half = cells.len() / 2;
    let median = *cells.select_nth_unstable_by(half, f32::total_cmp).1;
    f64::from(median) + level_above_mean_decades(map.len())
}

/// The `doubt` of Lambda normalised from the smallest to the largest cell, converted to `scale`.
fn doubt_on_scale(mut doubt: RangeAngleMap, [minimum, peak]: [f32; 2], scale: LambdaScale) -> RangeAngleMap {
    let factor = (f64::from(peak - minimum) / (scale.peak - scale.floor)) as f32;
    if factor != 1.0 && factor.is_finite() {
        doubt.lambda.par_mapv_inplace(|v| (v * factor).min(1.0));
    }
    doubt
}

impl Reconstructor for LiveMethod {
    fn family(&self) -> Family {
        Family::Network
    }

    fn info(&self) -> MethodInfo {
        let is_shipped = self.name == NAME;
        MethodInfo {
            name: self.name,
            description: if is_shipped { DESCRIPTION } else { "the live network with weights from a file" },
            prior_knowledge: if is_shipped {
                TRAINED_ON
            } else {
                "what its weights were trained on, which their file says"
            },
            eta: self.eta,
        }
    }

    fn reads_eta(&self) -> bool {
        true
    }

    fn weights(&self, radar: &Radar) -> Option<Weights> {
        Some(self.network_for(radar).weights.clone())
    }

    fn trained_noise(&self) -> Option<TrainedNoise> {
        Some(TrainedNoise::RoundingAndSnr(TRAINED_SNR[0], TRAINED_SNR[1]))
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        self.network_for(radar).trained.check(self.name, radar)
    }

    fn knows_pairs(&self) -> bool {
        std::iter::once(self).chain(&self.other_radars).any(|network| network.trained.is_of_pairs())
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let (Decades { mut map, minimum, .. }, doubt) = self.network_for(radar).run(radar, ends)?;
        let peak = map.par_iter().copied().reduce(|| f32::NEG_INFINITY, f32::max);
        let scale = LambdaScale::new(minimum.into(), peak.into(), request.normalisation);
        let least_eta = scale.lambda(noise_level_decades(&map)) as f32;
        let doubt = doubt.map(|doubt| doubt_on_scale(doubt, [minimum, peak], scale));
        map.par_chunks_mut(radar.elements).for_each(|line| each(line, |v| scale.lambda(v.into()) as f32));
        let lambda = Array2::from_shape_vec((radar.samples, radar.elements), map)
            .map_err(|e| ReconstructError::Unusable { method: self.name, reason: e.to_string() })?;
        let lambda = RangeAngleMap { lambda };
        let (eta, least_eta) = (Some(own_threshold(&lambda, doubt.as_ref())), Some(least_eta));
        Ok(Reconstruction { eta, least_eta, doubt, ..Reconstruction::of_map(lambda) })
    }
}
