//! Points from pairs of tones. A reflector has one tone at the first end and one at the last. Their two ranges give its place, and the phases of each end
//! its direction, which agree for true pairs only.

use super::tones::{Tone, gains_of_tones, tones};
use crate::radar::{self, End, Radar};
use crate::reconstruct::fit::Atom;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Largest error of a measured cosine of the direction without noise.
const MAX_COS_ERROR: f64 = 0.01;

/// Largest difference of the amplitudes of a pair, compensated for range by the 1/R^2 law, nepers.
const MAX_LOG_GAIN_ERROR: f64 = 0.1;

/// Largest [`Pair::disagreement`] of a point.
const MAX_DISAGREEMENT: f64 = 3.0;

/// Range bins around the first end's prediction in which the last end's tones are searched: the least, and the largest, for inexact directions.
const MIN_SEARCH_BINS: f64 = 2.0;
const MAX_SEARCH_BINS: f64 = 6.0;

/// Largest error by noise, standard deviations.
const NOISE_DEVIATIONS: f64 = 4.0;

/// Largest disagreement of a guess over that of a point: tones that are hardly resolved have large errors.
const GUESS_TOLERANCE_RATIO: f64 = 6.0;

/// Largest number of guesses with the same tone.
const MAX_GUESSES_PER_TONE: usize = 2;

/// Least difference of the disagreements of two pairs, one within the maximum range and one beyond, for the second to be a candidate. With less the array
/// is too small to measure the curvature.
const MIN_EVIDENCE_DIFFERENCE: f64 = 1.0;

/// Fixed-point iterations of a direction and of a pair of antennas; each leaves a small part of the error.
const FIXED_POINT_ROUNDS: usize = 4;

/// A tone at one end.
#[derive(Debug, Clone, Copy)]
struct EndTone {
    /// Range, range bins, wrapped.
    bins: f64,
    /// Cosine of the direction.
    cos: f64,
    amplitude: f64,
    /// Largest error of the cosine.
    cos_tolerance: f64,
}

/// A tone at each end, and the point that may have both.
#[derive(Debug, Clone, Copy)]
struct Pair {
    /// Numbers of the tones at the first and the last end.
    first: usize,
    last: usize,
    atom: Atom,
    /// Differences of the directions at both ends and of the gains, over their tolerances.
    disagreements: [f64; 3],
}

impl Pair {
    /// Sum of the magnitudes of [`Self::disagreements`].
    fn disagreement(&self) -> f64 {
        self.disagreements.iter().map(|part| part.abs()).sum()
    }

    /// Whether `other` has the same tone and nearly the same disagreements.
    fn is_equivalent(&self, other: &Self) -> bool {
        let differences = self.disagreements.iter().zip(other.disagreements).map(|(own, other)| (own - other).abs());
        self.last == other.last && differences.sum::<f64>() < MIN_EVIDENCE_DIFFERENCE
    }
}

/// The element nearest to the middle of an end, and its tones.
struct MiddleElement {
    x_metres: f64,
    /// Distance to the next element, whose phases give directions.
    step_metres: f64,
    /// Antennas of both elements, where transmitters are apart from receivers.
    antennas: Option<[radar::Pair; 2]>,
    tones: Vec<EndTone>,
}

/// A range and the cosine of a direction.
#[derive(Debug, Clone, Copy, Default)]
struct RangeCos {
    range_metres: f64,
    cos: f64,
}

impl MiddleElement {
    /// The place (x, y) at a range and in a direction from this element, metres.
    fn place_metres(&self, range_metres: f64, cos: f64) -> [f64; 2] {
        [self.x_metres + range_metres * cos, range_metres * (1.0 - cos * cos).max(0.0).sqrt()]
    }

    /// Range and cosine that this element measures for the place at (x, y), metres, minus those of a single antenna at the element's place.
    fn excess(&self, [x, y]: [f64; 2]) -> RangeCos {
        let Some([own, next]) = &self.antennas else { return RangeCos::default() };
        let dx = x - self.x_metres;
        let range = dx.hypot(y).max(f64::MIN_POSITIVE);
        let measured = own.range_metres(x, y);
        let cos = (measured - next.range_metres(x, y)) / self.step_metres;
        RangeCos { range_metres: measured - range, cos: cos - dx / range }
    }

