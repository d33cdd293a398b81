//! Echoes of many reflectors at every channel of both ends: sums of them, and their products with a residual.

use super::sensor::{Sensor, W, kept_apart};
use crate::scene::Reflector;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, Simd};
use crate::signal::split::{Factors, STRIDE, add_product, fill_factors};
use num_complex::Complex64;
use rayon::prelude::*;

/// Samples of both ends, neighbouring channels side by side: `[block of channels][sample]`, samples padded with zeros.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// One lane a channel.
    pub blocks: Vec<Vec<ComplexLanes<f64, W>>>,
}

/// Products of one echo and of its echo times time with a residual, channel by channel.
#[derive(Debug, Clone)]
pub struct Products {
    /// `sum w^2 conj(echo) residual`.
    pub zeroth: Vec<Complex64>,
    /// The same times `tau = (t - middle) / samples`.
    pub first: Vec<Complex64>,
}

/// What is left of samples without some echoes.
#[derive(Debug, Clone)]
pub struct Remainder {
    /// Samples less the echoes times their gains.
    pub residual: Samples,
    /// Energy of the windowed residual at each end.
    pub energy: [f64; 2],
    /// Products of every echo with the residual.
    pub products: Vec<Products>,
}

impl Samples {
    /// From samples laid out channel by channel.
    pub fn new(sensor: &Sensor, flat: &[Complex64]) -> Self {
        let padded = Factors::<f64, W>::new(sensor.samples).rows.len() * STRIDE;
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

    /// Laid out channel by channel again.
    pub fn flat(&self, sensor: &Sensor) -> Vec<Complex64> {
        let mut out = Vec::with_capacity(sensor.sample_count());
        for channel in 0..sensor.element_x.len() {
            let (block, lane) = (&self.blocks[channel / W], channel % W);
            out.extend(block[..sensor.samples].iter().map(|v| Complex64::new(v.re.0[lane], v.im.0[lane])));
        }
        out
    }
}

/// Fewest reflectors that are shared out among processors, block by block of channels; there are few blocks.
const LEAST_SHARED: usize = 12;

/// Parts that they are shared out in.
const SHARES: usize = 2;

/// `samples` less the echoes of `reflectors` times their gains at the first and at the last end, under the squared window `squared`;
/// with the products of all echoes with what is left where `products` is asked for.
pub fn remainder(
    sensor: &Sensor,
    squared: &[f64],
    samples: &Samples,
    reflectors: &[(Reflector, [Complex64; 2])],
    products: bool,
) -> Remainder {
    let shares = if reflectors.len() < LEAST_SHARED { 1 } else { SHARES };
    let share = reflectors.len().div_ceil(shares).max(1);
    let simd = Simd::chosen();
    let tasks = samples.blocks.len() * shares;
    let sums: Vec<Summed> = (0..tasks)
        .into_par_iter()
        .map(|task| {
            let reflectors = reflectors.chunks(share).nth(task % shares).unwrap_or_default();
            simd.run(Sum { sensor, first_channel: task / shares * W, reflectors })
        })
        .collect();
    let left: Vec<Left> = samples
        .blocks
        .iter()
        .zip(sums.chunks(shares))
        .map(|(samples, sums)| simd.run(Subtract { squared, samples, sums, weighted: products }))
        .collect();
    let mut energy = [0.0; 2];
    for channel in 0..sensor.element_x.len() {
        energy[channel / sensor.end_elements] += left[channel / W].energy.0[channel % W];
    }
    let products = if products { products_with(sensor, &sums, &left, shares) } else { Vec::new() };
    Remainder { residual: Samples { blocks: left.into_iter().map(|l| l.residual).collect() }, energy, products }
}

/// Products of every echo with what is left, from the echoes of each block of channels and share of the reflectors.
fn products_with(sensor: &Sensor, sums: &[Summed], left: &[Left], shares: usize) -> Vec<Products> {
    let parts: Vec<Vec<[ComplexLanes<f64, W>; 2]>> = (0..sums.len())
        .into_par_iter()
        .map(|task| {
            let (echoes, weighted) = (&sums[task].echoes, &left[task / shares].weighted);
            Simd::chosen().run(Multiply { samples: sensor.samples, echoes, weighted })
        })
        .collect();
    let channels = sensor.element_x.len();
    let of_echo = |share: usize, i: usize| {
        let part = |channel: usize, order: usize| {
            let v = &parts[channel / W * shares + share][i][order];
            Complex64::new(v.re.0[channel % W], v.im.0[channel % W])
        };
        let [zeroth, first] = [0, 1].map(|order| (0..channels).map(|channel| part(channel, order)).collect());
        Products { zeroth, first }
    };
    (0..shares).flat_map(|share| (0..sums[share].echoes.len()).map(move |i| of_echo(share, i))).collect()
}

/// Echoes taken off together: their phasors fit the first-level cache.
const TOGETHER: usize = 4;

/// Echoes of some reflectors at one block of channels.
struct Sum<'a> {
    sensor: &'a Sensor,
    first_channel: usize,
    reflectors: &'a [(Reflector, [Complex64; 2])],
}

