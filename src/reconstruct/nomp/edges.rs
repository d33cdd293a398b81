//! Rows of reflectors from their first alone: at the edge of a wall one reflector is heard by itself, however close the next.
//!
//! From such a point the beams of both ends tell the directions in which echoes go on. Along each of these every step that may be meant is
//! tried over the first few reflectors, and the best are followed as any row is.

use super::end_beams::beam_of_cos;
use super::phased::{BEAMS, Heard, PhasedBeams, Row};
use super::strides::{FIRST, MOST_STEP_METRES, Stride, added_up, followed, pitches_metres};
use crate::signal::simd::{Kernel, Simd};
use crate::task::Task;
use rayon::prelude::*;

/// Part of the strongest beam that echoes in the right direction have in the mean, in power and at both ends.
const LEAST_ALONG: f64 = 0.3;

/// Power of echoes, evened out over range, that go on, as a part of the point's own.
const LEAST_EVEN: f64 = 0.02;

const LONGER_TRIED: usize = 40;

/// Rows of one direction that are followed.
const KEPT: usize = 4;

/// Most directions of all points that are looked into.
const MOST_LOOKS: usize = 24;

/// Rows that begin at one of `points` (x, y; metres), best first; one for each at most.
pub fn rows_from_edges(beams: &PhasedBeams, points: &[[f64; 2]], directions: &[f64], task: &Task) -> Vec<Stride> {
    let strongest = beams.strongest();
    let mut looks: Vec<Look> = points
        .par_iter()
        .enumerate()
        .flat_map_iter(|(i, at)| looks_from(beams, &strongest, i, *at, directions))
        .collect();
    looks.sort_by(|a, b| b.score.total_cmp(&a.score));
    looks.truncate(MOST_LOOKS);
    tracing::debug!(looks = looks.len(), ?looks, "edges");
    let mut found: Vec<(usize, Stride)> = looks
        .par_iter()
        .filter(|_| !task.is_cancelled())
        .flat_map_iter(|look| {
            let rows = Simd::chosen().run(Scan { beams, look });
            rows.into_iter().filter_map(|row| Some((look.first, followed(beams, row)?)))
        })
        .collect();
    tracing::debug!(found = found.len(), "followed");
    found.sort_by(|a, b| b.1.weight.total_cmp(&a.1.weight));
    let mut taken = vec![false; points.len()];
    found.retain(|(first, _)| !std::mem::replace(&mut taken[*first], true));
    found.into_iter().map(|(_, stride)| stride).collect()
}

/// A direction in which echoes go on from a point.
#[derive(Debug, Clone, Copy)]
struct Look {
    /// Number of the point.
    first: usize,
    from_metres: [f64; 2],
    radians: f64,
    /// How well the direction is known.
    within_radians: f64,
    score: f64,
}

/// Where echoes may go on from `from`.
fn looks_from(
    beams: &PhasedBeams,
    strongest: &[Vec<f64>; 2],
    first: usize,
    from: [f64; 2],
    directions: &[f64],
) -> Vec<Look> {
    let bin_metres = beams.bin_metres();
    let own = beams.part_of_strongest(strongest, from).1;
    let look = |&radians: &f64| {
        let (sin, cos) = radians.sin_cos();
        let (mut bins, mut sum) = (0, 0.0);
        for bin in 1..=MOST_BINS {
            let d = bin as f64 * bin_metres;
            let at = [from[0] + d * cos, from[1] + d * sin];
            let (part, even) = beams.part_of_strongest(strongest, at);
            if at[1] <= 0.0 || even < LEAST_EVEN * own {
                break;
            }
            (bins, sum) = (bin, sum + part);
        }
        let part = sum / f64::from(bins.max(1));
        (bins >= LEAST_BINS && part > LEAST_ALONG).then(|| Look {
            first,
            from_metres: from,
            radians,
            within_radians: WITHIN_RADIANS,
            score: part * f64::from(bins).sqrt(),
        })
    };
    directions.iter().filter_map(look).collect()
}

/// Shortest step, metres: rows of closer reflectors are all alike.
const LEAST_STEP: f64 = 0.03;

/// Range bins over which echoes must go on.
const LEAST_BINS: u32 = 20;
const MOST_BINS: u32 = 100;
const WITHIN_RADIANS: f64 = 0.01;

/// All steps in about one direction tried over the first few reflectors.
struct Scan<'a> {
    beams: &'a PhasedBeams,
    look: &'a Look,
}

