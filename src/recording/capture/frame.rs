//! One frame of a capture.

use super::plan::CapturePlan;
use super::quality::Quality;
use super::table::{Capture, Treatment};
use crate::recording::Fault;
use crate::recording::analytic::{analytic_lanes, subtract_mean};
use crate::recording::layout::PartOrder;
use crate::recording::layout::stream::CaptureStream;
use ndarray::{Array3, Array4, Axis, s};
use num_complex::Complex64;
use std::io::{Read, Seek};

#[derive(Debug, Clone)]
pub(in crate::recording) struct Frame {
    /// `[loops, chirps, receivers, samples]`; real samples as analytic signals of half as many samples.
    pub samples: Array4<Complex64>,
    pub quality: Quality,
}

impl Frame {
    /// Reads the loops of the plan, and subtracts constant part and static clutter where `capture` says so.
    pub fn read<R: Read + Seek>(
        stream: &mut CaptureStream<R>,
        capture: &Capture,
        plan: &CapturePlan,
    ) -> Result<Frame, Fault> {
        let CapturePlan { samples, receivers, chirps, loops, layout, .. } = *plan;
        let size = layout.chirp_bytes(samples, receivers);
        let mut all = Array4::zeros((loops, chirps, receivers, samples));
        let mut quality = Quality::new(loops * chirps);
        let mut bytes = vec![0; size - layout.header_bytes];
        for n in 0..loops * chirps {
            let at = plan.start + n as u64 * size as u64 + layout.header_bytes as u64;
            stream.read_at(at, &mut bytes)?;
            quality.add_chirp(n, &bytes, layout);
            all.slice_mut(s![n / chirps, n % chirps, .., ..]).assign(&layout.decode(&bytes, samples, receivers));
        }
        quality.measure_samples(&all);
        if capture.constant == Treatment::Out {
            subtract_mean(&mut all);
        }
        if capture.static_clutter == Treatment::Out && loops > 1 {
            let mean = all.sum_axis(Axis(0)).mapv_into(|v| v / loops as f64);
            all.outer_iter_mut().for_each(|mut turn| turn -= &mean);
        }
        if layout.part_order == PartOrder::Real {
            all = analytic_lanes(all.view(), samples.div_ceil(2));
        } else if quality.is_real() {
            all = analytic_lanes(all.view(), samples);
        }
        Ok(Frame { samples: all, quality })
    }

    pub fn loops(&self) -> usize {
        self.samples.dim().0
    }

    /// Mean of the loops without zeros of lost packets, `[chirps, receivers, samples]`.
    pub fn mean(&self) -> Array3<Complex64> {
        let weights = self.weights(false);
        let mut mean = Array3::zeros(self.samples.index_axis(Axis(0), 0).raw_dim());
        for (turn, weight) in self.samples.outer_iter().zip(weights) {
            mean.scaled_add(Complex64::from(weight), &turn);
        }
        mean
    }

    /// Weights of the loops, of sum 1: equal, or a Hann window where `tapered`. Loops with zeros of lost packets have weight 0, unless all have such.
    pub fn weights(&self, tapered: bool) -> Vec<f64> {
        let loops = self.loops();
        let chirps = self.samples.dim().1;
        let window = match tapered {
            true => crate::radar::WindowFunction::Hann.weights(loops + 2)[1..=loops].to_vec(),
            false => vec![1.0; loops],
        };
        let whole = |n: usize| (n * chirps..(n + 1) * chirps).all(|chirp| !self.quality.has_zeros(chirp));
        let mut weights: Vec<f64> = (0..loops).map(|n| if whole(n) { window[n] } else { 0.0 }).collect();
        if weights.iter().all(|w| *w == 0.0) {
            weights = window;
        }
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|w| w / sum).collect()
    }
}
