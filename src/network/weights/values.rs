//! The values of tensors: 32-bit floats, or 16-bit ones, which take half the space.

use super::{TensorHeader, WeightFile, WeightsError};
use half::f16;

const SINGLE_NAME: &str = "F32";
/// safetensors' name of 16-bit floats. The shipped weights of `live` are of this type, so that a page loads faster.
const HALF_NAME: &str = "F16";

impl WeightFile<'_> {
    /// The values of one tensor.
    /// # Errors
    /// [`WeightsError`] when it is missing, of another shape or type, or not finite.
    pub fn tensor(&self, name: &str, shape: &[usize]) -> Result<Vec<f32>, WeightsError> {
        let bad = |problem: String| self.bad_tensor(name, problem);
        let found = self.tensors.get(name).ok_or_else(|| bad("is missing".into()))?;
        if found.shape != shape {
            return Err(bad(format!("has shape {:?}; expected {shape:?}", found.shape)));
        }
        let values = self.values(found).map_err(bad)?;
        match values.iter().position(|v| !v.is_finite()) {
            Some(i) => Err(bad(format!("is not finite at element {i}"))),
            None => Ok(values),
        }
    }

    /// Every value in the file, tensor by tensor in the order of their names; those of types that no network has are left out.
    pub fn all_values(&self) -> Vec<f32> {
        self.tensors.values().filter_map(|tensor| self.values(tensor).ok()).flatten().collect()
    }

    fn values(&self, tensor: &TensorHeader) -> Result<Vec<f32>, String> {
        let [start, end] = tensor.data_offsets;
        let bytes = self.data.get(start..end).ok_or("lies outside the file")?;
        let values: Vec<f32> = match tensor.dtype.as_str() {
            SINGLE_NAME => bytes.as_chunks().0.iter().map(|v| f32::from_le_bytes(*v)).collect(),
            HALF_NAME => bytes.as_chunks().0.iter().map(|v| f16::from_le_bytes(*v).to_f32()).collect(),
            other => return Err(format!("is of type {other}; expected {SINGLE_NAME} or {HALF_NAME}")),
        };
        match tensor.shape.iter().try_fold(1, |product: usize, n| product.checked_mul(*n)) {
            Some(count) if count == values.len() => Ok(values),
            _ => Err("lies outside the file".into()),
        }
    }

    /// The same file with 32-bit floats in place of 16-bit ones, for readers that need them; other types stay.
    /// # Errors
    /// [`WeightsError`] for a tensor that lies outside the file, [`WeightsError`] if the header can't be written.
    #[cfg(feature = "network")]
    pub(super) fn in_single_precision(&self) -> Result<Vec<u8>, WeightsError> {
        let mut data = Vec::new();
        let mut tensors = std::collections::BTreeMap::new();
        for (name, tensor) in &self.tensors {
            let bad = |problem: String| self.bad_tensor(name, problem);
            let (start, [from, to]) = (data.len(), tensor.data_offsets);
            let dtype = if tensor.dtype == HALF_NAME {
                data.extend(self.values(tensor).map_err(bad)?.iter().flat_map(|v| v.to_le_bytes()));
                SINGLE_NAME
            } else {
                data.extend(self.data.get(from..to).ok_or_else(|| bad("lies outside the file".into()))?);
                &tensor.dtype
            };
            let header = TensorHeader {
                dtype: dtype.to_owned(),
                shape: tensor.shape.clone(),
                data_offsets: [start, data.len()],
            };
            tensors.insert(name.clone(), header);
        }
        super::write(&self.name, &tensors, &self.provenance, &data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::weights::{Provenance, write};
    use std::collections::BTreeMap;

    const VALUES: [f32; 4] = [0.0, -1.5, 0.333_251_95, 65504.0];

    fn file(dtype: &str, data: &[u8]) -> Vec<u8> {
        let header = TensorHeader { dtype: dtype.into(), shape: vec![2, 2], data_offsets: [0, data.len()] };
        write("test", &BTreeMap::from([("w".to_owned(), header)]), &Provenance::default(), data).unwrap()
    }

    #[test]
    fn tensors_of_16_bit_floats_are_read_and_widened() {
        let data: Vec<u8> = VALUES.iter().flat_map(|v| f16::from_f32(*v).to_le_bytes()).collect();
        let bytes = file(HALF_NAME, &data);
        let read = WeightFile::parse("test", &bytes).unwrap();
        assert_eq!(read.tensor("w", &[2, 2]).unwrap(), VALUES);
        assert_eq!(read.all_values(), VALUES);
        #[cfg(feature = "network")]
        {
            let wide = read.in_single_precision().unwrap();
            let wide = WeightFile::parse("test", &wide).unwrap();
            assert_eq!(wide.tensors["w"].dtype, SINGLE_NAME);
            assert_eq!(wide.tensor("w", &[2, 2]).unwrap(), VALUES);
        }
    }

    #[test]
    fn a_tensor_of_another_type_is_named() {
        let bytes = file("I32", &[0; 16]);
        let told = WeightFile::parse("test", &bytes).unwrap().tensor("w", &[2, 2]).unwrap_err().to_string();
        assert!(told.contains("\"w\" is of type I32; expected F32 or F16"), "{told}");
    }
}
