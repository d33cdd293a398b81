//! Neural networks: the thesis' own encoder-decoder and its failing U-Net on burn, and the live network.

#[cfg(feature = "network")]
pub mod backend;
#[cfg(feature = "network")]
pub mod checkpoint;
pub mod domain;
pub mod floors;
pub mod kernels;
#[cfg(feature = "network")]
mod lesson;
pub mod live;
#[cfg(feature = "network")]
pub mod losses;
#[cfg(feature = "network")]
pub mod pytorch;
#[cfg(feature = "network")]
pub mod recipe;
#[cfg(feature = "network")]
pub mod run;
#[cfg(feature = "network")]
pub mod thesis;
#[cfg(feature = "network")]
pub mod thesis_engine;
#[cfg(feature = "network")]
pub mod thesis_method;
#[cfg(feature = "network")]
pub mod train;
#[cfg(feature = "network")]
pub mod trainable_network;
#[cfg(feature = "network")]
pub mod unet;
#[cfg(feature = "network")]
pub mod validation;
pub mod weights;

#[cfg(feature = "network")]
mod shipped;

#[cfg(feature = "network")]
pub use shipped::{from_file, shipped, shipped_on};

use crate::files::read_bounded;
use crate::platform;
#[cfg(not(feature = "network"))]
use crate::reconstruct::Reconstructor;
use live::LiveMethod;
use std::path::Path;
#[cfg(not(feature = "network"))]
use std::sync::{Arc, LazyLock};
use weights::{WeightFile, WeightsError};

/// Weight files of the live network, in the order of [`platform::live_weights`].
const LIVE_FILES: [&str; 3] = [
    "assets/weights/live.safetensors",
    "assets/weights/live-any.safetensors",
    "assets/weights/live-cascade.safetensors",
];

/// The live network with the weights that are part of the program: those for the radar of table 3.1, those for others of its shape, and those
/// for the cascade of 12 x 16 pairs. `None`, with a warning in the log, where the first can't be used.
pub fn live() -> Option<LiveMethod> {
    let of = |(name, bytes): (&str, std::borrow::Cow<[u8]>)| {
        usable(WeightFile::parse(name, &bytes).and_then(LiveMethod::new))
    };
    let mut files = LIVE_FILES.into_iter().zip(platform::live_weights()).map(of);
    let live = files.next()??;
    Some(live.with_other_radars(files.flatten().collect()))
}

/// Name of the live network with the weights of the file at `path`: "live-" and the file's name without its ending, at most 40 characters.
pub fn name_of_weights(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let plain: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect();
    let named = if plain.starts_with("live-") { plain } else { format!("live-{plain}") };
    named.chars().take(40).collect()
}

const MAX_LIVE_BYTES: u64 = 256 << 20;

/// The live network with the weights that the safetensors file at `path` holds, as a method called `name`.
/// # Errors
/// [`WeightsError`] when the file can't be read, is damaged, or belongs to another network.
pub fn live_from_file(path: &Path, name: &str) -> Result<LiveMethod, WeightsError> {
    let file = path.display().to_string();
    let bytes = read_bounded(path, MAX_LIVE_BYTES).map_err(|e| WeightsError(format!("{file}: {e}")))?;
    LiveMethod::named(WeightFile::parse(&file, &bytes)?, name)
}

/// The networks whose weights are part of the program: the live network alone, without the feature `network`.
#[cfg(not(feature = "network"))]
pub fn shipped() -> Vec<Arc<dyn Reconstructor>> {
    static SHIPPED: LazyLock<Vec<Arc<dyn Reconstructor>>> =
        LazyLock::new(|| live().into_iter().map(|live| Arc::new(live) as Arc<dyn Reconstructor>).collect());
    SHIPPED.clone()
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
