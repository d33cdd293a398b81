//! The elements of both ends that heard something.

use crate::radar::{End, Radar};
use crate::reconstruct::profiles::Profiles;
use crate::reconstruct::seen::seen_from;
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Rows of a range profile for each range bin: linear interpolation is then wrong by a few parts in a thousand.
const ROWS_PER_BIN: usize = 16;

/// Elements that heard something, those of the first end first; dead ones are missing samples.
pub(super) struct Ends {
    /// Positions, metres.
    pub x_metres: Vec<f64>,
    /// How many of them are the first end's.
    pub first_count: usize,
    /// Range profiles, one an element.
    pub profiles: Profiles,
}

impl Ends {
    /// The elements of `radar` whose samples in `ends` are not all zero.
    pub fn new(radar: &Radar, ends: &TwoEnds) -> Self {
        let mut x_metres = Vec::new();
        let mut channels = Vec::new();
        let mut first_count = 0;
        for end in End::BOTH {
            for (element, channel) in radar.end_range(end).zip(ends.end(end).outer_iter()) {
                if channel.iter().any(|v| v.norm_sqr() > 0.0) {
                    x_metres.push(radar.element_x_metres(element));
                    channels.push(channel);
                    first_count += usize::from(end == End::First);
                }
            }
        }
        Ends { profiles: Profiles::new(radar, &channels, ROWS_PER_BIN), x_metres, first_count }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.x_metres.len()
    }

    /// Distances of the elements from a place in the centre's polar grid, metres.
    pub fn distances_metres(&self, range_metres: f64, cos_theta: f64) -> impl Iterator<Item = f64> + '_ {
        self.x_metres.iter().map(move |x| seen_from(*x, range_metres, cos_theta).range_metres)
    }

    /// What each element heard from that place, the phase of its distance taken off: alike in every element but for the distance for
    /// a reflector there.
    pub fn heard_from(&self, range_metres: f64, cos_theta: f64) -> impl Iterator<Item = Complex64> + '_ {
        self.distances_metres(range_metres, cos_theta)
            .enumerate()
            .map(move |(channel, distance)| self.profiles.at(channel, distance))
    }
}
