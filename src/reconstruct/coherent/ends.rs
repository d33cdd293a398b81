//! The elements of both ends whose samples are not zero.

use crate::radar::{End, Pair, Radar};
use crate::reconstruct::profiles::Profiles;
use crate::signal::TwoEnds;
use crate::signal::simd::{LANES_F64, Lanes};
use num_complex::Complex64;

/// Rows of a range profile for each range bin: linear interpolation is then wrong by a few parts in a thousand.
const PROFILE_ROWS_PER_BIN: usize = 16;

/// Elements side by side.
const W: usize = LANES_F64;

/// Elements with samples, those of the first end first, one that is in both ends once; dead elements are missing samples.
pub(super) struct Ends {
    /// Positions, metres.
    pub x_metres: Vec<f64>,
    /// Number of the first end's elements.
    pub first_count: usize,
    /// Range profiles, one an element.
    pub profiles: Profiles,
    /// Antennas of each element.
    pub pairs: Vec<Pair>,
    /// The antennas in lanes, the last ones repeated.
    lanes: Vec<PairLanes<W>>,
}

/// Pairs of antennas, one a lane.
#[derive(Clone, Copy)]
pub(super) struct PairLanes<const W: usize> {
    transmitter_x_metres: Lanes<f64, W>,
    /// `None` where every pair is one antenna.
    receiver_x_metres: Option<Lanes<f64, W>>,
    /// y of transmitters and receivers; `None` where all stand on the array's line.
    y_metres: Option<[Lanes<f64, W>; 2]>,
}

impl<const W: usize> PairLanes<W> {
    /// The pairs `pair(0)`, `pair(1)` and so on, one a lane.
    #[inline(always)]
    pub fn new(pair: impl Fn(usize) -> Pair) -> Self {
        let pairs: [Pair; W] = std::array::from_fn(pair);
        let is_apart = !pairs.iter().all(Pair::is_one);
        PairLanes {
            transmitter_x_metres: Lanes(pairs.map(|p| p.transmitter_x_metres)),
            receiver_x_metres: is_apart.then(|| Lanes(pairs.map(|p| p.receiver_x_metres))),
            y_metres: (!pairs.iter().all(Pair::is_on_line))
                .then(|| [Lanes(pairs.map(|p| p.transmitter_y_metres)), Lanes(pairs.map(|p| p.receiver_y_metres))]),
        }
    }
}

impl Ends {
    /// The elements of `radar` whose samples in `ends` are not all zero.
    pub fn new(radar: &Radar, ends: &TwoEnds) -> Self {
        let (mut x_metres, mut pairs) = (Vec::new(), Vec::new());
        let mut channels = Vec::new();
        let mut first_count = 0;
        let mut hears = ends.hears().into_iter();
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
        let of_chunk = |pairs: &[Pair]| PairLanes::new(|i| pairs[i.min(pairs.len() - 1)]);
        let lanes = pairs.chunks(W).map(of_chunk).collect();
        Ends { profiles: Profiles::new(radar, &channels, PROFILE_ROWS_PER_BIN), x_metres, first_count, pairs, lanes }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.x_metres.len()
    }

    /// Writes into `heard` the profile of each element at a place in the centre's polar grid, without the phase of the element's distance: the
    /// profiles of a reflector there differ by the distance alone. `heard` has an entry an element.
    #[inline(always)]
    pub fn listen<const FMA: bool>(&self, range_metres: f64, cos_theta: f64, heard: &mut [Complex64]) {
        for (i, (pairs, heard)) in self.lanes.iter().zip(heard.chunks_mut(W)).enumerate() {
            let distances = distances_metres::<W, FMA>(*pairs, range_metres, Lanes::splat(cos_theta));
            self.profiles.lanes_at::<W, FMA>(i * W, distances, heard);
        }
    }
}

/// Ranges of places in the centre's polar grid for pairs of antennas, metres: half the way there and back.
#[inline(always)]
pub(super) fn distances_metres<const W: usize, const FMA: bool>(
    pairs: PairLanes<W>,
    range_metres: f64,
    cos_theta: Lanes<f64, W>,
) -> Lanes<f64, W> {
    let [out, home] = pairs.y_metres.map_or([None, None], |[out, home]| [Some(out), Some(home)]);
    let there = legs_metres::<W, FMA>(pairs.transmitter_x_metres, out, range_metres, cos_theta);
    match pairs.receiver_x_metres {
        None => there,
        Some(receivers) => {
            (there + legs_metres::<W, FMA>(receivers, home, range_metres, cos_theta)) * Lanes::splat(0.5)
        }
    }
}

/// Distances of places in the centre's polar grid from antennas, metres. Without `y` the antennas are on the array's axis.
#[inline(always)]
fn legs_metres<const W: usize, const FMA: bool>(
    x_metres: Lanes<f64, W>,
    y_metres: Option<Lanes<f64, W>>,
    range_metres: f64,
    cos_theta: Lanes<f64, W>,
) -> Lanes<f64, W> {
    let range = Lanes::splat(range_metres);
    let along = x_metres - range * cos_theta;
    // The place's distance from the axis, squared.
    let off_axis = (Lanes::splat(1.0) - cos_theta * cos_theta) * range * range;
    let off_axis = y_metres.map_or(off_axis, |y| {
        let ahead = off_axis.map(|square| square.max(0.0)).sqrt() - y;
        ahead * ahead
    });
    along.mul_add::<FMA>(along, off_axis).map(|square| square.max(1e-12)).sqrt()
}
