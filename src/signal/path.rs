//! The path of an echo: its range and complex amplitude at a pair of antennas.
//!
//! Simulation, fits, bounds and theory use this geometry, and the phases of [`EchoModel`](super::phase::EchoModel). A point of reflectivity `g` has
//! range `R = (Rt + Rr) / 2` and amplitude `P g / (Rt Rr)`, where `Rt` and `Rr` are its distances from transmitter and receiver, times
//! [`Pattern::amplitude`] of both. [`Path::new`] is for echoes of bodies ([`crate::scattering`]).

mod change;

pub use change::{PathChange, PolarCoordinate};

use super::double::{Double, product, sum};
use super::simd::Lanes;
use crate::radar::{Pair, Pattern, Radar};
use crate::scene::{MIN_ELEMENT_DISTANCE_METRES, Reflector};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Pairs of antennas, one a lane.
#[derive(Debug, Clone, Copy)]
pub struct PairBlocks<const W: usize> {
    /// x of transmitters and of receivers.
    x_metres: [Lanes<f64, W>; 2],
    /// y of transmitters and of receivers; `None` where all are on the array's line.
    y_metres: [Option<Lanes<f64, W>>; 2],
    is_monostatic: bool,
}

impl<const W: usize> PairBlocks<W> {
    /// The pairs that `pair` returns for lanes 0, 1 and so on.
    #[inline(always)]
    pub fn new(pair: impl Fn(usize) -> Pair) -> Self {
        let pairs: [Pair; W] = std::array::from_fn(pair);
        let is_on_line = pairs.iter().all(Pair::is_on_line);
        let y_metres = [pairs.map(|p| p.transmitter_y_metres), pairs.map(|p| p.receiver_y_metres)];
        PairBlocks {
            x_metres: [Lanes(pairs.map(|p| p.transmitter_x_metres)), Lanes(pairs.map(|p| p.receiver_x_metres))],
            y_metres: y_metres.map(|y| (!is_on_line).then_some(Lanes(y))),
            is_monostatic: pairs.iter().all(Pair::is_one),
        }
    }
}

impl<const W: usize> From<Lanes<f64, W>> for PairBlocks<W> {
    #[inline(always)]
    fn from(element_x_metres: Lanes<f64, W>) -> Self {
        PairBlocks { x_metres: [element_x_metres; 2], y_metres: [None; 2], is_monostatic: true }
    }
}

impl<const W: usize> PairBlocks<W> {
    /// Ranges of the places (x, y), one a lane, in double precision, metres.
    #[inline(always)]
    pub fn ranges_metres(&self, x_metres: Lanes<f64, W>, y_metres: Lanes<f64, W>) -> Lanes<f64, W> {
        let leg = |antenna_x: Lanes<f64, W>, antenna_y: Option<Lanes<f64, W>>| {
            let (dx, dy) = (x_metres - antenna_x, antenna_y.map_or(y_metres, |y| y_metres - y));
            (dx * dx + dy * dy).sqrt()
        };
        let there = leg(self.x_metres[0], self.y_metres[0]);
        if self.is_monostatic {
            return there;
        }
        (there + leg(self.x_metres[1], self.y_metres[1])) * Lanes::splat(0.5)
    }
}

impl From<Pair> for PairBlocks<1> {
    fn from(pair: Pair) -> Self {
        PairBlocks::new(|_| pair)
    }
}

/// Range and complex amplitude of one echo at `W` pairs.
#[derive(Debug, Clone, Copy)]
pub struct Path<const W: usize> {
    pub(super) range_metres: Double<Lanes<f64, W>>,
    pub(super) amplitude: Lanes<f64, W>,
    /// Phase of the complex amplitude, turns; `None` where it is 0 in every lane.
    pub(super) turns: Option<Lanes<f64, W>>,
}

impl<const W: usize> Path<W> {
    /// The path of an echo by its range in metres and its complex amplitude, one a lane.
    pub fn new(range_metres: [f64; W], amplitude: [Complex64; W]) -> Self {
        Path {
            range_metres: Double { hi: Lanes(range_metres), lo: Lanes::splat(0.0) },
            amplitude: Lanes(amplitude.map(|a| a.norm())),
            turns: Some(Lanes(amplitude.map(|a| a.arg() / TAU))),
        }
    }

