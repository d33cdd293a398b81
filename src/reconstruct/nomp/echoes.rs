//! Echoes of many reflectors at every channel of both ends: sums of them, and their products with a residual.

use super::sensor::{NEAREST_METRES, Sensor, W};
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

/// A reflector as every channel hears it; all vectors have one entry a channel.
#[derive(Debug, Clone)]
pub struct Echo {
    /// Frequency in range bins, wrapped.
    pub bins: Vec<f64>,
    /// Value at the middle of the chirp.
    pub middle: Vec<Complex64>,
    /// Change of the distance by the reflector's x.
    pub by_x: Vec<f64>,
    /// Change of the distance by half the square of the reflector's y, per metre.
    pub by_half_square: Vec<f64>,
    /// Relative loss of amplitude by distance, per metre.
    pub decay: Vec<f64>,
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

/// `r` moved to where its distance from every element is a number that can be divided by.
fn kept_apart(sensor: &Sensor, r: &Reflector) -> Reflector {
    let nearest = sensor.element_x.iter().fold(f64::INFINITY, |m, x| m.min((x - r.x_metres).abs()));
    let y_metres = if nearest.hypot(r.y_metres) < NEAREST_METRES { NEAREST_METRES } else { r.y_metres };
    Reflector { y_metres, ..*r }
}

impl Echo {
    /// The echo of `r`.
    pub fn new(sensor: &Sensor, r: &Reflector) -> Self {
        let r = kept_apart(sensor, r);
        let (samples, count) = (sensor.samples as f64, sensor.element_x.len());
        let middle = (samples - 1.0) / 2.0;
        let mut echo = Echo {
            bins: Vec::with_capacity(count),
            middle: Vec::with_capacity(count),
            by_x: Vec::with_capacity(count),
            by_half_square: Vec::with_capacity(count),
            decay: Vec::with_capacity(count),
        };
        for (&x, &hears) in sensor.element_x.iter().zip(&sensor.hears) {
            let e = sensor.model.echo(x, &r);
            echo.bins.push(e.beat_turns * samples);
            let turns = e.carrier_turns + (e.beat_turns * middle).fract();
            let amplitude = if hears { e.amplitude } else { 0.0 };
            echo.middle.push(Complex64::from_polar(amplitude, std::f64::consts::TAU * turns));
            echo.by_x.push((r.x_metres - x) / e.distance_metres);
            echo.by_half_square.push(1.0 / e.distance_metres);
            echo.decay.push(2.0 / e.distance_metres);
        }
        echo
    }
}

/// `samples` less the echoes of `reflectors` times their gains at the first and at the last end, under the squared window `squared`;
/// with the products of all echoes with what is left where `products` is asked for.
pub fn remainder(
    sensor: &Sensor,
    squared: &[f64],
    samples: &Samples,
    reflectors: &[(Reflector, [Complex64; 2])],
    products: bool,
) -> Remainder {
    let parts: Vec<BlockRemainder> = samples
        .blocks
        .par_iter()
        .enumerate()
        .map(|(block, samples)| {
            Simd::chosen().run(Subtract { sensor, squared, samples, first_channel: block * W, reflectors, products })
        })
        .collect();
    let channels = sensor.element_x.len();
    let mut energy = [0.0; 2];
    let mut all = vec![Products { zeroth: Vec::new(), first: Vec::new() }; if products { reflectors.len() } else { 0 }];
    for channel in 0..channels {
        let (part, lane) = (&parts[channel / W], channel % W);
        energy[channel / sensor.end_elements] += part.energy.0[lane];
        for (all, [zeroth, first]) in all.iter_mut().zip(&part.products) {
            all.zeroth.push(Complex64::new(zeroth.re.0[lane], zeroth.im.0[lane]));
            all.first.push(Complex64::new(first.re.0[lane], first.im.0[lane]));
        }
    }
    let blocks = parts.into_iter().map(|p| p.residual).collect();
    Remainder { residual: Samples { blocks }, energy, products: all }
}

/// One block of channels.
struct Subtract<'a> {
    sensor: &'a Sensor,
    squared: &'a [f64],
    samples: &'a [ComplexLanes<f64, W>],
    first_channel: usize,
    reflectors: &'a [(Reflector, [Complex64; 2])],
    products: bool,
}

