//! Range and direction of a place from an end.
//!
//! For elements that transmit and receive both are from the end's middle. Where transmitters are apart from receivers, the range is that of the pairs in
//! the end's middle, and the direction follows from the difference between the ranges of the first pair and the last, as the phases do.

use crate::radar::{End, Pair, Radar};
use crate::signal::path::PairBlocks;
use crate::signal::simd::Lanes;

/// Geometry of an end.
pub struct View {
    /// x of the end's middle, metres.
    pub centre_metres: f64,
    pairs: Option<ViewOfPairs>,
}

/// Pairs that represent an end, with x from its middle.
struct ViewOfPairs {
    middle: [Pair; 2],
    first: Pair,
    last: Pair,
    /// Distance from the first element to the last.
    length_metres: f64,
}

impl View {
    pub fn of(radar: &Radar, end: End) -> View {
        let centre_metres = radar.end_centre_metres(end);
        if radar.is_monostatic() {
            return View { centre_metres, pairs: None };
        }
        let pair = |n: usize| {
            let pair = radar.pair(n);
            let [transmitter_x_metres, receiver_x_metres] =
                [pair.transmitter_x_metres, pair.receiver_x_metres].map(|x| x - centre_metres);
            Pair { transmitter_x_metres, receiver_x_metres, ..pair }
        };
        let elements = radar.end_range(end);
        let [first, last] = [elements.start, elements.end - 1];
        let middle = [(first + last) / 2, (first + last).div_ceil(2)].map(pair);
        let length_metres = radar.element_x_metres(last) - radar.element_x_metres(first);
        View { centre_metres, pairs: Some(ViewOfPairs { middle, first: pair(first), last: pair(last), length_metres }) }
    }

    /// Range of places at `dx` along the array from the end's middle and `y` ahead, all in metres.
    #[inline(always)]
    pub fn range_metres<const W: usize>(&self, dx: Lanes<f64, W>, y: Lanes<f64, W>) -> Lanes<f64, W> {
        match &self.pairs {
            None => (dx * dx + y * y).sqrt(),
            Some(ViewOfPairs { middle: [a, b], .. }) => (range_for(a, dx, y) + range_for(b, dx, y)) * Lanes::splat(0.5),
        }
    }

    /// Cosine of the direction of such places; `inverse` is the reciprocal of the range.
    #[inline(always)]
    pub fn cos_theta<const W: usize>(
        &self,
        dx: Lanes<f64, W>,
        y: Lanes<f64, W>,
        inverse: Lanes<f64, W>,
    ) -> Lanes<f64, W> {
        match &self.pairs {
            None => dx * inverse,
            Some(ViewOfPairs { first, last, length_metres, .. }) => {
                let nearer = range_for(first, dx, y) - range_for(last, dx, y);
                (nearer * Lanes::splat(length_metres.recip())).map(|cos| cos.clamp(-1.0, 1.0))
            }
        }
    }

    /// Range in metres, at least `min_metres`, and cosine of the direction of the place at (x, y), metres.
    pub fn range_and_cos(&self, [x, y]: [f64; 2], min_metres: f64) -> (f64, f64) {
        let (dx, y) = (Lanes([x - self.centre_metres]), Lanes([y]));
        let range = self.range_metres(dx, y).map(|range| range.max(min_metres));
        let cos = self.cos_theta(dx, y, range.map(f64::recip));
        (range.0[0], cos.0[0])
    }

    /// Derivatives of the range of the place at (x, y) by x and by y. Distances from antennas are at least `min_metres`.
    #[inline(always)]
    pub fn slope(&self, [x, y]: [f64; 2], min_metres: f64) -> [f64; 2] {
        let dx = x - self.centre_metres;
        let of_leg = |[antenna_x, antenna_y]: [f64; 2]| {
            let (across, ahead) = (dx - antenna_x, y - antenna_y);
            let range = (across * across + ahead * ahead).sqrt().max(min_metres);
            [across / range, ahead / range]
        };
        let Some(ViewOfPairs { middle, .. }) = &self.pairs else { return of_leg([0.0; 2]) };
        let legs = middle.iter().flat_map(Pair::places_metres).map(of_leg);
        legs.fold([0.0; 2], |sum, leg| [sum[0] + leg[0] / 4.0, sum[1] + leg[1] / 4.0])
    }
}

#[inline(always)]
fn range_for<const W: usize>(pair: &Pair, dx: Lanes<f64, W>, y: Lanes<f64, W>) -> Lanes<f64, W> {
    PairBlocks::new(|_| *pair).ranges_metres(dx, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::presets::RadarPreset;

    /// A place that is near enough for the middle of an end to be a bad stand-in for its pairs.
    const NEAR_PLACE_METRES: [f64; 2] = [0.7, 1.6];

    #[test]
    fn pairs_of_one_element_see_from_the_middle_of_their_end() {
        let radar = Radar::default();
        let view = View::of(&radar, End::Last);
        let (range, cos) = view.range_and_cos(NEAR_PLACE_METRES, 1e-3);
        let dx = NEAR_PLACE_METRES[0] - radar.end_centre_metres(End::Last);
        assert!((range - dx.hypot(NEAR_PLACE_METRES[1])).abs() < 1e-12 && (cos - dx / range).abs() < 1e-12);
    }

    #[test]
    fn pairs_see_at_the_range_of_the_pairs_in_the_middle() {
        let radar = &RadarPreset::by_id("cascade-12x16").expect("a preset").radar;
        for end in End::BOTH {
            let view = View::of(radar, end);
            let (range, cos) = view.range_and_cos(NEAR_PLACE_METRES, 1e-3);
            let of_element = |n: usize| radar.pair(n).range_metres(NEAR_PLACE_METRES[0], NEAR_PLACE_METRES[1]);
            let elements = radar.end_range(end);
            let mean = elements.clone().map(of_element).sum::<f64>() / elements.len() as f64;
            assert!((range - mean).abs() < 1e-4, "{range} m; the elements' mean is {mean} m");
            let step = (of_element(elements.start) - of_element(elements.start + 1)) / radar.element_spacing_metres;
            assert!((cos - step).abs() < 0.02, "{cos}; from one element to the next {step}");
            let from_middle = (NEAR_PLACE_METRES[0] - view.centre_metres)
                / (NEAR_PLACE_METRES[0] - view.centre_metres).hypot(NEAR_PLACE_METRES[1]);
            assert!((cos - from_middle).abs() > 0.02, "the pairs' directions count: {cos}, {from_middle}");
        }
    }

    #[test]
    fn the_slope_is_the_difference_between_ranges() {
        for radar in [&Radar::default(), &RadarPreset::by_id("cascade-12x16").expect("a preset").radar] {
            let view = View::of(radar, End::First);
            let range = |x: f64, y: f64| view.range_and_cos([x, y], 1e-3).0;
            let by = 1e-5;
            let [x, y] = NEAR_PLACE_METRES;
            let slope = view.slope(NEAR_PLACE_METRES, 1e-3);
            assert!((slope[0] - (range(x + by, y) - range(x - by, y)) / (2.0 * by)).abs() < 1e-6, "{slope:?}");
            assert!((slope[1] - (range(x, y + by) - range(x, y - by)) / (2.0 * by)).abs() < 1e-6, "{slope:?}");
        }
    }
}