struct Summed {
    /// Of each reflector, of gain 1.
    echoes: Vec<Factors<f64, W>>,
    /// Of all together, times minus their gains; empty where there are none.
    sum: Vec<ComplexLanes<f64, W>>,
}

impl Kernel for Sum<'_> {
    type Output = Summed;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Summed {
        let Sum { sensor, reflectors, .. } = self;
        let last = sensor.element_x.len() - 1;
        let channel = |lane: usize| (self.first_channel + lane).min(last);
        let element_x = Lanes(std::array::from_fn(|lane| sensor.element_x[channel(lane)]));
        let mut echoes = vec![Factors::<f64, W>::new(sensor.samples); reflectors.len()];
        let mut scaled = vec![Factors::<f64, W>::new(sensor.samples); TOGETHER];
        let len = if reflectors.is_empty() { 0 } else { scaled[0].rows.len() * STRIDE };
        let mut sum = vec![ComplexLanes::zero(); len];
        for (echoes, reflectors) in echoes.chunks_mut(TOGETHER).zip(reflectors.chunks(TOGETHER)) {
            for ((echo, scaled), (reflector, gains)) in echoes.iter_mut().zip(&mut scaled).zip(reflectors) {
                fill_factors::<f64, W, FMA>(&sensor.model, element_x, &kept_apart(sensor, reflector), echo);
                let gain = |lane: usize| match sensor.hears[channel(lane)] {
                    true => -gains[channel(lane) / sensor.end_elements],
                    false => Complex64::default(),
                };
                let gain = ComplexLanes {
                    re: Lanes(std::array::from_fn(|lane| gain(lane).re)),
                    im: Lanes(std::array::from_fn(|lane| gain(lane).im)),
                };
                scaled.columns = echo.columns;
                for (scaled, row) in scaled.rows.iter_mut().zip(&echo.rows) {
                    *scaled = row.times::<FMA>(gain);
                }
            }
            add_product::<f64, W, FMA>(&scaled[..reflectors.len()], &mut sum);
        }
        Summed { echoes, sum }
    }
}

/// All sums of one block of channels added to its samples.
struct Subtract<'a> {
    squared: &'a [f64],
    samples: &'a [ComplexLanes<f64, W>],
    sums: &'a [Summed],
    /// Whether the weighted residual is asked for.
    weighted: bool,
}

struct Left {
    residual: Vec<ComplexLanes<f64, W>>,
    /// The residual times the squared window; empty where it was not asked for.
    weighted: Vec<ComplexLanes<f64, W>>,
    energy: Lanes<f64, W>,
}

