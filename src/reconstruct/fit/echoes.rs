//! The residual of samples without the echoes of many reflectors, and the products of the echoes with it.

use super::sensor::{Sensor, W, with_min_distance};
use crate::scene::Reflector;
use crate::signal::path::PairBlocks;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, Simd};
use crate::signal::split::{Product, ROW_SAMPLES, add_products, fill_factors, rows_of};
use num_complex::Complex64;
use rayon::prelude::*;

/// Samples of both ends: `[block of channels][sample]`, a channel in each lane. Samples are padded with zeros.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    pub blocks: Vec<Vec<ComplexLanes<f64, W>>>,
}

/// Inner products of one reflector's echo with a residual, one for each channel of both ends.
#[derive(Debug, Clone)]
pub struct Products {
    /// `sum w^2 conj(echo) residual` over the samples, for the window `w`.
    pub zeroth: Vec<Complex64>,
    /// The same sum with a factor `tau = (t - middle) / samples`.
    pub first: Vec<Complex64>,
}

/// Samples without some echoes.
#[derive(Debug, Clone)]
pub struct Remainder {
    /// Samples minus the echoes times their gains, not windowed.
    pub residual: Samples,
    /// Energy of the windowed residual at each end.
    pub energy: [f64; 2],
    /// Products of each echo with the residual, as requested.
    pub products: Vec<Products>,
}

impl Samples {
    /// From samples channel by channel, `[channels * samples]`.
    pub fn new(sensor: &Sensor, flat: &[Complex64]) -> Self {
        let padded = rows_of(sensor.samples) * ROW_SAMPLES;
        let channels: Vec<&[Complex64]> = flat.chunks_exact(sensor.samples).collect();
        let block = |channels: &[&[Complex64]]| {
            let mut out = vec![ComplexLanes::zero(); padded];
            for (lane, channel) in channels.iter().enumerate() {
                for (out, v) in out.iter_mut().zip(*channel) {
                    (out.re.0[lane], out.im.0[lane]) = (v.re, v.im);
                }
            }
            out
        };
        Samples { blocks: channels.chunks(W).map(block).collect() }
    }

    /// The samples channel by channel, `[channels * samples]`.
    pub fn flat(&self, sensor: &Sensor) -> Vec<Complex64> {
        let mut out = Vec::with_capacity(sensor.sample_count());
        for channel in 0..sensor.element_x.len() {
            let (block, lane) = (&self.blocks[channel / W], channel % W);
            out.extend(block[..sensor.samples].iter().map(|v| Complex64::new(v.re.0[lane], v.im.0[lane])));
        }
        out
    }
}

/// Least number of reflectors that are split into two parts for processors. There are few blocks of channels, which are for processors too.
const MIN_SPLIT_REFLECTORS: usize = 12;

/// The products of echoes with a residual that are requested.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProductKind {
    None,
    /// [`Products::zeroth`].
    Values,
    /// Both.
    Slopes,
}

