//! Neural networks on burn: the thesis' own encoder-decoder, its failing U-Net, and the live network.
//!
//! | file | what |
//! |---|---|
//! | [`live`] | the live network: features, burn module, an engine without a framework |
//! | [`thesis`], [`thesis_method`] | the thesis' encoder-decoder, and as a reconstruction method |
//! | [`unet`] | the thesis' failing U-Net |
//! | [`recipe`], [`losses`], [`students`], `lesson` | training: what, towards what, by whom, and from what |
//! | [`run`], [`train`], [`checkpoint`] | what a run is and what it was made of, how it goes, and going on with it |
//! | [`validation`] | what the trained network is worth, and its weight file |
//! | [`backend`] | which of burn's backends computes |
//! | [`weights`], [`pytorch`] | weight files: checking, loading, what they say about themselves |

pub mod backend;
pub mod checkpoint;
mod lesson;
pub mod live;
pub mod losses;
pub mod pytorch;
pub mod recipe;
pub mod run;
pub mod students;
pub mod thesis;
pub mod thesis_method;
pub mod train;
mod trained_for;
pub mod unet;
pub mod validation;
pub mod weights;

use crate::reconstruct::Reconstructor;
use backend::Backend;
use live::{Live, LiveMethod};
use pytorch::read_weights;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use students::Student;
use thesis::Thesis;
use thesis_method::{ThesisMethod, UnetMethod};
use unet::Unet;
use weights::{WeightFile, WeightsError};

static SHIPPED: LazyLock<Vec<Arc<dyn Reconstructor>>> = LazyLock::new(|| load_shipped(Backend::default()));

/// Weights of the live network.
const LIVE: &[u8] = include_bytes!("../../assets/weights/live.safetensors");
const LIVE_FILE: &str = "assets/weights/live.safetensors";

/// The live network whose weights are part of the program, by itself; `None`, with a warning in the log, where they can't be used.
pub fn live() -> Option<LiveMethod> {
    usable(WeightFile::parse(LIVE_FILE, LIVE).and_then(LiveMethod::new))
}

/// The networks whose weights are part of the program. One whose weights can't be used is left out, with a warning in the log.
pub fn shipped() -> Vec<Arc<dyn Reconstructor>> {
    SHIPPED.clone()
}

/// The same, with what burn computes of them computed by `backend`; `live` has an engine of its own.
pub fn shipped_on(backend: Backend) -> Vec<Arc<dyn Reconstructor>> {
    if backend == Backend::default() { shipped() } else { load_shipped(backend) }
}

fn load_shipped(backend: Backend) -> Vec<Arc<dyn Reconstructor>> {
    let unet: &[u8] = include_bytes!("../../assets/weights/unet.safetensors");
    let thesis: &[u8] = include_bytes!("../../assets/weights/thesis.safetensors");
    let thesis_1: &[u8] = include_bytes!("../../assets/weights/thesis-1.safetensors");
    [
        (LIVE_FILE, LIVE),
        ("assets/weights/thesis.safetensors", thesis),
        ("assets/weights/thesis-1.safetensors", thesis_1),
        ("assets/weights/unet.safetensors", unet),
    ]
    .into_iter()
    .filter_map(|(name, bytes)| usable(WeightFile::parse(name, bytes).and_then(|file| method_of(file, backend))))
    .collect()
}

/// The network whose weights the file at `path` holds: safetensors, or a PyTorch checkpoint of the thesis' or the live network.
///
/// # Errors
/// [`WeightsError`] when the file can't be read, is damaged, or belongs to no network of ours.
pub fn from_file(path: &Path, backend: Backend) -> Result<Arc<dyn Reconstructor>, WeightsError> {
    let bytes = read_weights(path)?;
    method_of(WeightFile::parse(&path.display().to_string(), &bytes)?, backend)
}

fn method_of(file: WeightFile, backend: Backend) -> Result<Arc<dyn Reconstructor>, WeightsError> {
    // PyTorch's own files name no network; their tensors do.
    let network = match file.network() {
        "" if Thesis::config_of(&file).is_ok() => Thesis::NAME,
        "" if Live::is_in(&file) => Live::NAME,
        named => named,
    };
    Ok(match network {
        Live::NAME => Arc::new(LiveMethod::new(file)?),
        Unet::NAME => Arc::new(UnetMethod::new(file, backend)?),
        Thesis::NAME => {
            let (name, description) = match file.provenance.get("recipe") {
                "experiment-1-small" => {
                    ("thesis-1", "the thesis' network at a quarter of its width, trained on points")
                }
                "experiment-2-small" => {
                    ("thesis", "the thesis' network at a quarter of its width, trained on points and lines")
                }
                _ => ("thesis", "the thesis' network with weights from a file"),
            };
            Arc::new(ThesisMethod::new(name, description, file, backend)?)
        }
        _ => return Err(file.foreign("live, thesis or unet")),
    })
}

fn usable<M>(method: Result<M, WeightsError>) -> Option<M> {
    match method {
        Ok(method) => Some(method),
        Err(error) => {
            tracing::warn!("a network is missing: {error}");
            None
        }
    }
}
