//! Pairs of both ends' tones. A reflector is one tone at the first end and one at the last; their two ranges give its place, and each end's
//! phases its direction, so that true pairs agree and others don't.

use super::tones::{Tone, gains_of_tones, tones};
use crate::radar::{self, End, Radar};
use crate::reconstruct::fit::Atom;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Cosines of a pair's directions, as measured and as they follow from its place, agree this well without noise.
const COS: f64 = 0.01;

/// Echoes of a pair, made equal by the 1/R^2 law, agree this well, as a logarithm.
const LOG_GAIN: f64 = 0.1;

/// A disagreement of this many times all that is allowed makes no pair.
const MOST_APART: f64 = 3.0;

/// Range bins within which the last end is searched for the prediction of the first end's direction.
const SEARCH_BINS: f64 = 2.0;

/// Standard deviations of noise that are allowed.
const DEVIATIONS: f64 = 4.0;

/// Factor of the tolerances of directions and gains where tones are hardly separated; pairs within them are guesses.
const GUESS: f64 = 6.0;

/// Guesses that one tone takes part in.
const MOST_GUESSES: usize = 2;

/// A place beyond the maximum range is not looked at where all that speaks for or against it differs by less than this, as a part of what is
/// allowed, from what does for the place within: the array is too small to see curvature there.
const ALIKE_ERRORS: f64 = 1.0;

/// Rounds in which directions and the tones of the neighbouring element are brought together, and in which the ranges of a pair of antennas become
/// those of one: each leaves a small part of the difference.
const ROUNDS: usize = 4;

/// A tone of one end.
#[derive(Debug, Clone, Copy)]
struct Heard {
    bins: f64,
    cos: f64,
    amplitude: f64,
    /// Largest error of the direction's cosine by noise.
    cos_tolerance: f64,
}

/// A point with a tone at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paired {
    pub atom: Atom,
    /// Disagreement of the ends, as a part of the tolerance: directions and gains together.
    pub apart: f64,
}

/// A tone at each end that may be one reflector.
#[derive(Debug, Clone, Copy)]
struct Pair {
    first: usize,
    last: usize,
    point: Paired,
    /// Disagreements of the directions at both ends and of the gains, as parts of their tolerances.
    disagreements: [f64; 3],
}

impl Pair {
    /// Whether the same tones support `other` as well as this pair.
    fn sounds_like(&self, other: &Self) -> bool {
        let differences = self.disagreements.iter().zip(other.disagreements).map(|(own, other)| (own - other).abs());
        self.last == other.last && differences.sum::<f64>() < ALIKE_ERRORS
    }
}

/// An end's element nearest to its middle, and the tones heard there.
struct Listener {
    x_metres: f64,
    /// Distance from this element to the next, which gives directions.
    step_metres: f64,
    /// Antennas of both, where transmitters stand apart from receivers.
    antennas: Option<[radar::Pair; 2]>,
    heard: Vec<Heard>,
}

/// A range and the cosine of a direction.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    range_metres: f64,
    cos: f64,
}

impl Listener {
    /// The place (x, y) at a range and in a direction from here, metres.
    fn place_metres(&self, range_metres: f64, cos: f64) -> [f64; 2] {
        [self.x_metres + range_metres * cos, range_metres * (1.0 - cos * cos).max(0.0).sqrt()]
    }

    /// Excess of this element's range and cosine for the place at (x, y) over those of a single antenna at the element's place.
    fn more_than_one_antenna(&self, [x, y]: [f64; 2]) -> Seen {
        let Some([own, next]) = &self.antennas else { return Seen::default() };
        let dx = x - self.x_metres;
        let alone = dx.hypot(y).max(f64::MIN_POSITIVE);
        let measured = own.range_metres(x, y);
        let cos = (measured - next.range_metres(x, y)) / self.step_metres;
        Seen { range_metres: measured - alone, cos: cos - dx / alone }
    }

