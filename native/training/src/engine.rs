//! What computes a training step: the engines of burn that this program was built with.

use burn::tensor::Device;
#[cfg(feature = "wgpu")]
use burn::tensor::{DeviceKind, DeviceType};
use thiserror::Error;

/// An engine. Flex is always there; each other one is a feature of this crate.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Engine {
    /// burn-flex, on the processor.
    #[default]
    Flex,
    /// burn-ndarray, on the processor; deprecated by its makers.
    NdArray,
    /// burn-wgpu, on a GPU through Vulkan, Metal or Direct3D 12.
    Wgpu,
    /// burn-cuda, on an NVIDIA GPU.
    Cuda,
}

/// Why an engine cannot be used.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum EngineError {
    /// The program was built without it.
    #[error("this program was built without the engine {name}; build it with --features {name}")]
    NotBuilt {
        /// The feature.
        name: &'static str,
    },
    /// It has no device here.
    #[error("there is no device for the engine {name}: neither a GPU nor a driver in software")]
    NoDevice {
        /// The engine.
        name: &'static str,
    },
}

impl Engine {
    /// Opens the engine's device.
    ///
    /// # Errors
    /// [`EngineError`].
    pub fn open(self) -> Result<Device, EngineError> {
        match self {
            Self::Flex => Ok(Device::flex()),
            #[cfg(feature = "ndarray")]
            #[expect(
                deprecated,
                reason = "burn-ndarray's makers have deprecated it for burn-flex"
            )]
            Self::NdArray => Ok(Device::ndarray()),
            #[cfg(not(feature = "ndarray"))]
            Self::NdArray => Err(EngineError::NotBuilt { name: "ndarray" }),
            #[cfg(feature = "wgpu")]
            Self::Wgpu => wgpu(),
            #[cfg(not(feature = "wgpu"))]
            Self::Wgpu => Err(EngineError::NotBuilt { name: "wgpu" }),
            #[cfg(feature = "cuda")]
            Self::Cuda => Ok(Device::cuda(0)),
            #[cfg(not(feature = "cuda"))]
            Self::Cuda => Err(EngineError::NotBuilt { name: "cuda" }),
        }
    }
}

/// The GPU that wgpu prefers; without one a software driver, if there is any.
#[cfg(feature = "wgpu")]
fn wgpu() -> Result<Device, EngineError> {
    if Device::enumerate(DeviceType::Wgpu).is_empty() {
        return Err(EngineError::NoDevice { name: "wgpu" });
    }
    Ok(Device::wgpu(DeviceKind::DefaultDevice))
}

/// What a device is called by its driver, if it has one: a software driver says so.
#[cfg(any(feature = "wgpu", feature = "cuda"))]
pub fn name_of(device: &Device) -> Option<String> {
    device.identity().map(|identity| identity.name)
}

/// What a device is called by its driver, if it has one.
#[cfg(not(any(feature = "wgpu", feature = "cuda")))]
pub fn name_of(_: &Device) -> Option<String> {
    None
}