    /// The path of a point's echo at a transmit power of `power_watts`, between elements of this pattern.
    #[inline(always)]
    pub(super) fn of_point<const FMA: bool>(
        power_watts: f64,
        pattern: Option<Pattern>,
        pairs: &PairBlocks<W>,
        r: &Reflector,
    ) -> Self {
        let scale = power_watts * r.reflectivity;
        let antenna_y = pairs.y_metres;
        let there = leg::<W, FMA>(pairs.x_metres[0], antenna_y[0], r);
        if pairs.is_monostatic {
            let amplitude = there.hi.map(|d| scale / (d * d));
            let amplitude = with_pattern(pattern, amplitude, [there.hi, there.hi], antenna_y, r);
            return Path { range_metres: there, amplitude, turns: None };
        }
        let back = leg::<W, FMA>(pairs.x_metres[1], antenna_y[1], r);
        let amplitude = there.hi.zip(back.hi, |t, r| scale / (t * r));
        let amplitude = with_pattern(pattern, amplitude, [there.hi, back.hi], antenna_y, r);
        Path { range_metres: Double::mean(there, back), amplitude, turns: None }
    }
}

/// An amplitude times the pattern of both ways to `r`, whose lengths are `legs` in metres; `antenna_y` is the antennas' y.
#[inline(always)]
fn with_pattern<const W: usize>(
    pattern: Option<Pattern>,
    amplitude: Lanes<f64, W>,
    legs: [Lanes<f64, W>; 2],
    antenna_y: [Option<Lanes<f64, W>>; 2],
    r: &Reflector,
) -> Lanes<f64, W> {
    let Some(pattern) = pattern else { return amplitude };
    legs.into_iter().zip(antenna_y).fold(amplitude, |amplitude, (leg, antenna_y)| {
        let y = Lanes::splat(r.y_metres);
        let cos = antenna_y.map_or(y, |antenna_y| y - antenna_y).zip(leg, |y, d| y / d);
        amplitude.zip(cos, |a, cos| a * pattern.amplitude(cos))
    })
}

/// Distance of `r` from antennas, whose y is 0 by default.
#[inline(always)]
fn leg<const W: usize, const FMA: bool>(
    antenna_x_metres: Lanes<f64, W>,
    antenna_y_metres: Option<Lanes<f64, W>>,
    r: &Reflector,
) -> Double<Lanes<f64, W>> {
    let of = Lanes::<f64, W>::splat;
    let dx = sum(antenna_x_metres, of(-r.x_metres));
    let x2 = product::<W, FMA>(dx.hi, dx.hi);
    let dy = antenna_y_metres.map(|y| sum(y, of(-r.y_metres)));
    let y = dy.map_or(of(r.y_metres), |dy| dy.hi);
    let y2 = product::<W, FMA>(y, y);
    let s = sum(x2.hi, y2.hi);
    let low = s.lo + x2.lo + y2.lo + of(2.0) * dx.hi * dx.lo;
    let low = dy.map_or(low, |dy| low + of(2.0) * dy.hi * dy.lo);
    let root = s.hi.sqrt();
    let square = product::<W, FMA>(root, root);
    let residual = (s.hi - square.hi) - square.lo + low;
    sum(root, residual.zip(root, |a, b| a / (2.0 * b)))
}

#[inline(always)]
pub(super) fn plain_path<const W: usize>(radar: &Radar, pairs: &PairBlocks<W>, r: &Reflector) -> [Lanes<f64, W>; 2] {
    let scale = radar.transmit_power_watts * r.reflectivity;
    let pattern = radar.pattern();
    let antenna_y = pairs.y_metres;
    let square = |antenna_x_metres: Lanes<f64, W>, antenna_y: Option<Lanes<f64, W>>| {
        let dx = antenna_x_metres - Lanes::splat(r.x_metres);
        let y2 = match antenna_y {
            None => Lanes::splat(r.y_metres * r.y_metres),
            Some(y) => (y - Lanes::splat(r.y_metres)) * (y - Lanes::splat(r.y_metres)),
        };
        dx * dx + y2
    };
    let there = square(pairs.x_metres[0], antenna_y[0]);
    if pairs.is_monostatic {
        let range = there.sqrt();
        return [range, with_pattern(pattern, there.map(|s| scale / s), [range, range], antenna_y, r)];
    }
    let (there, back) = (there.sqrt(), square(pairs.x_metres[1], antenna_y[1]).sqrt());
    let amplitude = there.zip(back, |t, r| scale / (t * r));
    [(there + back) * Lanes::splat(0.5), with_pattern(pattern, amplitude, [there, back], antenna_y, r)]
}