/// `samples` without the echoes of `reflectors`, each with its gains at the first and at the last end. Energy and products are under the window whose
/// squares are `squared`, `[samples]`.
pub fn remainder(
    sensor: &Sensor,
    squared: &[f64],
    samples: &Samples,
    reflectors: &[(Reflector, [Complex64; 2])],
    kind: ProductKind,
) -> Remainder {
    let simd = Simd::chosen();
    let parts = if reflectors.len() < MIN_SPLIT_REFLECTORS { 1 } else { 2 };
    let part_size = reflectors.len().div_ceil(parts).max(1);
    let sum = |block: usize, part_at: usize| {
        let start = (part_at == 0).then(|| &samples.blocks[block][..]);
        let reflectors = reflectors.chunks(part_size).nth(part_at).unwrap_or_default();
        simd.run(Sum { sensor, first_channel: block * W, reflectors, start, keeps_echoes: kind != ProductKind::None })
    };
    let subtract = |sums: &mut [BlockSum]| simd.run(Subtract { squared, sums, weighted: kind != ProductKind::None });
    let multiply = |summed: &BlockSum, residual: &BlockResidual| match kind {
        ProductKind::None => Vec::new(),
        _ => simd.run(Multiply { samples: sensor.samples, echoes: &summed.echoes, weighted: &residual.weighted, kind }),
    };
    let of_block = |block: usize| {
        let mut sums: Vec<BlockSum> = (0..parts).into_par_iter().map(|part_at| sum(block, part_at)).collect();
        let residual = subtract(&mut sums);
        let products: Vec<BlockProducts> =
            sums.par_iter().flat_map_iter(|summed| multiply(summed, &residual)).collect();
        (residual, products)
    };
    let (residuals, products): (Vec<BlockResidual>, Vec<Vec<BlockProducts>>) =
        (0..samples.blocks.len()).into_par_iter().map(of_block).unzip();
    let mut energy = [0.0; 2];
    for channel in 0..sensor.element_x.len() {
        energy[channel / sensor.end_elements] += residuals[channel / W].energy.0[channel % W];
    }
    let products = if kind == ProductKind::None { Vec::new() } else { channel_by_channel(sensor, &products) };
    Remainder {
        residual: Samples { blocks: residuals.into_iter().map(|block| block.residual).collect() },
        energy,
        products,
    }
}

/// Sum of the echoes of all `reflectors` of gain 1 at one block of channels, `[padded samples]`.
pub fn echo_of_all(sensor: &Sensor, reflectors: &[Reflector], block: usize) -> Vec<ComplexLanes<f64, W>> {
    let negative = [Complex64::from(-1.0); 2];
    let reflectors: Vec<(Reflector, [Complex64; 2])> = reflectors.iter().map(|r| (*r, negative)).collect();
    let first_channel = block * W;
    let sum = Sum { sensor, first_channel, reflectors: &reflectors, start: None, keeps_echoes: false };
    Simd::chosen().run(sum).sum
}

/// Products of each echo at all channels, from those of each block of channels, `[block][echo]`.
fn channel_by_channel(sensor: &Sensor, blocks: &[Vec<BlockProducts>]) -> Vec<Products> {
    let channels = sensor.element_x.len();
    let of_echo = |i: usize| {
        let part = |channel: usize, order: usize| {
            let v = &blocks[channel / W][i][order];
            Complex64::new(v.re.0[channel % W], v.im.0[channel % W])
        };
        let [zeroth, first] = [0, 1].map(|order| (0..channels).map(|channel| part(channel, order)).collect());
        Products { zeroth, first }
    };
    (0..blocks.first().map_or(0, Vec::len)).map(of_echo).collect()
}

/// Number of reflectors whose echoes are subtracted together: their phasors fit into the first-level cache.
const BATCH_REFLECTORS: usize = 4;

/// Kernel of the echoes of some reflectors at one block of channels.
struct Sum<'a> {
    sensor: &'a Sensor,
    first_channel: usize,
    reflectors: &'a [(Reflector, [Complex64; 2])],
    /// Initial value of the sum; 0 where there is none.
    start: Option<&'a [ComplexLanes<f64, W>]>,
    /// Whether the phasors of all echoes are part of the output.
    keeps_echoes: bool,
}

/// Factors of the echoes of some reflectors ([`Factors`](crate::signal::split::Factors)).
struct Phasors {
    /// `[reflector * rows + row]`.
    rows: Vec<ComplexLanes<f64, W>>,
    columns: Vec<[ComplexLanes<f64, W>; ROW_SAMPLES]>,
}

impl Phasors {
    #[inline(always)]
    fn zero(reflectors: usize, rows: usize) -> Self {
        let zero = ComplexLanes::zero();
        Phasors { rows: vec![zero; reflectors * rows], columns: vec![[zero; ROW_SAMPLES]; reflectors] }
    }
}

struct BlockSum {
    /// The echoes of gain 1: of all reflectors if they are requested, else of the last batch.
    echoes: Phasors,
    /// The initial value minus all echoes times their gains.
    sum: Vec<ComplexLanes<f64, W>>,
}