    /// Range and cosine at a single antenna for the place at which this element measures `range_metres` and `cos`.
    fn as_one_antenna(&self, range_metres: f64, cos: f64) -> RangeCos {
        let measured = RangeCos { range_metres, cos };
        let iterate = |at: RangeCos| {
            let excess = self.excess(self.place_metres(at.range_metres, at.cos.clamp(-1.0, 1.0)));
            RangeCos { range_metres: range_metres - excess.range_metres, cos: cos - excess.cos }
        };
        (0..FIXED_POINT_ROUNDS).fold(measured, |at, _| iterate(at))
    }
}

/// Points and guesses from both ends' tones.
#[derive(Debug, Clone, Default)]
pub struct Pairs {
    /// Points, no two of which have a tone in common, the one with the least disagreement first.
    pub points: Vec<Atom>,
    /// Places (x, y), metres, of points and of further pairs.
    pub guesses_metres: Vec<[f64; 2]>,
}

/// Points with a tone at both ends, from samples channel by channel, `[channels * samples]`, over white noise of `noise_variance`. `None` where an end has
/// more tones than it can resolve, or where neighbouring elements are too far apart for a unique direction.
pub fn paired_points(radar: &Radar, flat: &[Complex64], noise_variance: f64) -> Option<Pairs> {
    let of_end = |end: End| {
        let at = if end == End::First { 0 } else { radar.end_elements };
        let channels: Vec<&[Complex64]> = flat.chunks_exact(radar.samples).skip(at).take(radar.end_elements).collect();
        middle_element(radar, end, &channels, noise_variance)
    };
    let (first, last) = rayon::join(|| of_end(End::First), || of_end(End::Last));
    let (first, last) = (first?, last?);
    let mut pairs: Vec<Pair> = Vec::new();
    for i in 0..first.tones.len() {
        let within = candidates(radar, &first, &last, i, 0);
        let mut beyond = candidates(radar, &first, &last, i, 1);
        beyond.retain(|far| !within.iter().any(|near| near.is_equivalent(far)));
        pairs.extend(within);
        pairs.extend(beyond);
    }
    pairs.sort_by(|a, b| a.disagreement().total_cmp(&b.disagreement()));
    let guesses = matched(&pairs, &first, &last, MAX_GUESSES_PER_TONE);
    let guesses_metres = guesses.iter().map(|pair| pair.atom.position_metres(0.0)).collect();
    pairs.retain(|pair| pair.disagreement() < MAX_DISAGREEMENT);
    let points: Vec<Atom> = matched(&pairs, &first, &last, 1).iter().map(|pair| pair.atom).collect();
    let [first, last] = [first, last].map(|end| end.tones.len());
    tracing::debug!(first, last, points = points.len(), guesses = guesses.len(), "tones");
    Some(Pairs { points, guesses_metres })
}

/// The best of the sorted `pairs`, each tone in `max_uses` of them at most.
fn matched(pairs: &[Pair], first: &MiddleElement, last: &MiddleElement, max_uses: usize) -> Vec<Pair> {
    let (mut first_taken, mut last_taken) = (vec![0; first.tones.len()], vec![0; last.tones.len()]);
    let mut free = |pair: &&Pair| {
        let is_free = first_taken[pair.first] < max_uses && last_taken[pair.last] < max_uses;
        if is_free {
            first_taken[pair.first] += 1;
            last_taken[pair.last] += 1;
        }
        is_free
    };
    pairs.iter().filter(|pair| free(pair)).copied().collect()
}

