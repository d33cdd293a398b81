//! Equation 3.3 in double-double arithmetic (about 31 digits): the reference of every other algorithm. Tests compare it with known values.

use super::samples::BeatSignal;
use crate::radar::{Pair, Radar};
use crate::scattering::Sources;
use num_complex::Complex64;
use rayon::prelude::*;
use twofloat::TwoFloat;

/// Beat signal of all scatterers, `[elements, samples]`, exact in f64 to the last bit.
pub fn beat_signal<'a>(radar: &Radar, sources: impl Into<Sources<'a>>) -> BeatSignal {
    let sources = sources.into();
    let mut signal = BeatSignal::silence(radar);
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
        for (sample, value) in row.iter_mut().zip(element_signal(radar, sources, n)) {
            *sample = value;
        }
    });
    signal
}

/// Beat signal of one element, `[samples]`.
pub fn element_signal<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, element: usize) -> Vec<Complex64> {
    pair_signal(radar, sources, radar.pair(element))
}

/// Beat signal of one pair of antennas, `[samples]`. Ranges and amplitudes of bodies have the precision of f64.
pub fn pair_signal<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, pair: Pair) -> Vec<Complex64> {
    let sources = sources.into();
    let zero = TwoFloat::from(0.0);
    let mut sums = vec![Phasor { re: zero, im: zero }; radar.samples];
    let mut add = |distance: TwoFloat, amplitude: Phasor| {
        let carrier = distance / radar.wavelength_metres() * radar.carrier.turns_per_wavelength();
        let bins = distance / radar.range_resolution_metres();
        for (n1, sum) in sums.iter_mut().enumerate() {
            let phase = fraction(bins * n1 as f64 / radar.samples as f64) + fraction(carrier);
            let p = Phasor::of_turns(phase);
            sum.re += p.re * amplitude.re - p.im * amplitude.im;
            sum.im += p.im * amplitude.re + p.re * amplitude.im;
        }
    };
    for r in sources.points {
        let [there, back] = pair.places_metres().map(|[antenna_x, antenna_y]| {
            let dx = TwoFloat::new_sub(antenna_x, r.x_metres);
            if antenna_y == 0.0 {
                return root(dx * dx + TwoFloat::new_mul(r.y_metres, r.y_metres));
            }
            let dy = TwoFloat::new_sub(antenna_y, r.y_metres);
            root(dx * dx + dy * dy)
        });
        let distance = (there + back) / 2.0;
        let mut amplitude = TwoFloat::new_mul(radar.transmit_power_watts, r.reflectivity) / (there * back);
        if let Some(pattern) = radar.pattern() {
            for (leg, [_, antenna_y]) in [there, back].into_iter().zip(pair.places_metres()) {
                amplitude *= pattern.amplitude((r.y_metres - antenna_y) / leg.hi());
            }
        }
        add(distance, Phasor { re: amplitude, im: zero });
    }
    let mut scattered = Vec::new();
    sources.scattered(pair, &mut scattered);
    for echo in scattered.iter().filter(|e| e.is_heard()) {
        let [re, im] = [echo.amplitude.re, echo.amplitude.im].map(TwoFloat::from);
        add(TwoFloat::from(echo.range_metres), Phasor { re, im });
    }
    sums.iter().map(|p| Complex64::new(p.re.hi() + p.re.lo(), p.im.hi() + p.im.lo())).collect()
}

fn root(a: TwoFloat) -> TwoFloat {
    let guess = a.hi().sqrt();
    (TwoFloat::from(guess) + a / guess) * 0.5
}

/// `t` modulo whole turns, in [-1/2, 1/2].
fn fraction(t: TwoFloat) -> TwoFloat {
    let t = t - t.hi().round();
    t - t.hi().round()
}

#[derive(Clone, Copy)]
struct Phasor {
    re: TwoFloat,
    im: TwoFloat,
}

/// 2 pi as the sum of two f64.
const TAU_HIGH: f64 = std::f64::consts::TAU;
const TAU_LOW: f64 = 2.449_293_598_294_706_4e-16;

impl Phasor {
    /// `exp(2 pi j t)`: without quarter turns, by Taylor series for an angle of at most pi/4.
    fn of_turns(t: TwoFloat) -> Phasor {
        let quarters = (t.hi() * 4.0).round();
        let angle = (t - quarters / 4.0) * TwoFloat::new_add(TAU_HIGH, TAU_LOW);
        let square = angle * angle;
        let (mut sin, mut cos) = (TwoFloat::from(0.0), TwoFloat::from(0.0));
        // Horner from the smallest term; (pi/4)^28/28! is below 1e-32.
        for k in (0..14).rev() {
            let (even, odd) = ((2 * k + 1) * (2 * k + 2), (2 * k + 2) * (2 * k + 3));
            cos = square * (cos + 1.0) / -f64::from(even);
            sin = square * (sin + 1.0) / -f64::from(odd);
        }
        let (cos, sin) = (cos + 1.0, angle * (sin + 1.0));
        match quarters.rem_euclid(4.0) as u8 {
            0 => Phasor { re: cos, im: sin },
            1 => Phasor { re: -sin, im: cos },
            2 => Phasor { re: -cos, im: -sin },
            _ => Phasor { re: sin, im: -cos },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn off(value: TwoFloat, expected: f64) -> f64 {
        (value - expected).hi().abs()
    }

    #[test]
    fn phasors_of_known_angles() {
        let third = TwoFloat::from(1.0) / 12.0;
        let p = Phasor::of_turns(third);
        assert!(off(p.im, 0.5) < 1e-30, "sin 30 deg is off by {:e}", off(p.im, 0.5));
        let three_quarters = p.re * p.re;
        assert!(off(three_quarters, 0.75) < 1e-30);
        for t in [-0.5, -0.37, -0.125, 0.0, 0.1, 0.25, 0.49] {
            let p = Phasor::of_turns(TwoFloat::from(t));
            assert!(off(p.re * p.re + p.im * p.im, 1.0) < 1e-30, "unit magnitude at {t}");
        }
    }

    #[test]
    fn roots_square_back() {
        let a = TwoFloat::from(2.0) / 3.0;
        let r = root(a);
        assert!((r * r - a).hi().abs() < 1e-31);
    }
}