impl Kernel for Sum<'_> {
    type Output = BlockSum;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> BlockSum {
        let Sum { sensor, reflectors, keeps_echoes, .. } = self;
        let last = sensor.element_x.len() - 1;
        let channel = |lane: usize| (self.first_channel + lane).min(last);
        let pairs = PairBlocks::new(|lane| sensor.pairs[channel(lane)]);
        let many = rows_of(sensor.samples);
        let mut echoes =
            Phasors::zero(if keeps_echoes { reflectors.len() } else { reflectors.len().min(BATCH_REFLECTORS) }, many);
        let mut scaled = vec![ComplexLanes::zero(); BATCH_REFLECTORS * many];
        let mut sum = self.start.map_or_else(|| vec![ComplexLanes::zero(); many * ROW_SAMPLES], <[_]>::to_vec);
        // The gains of a fit begin at 0.
        let is_silent = reflectors.iter().all(|(_, gains)| *gains == [Complex64::default(); 2]);
        for (at, reflectors) in reflectors.chunks(BATCH_REFLECTORS).enumerate() {
            let first = if keeps_echoes { at * BATCH_REFLECTORS } else { 0 };
            let rows = &mut echoes.rows[first * many..(first + reflectors.len()) * many];
            let columns = &mut echoes.columns[first..first + reflectors.len()];
            let each = rows.chunks_exact_mut(many).zip(columns.iter_mut()).zip(scaled.chunks_exact_mut(many));
            for (((rows, columns), scaled), (reflector, gains)) in each.zip(reflectors) {
                fill_factors::<f64, W, FMA>(&sensor.model, pairs, &with_min_distance(sensor, reflector), rows, columns);
                let gain = |lane: usize| match sensor.has_samples[channel(lane)] {
                    true => -gains[channel(lane) / sensor.end_elements],
                    false => Complex64::default(),
                };
                let gain = ComplexLanes {
                    re: Lanes(std::array::from_fn(|lane| gain(lane).re)),
                    im: Lanes(std::array::from_fn(|lane| gain(lane).im)),
                };
                for (scaled, row) in scaled.iter_mut().zip(rows) {
                    *scaled = row.times::<FMA>(gain);
                }
            }
            if !is_silent {
                let products: [_; BATCH_REFLECTORS] = std::array::from_fn(|i| Product {
                    rows: &scaled[i * many..(i + 1) * many],
                    columns: &columns[i.min(columns.len() - 1)],
                });
                add_products::<f64, W, FMA>(&products[..columns.len()], &mut sum);
            }
        }
        BlockSum { echoes, sum }
    }
}

/// Kernel of the residual at one block of channels, from the sums of all parts of the reflectors.
struct Subtract<'a> {
    squared: &'a [f64],
    /// The first contains the samples; its sum is moved out.
    sums: &'a mut [BlockSum],
    weighted: bool,
}

struct BlockResidual {
    residual: Vec<ComplexLanes<f64, W>>,
    /// The residual times the squared window; empty unless requested.
    weighted: Vec<ComplexLanes<f64, W>>,
    energy: Lanes<f64, W>,
}

impl Kernel for Subtract<'_> {
    type Output = BlockResidual;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> BlockResidual {
        let mut residual = std::mem::take(&mut self.sums[0].sum);
        for part in &self.sums[1..] {
            for (v, echoes) in residual.iter_mut().zip(&part.sum) {
                *v = *v + *echoes;
            }
        }
        let mut energy = Lanes::splat(0.0);
        let mut weighted = vec![ComplexLanes::zero(); if self.weighted { residual.len() } else { 0 }];
        if self.weighted {
            for ((weighted, v), w) in weighted.iter_mut().zip(&residual).zip(self.squared) {
                *weighted = v.scaled(Lanes::splat(*w));
                energy = v.re.mul_add::<FMA>(weighted.re, v.im.mul_add::<FMA>(weighted.im, energy));
            }
        } else {
            for (v, w) in residual.iter().zip(self.squared) {
                energy = (v.re * v.re + v.im * v.im).mul_add::<FMA>(Lanes::splat(*w), energy);
            }
        }
        BlockResidual { residual, weighted, energy }
    }
}

