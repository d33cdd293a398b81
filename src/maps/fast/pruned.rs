//! The ends' transforms, which skip the zeros among their inputs: all but those of an end's elements.

use super::log::{Extremes, LogScale, log_rolled};
use crate::radar::Radar;
use crate::signal::lane_fft::LaneFft;
use crate::signal::simd::{ComplexLanes, Lanes, Real, Simd};
use num_complex::Complex;
use rustfft::Fft;
use std::sync::Arc;

/// Transform of a few inputs padded with zeros: `columns = small * stride` splits into `stride` transforms of `small` points,
/// `X[stride p + q] = sum_n (x[n] w^(n q)) exp(-2 pi j n p / small)`, one lane a `q`.
#[derive(Clone)]
pub(super) struct PrunedFft<T: Real, const W: usize> {
    columns: usize,
    /// Window times twiddle: `[q / W][n]`.
    twiddles: Vec<Vec<ComplexLanes<T, W>>>,
    small: LaneFft<T>,
    points: usize,
    /// A window and a full transform, for lengths without such factors.
    plain: Option<(Vec<T>, Arc<dyn Fft<T>>)>,
}

/// Most points of the small transforms.
const MAX_POINTS: usize = 64;

impl<T: Real, const W: usize> PrunedFft<T, W> {
    pub(super) fn new(radar: &Radar, simd: Simd) -> Self {
        let (inputs, columns) = (radar.end_elements, radar.elements);
        let points = inputs.next_power_of_two();
        let scale = (columns as f64).sqrt().recip();
        let window: Vec<f64> = radar.window.weights(inputs).into_iter().map(|w| w * scale).collect();
        let fits = points <= MAX_POINTS && columns.is_multiple_of(2 * points * W);
        let stride = columns / points;
        let twiddle = |n: usize, q: usize| {
            let (sin, cos) = (-std::f64::consts::TAU * (n * q) as f64 / columns as f64).sin_cos();
            (window[n] * cos, window[n] * sin)
        };
        let chunk = |begin: usize| {
            let lanes = |n: usize, part: fn((f64, f64)) -> f64| {
                Lanes(std::array::from_fn(|i| T::of(part(twiddle(n, begin + i)))))
            };
            (0..inputs).map(|n| ComplexLanes { re: lanes(n, |t| t.0), im: lanes(n, |t| t.1) }).collect()
        };
        PrunedFft {
            columns,
            twiddles: if fits { (0..stride).step_by(W).map(chunk).collect() } else { Vec::new() },
            small: LaneFft::new(points),
            points,
            plain: (!fits).then(|| (window.iter().map(|w| T::of(*w)).collect(), simd.forward_fft(columns))),
        }
    }

    /// Decades of the rolled transform of `inputs`.
    #[inline(always)]
    pub(super) fn log_row<const FMA: bool>(
        &self,
        inputs: &[Complex<T>],
        log: &LogScale,
        out: &mut [f32],
        extremes: &mut Extremes<W>,
    ) {
        if let Some((window, fft)) = &self.plain {
            let mut row = vec![Complex::default(); self.columns];
            for ((v, x), w) in row.iter_mut().zip(inputs).zip(window) {
                *v = Complex::new(x.re * *w, x.im * *w);
            }
            fft.process(&mut row);
            return log_rolled::<T, W, FMA>(&row, log, out, extremes);
        }
        let stride = self.columns / self.points;
        // A copy that may be in registers.
        let mut seen = *extremes;
        let mut data = [ComplexLanes::<T, W>::zero(); MAX_POINTS];
        let mut spare = [ComplexLanes::<T, W>::zero(); MAX_POINTS];
        for (chunk, twiddles) in self.twiddles.iter().enumerate() {
            for (n, x) in inputs.iter().enumerate() {
                // Indexed, not zipped: else the compiler vectorises the loop over inputs, with slow gathers.
                data[n] = twiddles[n].times::<FMA>(ComplexLanes::splat(*x));
            }
            data[inputs.len()..self.points].fill(ComplexLanes::zero());
            self.small.process::<W, FMA>(&mut data[..self.points], &mut spare[..self.points]);
            for (p, v) in data[..self.points].iter().enumerate() {
                let column = (stride * p + chunk * W + self.columns / 2) % self.columns;
                let d = log.decades::<T, W, FMA>(*v);
                seen.add(d);
                d.store(&mut out[column..]);
            }
        }
        *extremes = seen;
    }
}
