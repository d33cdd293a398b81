//! References for the echoes: quadrature of physical optics over a face, and the exact series of a cylinder.

use super::super::transition::EIGHTH_TURN;
use super::super::{AntennaPlaces, REFERENCE_LENGTH_METRES};
use crate::radar::Radar;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// Nodes in [-1, 1] and weights of Gauss's rule with 8 points.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_3),
];

/// Phase for each metre of range at sample `n`, radians; positive where phases fall with the range.
pub fn radians_per_metre(radar: &Radar, n: f64) -> f64 {
    -TAU * radar.turns_per_metre(n)
}

/// Samples of a face by quadrature of
/// `P r e^{j pi/4} sqrt(kappa / (2 pi L0)) int (cos t + cos r)/2 / (Rt Rr) exp(-j kappa (Rt + Rr)/2) du`
/// by Gauss's rule with 8 points in panels over each of which the phase changes by `panel_radians` at most: 8 leave an error of 1e-8 or so.
/// The face leads from `a` to `b`, (x, y) in metres, and has the reflection coefficient `r`.
pub fn face(
    radar: &Radar,
    [a, b]: [[f64; 2]; 2],
    r: f64,
    antennas: &AntennaPlaces,
    samples: &[usize],
    panel_radians: f64,
) -> Vec<Complex64> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    let panels = (length * radians_per_metre(radar, 0.0).abs() / panel_radians).ceil().max(16.0);
    let step = length / panels;
    let leg = |antenna: [f64; 2], place: [f64; 2]| {
        let (dx, dy) = (antenna[0] - place[0], antenna[1] - place[1]);
        let distance = dx.hypot(dy);
        (distance, (dx * along[1] - dy * along[0]).abs() / distance)
    };
    let mut sums = vec![Complex64::default(); samples.len()];
    for panel in 0..panels as usize {
        for (node, weight) in GAUSS.iter().flat_map(|(x, w)| [(-x, w), (*x, w)]) {
            let u = (panel as f64 + (node + 1.0) / 2.0) * step;
            let place = [a[0] + u * along[0], a[1] + u * along[1]];
            let (rt, cos_t) = leg(antennas.transmitter_metres, place);
            let (rr, cos_r) = leg(antennas.receiver_metres, place);
            let strength = radar.transmit_power_watts * r * weight * step / 2.0 * (cos_t + cos_r) / 2.0 / (rt * rr);
            for (sum, n) in sums.iter_mut().zip(samples) {
                *sum += Complex64::from_polar(strength, -radians_per_metre(radar, *n as f64) * (rt + rr) / 2.0);
            }
        }
    }
    let density = |n: usize| {
        let kappa = radians_per_metre(radar, n as f64);
        let turn = if kappa > 0.0 { EIGHTH_TURN } else { EIGHTH_TURN.conj() };
        turn * (kappa.abs() / (TAU * REFERENCE_LENGTH_METRES)).sqrt()
    };
    sums.iter().zip(samples).map(|(sum, n)| sum * density(*n)).collect()
}

/// Bessel's functions of the first kind (downwards, Miller) and of the second (upwards from Neumann's series) of orders 0 to `top` at `x`.
fn bessel(x: f64, top: usize) -> (Vec<f64>, Vec<f64>) {
    let start = (top.max(x as usize) + 40 + (15.0 * x.cbrt()) as usize) / 2 * 2;
    let mut first = vec![0.0; start + 2];
    first[start] = 1e-200;
    for m in (0..start).rev() {
        first[m] = 2.0 * (m + 1) as f64 / x * first[m + 1] - first[m + 2];
        if first[m].abs() > 1e200 {
            first[m..].iter_mut().for_each(|v| *v *= 1e-250);
        }
    }
    let sum = first[0] + 2.0 * first.iter().skip(2).step_by(2).sum::<f64>();
    first.iter_mut().for_each(|v| *v /= sum);
    const EULER: f64 = 0.577_215_664_901_532_9;
    let even = (1..start / 2).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 } * first[2 * k] / k as f64);
    let zeroth = 2.0 / PI * ((x / 2.0).ln() + EULER) * first[0] - 4.0 / PI * even.sum::<f64>();
    let mut second = vec![zeroth, (first[1] * zeroth - 2.0 / (PI * x)) / first[0]];
    for m in 1..top {
        second.push(2.0 * m as f64 / x * second[m] - second[m - 1]);
    }
    first.truncate(top + 1);
    (first, second)
}

/// The exact echo of a perfect cylinder at sample `n`, E along the post, from an observing line source, the way to its nearest point included.
pub fn post(radar: &Radar, centre: [f64; 2], radius: f64, antenna: [f64; 2], n: usize) -> Complex64 {
    let away = (antenna[0] - centre[0]).hypot(antenna[1] - centre[1]);
    let k = radians_per_metre(radar, n as f64) / 2.0;
    let top = (k * radius + 12.0 * (k * radius).cbrt() + 12.0) as usize;
    let (near_j, near_y) = bessel(k * radius, top);
    let (far_j, far_y) = bessel(k * away, top);
    let term = |m: usize| {
        let near = Complex64::new(near_j[m], -near_y[m]);
        let far = Complex64::new(far_j[m], -far_y[m]);
        near_j[m] / near * far * far
    };
    let total = term(0) + 2.0 * (1..=top).map(term).sum::<Complex64>();
    let scale = radar.transmit_power_watts / (away - radius) / REFERENCE_LENGTH_METRES.sqrt();
    total * (PI * k).sqrt() * scale / EIGHTH_TURN
}
