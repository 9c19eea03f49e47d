//! The optimizer of a run, whose state is loaded onto the device that trains.

use burn::grad_clipping::GradientClippingConfig;
use burn::module::ParamGroup;
use burn::optim::{
    AdamW, AdamWConfig, DynOptimizer, DynState, LearningRate, ModuleOptimizer, StateSink,
    StateSource,
};
use burn::tensor::Device;
use burn::tensor::kind::BridgeTensor;

/// The optimizer for a network that trains on a device, which is not yet the one with gradients.
pub fn optimizer(device: &Device) -> ModuleOptimizer {
    let config = AdamWConfig::new().with_weight_decay(1e-2);
    let here = Here {
        adamw: config.build(),
        device: device.clone(),
    };
    let clipping = GradientClippingConfig::Norm(1.0).init();
    // The group that was added last is asked.
    config
        .init()
        .with_group(ParamGroup::all(), here, Some(clipping))
}

/// An optimizer of one device.
///
/// burn loads the state of a checkpoint onto its default device, which in a program with a GPU's
/// engine is the GPU: the first step would move it from there, but a run on the processor must not
/// open a GPU, and ends where there is none.
struct Here {
    adamw: AdamW,
    device: Device,
}

impl DynOptimizer for Here {
    fn step_dyn(
        &self,
        rank: usize,
        rate: LearningRate,
        parameter: BridgeTensor,
        gradient: BridgeTensor,
        state: Option<DynState>,
    ) -> (BridgeTensor, Option<DynState>) {
        self.adamw.step_dyn(rank, rate, parameter, gradient, state)
    }

    fn to_device_dyn(&self, state: DynState, device: &Device) -> DynState {
        self.adamw.to_device_dyn(state, device)
    }

    fn state_flatten(&self, prefix: &str, state: &DynState, sink: &mut StateSink) {
        self.adamw.state_flatten(prefix, state, sink);
    }

    fn state_unflatten(
        &self,
        rank: usize,
        prefix: &str,
        source: &mut StateSource,
        _: &Device,
    ) -> Option<DynState> {
        self.adamw
            .state_unflatten(rank, prefix, source, &self.device)
    }
}

#[cfg(all(test, feature = "ndarray"))]
mod tests {
    use std::collections::BTreeMap;

    use burn::optim::{AdamWState, AdaptiveMomentumState};
    use burn::tensor::Tensor;

    use super::*;
    use crate::engine::Engine;

    #[test]
    fn a_state_is_loaded_onto_the_device_that_trains() {
        let chosen = Engine::NdArray.open().unwrap();
        let here = Here {
            adamw: AdamWConfig::new().build(),
            device: chosen.clone(),
        };
        let moment = || Tensor::<1>::ones([2], &chosen);
        let momentum = AdaptiveMomentumState::new(3, moment(), moment());
        let state = DynState::create(AdamWState::new(momentum), 1);
        let mut sink = StateSink::default();
        here.state_flatten("p", &state, &mut sink);
        let mut source = StateSource::new(BTreeMap::from_iter(sink.scalars));
        for (name, data) in sink.tensors {
            source.insert_tensor(name, data);
        }
        let other = Engine::Flex.open().unwrap();
        let loaded = here.state_unflatten(1, "p", &mut source, &other).unwrap();
        let loaded = loaded.downcast::<AdamWState<1>>().momentum;
        assert_eq!(loaded.moment_1.device(), chosen);
        assert_eq!(loaded.moment_2.device(), chosen);
    }
}