struct BlockRemainder {
    residual: Vec<ComplexLanes<f64, W>>,
    energy: Lanes<f64, W>,
    products: Vec<[ComplexLanes<f64, W>; 2]>,
}

/// Echoes taken off together: their phasors fit the first-level cache.
const TOGETHER: usize = 4;

impl Kernel for Subtract<'_> {
    type Output = BlockRemainder;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> BlockRemainder {
        let sensor = self.sensor;
        let last = sensor.element_x.len() - 1;
        let channel = |lane: usize| (self.first_channel + lane).min(last);
        let element_x = Lanes(std::array::from_fn(|lane| sensor.element_x[channel(lane)]));
        let mut residual = self.samples.to_vec();
        let mut factors = vec![Factors::<f64, W>::new(sensor.samples); self.reflectors.len()];
        for (factors, reflectors) in factors.chunks_mut(TOGETHER).zip(self.reflectors.chunks(TOGETHER)) {
            for (f, (reflector, gains)) in factors.iter_mut().zip(reflectors) {
                fill_factors::<f64, W, FMA>(&sensor.model, element_x, &kept_apart(sensor, reflector), f);
                let gain = |lane: usize| match sensor.hears[channel(lane)] {
                    true => -gains[channel(lane) / sensor.end_elements],
                    false => Complex64::default(),
                };
                let gain = ComplexLanes {
                    re: Lanes(std::array::from_fn(|lane| gain(lane).re)),
                    im: Lanes(std::array::from_fn(|lane| gain(lane).im)),
                };
                for row in &mut f.rows {
                    *row = row.times::<FMA>(gain);
                }
            }
            add_product::<f64, W, FMA>(factors, &mut residual);
        }
        let mut weighted = residual.clone();
        let mut energy = Lanes::splat(0.0);
        for (i, v) in weighted.iter_mut().enumerate() {
            let w = Lanes::splat(self.squared.get(i).copied().unwrap_or(0.0));
            energy = energy + (v.re * v.re + v.im * v.im) * w;
            *v = v.scaled(w);
        }
        let mut products = Vec::new();
        if self.products {
            let samples = sensor.samples as f64;
            let middle = (samples - 1.0) / 2.0;
            for (f, (reflector, _)) in factors.iter_mut().zip(self.reflectors) {
                fill_factors::<f64, W, FMA>(&sensor.model, element_x, &kept_apart(sensor, reflector), f);
                let mut sums = [ComplexLanes::zero(); 2];
                for (a, (row, part)) in f.rows.iter().zip(weighted.chunks_exact(STRIDE)).enumerate() {
                    let (mut plain, mut timed) = (ComplexLanes::zero(), ComplexLanes::zero());
                    for (b, (column, v)) in f.columns.iter().zip(part).enumerate() {
                        let product = conjugate(*column).times::<FMA>(*v);
                        plain = plain + product;
                        timed = timed + product.scaled(Lanes::splat(b as f64 / samples));
                    }
                    let start = ((a * STRIDE) as f64 - middle) / samples;
                    let row = conjugate(*row);
                    sums[0] = sums[0].plus_product::<FMA>(row, plain);
                    sums[1] = sums[1].plus_product::<FMA>(row, timed + plain.scaled(Lanes::splat(start)));
                }
                products.push(sums);
            }
        }
        BlockRemainder { residual, energy, products }
    }
}

#[inline(always)]
fn conjugate(v: ComplexLanes<f64, W>) -> ComplexLanes<f64, W> {
    ComplexLanes { re: v.re, im: -v.im }
}
