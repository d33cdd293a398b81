//! The thesis' networks as reconstruction methods.

use super::backend::Backend;
use super::domain::Domain;
use super::thesis::{Thesis, ThesisConfig};
use super::thesis_engine::{Buffers, ThesisEngine};
use super::trainable_network::TrainableNetwork;
use super::unet::{Unet, UnetConfig};
use super::weights::{WeightFile, WeightsError};
use crate::maps::RangeAngleMap;
use crate::maps::cartesian::to_polar;
use crate::radar::Radar;
use crate::reconstruct::{
    Family, MethodInfo, NEEDS_SAMPLES, ReconstructError, Reconstruction, Reconstructor, Request, TrainedNoise, Weights,
};
use crate::signal::TwoEnds;
use burn::tensor::Device;
use ndarray::{Array2, Array3};
use std::sync::{Mutex, PoisonError};

const THESIS_ETA: f32 = 0.7;

const TRAINED_ON: &str =
    "scenes drawn like the tables', with the radar of table 3.1, over the thesis' floor and never over thermal noise";

/// A network of the thesis with weights: the encoder-decoder, or the failing U-Net, whose Cartesian answer is resampled to range and angle.
///
/// The encoder-decoder's output is Lambda without a further normalisation, of which the thesis takes the squared error. Its threshold is one
/// for the output stretched to [0, 1], as the thesis' is.
#[derive(Debug)]
pub struct ThesisMethod {
    network: Network,
    /// Of the encoder-decoder; `None` for the U-Net.
    config: Option<ThesisConfig>,
    info: MethodInfo,
    weights: Weights,
    trained: Domain,
}

#[derive(Debug)]
enum Network {
    /// The engine without a framework, with idle buffers. A pass takes them out and holds no lock while it runs: another thread makes its own.
    Engine {
        engine: Box<ThesisEngine>,
        idle: Mutex<Option<Buffers>>,
    },
    Burn {
        network: Box<Thesis>,
        device: Device,
    },
    Unet {
        network: Box<Unet>,
        device: Device,
    },
}

impl Network {
    fn new(file: &WeightFile, config: &ThesisConfig, backend: Backend) -> Result<Self, WeightsError> {
        if backend == Backend::default() {
            let engine = Box::new(ThesisEngine::new(file, config)?);
            return Ok(Network::Engine { engine, idle: Mutex::default() });
        }
        let device = backend.device();
        Ok(Network::Burn { network: Box::new(Thesis::load(file, config, &device)?.folded()), device })
    }

    fn estimate(
        &self,
        method: &'static str,
        input: Vec<f32>,
        size: [usize; 2],
    ) -> Result<Array2<f32>, ReconstructError> {
        match self {
            Network::Engine { engine, idle } => {
                // A panic elsewhere can't spoil the buffers: every pass overwrites them.
                let idle = || idle.lock().unwrap_or_else(PoisonError::into_inner);
                let taken = idle().take();
                let mut buffers = taken.unwrap_or_default();
                let map = engine.forward(&input, size, &mut buffers);
                *idle() = Some(buffers);
                in_rows(method, size, map)
            }
            Network::Burn { network, device } => estimate(&**network, method, input, size, device),
            Network::Unet { network, device } => estimate(&**network, method, input, size, device),
        }
    }
}

impl ThesisMethod {
    /// The network with the weights of `file`, whose tensors decide its width and depth: computed by an engine of its own, or by burn where
    /// `backend` is not the default one.
    /// # Errors
    /// [`WeightsError`] when the file belongs to another network.
    pub fn new(
        name: &'static str,
        description: &'static str,
        file: WeightFile,
        backend: Backend,
    ) -> Result<Self, WeightsError> {
        let config = Thesis::config_of(&file)?;
        let eta = file.provenance.eta().unwrap_or(THESIS_ETA);
        Ok(ThesisMethod {
            network: Network::new(&file, &config, backend)?,
            config: Some(config),
            info: MethodInfo { name, description, prior_knowledge: TRAINED_ON, eta },
            weights: file.weights(),
            trained: file.provenance.domain(file.name())?,
        })
    }

    /// The U-Net of the shipped architecture with the weights of `file`, computed by `backend`.
    /// # Errors
    /// [`WeightsError`] when the file belongs to another network.
    pub fn unet(file: WeightFile, backend: Backend) -> Result<Self, WeightsError> {
        let device = backend.device();
        let mut network = Box::new(Unet::fresh(&UnetConfig::default(), &device));
        file.load_into(&mut *network, |_| false)?;
        let description = "the thesis' U-Net on thresholded Cartesian maps; bright cells are so rare that it learned to answer nothing";
        Ok(ThesisMethod {
            network: Network::Unet { network, device },
            config: None,
            info: MethodInfo { name: Unet::NAME, description, prior_knowledge: TRAINED_ON, eta: 0.5 },
            weights: file.weights(),
            trained: file.provenance.domain(file.name())?,
        })
    }

    /// The network's answer, with the threshold of its cells that equals the method's own after stretching to [0, 1].
    fn answer(&self, input: Vec<f32>, radar: &Radar) -> Result<Reconstruction, ReconstructError> {
        let map = self.network.estimate(self.name(), input, [radar.samples, radar.elements])?;
        let eta = Some(unstretched(&map, self.eta()));
        Ok(Reconstruction { eta, ..Reconstruction::of_map(Thesis::finish(map)) })
    }
}

impl Reconstructor for ThesisMethod {
    fn family(&self) -> Family {
        Family::Network
    }

    fn info(&self) -> MethodInfo {
        self.info
    }

