//! The elements of both ends that have samples, and their range profiles.

use crate::radar::{End, Pair, Radar};
use crate::reconstruct::profiles::Profiles;
use crate::signal::TwoEnds;
use crate::signal::path::PairBlocks;
use crate::signal::simd::{LANES_F64 as W, Lanes};
use num_complex::Complex64;

/// Rows of a range profile for each range bin: linear interpolation is then wrong by a few parts in a thousand.
const PROFILE_ROWS_PER_BIN: usize = 16;

/// Least distance of a place from an element, metres: amplitudes are divided by it.
const MIN_DISTANCE_METRES: f64 = 1e-6;

/// Elements whose samples are not all 0, those of the first end first. An element of both ends is there once.
pub(super) struct Ends {
    pub x_metres: Vec<f64>,
    /// Number of the first end's elements.
    pub first_count: usize,
    pub profiles: Profiles,
    pub pairs: Vec<Pair>,
    /// The antennas in lanes; the last one is repeated.
    lanes: Vec<PairBlocks<W>>,
}

impl Ends {
    pub fn new(radar: &Radar, ends: &TwoEnds) -> Self {
        let (mut x_metres, mut pairs) = (Vec::new(), Vec::new());
        let mut channels = Vec::new();
        let mut first_count = 0;
        let mut hears = ends.measured_elements().into_iter();
        for end in End::BOTH {
            for (element, channel) in radar.end_range(end).zip(ends.end(end).outer_iter()) {
                let is_in_both = end == End::Last && element < radar.end_elements;
                if hears.next() == Some(true) && !is_in_both {
                    x_metres.push(radar.element_x_metres(element));
                    pairs.push(radar.pair(element));
                    channels.push(channel);
                    first_count += usize::from(end == End::First);
                }
            }
        }
        let of_chunk = |pairs: &[Pair]| PairBlocks::new(|i| pairs[i.min(pairs.len() - 1)]);
        let lanes = pairs.chunks(W).map(of_chunk).collect();
        Ends { profiles: Profiles::new(radar, &channels, PROFILE_ROWS_PER_BIN), x_metres, first_count, pairs, lanes }
    }

    pub fn len(&self) -> usize {
        self.x_metres.len()
    }

    /// Writes each element's profile at a place in the centre's polar grid into `snapshot`, `[elements]`, without the phase of its distance.
    #[inline(always)]
    pub fn fill_snapshot<const FMA: bool>(&self, range_metres: f64, cos_theta: f64, snapshot: &mut [Complex64]) {
        for (i, (pairs, snapshot)) in self.lanes.iter().zip(snapshot.chunks_mut(W)).enumerate() {
            let distances = distances_metres(*pairs, range_metres, Lanes::splat(cos_theta));
            self.profiles.lanes_at::<W, FMA>(i * W, distances, snapshot);
        }
    }
}

/// Ranges of places in the centre's polar grid for pairs of antennas, metres: half of the path from transmitter to receiver.
#[inline(always)]
pub(super) fn distances_metres<const W: usize>(
    pairs: PairBlocks<W>,
    range_metres: f64,
    cos_theta: Lanes<f64, W>,
) -> Lanes<f64, W> {
    let range = Lanes::splat(range_metres);
    let ahead = (Lanes::splat(1.0) - cos_theta * cos_theta).map(|square| square.max(0.0)).sqrt() * range;
    pairs.ranges_metres(range * cos_theta, ahead).map(|distance| distance.max(MIN_DISTANCE_METRES))
}
