//! The thesis network's forward pass without a framework: channels-last, buffers kept, with the weights of [`super::thesis`]; tests compare both.

mod layers;
mod pictures;
mod towers;
mod upward;

use super::kernels::convolution::padded;
use super::thesis::{Thesis, ThesisConfig};
use super::weights::{WeightFile, WeightsError};
use layers::ThesisLayers;
use pictures::{Bordered, Parted};
use towers::CHANNELS;

const TOWERS: [(&str, usize); 2] = [("layer3x3", 3), ("layer5x5", 5)];

/// The thesis' network, packed for [`super::kernels`].
#[derive(Debug)]
pub struct ThesisEngine {
    towers: [Vec<towers::TowerLevel>; 2],
    upward: Vec<upward::UpwardLevel>,
    last: upward::Last,
    config: ThesisConfig,
}

/// Buffers of one forward pass; keep them between calls. For 16 filters they take some 45 MB, for 64 some 150 MB.
#[derive(Debug, Default)]
pub struct Buffers {
    input: Parted,
    /// Outputs of each level of a tower but the last; the second tower overwrites the first one's.
    down: Vec<Parted>,
    joined: Bordered,
    up: Vec<Bordered>,
    products: Bordered,
}

impl ThesisEngine {
    /// Packs the weights of `file`, ours or the author's `MultiFilter.state_dict()`, which must fit `config`.
    /// # Errors
    /// [`WeightsError`] names the first tensor that is missing, unknown, of another shape or type, or not finite.
    pub fn new(file: &WeightFile, config: &ThesisConfig) -> Result<Self, WeightsError> {
        let renamed = Thesis::in_our_names(file)?;
        let file = &WeightFile::parse(file.name(), &renamed)?;
        let layers = ThesisLayers { file };
        let ThesisConfig { filters, levels, .. } = *config;
        let [first, second] =
            TOWERS.map(|(name, size)| towers::TowerLevel::tower(layers, name, size, [filters, levels]));
        let end = levels.saturating_sub(1);
        let upward = (0..end).map(|level| upward::UpwardLevel::new(layers, level, [2 * filters; 2]));
        let engine = ThesisEngine {
            towers: [first?, second?],
            upward: upward.collect::<Result<_, _>>()?,
            last: upward::Last::new(layers, end, 2 * filters)?,
            config: *config,
        };
        file.expect_only(|name| engine.knows(name))?;
        Ok(engine)
    }

    fn knows(&self, name: &str) -> bool {
        let levels = || 0..self.config.levels;
        let mut stages = levels().flat_map(|level| {
            [format!("down.layer3x3.{level}."), format!("down.layer5x5.{level}."), format!("up.upconv.{level}.")]
        });
        let parts = ["conv.weight", "norm.weight", "norm.bias", "norm.running_mean", "norm.running_var"];
        Thesis::ignores(name) || stages.any(|stage| name.strip_prefix(&stage).is_some_and(|part| parts.contains(&part)))
    }

