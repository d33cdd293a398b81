//! Beams of each end over range.

use crate::maps::channels_range_transform;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use crate::signal::simd::{Kernel, Simd};
use ndarray::{Array2, ArrayViewMut1};
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Number of beams of an end between which an echo is hardly weaker: four for each of its elements.
pub fn beam_count(radar: &Radar) -> usize {
    4 * radar.end_elements
}

/// `count` beams of each end, even in cos(theta), `[beam, range bin]`, phases referred to the end's middle, from samples `[channels * samples]`.
pub fn end_beams(radar: &Radar, samples: &[Complex64], count: usize) -> [Array2<Complex64>; 2] {
    let ends = TwoEnds::of_flat(radar, samples);
    let radians_per_element =
        -TAU * radar.carrier.turns_per_wavelength() * radar.element_spacing_metres / radar.wavelength_metres();
    End::BOTH.map(|end| {
        let profiles = channels_range_transform(radar, ends.end(end).view()).profiles;
        let middle = (profiles.nrows() as f64 - 1.0) / 2.0;
        let [re, im]: [Vec<f64>; 2] =
            [|v: &Complex64| v.re, |v: &Complex64| v.im].map(|of| profiles.iter().map(of).collect());
        let mut beams = Array2::zeros((count, radar.samples));
        beams.outer_iter_mut().into_par_iter().enumerate().for_each(|(beam, row)| {
            let radians = -radians_per_element * cos_of_beam(beam, count);
            let steering: Vec<Complex64> =
                (0..profiles.nrows()).map(|n| Complex64::cis(radians * (n as f64 - middle))).collect();
            Simd::chosen().run(Steer { profiles: [&re, &im], steering: &steering, beam: row });
        });
        beams
    })
}

/// Kernel of one beam from the real and imaginary parts of the elements' range profiles, `[elements * range bins]`.
struct Steer<'a> {
    profiles: [&'a [f64]; 2],
    steering: &'a [Complex64],
    beam: ArrayViewMut1<'a, Complex64>,
}

impl Kernel for Steer<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let bins = self.beam.len();
        let [mut re, mut im] = [vec![0.0; bins], vec![0.0; bins]];
        let [profiles_re, profiles_im] = self.profiles.map(|part| part.chunks_exact(bins.max(1)));
        for ((steer, from_re), from_im) in self.steering.iter().zip(profiles_re).zip(profiles_im) {
            for (((re, im), a), b) in re.iter_mut().zip(&mut im).zip(from_re).zip(from_im) {
                *re += steer.re * a - steer.im * b;
                *im += steer.re * b + steer.im * a;
            }
        }
        for (beam, (re, im)) in self.beam.into_iter().zip(re.into_iter().zip(im)) {
            *beam = Complex64::new(re, im);
        }
    }
}

/// Mean power of white noise of `variance` a sample in a cell of [`end_beams`], and its energy in a range bin of all elements of an end.
pub fn beam_noise_power(radar: &Radar, variance: f64) -> f64 {
    let window: f64 = radar.window.weights(radar.samples).iter().map(|w| w * w).sum();
    variance * window / radar.samples as f64 * radar.end_elements as f64
}

/// cos(theta) of the middle of a beam.
fn cos_of_beam(beam: usize, count: usize) -> f64 {
    (beam as f64 + 0.5) / count as f64 * 2.0 - 1.0
}

/// The beam, of `count`, that contains this cosine.
#[inline(always)]
pub fn beam_of_cos(cos: f64, count: usize) -> usize {
    // A float cast saturates: the first beam contains cosines below -1.
    (((cos + 1.0) * (0.5 * count as f64)) as usize).min(count - 1)
}