/// Range in metres and amplitude of a point for one pair, rounded as the thesis' program rounds them.
pub(super) fn thesis_path(radar: &Radar, pair: Pair, r: &Reflector) -> (f64, f64) {
    let leg = |[antenna_x_metres, antenna_y_metres]: [f64; 2]| {
        let (dx, dy) = (antenna_x_metres - r.x_metres, r.y_metres - antenna_y_metres);
        (dx * dx + dy * dy).sqrt()
    };
    let [there, back] = pair.places_metres().map(leg);
    let amplitude = radar.transmit_power_watts * r.reflectivity / (there * back);
    let [out, home] = [r.y_metres - pair.transmitter_y_metres, r.y_metres - pair.receiver_y_metres];
    let gain = radar.pattern().map_or(1.0, |p| p.amplitude(out / there) * p.amplitude(home / back));
    ((there + back) / 2.0, amplitude * gain)
}

/// Bounds of the ranges of `r` from elements of `radar` up to `elements`, metres; for single antennas they are reached.
pub(super) fn range_span_metres(radar: &Radar, elements: usize, r: &Reflector) -> (f64, f64) {
    let (mut left, mut right) = (radar.element_x_metres(0), radar.element_x_metres(elements));
    if !radar.is_monostatic() {
        // Half the way there and back lies between the distances of both antennas.
        let [low, high] = radar.antenna_span_metres();
        (left, right) = (left.min(low), right.max(high));
    }
    let [hind, fore] = radar.antenna_depth_metres();
    let nearest = (r.x_metres.clamp(left, right) - r.x_metres).hypot(r.y_metres - r.y_metres.clamp(hind, fore));
    let ahead = (r.y_metres - hind).abs().max((r.y_metres - fore).abs());
    let farthest = (left - r.x_metres).abs().max((right - r.x_metres).abs()).hypot(ahead);
    (nearest, farthest)
}

pub(super) fn largest_amplitude(radar: &Radar, r: &Reflector) -> f64 {
    let half = match radar.is_monostatic() {
        true => radar.aperture_metres() / 2.0,
        false => radar.antenna_span_metres().into_iter().fold(0.0, |m: f64, x| m.max(x.abs())),
    };
    let beside = (r.x_metres.abs() - half).max(0.0);
    let [hind, fore] = radar.antenna_depth_metres();
    let ahead = r.y_metres - r.y_metres.clamp(hind, fore);
    let square = (beside * beside + ahead * ahead).max(MIN_ELEMENT_DISTANCE_METRES.powi(2));
    radar.transmit_power_watts * r.reflectivity.abs() / square
}

#[cfg(test)]
mod tests {
    use super::super::judge;
    use super::super::phase::EchoModel;
    use super::*;
    use crate::radar::{Carrier, LinkBudget};

    const SEPARATE_PAIR: Pair = Pair::on_line(-0.4, 0.7);

    const BENT: Pair = Pair {
        transmitter_y_metres: -0.06,
        receiver_y_metres: 0.11,
        transmitter_x_metres: -0.4,
        receiver_x_metres: 0.7,
    };

    fn radars() -> [Radar; 2] {
        [Carrier::OneWay, Carrier::TwoWay].map(|carrier| Radar { carrier, ..Radar::default() })
    }

    fn point(x_metres: f64, y_metres: f64) -> Reflector {
        Reflector { x_metres, y_metres, reflectivity: 0.7 }
    }

    fn narrow() -> Radar {
        let budget = LinkBudget { half_power_width_degrees: Some(60.0), ..LinkBudget::default() };
        Radar { budget: Some(budget), ..Radar::default() }
    }

    #[test]
    fn a_pattern_takes_its_two_way_value_from_every_algorithm() {
        let (narrow, isotropic) = (narrow(), Radar::default());
        // cos^n is one half at 30 degrees.
        let exponent = 0.5f64.ln() / 30f64.to_radians().cos().ln();
        for r in [point(2.0, 11.0), point(-9.0, 5.0), point(0.0, 14.0), point(3.0, -8.0)] {
            for pair in [SEPARATE_PAIR, BENT, Pair::at(0.3)] {
                let cos = |[x, y]: [f64; 2]| (r.y_metres - y).abs() / (r.x_metres - x).hypot(r.y_metres - y);
                let [there, back] = pair.places_metres().map(cos);
                let power = (there * back).powf(exponent);
                let samples = |radar: &Radar| EchoModel::new(radar).echo(pair, &r).sample(77);
                let kept = samples(&narrow) / samples(&isotropic);
                let holds = (kept.norm_sqr() / power - 1.0).abs() < 1e-9 && kept.im.abs() < 1e-12;
                assert!(holds, "{r:?}: {kept}, {power}");
                let judged = judge::pair_signal(&narrow, &[r], pair)[77];
                assert!((judged - samples(&narrow)).norm() < 1e-13 * judged.norm(), "{r:?}");
            }
        }
    }