    /// Range and cosine of a single antenna here, for the place that this element measures at a range and in a direction.
    fn as_one_antenna(&self, range_metres: f64, cos: f64) -> Seen {
        let measured = Seen { range_metres, cos };
        let nearer = |seen: Seen| {
            let more = self.more_than_one_antenna(self.place_metres(seen.range_metres, seen.cos.clamp(-1.0, 1.0)));
            Seen { range_metres: range_metres - more.range_metres, cos: cos - more.cos }
        };
        (0..ROUNDS).fold(measured, |seen, _| nearer(seen))
    }
}

/// Points and guesses from both ends' tones.
#[derive(Debug, Clone, Default)]
pub struct Pairs {
    /// Points, each of tones of its own, those first on which the ends agree best.
    pub points: Vec<Paired>,
    /// Places (x, y), metres, where points may be: those and others that take part in the same tones.
    pub guesses_metres: Vec<[f64; 2]>,
}

/// Points whose tones both ends hear, from samples laid out channel by channel over white noise of `noise_variance`. `None` where an end
/// hears more tones than it can tell apart, or where neighbouring elements are too far apart to tell directions.
pub fn paired_points(radar: &Radar, flat: &[Complex64], noise_variance: f64) -> Option<Pairs> {
    let listen = |end: End| {
        let at = if end == End::First { 0 } else { radar.end_elements };
        let channels: Vec<&[Complex64]> = flat.chunks_exact(radar.samples).skip(at).take(radar.end_elements).collect();
        listener(radar, end, &channels, noise_variance)
    };
    let (first, last) = rayon::join(|| listen(End::First), || listen(End::Last));
    let (first, last) = (first?, last?);
    let mut pairs: Vec<Pair> = Vec::new();
    for i in 0..first.heard.len() {
        let within = candidates(radar, &first, &last, i, 0);
        let mut beyond = candidates(radar, &first, &last, i, 1);
        beyond.retain(|far| !within.iter().any(|near| near.sounds_like(far)));
        pairs.extend(within);
        pairs.extend(beyond);
    }
    pairs.sort_by(|a, b| a.point.apart.total_cmp(&b.point.apart));
    let guesses = matched(&pairs, &first, &last, MOST_GUESSES);
    let guesses_metres = guesses.iter().map(|pair| pair.point.atom.position_metres(0.0)).collect();
    pairs.retain(|pair| pair.point.apart < MOST_APART);
    let points: Vec<Paired> = matched(&pairs, &first, &last, 1).iter().map(|pair| pair.point).collect();
    tracing::debug!(
        first = first.heard.len(),
        last = last.heard.len(),
        points = points.len(),
        guesses = guesses.len(),
        "tones"
    );
    Some(Pairs { points, guesses_metres })
}

/// The best of `pairs`, each tone in `most` of them.
fn matched(pairs: &[Pair], first: &Listener, last: &Listener, most: usize) -> Vec<Pair> {
    let (mut first_taken, mut last_taken) = (vec![0; first.heard.len()], vec![0; last.heard.len()]);
    let mut free = |pair: &&Pair| {
        let is_free = first_taken[pair.first] < most && last_taken[pair.last] < most;
        if is_free {
            first_taken[pair.first] += 1;
            last_taken[pair.last] += 1;
        }
        is_free
    };
    pairs.iter().filter(|pair| free(pair)).copied().collect()
}

