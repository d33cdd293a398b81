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

impl Backend {
    const NAMED: &[(&str, Backend)] = &[
        ("flex", Backend::Flex),
        #[cfg(feature = "backend-ndarray")]
        ("ndarray", Backend::NdArray),
        #[cfg(feature = "backend-wgpu")]
        ("wgpu", Backend::Wgpu),
    ];

    /// Names of this build's backends, separated by commas.
    pub fn names() -> String {
        Backend::NAMED.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    }

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
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Backend::NAMED.iter().find(|(known, _)| *known == name);
        let unknown = || format!("unknown backend \"{name}\"; this build has: {}", Backend::names());
        found.map(|(_, backend)| *backend).ok_or_else(unknown)
    }
}