    #[test]
    fn the_echo_between_antennas_apart_is_the_judges() {
        for radar in radars() {
            for r in [point(2.0, 11.0), point(-7.0, 0.3), point(0.1, 60.0)] {
                for pair in [SEPARATE_PAIR, BENT] {
                    let echo = EchoModel::new(&radar).echo(pair, &r);
                    let judged = judge::pair_signal(&radar, &[r], pair);
                    for (n1, judged) in judged.iter().enumerate() {
                        let off = (echo.sample(n1) - judged).norm();
                        assert!(off < 1e-14 * echo.amplitude, "{r:?}, {pair:?}, sample {n1}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn antennas_at_one_place_are_one_element_bit_for_bit() {
        let model = EchoModel::new(&Radar::default());
        let (x, r) = (0.3, point(2.0, 11.0));
        let apart = PairBlocks::<1> { is_monostatic: false, ..PairBlocks::from(Lanes([x])) };
        assert_eq!(model.echo_lanes::<1, false>(apart, &r), model.echo_lanes::<1, false>(Lanes([x]), &r));
    }

    #[test]
    fn a_complex_amplitude_turns_the_samples() {
        for radar in radars() {
            let model = EchoModel::new(&radar);
            let r = point(2.0, 11.0);
            let (range, amplitude) = thesis_path(&radar, SEPARATE_PAIR, &r);
            let factor = Complex64::from_polar(1.5, 2.0);
            let plain = model.of_path::<1, false>(Path::new([range], [Complex64::from(amplitude)])).first();
            let turned = model.of_path::<1, false>(Path::new([range], [factor * amplitude])).first();
            for n1 in [0, 1, 200, 511] {
                let off = (turned.sample(n1) - plain.sample(n1) * factor).norm();
                assert!(off < 1e-14 * turned.amplitude, "sample {n1}: {off:e}");
            }
        }
    }

    #[test]
    fn changes_are_derivatives_of_samples() {
        const STEP: f64 = 1e-7;
        let (x, y) = (2.0, 11.0);
        let range = f64::hypot(x, y);
        let polar = |range: f64, cos: f64| [range * cos, range * (1.0 - cos * cos).sqrt()];
        let moved = |by, step| match by {
            PolarCoordinate::Range => polar(range + step, x / range),
            PolarCoordinate::CosTheta => polar(range, x / range + step),
        };
        for radar in radars().into_iter().chain([narrow()]) {
            let model = EchoModel::new(&radar);
            for by in [PolarCoordinate::Range, PolarCoordinate::CosTheta] {
                for pair in [SEPARATE_PAIR, BENT, Pair::at(0.3)] {
                    for n1 in [0, 300] {
                        let at = |step| {
                            let [x, y] = moved(by, step);
                            model.echo(pair, &point(x, y)).sample(n1)
                        };
                        let expected = (at(STEP) - at(-STEP)) / (2.0 * STEP) / at(0.0);
                        let change = PathChange::of_point(pair, [x, y], by).through(radar.pattern(), pair, [x, y], by);
                        let found = change.of_sample(radar.turns_per_metre(n1 as f64));
                        assert!((found - expected).norm() < 1e-6 * expected.norm(), "{by:?}: {found}, {expected}");
                    }
                }
            }
        }
    }

    #[test]
    fn plain_paths_agree_with_exact_ones() {
        let r = point(2.0, 11.0);
        for (radar, pair) in [Radar::default(), narrow()]
            .into_iter()
            .flat_map(|r| [SEPARATE_PAIR, BENT, Pair::at(0.3)].map(|p| (r.clone(), p)))
        {
            let echo = EchoModel::new(&radar).echo(pair, &r);
            let [range, amplitude] = plain_path(&radar, &PairBlocks::from(pair), &r);
            let thesis = thesis_path(&radar, pair, &r);
            for (range, amplitude) in [(range.0[0], amplitude.0[0]), thesis] {
                assert!((range - echo.distance_metres).abs() < 1e-14 * range);
                assert!((amplitude / echo.amplitude - 1.0).abs() < 1e-14);
            }
            assert!((pair.range_metres(r.x_metres, r.y_metres) - echo.distance_metres).abs() < 1e-14 * thesis.0);
        }
    }
}
