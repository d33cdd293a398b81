use super::*;
use crate::radar::End;
use std::f64::consts::TAU;

fn at(range: f64, cos: f64) -> Reflector {
    Reflector { x_metres: range * cos, y_metres: range * (1.0 - cos * cos).sqrt(), reflectivity: 1.0 }
}

/// The bound of one reflector at 0 dB a sample.
fn alone(layout: &Layout, r: Reflector, gains: Gains) -> PositionBound {
    let radar = Radar::default();
    cramer_rao_of(&radar, layout, &[r], noise_variance(&radar, layout, &r, Decibels(0.0)), gains).unwrap()[0]
}

/// Bounds on range, metres, and on cos(theta) at 0 dB a sample, by differences of the samples as the formula of a point has them, each
/// taken orthogonal to the samples themselves: what stands along them belongs to the unknown gain.
fn by_differences(radar: &Radar, layout: &Layout, range: f64, cos: f64) -> [f64; 2] {
    let samples = |range: f64, cos: f64| -> Vec<Complex64> {
        let (x, y) = (range * cos, range * (1.0 - cos * cos).sqrt());
        let of_element = |element: &f64| {
            let distance = (x - element).hypot(y);
            let amplitude = radar.transmit_power_watts / (distance * distance);
            (0..radar.samples).map(move |n| {
                let beat = n as f64 / radar.samples as f64 * distance / radar.range_resolution_metres();
                Complex64::from_polar(amplitude, TAU * (beat - distance / radar.wavelength_metres()))
            })
        };
        layout.x_metres.iter().flat_map(of_element).collect()
    };
    let product = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| a.conj() * b).sum::<Complex64>();
    let own = samples(range, cos);
    let power = product(&own, &own).re;
    let step = 1e-6;
    let change = |after: Vec<Complex64>, before: Vec<Complex64>| -> Vec<Complex64> {
        let change: Vec<_> = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        let along = product(&own, &change) / power;
        change.iter().zip(&own).map(|(c, o)| c - o * along).collect()
    };
    let by_range = change(samples(range + step, cos), samples(range - step, cos));
    let by_cos = change(samples(range, cos + step), samples(range, cos - step));
    // At 0 dB the noise has the mean power of a sample.
    let weight = 2.0 * own.len() as f64 / power;
    let [rr, rc, cc] =
        [(&by_range, &by_range), (&by_range, &by_cos), (&by_cos, &by_cos)].map(|(a, b)| weight * product(a, b).re);
    let determinant = rr * cc - rc * rc;
    [(cc / determinant).sqrt(), (rr / determinant).sqrt()]
}

#[test]
fn the_bound_is_that_of_the_samples_differences() {
    let radar = Radar::default();
    for layout in [Layout::two_ends(&radar), Layout::one_end(&radar, End::First), Layout::uniform(&radar)] {
        let [range_metres, cos_theta] = by_differences(&radar, &layout, 20.0, 0.3);
        let bound = alone(&layout, at(20.0, 0.3), Gains::One);
        assert!((bound.range_metres / range_metres - 1.0).abs() < 1e-3, "{bound:?}, {range_metres}");
        assert!((bound.cos_theta / cos_theta - 1.0).abs() < 1e-3, "{bound:?}, {cos_theta}");
    }
}

#[test]
fn a_gain_an_end_costs_the_phase_between_the_ends() {
    let radar = Radar::default();
    // Against figures of an independent program, given to this many digits.
    for (gains, columns, millimetres, digits) in [(Gains::One, 0.0021, 0.28, 0.04), (Gains::PerEnd, 0.126, 4.8, 0.02)] {
        let bound = alone(&Layout::two_ends(&radar), Reflector::at([5.0, 18.0], 1.0), gains);
        let found = bound.cos_theta / (2.0 / radar.elements as f64);
        assert!((found / columns - 1.0).abs() < digits, "{gains:?}: {found} columns");
        let found = bound.position_metres() * 1e3;
        assert!((found / millimetres - 1.0).abs() < digits, "{gains:?}: {found} mm");
    }
}