/// Tones of an end's middle element, with directions from the element beside it.
fn listener(radar: &Radar, end: End, channels: &[&[Complex64]], noise_variance: f64) -> Option<Listener> {
    let middle = (radar.end_elements.max(1) - 1) / 2;
    let (own, beside) = (channels.get(middle)?, channels.get(middle + 1)?);
    let number = radar.end_range(end).start + middle;
    let x_metres = radar.element_x_metres(number);
    let step_metres = radar.element_x_metres(number + 1) - x_metres;
    let chirp_middle = (radar.samples as f64 - 1.0) / 2.0;
    let radians_per_metre = TAU
        * (radar.carrier.turns_per_wavelength() / radar.wavelength_metres()
            + chirp_middle / radar.samples as f64 / radar.range_resolution_metres());
    // Half a turn from one element to the next is what a direction may amount to.
    if (radians_per_metre * step_metres).abs() > 1.05 * TAU / 2.0 {
        return None;
    }
    let tones = tones(own, noise_variance)?;
    let gains = gains_of_tones(own, &tones);
    let mut cosines = vec![0.0f64; tones.len()];
    for _ in 0..ROUNDS {
        let nearer = |cos: &f64| step_metres * cos / radar.range_resolution_metres();
        let moved: Vec<Tone> =
            tones.iter().zip(&cosines).map(|(tone, cos)| Tone { bins: tone.bins - nearer(cos), ..*tone }).collect();
        let mut changed = 0.0f64;
        for ((cos, own), beside) in cosines.iter_mut().zip(&gains).zip(gains_of_tones(beside, &moved)) {
            let nearer_metres = -(beside * own.conj()).arg() / radians_per_metre;
            let before = std::mem::replace(cos, (nearer_metres / step_metres).clamp(-1.0, 1.0));
            changed = changed.max((*cos - before).abs());
        }
        if changed < 0.1 * COS {
            break;
        }
    }
    let deviation = (noise_variance / radar.samples as f64).sqrt() / (radians_per_metre * step_metres).abs();
    let heard = tones.iter().zip(&gains).zip(&cosines).map(|((tone, gain), cos)| Heard {
        bins: tone.bins,
        cos: *cos,
        amplitude: gain.norm(),
        cos_tolerance: COS + DEVIATIONS * deviation / gain.norm().max(f64::MIN_POSITIVE),
    });
    let antennas = (!radar.is_monostatic()).then(|| [radar.pair(number), radar.pair(number + 1)]);
    Some(Listener { x_metres, step_metres, antennas, heard: heard.collect() })
}

/// The pairs of tone `i` of the first end, if its range has wrapped this often.
fn candidates(radar: &Radar, first: &Listener, last: &Listener, i: usize, wraps: usize) -> Vec<Pair> {
    let (bins, bin_metres) = (radar.samples as f64, radar.range_resolution_metres());
    let between = last.x_metres - first.x_metres;
    let own = first.heard[i];
    let Seen { range_metres: range, cos } =
        first.as_one_antenna((own.bins + wraps as f64 * bins) * bin_metres, own.cos);
    let from_last = (range * range + between * between - 2.0 * range * cos * between).max(0.0).sqrt();
    let more = last.more_than_one_antenna(first.place_metres(range, cos));
    let predicted = (from_last + more.range_metres) / bin_metres;
    let mut pairs = Vec::new();
    for (j, other) in last.heard.iter().enumerate() {
        let off = (predicted - other.bins + bins / 2.0).rem_euclid(bins) - bins / 2.0;
        let search = SEARCH_BINS.max((own.cos_tolerance * between / bin_metres).min(6.0));
        if off.abs() > search {
            continue;
        }
        let other_range = (predicted - off) * bin_metres - more.range_metres;
        let along = (range * range - other_range * other_range + between * between) / (2.0 * between);
        let square = range * range - along * along;
        if range <= 0.0 || other_range <= 0.0 || square < 0.0 {
            continue;
        }
        let disagreements = [
            (along / range - cos) / own.cos_tolerance,
            ((along - between) / other_range - (other.cos - more.cos)) / other.cos_tolerance,
            (own.amplitude * range * range / (other.amplitude * other_range * other_range)).ln() / LOG_GAIN,
        ];
        let apart = disagreements.iter().map(|part| part.abs()).sum();
        if apart < GUESS * MOST_APART {
            let atom = Atom::Point { x_metres: first.x_metres + along, y_metres: square.sqrt() };
            pairs.push(Pair { first: i, last: j, point: Paired { atom, apart }, disagreements });
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::hearing::ends_noise_variance;
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
            let distance = |a: &Paired| {
                let [fx, fy] = a.atom.position_metres(0.0);
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
