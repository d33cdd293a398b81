//! Sparse answers as maps: the exact map of a few reflectors with complex gains.

use super::answer::{Reconstruction, Request};
use super::confidence::confidences;
use super::power::lambda_of_power;
use crate::maps::Aperture;
use crate::maps::focus::map_of;
use crate::radar::{BuiltArray, Radar};
use crate::scene::Reflector;
use crate::signal::path::PairBlocks;
use crate::signal::phase::EchoModel;
use crate::signal::simd::{ComplexLanes, Kernel, LANES_F64, Simd};
use crate::signal::split::{CHUNK_REFLECTORS, Factors, ROW_SAMPLES, add_products, fill_factors};
use crate::signal::{BeatSignal, TwoEnds};
use ndarray::Axis;
use num_complex::Complex64;
use rayon::prelude::*;

const W: usize = LANES_F64;

#[derive(Debug, Clone, Copy)]
pub(super) struct Gained {
    pub reflector: Reflector,
    pub gain: Complex64,
}

pub(super) fn of_echoes(
    radar: &Radar,
    ends: &TwoEnds,
    found: &[Gained],
    noise_variance: f64,
    request: &Request,
) -> Reconstruction {
    let model = EchoModel::new(radar);
    let mut signal = BeatSignal::silence(radar);
    signal.samples.axis_chunks_iter_mut(Axis(0), W).into_par_iter().enumerate().for_each(|(block, mut rows)| {
        let element = |lane: usize| (block * W + lane).min(radar.elements - 1);
        let pairs = PairBlocks::new(|lane| radar.pair(element(lane)));
        let sum = Simd::chosen().run(Sum { model: &model, pairs, found, samples: radar.samples });
        for (lane, mut row) in rows.outer_iter_mut().enumerate() {
            for (out, v) in row.iter_mut().zip(&sum) {
                *out = Complex64::new(v.re.0[lane], v.im.0[lane]);
            }
        }
    });
    let map = map_of(radar, &BuiltArray::default(), &signal, Aperture::Full);
    let power = map.cells.mapv(|v| v.norm_sqr());
    let reflectors: Vec<Reflector> =
        found.iter().map(|f| Reflector { reflectivity: f.gain.norm(), ..f.reflector }).collect();
    let confidences = confidences(radar, ends, &reflectors, noise_variance);
    let (lambda, least) = lambda_of_power(radar, power, noise_variance, request);
    Reconstruction { reflectors, confidences, least_eta: Some(least), ..Reconstruction::of_map(lambda) }
}

struct Sum<'a> {
    model: &'a EchoModel,
    pairs: PairBlocks<W>,
    found: &'a [Gained],
    samples: usize,
}

impl Kernel for Sum<'_> {
    type Output = Vec<ComplexLanes<f64, W>>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let mut factors = vec![Factors::<f64, W>::new(self.samples); CHUNK_REFLECTORS];
        let mut sum = vec![ComplexLanes::zero(); factors[0].rows.len() * ROW_SAMPLES];
        for chunk in self.found.chunks(CHUNK_REFLECTORS) {
            for (f, Gained { reflector, gain }) in factors.iter_mut().zip(chunk) {
                fill_factors::<f64, W, FMA>(self.model, self.pairs, reflector, &mut f.rows, &mut f.columns);
                for row in &mut f.rows {
                    *row = row.times::<FMA>(ComplexLanes::splat(*gain));
                }
            }
            let products: [_; CHUNK_REFLECTORS] = std::array::from_fn(|i| factors[i].product());
            add_products::<f64, W, FMA>(&products[..chunk.len()], &mut sum);
        }
        sum
    }
}