impl Kernel for Subtract<'_> {
    type Output = Left;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Left {
        let mut residual = self.samples.to_vec();
        for part in self.sums {
            for (left, echoes) in residual.iter_mut().zip(&part.sum) {
                *left = *left + *echoes;
            }
        }
        let mut energy = Lanes::splat(0.0);
        for (v, w) in residual.iter().zip(self.squared) {
            energy = energy + (v.re * v.re + v.im * v.im) * Lanes::splat(*w);
        }
        let mut weighted = Vec::new();
        if self.weighted {
            weighted = vec![ComplexLanes::zero(); residual.len()];
            for (weighted, (v, w)) in weighted.iter_mut().zip(residual.iter().zip(self.squared)) {
                *weighted = v.scaled(Lanes::splat(*w));
            }
        }
        Left { residual, weighted, energy }
    }
}

/// Some echoes of one block of channels times what is left there, plain and times time.
struct Multiply<'a> {
    samples: usize,
    echoes: &'a [Factors<f64, W>],
    weighted: &'a [ComplexLanes<f64, W>],
}

impl Kernel for Multiply<'_> {
    type Output = Vec<[ComplexLanes<f64, W>; 2]>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let samples = self.samples as f64;
        let middle = (samples - 1.0) / 2.0;
        let mut products = Vec::with_capacity(self.echoes.len());
        for f in self.echoes {
            let mut sums = [ComplexLanes::zero(); 2];
            for (a, (row, part)) in f.rows.iter().zip(self.weighted.chunks_exact(STRIDE)).enumerate() {
                let (mut plain, mut timed) = (ComplexLanes::zero(), ComplexLanes::zero());
                for (b, (column, v)) in f.columns.iter().zip(part).enumerate() {
                    let product = column.conj().times::<FMA>(*v);
                    plain = plain + product;
                    timed = timed + product.scaled(Lanes::splat(b as f64 / samples));
                }
                let start = ((a * STRIDE) as f64 - middle) / samples;
                let row = row.conj();
                sums[0] = sums[0].plus_product::<FMA>(row, plain);
                sums[1] = sums[1].plus_product::<FMA>(row, timed + plain.scaled(Lanes::splat(start)));
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
    fn many_reflectors_are_shared_out_and_leave_what_they_leave_a_few_at_a_time() {
        let radar = Radar::default();
        let sensor = Sensor::new(&radar);
        let squared: Vec<f64> = hann(radar.samples).iter().map(|w| w * w).collect();
        let noise: Vec<Complex64> = unit_noise(1, 0).take(sensor.sample_count()).collect();
        let samples = Samples::new(&sensor, &noise);
        let at = |i: usize| Reflector { x_metres: i as f64 - 9.0, y_metres: 4.0 + i as f64, reflectivity: 1.0 };
        let gain = |i: usize| Complex64::from_polar(30.0, i as f64);
        let reflectors: Vec<_> = (0..2 * LEAST_SHARED + 1).map(|i| (at(i), [gain(i), -gain(2 * i)])).collect();
        let together = remainder(&sensor, &squared, &samples, &reflectors, true);
        let mut left = samples;
        for few in reflectors.chunks(LEAST_SHARED - 1) {
            left = remainder(&sensor, &squared, &left, few, false).residual;
        }
        for (a, b) in together.residual.flat(&sensor).iter().zip(left.flat(&sensor)) {
            assert!((a - b).norm() < 1e-11, "{a} {b}");
        }
        // In the order of the reflectors, whoever computed them.
        for ((reflector, _), found) in reflectors.iter().zip(&together.products) {
            let alone = remainder(&sensor, &squared, &left, &[(*reflector, [Complex64::default(); 2])], true);
            for (a, b) in found.zeroth.iter().zip(&alone.products[0].zeroth) {
                assert!((a - b).norm() < 1e-11, "{a} {b}");
            }
        }
        assert_eq!(together.products.len(), reflectors.len());
    }
}