impl Kernel for Scan<'_> {
    type Output = Vec<Row>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let Look { from_metres, radians, within_radians, .. } = *self.look;
        // Turning a row by this much at its longest step is one pitch across.
        let [along, across] = pitches_metres(self.beams, from_metres, MOST_STEP_METRES);
        let range = from_metres[0].hypot(from_metres[1]).max(0.1);
        let (sin, cos) = radians.sin_cos();
        let by_sight = ((cos * from_metres[0] + sin * from_metres[1]) / range).abs();
        let by_side = (1.0 - by_sight * by_sight).max(0.0).sqrt();
        let length_pitch = (by_sight / along + by_side / across).recip();
        let turn_pitch = (by_sight / across + by_side / along).recip() / (0.5 * MOST_STEP_METRES);
        let lengths = ((MOST_STEP_METRES - LEAST_STEP) / length_pitch) as usize + 1;
        let turns = (within_radians / turn_pitch).ceil() as i32;
        let columns = (2 * turns + 1) as usize;
        let row = |at: usize| {
            let length = LEAST_STEP + (at / columns) as f64 * length_pitch;
            let (sin, cos) = (radians + f64::from((at % columns) as i32 - turns) * turn_pitch).sin_cos();
            Row { first_metres: from_metres, step_metres: [length * cos, length * sin] }
        };
        let mut parts = vec![0.0; lengths * columns];
        let mut heard = [Heard::default(); FIRST];
        for (at, part) in parts.iter_mut().enumerate() {
            let row = row(at);
            if row.place_metres((FIRST - 1) as f64)[1] <= 0.0 {
                continue;
            }
            let (mut added, mut all) = (0.0, 0.0);
            for end in 0..2 {
                self.beams.listen::<FMA>(end, &row, &mut heard);
                let (a, b) = added_up(&heard);
                (added, all) = (added + a, all + b);
            }
            *part = added / f64::max(all, f64::MIN_POSITIVE);
        }
        let is_summit = |at: usize| {
            let (i, j) = (at / columns, at % columns);
            let beside = (i.saturating_sub(1)..=(i + 1).min(lengths - 1))
                .flat_map(|k| (j.saturating_sub(1)..=(j + 1).min(columns - 1)).map(move |l| k * columns + l));
            beside.into_iter().all(|other| parts[other] <= parts[at])
        };
        let mut summits: Vec<usize> = (0..parts.len()).filter(|&at| parts[at] > 0.3 && is_summit(at)).collect();
        summits.sort_by(|a, b| parts[*b].total_cmp(&parts[*a]));
        summits.truncate(LONGER_TRIED);
        let mut heard = [Heard::default(); 2 * FIRST];
        let mut longer: Vec<(f64, Row)> = summits
            .into_iter()
            .map(|at| {
                let row = row(at);
                let (mut added, mut all) = (0.0, 0.0);
                for end in 0..2 {
                    self.beams.listen::<FMA>(end, &row, &mut heard);
                    let (a, b) = added_up(&heard);
                    (added, all) = (added + a, all + b);
                }
                (added / f64::max(all, f64::MIN_POSITIVE), row)
            })
            .collect();
        longer.sort_by(|a, b| b.0.total_cmp(&a.0));
        longer.truncate(KEPT);
        longer.into_iter().map(|(_, row)| row).collect()
    }
}

impl PhasedBeams {
    /// Power of the strongest beam of each range bin at each end.
    fn strongest(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|end| {
            let mut most = vec![0.0f64; self.bins];
            for beam in self.beams[end].chunks_exact(self.bins) {
                most.iter_mut().zip(beam).for_each(|(m, v)| *m = m.max(v.norm_sqr()));
            }
            most
        })
    }

    /// Power in the beams that look at a place, as a part of the strongest in the same range bins; the lesser of both ends'.
    fn part_of_strongest(&self, strongest: &[Vec<f64>; 2], [x, y]: [f64; 2]) -> (f64, f64) {
        let of_end = |end: usize| {
            let dx = x - self.centres_metres[end];
            let range = dx.hypot(y).max(1e-3);
            let bin = (range * self.bins_per_metre).round() as usize % self.bins;
            let power = self.beams[end][beam_of_cos(dx / range, BEAMS) * self.bins + bin].norm_sqr();
            (power / strongest[end][bin].max(f64::MIN_POSITIVE), strongest[end][bin] * range.powi(4))
        };
        let (a, b) = (of_end(0), of_end(1));
        (a.0.min(b.0), a.1.min(b.1))
    }

    fn bin_metres(&self) -> f64 {
        self.bins_per_metre.recip()
    }
}
