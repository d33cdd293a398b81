//! Frequency, phase, amplitude and derivatives of a reflector's echo at each channel: the factors of inner products of echoes.

use super::sensor::{MIN_DISTANCE_METRES, Sensor, W, with_min_distance};
use crate::radar::Pair;
use crate::scene::Reflector;
use crate::signal::path::PairBlocks;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, phasor};

/// A reflector's echo at neighbouring channels of one end, a channel in each lane. Lanes beyond the end are 0.
#[derive(Debug, Clone, Copy)]
pub struct EchoBlock {
    /// Beat frequency, range bins, wrapped.
    pub bins: Lanes<f64, W>,
    /// Complex amplitude at the middle of the chirp.
    pub middle: ComplexLanes<f64, W>,
    /// Derivative of the distance by the reflector's x.
    pub by_x: Lanes<f64, W>,
    /// Derivative of the distance by half the square of the reflector's y, per metre.
    pub by_half_square: Lanes<f64, W>,
    /// Relative decrease of the amplitude with distance, per metre.
    pub decay: Lanes<f64, W>,
}

/// A reflector's echo at both ends.
#[derive(Debug, Clone)]
pub struct Echo {
    /// Blocks of the first end, then as many of the last.
    blocks: Vec<EchoBlock>,
}

impl Echo {
    #[inline(always)]
    pub fn end(&self, end: usize) -> &[EchoBlock] {
        let each = self.blocks.len() / 2;
        &self.blocks[end * each..(end + 1) * each]
    }
}

/// Kernel of the echoes of `reflectors`.
pub struct Echoes<'a> {
    pub sensor: &'a Sensor,
    pub reflectors: &'a [Reflector],
}

impl Kernel for Echoes<'_> {
    type Output = Vec<Echo>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Vec<Echo> {
        let Echoes { sensor, reflectors } = self;
        let starts = (0..2).flat_map(|end| (0..sensor.end_elements).step_by(W).map(move |first| (end, first)));
        let starts: Vec<(usize, usize)> = starts.collect();
        let mut echoes = Vec::with_capacity(reflectors.len());
        for reflector in reflectors {
            let mut blocks = Vec::with_capacity(starts.len());
            let reflector = with_min_distance(sensor, reflector);
            for &(end, first) in &starts {
                blocks.push(echo_block::<FMA>(sensor, &reflector, end, first));
            }
            echoes.push(Echo { blocks });
        }
        echoes
    }
}

#[inline(always)]
fn echo_block<const FMA: bool>(sensor: &Sensor, r: &Reflector, end: usize, first: usize) -> EchoBlock {
    let of = |v: f64| Lanes::<f64, W>::splat(v);
    let samples = sensor.samples as f64;
    let channel = |lane: usize| end * sensor.end_elements + (first + lane).min(sensor.end_elements - 1);
    let has_samples = |lane: usize| first + lane < sensor.end_elements && sensor.has_samples[channel(lane)];
    let factor = Lanes(std::array::from_fn(|lane| f64::from(u8::from(has_samples(lane)))));
    let pairs = PairBlocks::new(|lane| sensor.pairs[channel(lane)]);
    let echo = sensor.model.echo_lanes::<W, FMA>(pairs, r);
    let turns = echo.carrier_turns + echo.beat_turns_at::<FMA>((samples - 1.0) / 2.0);
    let Slopes { by_x, by_half_square, decay } = if sensor.is_monostatic {
        let x = Lanes(std::array::from_fn(|lane| sensor.element_x[channel(lane)]));
        let by_distance = echo.distance_metres.map(f64::recip);
        Slopes { by_x: (of(r.x_metres) - x) * by_distance, by_half_square: by_distance, decay: by_distance * of(2.0) }
    } else {
        Slopes::of_pairs(std::array::from_fn(|lane| sensor.pairs[channel(lane)]), r)
    };
    EchoBlock {
        bins: echo.beat_turns * of(samples),
        middle: phasor::<f64, W, FMA>(turns).scaled(echo.amplitude * factor),
        by_x,
        by_half_square,
        decay,
    }
}

/// Derivatives of distances and amplitudes, as in [`EchoBlock`].
struct Slopes {
    by_x: Lanes<f64, W>,
    by_half_square: Lanes<f64, W>,
    decay: Lanes<f64, W>,
}

impl Slopes {
    /// The slopes for transmitters and receivers apart, amplitudes as for equal legs: the error is small beside the change of phase.
    #[inline(always)]
    fn of_pairs(pairs: [Pair; W], r: &Reflector) -> Self {
        let of = Lanes::<f64, W>::splat;
        let leg = |antenna: usize| {
            let dx = of(r.x_metres) - Lanes(pairs.map(|pair| pair.places_metres()[antenna][0]));
            let ahead = of(r.y_metres) - Lanes(pairs.map(|pair| pair.places_metres()[antenna][1]));
            let by_distance = (dx * dx + ahead * ahead).sqrt().map(f64::recip);
            (dx * by_distance, by_distance, by_distance * ahead)
        };
        let ((x_out, out, ahead_out), (x_back, back, ahead_back)) = (leg(0), leg(1));
        let half = of(0.5);
        // The derivative of half the square of y by y is y. Where y is 0, the antennas count as on the array's line.
        let by_half_square = if pairs.iter().all(Pair::is_on_line) || r.y_metres.abs() < MIN_DISTANCE_METRES {
            (out + back) * half
        } else {
            (ahead_out + ahead_back) * of(0.5 / r.y_metres)
        };
        Slopes { by_x: (x_out + x_back) * half, by_half_square, decay: out + back }
    }
}
