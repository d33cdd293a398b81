//! The choice of burn's backend.

use burn::tensor::Device;
use std::str::FromStr;

/// A burn backend of this build.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Backend {
    /// burn-flex: pure Rust, all cores.
    #[default]
    Flex,
    /// burn-ndarray: older and slower, for comparison.
    #[cfg(feature = "backend-ndarray")]
    NdArray,
    /// burn-wgpu: a graphics card.
    #[cfg(feature = "backend-wgpu")]
    Wgpu,
}

/// A backend that this build doesn't have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown backend \"{0}\"; this build has: {names}", names = Backend::NAMES.join(", "))]
pub struct UnknownBackend(String);

impl Backend {
    /// Names of this build's backends.
    pub const NAMES: &[&str] = &[
        "flex",
        #[cfg(feature = "backend-ndarray")]
        "ndarray",
        #[cfg(feature = "backend-wgpu")]
        "wgpu",
    ];

    /// The backend's device.
    #[cfg_attr(feature = "backend-ndarray", expect(deprecated, reason = "burn's past backend stays for comparison"))]
    pub fn device(self) -> Device {
        match self {
            Backend::Flex => Device::flex(),
            #[cfg(feature = "backend-ndarray")]
            Backend::NdArray => Device::ndarray(),
            #[cfg(feature = "backend-wgpu")]
            Backend::Wgpu => Device::wgpu(burn::tensor::DeviceKind::default()),
        }
    }
}

impl FromStr for Backend {
    type Err = UnknownBackend;

    fn from_str(s: &str) -> Result<Self, UnknownBackend> {
        match s {
            "flex" => Ok(Backend::Flex),
            #[cfg(feature = "backend-ndarray")]
            "ndarray" => Ok(Backend::NdArray),
            #[cfg(feature = "backend-wgpu")]
            "wgpu" => Ok(Backend::Wgpu),
            _ => Err(UnknownBackend(s.to_owned())),
        }
    }
}
