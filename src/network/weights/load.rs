//! Loading of weights into a module of burn.

use super::{WeightFile, WeightsError};
use burn::module::Module;
use burn::store::{BurnToPyTorchAdapter, ModuleSnapshot, PyTorchToBurnAdapter, SafetensorsStore};
use std::collections::BTreeMap;

impl WeightFile<'_> {
    /// Loads the weights, under PyTorch's names, into `module`. Buffers that `ignored` accepts may lie in the file unused.
    /// # Errors
    /// [`WeightsError`] names the first tensor that is missing, unknown, of another shape or type, or not finite.
    pub fn load_into<M: Module>(&self, module: &mut M, ignored: fn(&str) -> bool) -> Result<(), WeightsError> {
        let wanted: BTreeMap<String, Vec<usize>> = module
            .collect(None, Some(Box::new(BurnToPyTorchAdapter)), false)
            .into_iter()
            .map(|t| (t.name.clone(), t.shape.to_vec()))
            .collect();
        for (name, shape) in &wanted {
            self.tensor(name, shape)?;
        }
        self.expect_only(|name| wanted.contains_key(name) || ignored(name))?;
        let mut store =
            SafetensorsStore::from_bytes(Some(self.in_single_precision()?)).with_from_adapter(PyTorchToBurnAdapter);
        let store_error = |reason: String| WeightsError(format!("{}: {reason}", self.name));
        let result = module.load_from(&mut store).map_err(|e| store_error(e.to_string()))?;
        if !result.missing.is_empty() || !result.errors.is_empty() {
            return Err(store_error(format!("missing {:?}, errors {:?}", result.missing, result.errors)));
        }
        Ok(())
    }
}