    /// Estimates Lambda of one scene, `[rows, columns]` row-major, from `input` `[4, rows, columns]`; both are multiples of `2^levels`.
    /// # Panics
    /// On an input of another shape.
    pub fn forward(&self, input: &[f32], [rows, columns]: [usize; 2], buffers: &mut Buffers) -> Vec<f32> {
        let least = 1 << self.config.levels;
        assert!(rows.is_multiple_of(least) && columns.is_multiple_of(least), "{rows} x {columns} cells");
        assert_eq!(input.len(), CHANNELS * rows * columns, "an input of another size");
        let Buffers { input: first, down, joined, up, products } = buffers;
        first.reset(rows, columns, CHANNELS);
        first.fill(|y, line, _| {
            let channels: [&[f32]; CHANNELS] = std::array::from_fn(|c| &input[(c * rows + y) * columns..][..columns]);
            for x in 0..columns {
                line.cell(x).copy_from_slice(&channels.map(|channel| channel[x]));
            }
        });
        joined.reset(rows / least, columns / least, padded(2 * self.config.filters));
        down.resize_with(self.config.levels.saturating_sub(1), Parted::default);
        for (tower, stages) in self.towers.iter().enumerate() {
            let mut from = &*first;
            for (stage, to) in stages.iter().zip(&mut *down) {
                stage.forward(from, to);
                from = to;
            }
            if let Some(stage) = stages.last() {
                stage.join(from, joined, tower * self.config.filters);
            }
        }
        up.resize_with(self.upward.len(), Bordered::default);
        let mut from = &*joined;
        let (before, earlier) = match self.upward.split_last() {
            Some((before, earlier)) => (Some(before), earlier),
            None => (None, [].as_slice()),
        };
        for (stage, to) in earlier.iter().zip(up) {
            stage.forward(from, to);
            from = to;
        }
        self.last.multiply(before, from, products);
        self.last.add_up(products)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::network::kernels::convolution::tests::numbers;
    use crate::network::trainable_network::TrainableNetwork;
    use burn::store::{BurnToPyTorchAdapter, ModuleSnapshot, SafetensorsStore};
    use burn::tensor::{Device, Tensor, TensorData};

    const REFERENCE_WEIGHTS: &[u8] = include_bytes!("../../../tests/data/thesis_reference_weights.safetensors");
    const SHIPPED: [&[u8]; 2] = [
        include_bytes!("../../../assets/weights/thesis.safetensors"),
        include_bytes!("../../../assets/weights/thesis-1.safetensors"),
    ];

    /// A weight file of a network with random weights and random statistics of its batch norms, whose output is well above zero.
    pub(in crate::network) fn random(filters: usize, levels: usize) -> Vec<u8> {
        let device = Device::flex();
        device.seed(1);
        let network = Thesis::fresh(&ThesisConfig { filters, levels, alive_output: true }, &device);
        let mut store = SafetensorsStore::from_bytes(None).with_to_adapter(BurnToPyTorchAdapter);
        network.save_into(&mut store).unwrap();
        let mut bytes = store.get_bytes().unwrap();
        let header = 8 + u64::from_le_bytes(*bytes.first_chunk().unwrap()) as usize;
        let parsed: serde_json::Value = serde_json::from_slice(&bytes[8..header]).unwrap();
        for (name, tensor) in parsed.as_object().unwrap() {
            let least = if name.ends_with("running_var") { 0.5 } else { -0.25 };
            if name.contains("norm.running") {
                let [from, to] = [0, 1].map(|i| header + tensor["data_offsets"][i].as_u64().unwrap() as usize);
                for (value, new) in bytes[from..to].chunks_exact_mut(4).zip(numbers(to - from, 7)) {
                    value.copy_from_slice(&(least + 0.25 * (1.0 + new)).to_le_bytes());
                }
            }
        }
        bytes
    }

    fn difference(bytes: &[u8], size: [usize; 2], buffers: &mut Buffers) -> (f32, Vec<f32>) {
        let [rows, columns] = size;
        let input = numbers(4 * rows * columns, 3);
        let file = WeightFile::parse("test", bytes).unwrap();
        let config = Thesis::config_of(&file).unwrap();
        let found = ThesisEngine::new(&file, &config).unwrap().forward(&input, size, buffers);
        let device = Device::flex();
        let input = Tensor::<4>::from_data(TensorData::new(input, vec![1, 4, rows, columns]), &device);
        let network = Thesis::load(&file, &config, &device).unwrap();
        let expected = network.answer(input).into_data().try_into_vec::<f32>().unwrap();
        assert_eq!(found.len(), expected.len());
        (found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max), expected)
    }

    #[test]
    fn every_width_and_depth_agrees_with_burn() {
        // All scenes share the buffers: results of an earlier pass must not show. Some maps are smaller than the margins.
        let mut buffers = Buffers::default();
        for (filters, levels, size) in [
            (16, 5, [64, 96]),
            (3, 2, [20, 12]),
            (3, 2, [4, 4]),
            (1, 1, [6, 10]),
            (7, 3, [8, 8]),
            (17, 2, [12, 44]),
            (64, 2, [8, 36]),
            (3, 8, [256, 256]),
        ] {
            let (worst, expected) = difference(&random(filters, levels), size, &mut buffers);
            assert!(worst < 1e-4, "{filters} filters, {levels} levels, {size:?}: {worst}");
            let (least, most) = expected.iter().fold((f32::MAX, 0.0f32), |(a, b), v| (a.min(*v), b.max(*v)));
            let holds = most - least > 1e-2;
            assert!(holds, "{filters} filters, {levels} levels: the same value everywhere, {least} to {most}");
        }
    }

    #[test]
    fn the_authors_and_the_shipped_weights_agree_with_burn() {
        let mut buffers = Buffers::default();
        for (name, bytes) in [("author's", REFERENCE_WEIGHTS), ("thesis", SHIPPED[0]), ("thesis-1", SHIPPED[1])] {
            let (worst, expected) = difference(bytes, [96, 160], &mut buffers);
            assert!(worst < 1e-4, "{name}: {worst}");
            assert!(expected.iter().any(|v| *v > 0.1), "{name}: zeros would prove nothing");
        }
    }

    #[test]
    fn a_file_that_does_not_fit_is_refused_as_burn_refuses_it() {
        let good = WeightFile::parse("test", REFERENCE_WEIGHTS).unwrap();
        let config = Thesis::config_of(&good).unwrap();
        let rename = |from: &str, to: &str| good.renamed(|n| if n == from { to.into() } else { n.into() }).unwrap();
        let missing = rename("up.upconv.2.1.running_var", "up.upconv.2.1.running_variance");
        let unknown = rename("up.upconv.2.1.num_batches_tracked", "up.upconv.9.0.weight");
        for (bytes, config, expected) in [
            (REFERENCE_WEIGHTS, ThesisConfig { filters: 4, ..config }, "expected ["),
            (&missing, config, "\"up.upconv.2.norm.running_var\" is missing"),
            (&unknown, config, "\"up.upconv.9.conv.weight\" is not part of this network"),
        ] {
            let file = WeightFile::parse("test", bytes).unwrap();
            let ours = ThesisEngine::new(&file, &config).map(|_| ()).unwrap_err().to_string();
            let burns = Thesis::load(&file, &config, &Device::flex()).map(|_| ()).unwrap_err().to_string();
            assert!(ours.contains(expected), "{ours}");
            assert!(burns.contains(expected), "{burns}");
        }
    }
}