/// The middle element of an end with `channels`, `[elements][samples]`. Directions are by the phases of the next element.
fn middle_element(radar: &Radar, end: End, channels: &[&[Complex64]], noise_variance: f64) -> Option<MiddleElement> {
    let middle = (radar.end_elements.max(1) - 1) / 2;
    let (own, beside) = (channels.get(middle)?, channels.get(middle + 1)?);
    let number = radar.end_range(end).start + middle;
    let x_metres = radar.element_x_metres(number);
    let step_metres = radar.element_x_metres(number + 1) - x_metres;
    let chirp_middle = (radar.samples as f64 - 1.0) / 2.0;
    let radians_per_metre = TAU
        * (radar.carrier.turns_per_wavelength() / radar.wavelength_metres()
            + chirp_middle / radar.samples as f64 / radar.range_resolution_metres());
    // A direction is unique up to half a turn from one element to the next.
    if (radians_per_metre * step_metres).abs() > 1.05 * TAU / 2.0 {
        return None;
    }
    let tones = tones(own, noise_variance)?;
    let gains = gains_of_tones(own, &tones);
    let mut cosines = vec![0.0f64; tones.len()];
    for _ in 0..FIXED_POINT_ROUNDS {
        let nearer = |cos: &f64| step_metres * cos / radar.range_resolution_metres();
        let moved: Vec<Tone> =
            tones.iter().zip(&cosines).map(|(tone, cos)| Tone { bins: tone.bins - nearer(cos), ..*tone }).collect();
        let mut change = 0.0f64;
        for ((cos, own), beside) in cosines.iter_mut().zip(&gains).zip(gains_of_tones(beside, &moved)) {
            let nearer_metres = -(beside * own.conj()).arg() / radians_per_metre;
            let before = std::mem::replace(cos, (nearer_metres / step_metres).clamp(-1.0, 1.0));
            change = change.max((*cos - before).abs());
        }
        if change < 0.1 * MAX_COS_ERROR {
            break;
        }
    }
    let deviation = (noise_variance / radar.samples as f64).sqrt() / (radians_per_metre * step_metres).abs();
    let tones = tones.iter().zip(&gains).zip(&cosines).map(|((tone, gain), cos)| EndTone {
        bins: tone.bins,
        cos: *cos,
        amplitude: gain.norm(),
        cos_tolerance: MAX_COS_ERROR + NOISE_DEVIATIONS * deviation / gain.norm().max(f64::MIN_POSITIVE),
    });
    let antennas = (!radar.is_monostatic()).then(|| [radar.pair(number), radar.pair(number + 1)]);
    Some(MiddleElement { x_metres, step_metres, antennas, tones: tones.collect() })
}

/// The pairs of tone `i` of the first end, for a range beyond `wraps` maximum ranges.
fn candidates(radar: &Radar, first: &MiddleElement, last: &MiddleElement, i: usize, wraps: usize) -> Vec<Pair> {
    let (bins, bin_metres) = (radar.samples as f64, radar.range_resolution_metres());
    let between = last.x_metres - first.x_metres;
    let own = first.tones[i];
    let RangeCos { range_metres: range, cos } =
        first.as_one_antenna((own.bins + wraps as f64 * bins) * bin_metres, own.cos);
    let from_last = (range * range + between * between - 2.0 * range * cos * between).max(0.0).sqrt();
    let excess = last.excess(first.place_metres(range, cos));
    let predicted = (from_last + excess.range_metres) / bin_metres;
    let mut pairs: Vec<Pair> = Vec::new();
    for (j, other) in last.tones.iter().enumerate() {
        let error = (predicted - other.bins + bins / 2.0).rem_euclid(bins) - bins / 2.0;
        let search = MIN_SEARCH_BINS.max((own.cos_tolerance * between / bin_metres).min(MAX_SEARCH_BINS));
        if error.abs() > search {
            continue;
        }
        let other_range = (predicted - error) * bin_metres - excess.range_metres;
        let along = (range * range - other_range * other_range + between * between) / (2.0 * between);
        let square = range * range - along * along;
        if range <= 0.0 || other_range <= 0.0 || square < 0.0 {
            continue;
        }
        let disagreements = [
            (along / range - cos) / own.cos_tolerance,
            ((along - between) / other_range - (other.cos - excess.cos)) / other.cos_tolerance,
            (own.amplitude * range * range / (other.amplitude * other_range * other_range)).ln() / MAX_LOG_GAIN_ERROR,
        ];
        let atom = Atom::Point { x_metres: first.x_metres + along, y_metres: square.sqrt() };
        pairs.push(Pair { first: i, last: j, atom, disagreements });
    }
    pairs.retain(|pair| pair.disagreement() < GUESS_TOLERANCE_RATIO * MAX_DISAGREEMENT);
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::noise_model::ends_noise_variance;
    use crate::scene::Scene;
    use crate::scene::generate::{Generator, Kind, Purpose, Reading};
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_crowd_is_paired_to_rounding() {
        let radar = Radar::default();
        let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 3);
        let scene: Scene = generator.scene(Kind::Crowd, 0);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let noise = ends_noise_variance(&radar, &ends, Floor::Thesis.into());
        let found = paired_points(&radar, &ends.flat(), noise).unwrap().points;
        let near = |x: f64, y: f64| {
            let distance = |point: &Atom| {
                let [fx, fy] = point.position_metres(0.0);
                (fx - x).hypot(fy - y)
            };
            found.iter().map(distance).fold(f64::INFINITY, f64::min)
        };
        let reflectors = scene.reflectors();
        let right = reflectors.iter().filter(|r| near(r.x_metres, r.y_metres) < 1e-3).count();
        assert!(right * 10 >= reflectors.len() * 9, "{right} of {}", reflectors.len());
        assert!(found.len() <= reflectors.len() + 1, "{} for {}", found.len(), reflectors.len());
    }
}
