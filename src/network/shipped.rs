//! The networks that come with the program, and those of weight files.

use super::backend::Backend;
use super::live::{self, LiveMethod};
use super::pytorch::read_weights;
use super::thesis::Thesis;
use super::thesis_method::ThesisMethod;
use super::trainable_network::TrainableNetwork;
use super::unet::Unet;
use super::usable;
use super::weights::{WeightFile, WeightsError};
use crate::reconstruct::Reconstructor;
use std::path::Path;
use std::sync::{Arc, LazyLock};

static SHIPPED: LazyLock<Vec<Arc<dyn Reconstructor>>> = LazyLock::new(|| load_shipped(Backend::default()));

/// The networks whose weights are part of the program. A network whose weights can't be used is left out, with a warning in the log.
pub fn shipped() -> Vec<Arc<dyn Reconstructor>> {
    SHIPPED.clone()
}

/// [`shipped`] with `backend` for the networks on burn; `live` has an engine of its own.
pub fn shipped_on(backend: Backend) -> Vec<Arc<dyn Reconstructor>> {
    if backend == Backend::default() { shipped() } else { load_shipped(backend) }
}

fn load_shipped(backend: Backend) -> Vec<Arc<dyn Reconstructor>> {
    let unet: &[u8] = include_bytes!("../../assets/weights/unet.safetensors");
    let thesis: &[u8] = include_bytes!("../../assets/weights/thesis.safetensors");
    let thesis_1: &[u8] = include_bytes!("../../assets/weights/thesis-1.safetensors");
    let live = super::live().map(|live| Arc::new(live) as Arc<dyn Reconstructor>);
    let others = [
        ("assets/weights/thesis.safetensors", thesis),
        ("assets/weights/thesis-1.safetensors", thesis_1),
        ("assets/weights/unet.safetensors", unet),
    ]
    .into_iter()
    .filter_map(|(name, bytes)| usable(WeightFile::parse(name, bytes).and_then(|file| method_of(file, backend))));
    live.into_iter().chain(others).collect()
}

/// The network with the weights of the file at `path`: safetensors, or a PyTorch checkpoint of the thesis' or the live network.
/// # Errors
/// [`WeightsError`] when the file can't be read, is damaged, or belongs to no network of ours.
pub fn from_file(path: &Path, backend: Backend) -> Result<Arc<dyn Reconstructor>, WeightsError> {
    let bytes = read_weights(path)?;
    method_of(WeightFile::parse(&path.display().to_string(), &bytes)?, backend)
}

fn method_of(file: WeightFile, backend: Backend) -> Result<Arc<dyn Reconstructor>, WeightsError> {
    // PyTorch's own files don't name their network; the tensors tell it.
    let network = match file.network() {
        "" if Thesis::config_of(&file).is_ok() => Thesis::NAME,
        "" if file.shape("row_kernel").is_some() => live::method::NAME,
        named => named,
    };
    Ok(match network {
        live::method::NAME => Arc::new(LiveMethod::new(file)?),
        Unet::NAME => Arc::new(ThesisMethod::unet(file, backend)?),
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