    fn reads_eta(&self) -> bool {
        self.config.is_some()
    }

    fn weights(&self, _radar: &Radar) -> Option<Weights> {
        Some(self.weights.clone())
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        self.trained.check(self.name(), radar)
    }

    fn trained_noise(&self) -> Option<TrainedNoise> {
        Some(TrainedNoise::Rounding)
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, _: &Request) -> Result<Reconstruction, ReconstructError> {
        let Some(config) = &self.config else {
            let config = UnetConfig::default();
            let (rows, input) = (config.rows, Unet::input(&config, radar, ends)?);
            let cartesian = self.network.estimate(Unet::NAME, input, [rows, 2 * rows])?;
            return Ok(Reconstruction::of_map(RangeAngleMap { lambda: to_polar(radar, &cartesian) }));
        };
        self.answer(Thesis::input(config, radar, ends)?, radar)
    }

    fn reconstruct_mag_phase(&self, radar: &Radar, input: &Array3<f64>) -> Result<Reconstruction, ReconstructError> {
        let Some(config) = &self.config else { return Err(self.unusable(NEEDS_SAMPLES.to_owned())) };
        self.trained.check(self.name(), radar)?;
        let expected = vec![Thesis::CHANNELS, radar.samples, radar.elements];
        if input.shape() != expected {
            let what = "polar_partial_mag_phase";
            return Err(ReconstructError::Shape { what, found: input.shape().to_vec(), expected });
        }
        config.check(radar)?;
        self.answer(input.iter().map(|v| *v as f32).collect(), radar)
    }
}

fn estimate<S: TrainableNetwork>(
    network: &S,
    method: &'static str,
    input: Vec<f32>,
    size: [usize; 2],
    device: &Device,
) -> Result<Array2<f32>, ReconstructError> {
    let values = network.estimate(&[input], size, device).into_data().try_into_vec::<f32>();
    let unusable = |e| ReconstructError::Unusable { method, reason: format!("its output can't be read: {e:?}") };
    in_rows(method, size, values.map_err(unusable)?)
}

fn in_rows(
    method: &'static str,
    [rows, columns]: [usize; 2],
    values: Vec<f32>,
) -> Result<Array2<f32>, ReconstructError> {
    Array2::from_shape_vec((rows, columns), values)
        .map_err(|e| ReconstructError::Unusable { method, reason: e.to_string() })
}

/// The value of `map` that becomes `eta` where the map is stretched to [0, 1].
fn unstretched(map: &Array2<f32>, eta: f32) -> f32 {
    let (least, most) = map.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
    (least + eta * (most - least)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};
    use std::hint::black_box;
    use std::time::Instant;

    /// The median of eleven times of `work` after one that is not counted, milliseconds.
    fn milliseconds(mut work: impl FnMut()) -> f64 {
        work();
        let mut times = [(); 11].map(|()| {
            let start = Instant::now();
            work();
            1e3 * start.elapsed().as_secs_f64()
        });
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }

    #[test]
    #[ignore = "prints times for docs/speed.md; nothing else may run beside it"]
    fn times_beside_burn_and_live() {
        let radar = Radar::default();
        let scene = Scene::of_points((0..10).map(|i| (f64::from(i - 5), 5.0 + 3.0 * f64::from(i))));
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let bytes = include_bytes!("../../assets/weights/thesis.safetensors");
        let file = || WeightFile::parse("thesis", bytes).unwrap();
        let method = ThesisMethod::new("thesis", "", file(), Backend::default()).unwrap();
        let (config, device) = (method.config.unwrap(), Backend::default().device());
        let burn = Thesis::load(&file(), &config, &device).unwrap().folded();
        let input = Thesis::input(&config, &radar, &ends).unwrap();
        let size = [radar.samples, radar.elements];
        let live = crate::network::live().unwrap();
        let request = Request::default();
        println!("{}, milliseconds a map:", crate::signal::simd::Simd::chosen());
        let print = |what: &str, work: &mut dyn FnMut()| println!("{what}: {:.1}", milliseconds(work));
        print("burn's forward pass", &mut || {
            drop(black_box(burn.estimate(std::slice::from_ref(&input), size, &device).into_data()))
        });
        print("the engine's", &mut || drop(black_box(method.network.estimate("thesis", input.clone(), size).unwrap())));
        print("the network's input", &mut || drop(black_box(Thesis::input(&config, &radar, &ends).unwrap())));
        print("thesis", &mut || drop(black_box(method.estimate(&radar, &ends, &request).unwrap())));
        print("live", &mut || drop(black_box(live.estimate(&radar, &ends, &request).unwrap())));
        let full = ThesisConfig::default();
        let bytes = crate::network::thesis_engine::tests::random(full.filters, full.levels);
        let wide = ThesisEngine::new(&WeightFile::parse("random", &bytes).unwrap(), &full).unwrap();
        let mut buffers = Buffers::default();
        print("the engine's with 64 filters", &mut || drop(black_box(wide.forward(&input, size, &mut buffers))));
    }

    #[test]
    fn a_stretched_map_keeps_the_cells_over_its_threshold() {
        let map = Array2::from_shape_fn((16, 32), |(i, j)| 0.15 + 0.7 * ((i * 37 + j * 11) % 101) as f32 / 100.0);
        let stretched = Thesis::thresholded(map.clone());
        for eta in [0.1, 0.33, 0.701, 0.9] {
            let kept = Thesis::finish(map.clone()).above(unstretched(&map, eta));
            assert_eq!(kept, stretched.above(eta), "{eta}");
            assert!((1..map.len()).contains(&kept.count()));
        }
    }
}
