//! Fourier transforms of several channels at once, one lane an element: Stockham's radix-4 for powers of two, else rustfft lane by lane.

use super::simd::{ComplexLanes, Real, Simd};
use num_complex::Complex;
use rustfft::Fft;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A forward transform of fixed length, not scaled: `X[k] = sum_n x[n] exp(-2 pi j n k / len)`.
#[derive(Clone)]
pub struct LaneFft<T: Real> {
    len: usize,
    method: Method<T>,
}

#[derive(Clone)]
enum Method<T: Real> {
    /// Twiddles `w, w^2, w^3` of every radix-4 stage.
    Stockham(Vec<Vec<[Complex<T>; 3]>>),
    Rustfft(Arc<dyn Fft<T>>),
}

impl<T: Real> LaneFft<T> {
    /// Plans transforms of `len` points.
    pub fn new(len: usize) -> Self {
        if !len.is_power_of_two() {
            return LaneFft { len, method: Method::Rustfft(Simd::chosen().forward_fft(len)) };
        }
        let mut stages = Vec::new();
        let mut remaining = len;
        while remaining >= 4 {
            let twiddle = |p: usize, power: usize| {
                let (sin, cos) = (-TAU * (p * power) as f64 / remaining as f64).sin_cos();
                Complex::new(T::of(cos), T::of(sin))
            };
            stages.push((0..remaining / 4).map(|p| [1, 2, 3].map(|power| twiddle(p, power))).collect());
            remaining /= 4;
        }
        LaneFft { len, method: Method::Stockham(stages) }
    }

    /// Transforms `data` in place; `spare` is overwritten and must be as long.
    #[inline(always)]
    pub fn process<const W: usize, const FMA: bool>(
        &self,
        data: &mut [ComplexLanes<T, W>],
        spare: &mut [ComplexLanes<T, W>],
    ) {
        match &self.method {
            Method::Stockham(stages) => stockham::<T, W, FMA>(self.len, stages, data, spare),
            Method::Rustfft(fft) => lane_by_lane(fft.as_ref(), data),
        }
    }
}

fn lane_by_lane<T: Real, const W: usize>(fft: &dyn Fft<T>, data: &mut [ComplexLanes<T, W>]) {
    let mut channel = vec![Complex::default(); data.len()];
    for lane in 0..W {
        for (c, d) in channel.iter_mut().zip(data.iter()) {
            *c = Complex::new(d.re.0[lane], d.im.0[lane]);
        }
        fft.process(&mut channel);
        for (c, d) in channel.iter().zip(data.iter_mut()) {
            (d.re.0[lane], d.im.0[lane]) = (c.re, c.im);
        }
    }
}

#[inline(always)]
fn stockham<T: Real, const W: usize, const FMA: bool>(
    len: usize,
    stages: &[Vec<[Complex<T>; 3]>],
    data: &mut [ComplexLanes<T, W>],
    spare: &mut [ComplexLanes<T, W>],
) {
    let (data, spare) = (&mut data[..len], &mut spare[..len]);
    let (mut from, mut to) = (&mut *data, &mut *spare);
    let mut stride = 1;
    for twiddles in stages {
        let quarter = stride * twiddles.len();
        let (x0, rest) = from.split_at(quarter);
        let (x1, rest) = rest.split_at(quarter);
        let (x2, x3) = rest.split_at(quarter);
        for (p, [w1, w2, w3]) in twiddles.iter().enumerate() {
            let group = p * stride..(p + 1) * stride;
            let (x0, x1, x2, x3) = (&x0[group.clone()], &x1[group.clone()], &x2[group.clone()], &x3[group]);
            let (y0, rest) = to[4 * p * stride..4 * (p + 1) * stride].split_at_mut(stride);
            let (y1, rest) = rest.split_at_mut(stride);
            let (y2, y3) = rest.split_at_mut(stride);
            for q in 0..stride {
                let (a, b, c, d) = (x0[q], x1[q], x2[q], x3[q]);
                let (sum, difference) = (a + c, a - c);
                let (other_sum, t) = (b + d, b - d);
                let turned = ComplexLanes { re: -t.im, im: t.re };
                y0[q] = sum + other_sum;
                y1[q] = (difference - turned).times::<FMA>(ComplexLanes::splat(*w1));
                y2[q] = (sum - other_sum).times::<FMA>(ComplexLanes::splat(*w2));
                y3[q] = (difference + turned).times::<FMA>(ComplexLanes::splat(*w3));
            }
        }
        stride *= 4;
        std::mem::swap(&mut from, &mut to);
    }
    if stride < len {
        let (x0, x1) = from.split_at(stride);
        let (y0, y1) = to.split_at_mut(stride);
        for q in 0..stride {
            (y0[q], y1[q]) = (x0[q] + x1[q], x0[q] - x1[q]);
        }
        std::mem::swap(&mut from, &mut to);
    }
    let passes = stages.len() + usize::from(stride < len);
    if passes % 2 == 1 {
        to.copy_from_slice(from);
    }
}

#[cfg(test)]
mod tests {
    use super::super::simd::{Kernel, LANES_F64, Simd};
    use super::*;
    use rustfft::FftPlanner;

    struct Transform<'a>(&'a LaneFft<f64>, &'a mut [ComplexLanes<f64, LANES_F64>]);

    impl Kernel for Transform<'_> {
        type Output = ();
        #[inline(always)]
        fn run<const FMA: bool>(self) {
            let mut spare = vec![ComplexLanes::zero(); self.1.len()];
            self.0.process::<LANES_F64, FMA>(self.1, &mut spare);
        }
    }

    #[test]
    fn every_lane_agrees_with_rustfft() {
        for len in [1, 2, 4, 8, 12, 32, 100, 512, 1024] {
            let value = |n: usize, lane: usize| ((n * 7 + lane * 3) as f64).sin();
            let input = |lane: usize| -> Vec<_> {
                (0..len).map(|n| Complex::new(value(n, lane), value(n + 1, lane + 5))).collect()
            };
            for simd in Simd::available() {
                let mut data: Vec<ComplexLanes<f64, LANES_F64>> = vec![ComplexLanes::zero(); len];
                for lane in 0..LANES_F64 {
                    for (d, v) in data.iter_mut().zip(input(lane)) {
                        (d.re.0[lane], d.im.0[lane]) = (v.re, v.im);
                    }
                }
                simd.run(Transform(&LaneFft::new(len), &mut data));
                for lane in 0..LANES_F64 {
                    let mut expected = input(lane);
                    FftPlanner::new().plan_fft_forward(len).process(&mut expected);
                    for (d, e) in data.iter().zip(&expected) {
                        let off = (d.re.0[lane] - e.re).hypot(d.im.0[lane] - e.im);
                        assert!(off < 1e-13 * len as f64, "{len} points, lane {lane}, {simd:?}: {off:e}");
                    }
                }
            }
        }
    }
}
