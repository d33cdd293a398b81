//! Neural networks on burn: the thesis' own encoder-decoder, its failing U-Net, and the live network.
//!
//! | file | what |
//! |---|---|
//! | [`features`] | raw samples of the two ends to the live network's tensors |
//! | [`live`] | the live network as a burn module |
//! | [`engine`], [`kernel`], [`fastmath`] | the same without a framework, for speed |
//! | [`live_method`] | the live network as a reconstruction method |
//! | [`thesis`], [`thesis_method`] | the thesis' encoder-decoder, and as a reconstruction method |
//! | [`unet`] | the thesis' failing U-Net |
//! | [`recipe`], [`losses`], [`students`], [`train`] | training: what, towards what, from what, and how |
//! | [`backend`] | which of burn's backends computes |
//! | [`weights`] | weight files: checking, loading, what they say about themselves |

pub mod backend;
pub mod engine;
pub mod fastmath;
pub mod features;
pub mod kernel;
pub mod live;
pub mod live_method;
pub mod losses;
pub mod recipe;
pub mod students;
pub mod thesis;
pub mod thesis_method;
pub mod train;
pub mod unet;
pub mod weights;

use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Reconstructor};
use backend::Backend;
use live_method::LiveMethod;
use ndarray::{Array2, Array3};
use std::sync::{Arc, LazyLock};
use thesis_method::{ThesisMethod, UnetMethod};
use weights::WeightsError;

/// The networks whose weights are part of the program.
struct Shipped {
    live: Option<Arc<LiveMethod>>,
    thesis: Vec<Arc<ThesisMethod>>,
    unet: Option<Arc<UnetMethod>>,
}

static SHIPPED: LazyLock<Shipped> = LazyLock::new(|| Shipped {
    live: usable(LiveMethod::from_bytes(
        "assets/weights/live.safetensors",
        include_bytes!("../../assets/weights/live.safetensors"),
    )),
    thesis: Vec::new(),
    unet: usable(UnetMethod::from_bytes(
        "assets/weights/unet.safetensors",
        include_bytes!("../../assets/weights/unet.safetensors"),
        unet::UnetConfig::default(),
        Backend::default(),
    )),
});

/// The networks whose weights are part of the program. One whose weights can't be used is left out, with a warning in the log.
pub fn shipped() -> Vec<Arc<dyn Reconstructor>> {
    let Shipped { live, thesis, unet } = &*SHIPPED;
    let live = live.iter().cloned().map(|m| m as Arc<dyn Reconstructor>);
    let thesis = thesis.iter().cloned().map(|m| m as Arc<dyn Reconstructor>);
    let unet = unet.iter().cloned().map(|m| m as Arc<dyn Reconstructor>);
    live.chain(thesis).chain(unet).collect()
}

/// Estimates Lambda with the thesis network called `method` from its own input, `[4, range bins, columns]`.
///
/// # Errors
/// [`ReconstructError`] when there is no such network or the input has another shape.
pub fn from_mag_phase(method: &str, radar: &Radar, input: &Array3<f64>) -> Result<Array2<f32>, ReconstructError> {
    let Some(network) = SHIPPED.thesis.iter().find(|m| m.name() == method) else {
        let reason = format!(
            "polar_partial_mag_phase is the input of the thesis' networks; \"{method}\" needs sub0 and sub1 instead"
        );
        return Err(ReconstructError::Unusable { method: "reconstruct", reason });
    };
    network.from_mag_phase(radar, input).map(|map| map.lambda)
}

fn usable<M>(method: Result<M, WeightsError>) -> Option<Arc<M>> {
    match method {
        Ok(method) => Some(Arc::new(method)),
        Err(error) => {
            tracing::warn!("a network is missing: {error}");
            None
        }
    }
}