/// [`Products`] at one block of channels: order 0, order 1.
type BlockProducts = [ComplexLanes<f64, W>; 2];

/// Kernel of the products of echoes with the weighted residual at one block of channels, `[echo]`.
struct Multiply<'a> {
    samples: usize,
    echoes: &'a Phasors,
    weighted: &'a [ComplexLanes<f64, W>],
    kind: ProductKind,
}

impl Kernel for Multiply<'_> {
    type Output = Vec<BlockProducts>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let samples = self.samples as f64;
        let middle = (samples - 1.0) / 2.0;
        let mut products = Vec::with_capacity(self.echoes.columns.len());
        let Phasors { rows, columns } = self.echoes;
        for (rows, columns) in rows.chunks_exact(rows_of(self.samples)).zip(columns) {
            let mut sums = [ComplexLanes::zero(); 2];
            for (a, (row, part)) in rows.iter().zip(self.weighted.chunks_exact(ROW_SAMPLES)).enumerate() {
                let row = row.conj();
                if self.kind == ProductKind::Values {
                    let mut plain = ComplexLanes::zero();
                    for (column, v) in columns.iter().zip(part) {
                        plain = plain.plus_product::<FMA>(column.conj(), *v);
                    }
                    sums[0] = sums[0].plus_product::<FMA>(row, plain);
                    continue;
                }
                let (mut plain, mut timed) = (ComplexLanes::zero(), ComplexLanes::zero());
                // The sum of b times the product of column b is the sum of all partial sums from column 1, 2, … on.
                for (column, v) in columns.iter().zip(part).skip(1).rev() {
                    plain = plain.plus_product::<FMA>(column.conj(), *v);
                    timed = timed + plain;
                }
                plain = plain.plus_product::<FMA>(columns[0].conj(), part[0]);
                let start = ((a * ROW_SAMPLES) as f64 - middle) / samples;
                sums[0] = sums[0].plus_product::<FMA>(row, plain);
                let timed = timed.scaled(Lanes::splat(samples.recip())) + plain.scaled(Lanes::splat(start));
                sums[1] = sums[1].plus_product::<FMA>(row, timed);
            }
            products.push(sums);
        }
        products
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Radar, hann};
    use crate::signal::floor::unit_noise;

    #[test]
    fn many_reflectors_together_leave_what_few_at_a_time_leave() {
        let radar = Radar::default();
        let sensor = Sensor::new(&radar);
        let squared: Vec<f64> = hann(radar.samples).iter().map(|w| w * w).collect();
        let noise: Vec<Complex64> = unit_noise(1, 0).take(sensor.sample_count()).collect();
        let samples = Samples::new(&sensor, &noise);
        let at = |i: usize| Reflector { x_metres: i as f64 - 9.0, y_metres: 4.0 + i as f64, reflectivity: 1.0 };
        let gain = |i: usize| Complex64::from_polar(30.0, i as f64);
        let reflectors: Vec<_> = (0..2 * MIN_SPLIT_REFLECTORS + 1).map(|i| (at(i), [gain(i), -gain(2 * i)])).collect();
        let together = remainder(&sensor, &squared, &samples, &reflectors, ProductKind::Slopes);
        let mut residual = samples;
        for few in reflectors.chunks(MIN_SPLIT_REFLECTORS - 1) {
            residual = remainder(&sensor, &squared, &residual, few, ProductKind::None).residual;
        }
        for (a, b) in together.residual.flat(&sensor).iter().zip(residual.flat(&sensor)) {
            assert!((a - b).norm() < 1e-11, "{a} {b}");
        }
        // In the order of the reflectors, whichever thread computed them.
        for ((reflector, _), found) in reflectors.iter().zip(&together.products) {
            let silent = [(*reflector, [Complex64::default(); 2])];
            let alone = remainder(&sensor, &squared, &residual, &silent, ProductKind::Slopes);
            for (a, b) in found.zeroth.iter().zip(&alone.products[0].zeroth) {
                assert!((a - b).norm() < 1e-11, "{a} {b}");
            }
        }
        assert_eq!(together.products.len(), reflectors.len());
    }
}
