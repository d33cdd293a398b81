//! The thesis' networks as reconstruction methods.

use super::backend::Backend;
use super::students::{Student, ThesisInput, UnetTables};
use super::thesis::{Thesis, ThesisConfig};
use super::trained_for::check_radar;
use super::unet::{Unet, UnetConfig};
use super::weights::{Provenance, WeightFile, WeightsError};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Reconstruction, Reconstructor, Request, check_ends, silence, unit_gain};
use crate::signal::TwoEnds;
use burn::tensor::Device;
use ndarray::{Array2, Array3};

/// The thesis' own threshold, for weights that name none.
const THESIS_ETA: f32 = 0.7;

/// The thesis' encoder-decoder with weights; its output is stretched to [0, 1] as the thesis does before it is thresholded.
#[derive(Debug)]
pub struct ThesisMethod {
    network: Thesis,
    config: ThesisConfig,
    device: Device,
    eta: f32,
    name: &'static str,
    description: &'static str,
    /// Where the weights come from.
    pub provenance: Provenance,
}

impl ThesisMethod {
    /// The network with the weights of `file`, whose tensors decide its width and depth, computed by `backend`.
    ///
    /// # Errors
    /// [`WeightsError`] when the file belongs to another network.
    pub fn new(
        name: &'static str,
        description: &'static str,
        file: WeightFile,
        backend: Backend,
    ) -> Result<Self, WeightsError> {
        let device = backend.device();
        let config = Thesis::config_of(&file)?;
        Ok(ThesisMethod {
            network: Thesis::load(&file, &config, &device)?.folded(),
            config,
            device,
            eta: file.provenance.eta().unwrap_or(THESIS_ETA),
            name,
            description,
            provenance: file.provenance,
        })
    }
}

impl Reconstructor for ThesisMethod {
    fn name(&self) -> &'static str {
        self.name
    }

    fn description(&self) -> &'static str {
        self.description
    }

    fn eta(&self) -> f32 {
        self.eta
    }

    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        check_radar(self.name, radar)?;
        check_ends(radar, ends)?;
        request.task.check()?;
        let Some((ends, _)) = unit_gain(ends) else { return Ok(silence(radar)) };
        let tables = Thesis::tables(&self.config, radar)?;
        let input = Thesis::input(&tables, &ends)?;
        let map = estimate(&self.network, self.name, input, [radar.samples, radar.elements], &self.device)?;
        Ok(Reconstruction { lambda: RangeAngleMap::stretched(map), reflectors: Vec::new() })
    }

    fn reconstruct_mag_phase(&self, radar: &Radar, input: &Array3<f64>) -> Result<RangeAngleMap, ReconstructError> {
        check_radar(self.name, radar)?;
        let size = [radar.samples, radar.elements];
        let expected = vec![4, size[0], size[1]];
        if input.shape() != expected {
            let what = "polar_partial_mag_phase";
            return Err(ReconstructError::Shape { what, found: input.shape().to_vec(), expected });
        }
        Thesis::tables(&self.config, radar)?;
        let input = ThesisInput { values: input.iter().map(|v| *v as f32).collect(), size };
        estimate(&self.network, self.name, input, size, &self.device).map(RangeAngleMap::stretched)
    }
}

/// The failing U-Net: its Cartesian answer, drawn back onto range and angle.
#[derive(Debug)]
pub struct UnetMethod {
    network: Unet,
    config: UnetConfig,
    device: Device,
    /// Where the weights come from.
    pub provenance: Provenance,
}

impl UnetMethod {
    /// The shipped architecture with the weights of `file`, computed by `backend`.
    ///
    /// # Errors
    /// [`WeightsError`] when the file belongs to another network.
    pub fn new(file: WeightFile, backend: Backend) -> Result<Self, WeightsError> {
        let device = backend.device();
        let config = UnetConfig::default();
        let mut network = Unet::new(&config, &device);
        file.load_into(&mut network, |_| false)?;
        Ok(UnetMethod { network, config, device, provenance: file.provenance })
    }
}

impl Reconstructor for UnetMethod {
    fn name(&self) -> &'static str {
        Unet::NAME
    }

    fn description(&self) -> &'static str {
        "the thesis' U-Net on thresholded Cartesian maps; bright cells are so rare that it learned to answer nothing"
    }

    fn eta(&self) -> f32 {
        0.5
    }

    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        check_radar(Unet::NAME, radar)?;
        check_ends(radar, ends)?;
        request.task.check()?;
        let Some((ends, _)) = unit_gain(ends) else { return Ok(silence(radar)) };
        let tables: UnetTables = Unet::tables(&self.config, radar)?;
        let rows = self.config.rows;
        let cartesian =
            estimate(&self.network, Unet::NAME, Unet::input(&tables, &ends)?, [rows, 2 * rows], &self.device)?;
        let pixel = radar.max_range_metres() / rows as f64;
        let lambda = Array2::from_shape_fn((radar.samples, radar.elements), |(bin, column)| {
            let range = radar.range_of_bin_metres(bin as f64);
            let cos = radar.cos_of_column(column as f64).clamp(-1.0, 1.0);
            let (x, y) = (range * cos, range * (1.0 - cos * cos).sqrt());
            let row = ((y / pixel) as usize).min(rows - 1);
            let column = (((x + radar.max_range_metres()) / pixel).max(0.0) as usize).min(2 * rows - 1);
            cartesian[[row, column]]
        });
        Ok(Reconstruction { lambda: RangeAngleMap { lambda }, reflectors: Vec::new() })
    }
}

/// One scene through a network, as an array.
fn estimate<S: Student>(
    network: &S,
    method: &'static str,
    input: S::Input,
    [rows, columns]: [usize; 2],
    device: &Device,
) -> Result<Array2<f32>, ReconstructError> {
    let unusable = |reason: String| ReconstructError::Unusable { method, reason };
    let values = network.estimate(&[input], device).into_data().try_into_vec::<f32>();
    let values = values.map_err(|e| unusable(format!("its output can't be read: {e:?}")))?;
    Array2::from_shape_vec((rows, columns), values).map_err(|e| unusable(e.to_string()))
}