#[test]
fn a_gain_an_end_changes_nothing_for_one_end() {
    let radar = Radar::default();
    let layout = Layout::one_end(&radar, End::First);
    let bound = |gains| cramer_rao_of(&radar, &layout, &[at(20.0, 0.3)], 1.0, gains).unwrap()[0];
    assert_eq!(bound(Gains::One), bound(Gains::PerEnd));
}

#[test]
fn far_ahead_the_amplitude_is_as_sure_as_all_samples_together() {
    let radar = Radar::default();
    for (layout, gains) in [
        (Layout::two_ends(&radar), Gains::One),
        (Layout::two_ends(&radar), Gains::PerEnd),
        (Layout::one_end(&radar, End::First), Gains::One),
    ] {
        let bound = alone(&layout, at(1e4, 0.0), gains);
        // Kay, example 3.14: the variance of a sinusoid's amplitude is that of its samples over twice their number.
        let expected = (2.0 * (layout.len() * radar.samples) as f64).sqrt().recip();
        assert!((bound.amplitude / expected - 1.0).abs() < 1e-3, "{} {expected}", bound.amplitude);
    }
}

#[test]
fn an_unknown_place_costs_a_near_reflectors_amplitude() {
    let radar = Radar::default();
    let layout = Layout::one_end(&radar, End::First);
    let bound = alone(&layout, Reflector::at([radar.end_centre_metres(End::First), 0.05], 1.0), Gains::One);
    let alone = (2.0 * (layout.len() * radar.samples) as f64).sqrt().recip();
    assert!(bound.amplitude > 1.2 * alone, "{} {alone}", bound.amplitude);
}

#[test]
fn the_bound_scales_with_noise() {
    let radar = Radar::default();
    let layout = Layout::two_ends(&radar);
    let r = at(12.0, -0.4);
    let at_20_db = noise_variance(&radar, &layout, &r, Decibels(20.0));
    let bound = cramer_rao(&radar, &layout, &[r], at_20_db).unwrap()[0];
    assert!((alone(&layout, r, Gains::One).range_metres / bound.range_metres - 10.0).abs() < 1e-6);
    let faint = Reflector { reflectivity: 1e-20, ..r };
    let same = cramer_rao(&radar, &layout, &[faint], at_20_db * 1e-40).unwrap()[0];
    assert!((same.position_metres() / bound.position_metres() - 1.0).abs() < 1e-6);
}

#[test]
fn a_neighbour_costs_accuracy_only_when_near() {
    let radar = Radar::default();
    let layout = Layout::two_ends(&radar);
    let r = at(20.0, 0.1);
    let variance = noise_variance(&radar, &layout, &r, Decibels(0.0));
    let beside = |neighbour| cramer_rao(&radar, &layout, &[r, neighbour], variance).unwrap()[0].cos_theta;
    let alone = alone(&layout, r, Gains::One).cos_theta;
    let far = beside(at(30.0, -0.5)) / alone;
    assert!((far - 1.0).abs() < 0.01, "{far}");
    let near = beside(at(20.0, 0.1002)) / alone;
    assert!(near > 1.5, "{near}");
    assert!(beside(at(20.0, 0.1001)) / alone > near, "nearer is worse");
}

#[test]
fn what_can_not_be_told_apart_is_an_error() {
    let radar = Radar::default();
    let layout = Layout::two_ends(&radar);
    let r = at(20.0, 0.1);
    for (layout, reflectors) in [
        (&layout, vec![r, r]),
        (&Layout::at(vec![0.0]), vec![r]),
        (&Layout::at(Vec::new()), vec![r]),
        (&layout, vec![Reflector { reflectivity: 0.0, ..r }]),
    ] {
        let error = cramer_rao(&radar, layout, &reflectors, 1.0).unwrap_err();
        assert!(matches!(error, BoundsError::NotIdentifiable { .. }), "{error}");
    }
    assert_eq!(cramer_rao(&radar, &layout, &[], 1.0), Ok(Vec::new()));
    assert_eq!(cramer_rao(&radar, &layout, &[r], 0.0), Err(BoundsError::Noise));
    let beside = cramer_rao(&radar, &layout, &[at(20.0, 1.0)], 1.0).unwrap()[0];
    assert!(beside.y_metres.is_infinite() && beside.x_metres.is_finite());
}
