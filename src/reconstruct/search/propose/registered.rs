//! Both ends' beams on the polar grid of the array's centre: a reflector has different ranges and angles at the ends, so each cell looks up its
//! own range and angle at each end.

use super::end_beams::beam_of_cos;
use super::view::View;
use crate::radar::{End, Radar};

/// The places of a polar grid's cells in the beams of each end.
pub struct Registered {
    /// Centre (x, y) of every cell, metres, range after range; one wrap beyond the maximum range included.
    pub places_metres: Vec<[f64; 2]>,
    /// `[beam * range bins + range bin]` for each end.
    pub cells: [Vec<u32>; 2],
    /// Range bin of each of those cells, for each end.
    pub bins: [Vec<u32>; 2],
}

impl Registered {
    /// The table for the ends of `radar`, each with so many `beams`; the grid has so many `columns` over cos(theta).
    pub fn new(radar: &Radar, beams: usize, columns: usize) -> Self {
        let (bins, bin_metres) = (radar.samples, radar.range_resolution_metres());
        let place = |i: usize| {
            let range = (i / columns) as f64 * bin_metres;
            let cos = ((i % columns) as f64 + 0.5) / columns as f64 * 2.0 - 1.0;
            [range * cos, range * (1.0 - cos * cos).sqrt()]
        };
        let places_metres: Vec<[f64; 2]> = (0..2 * bins * columns).map(place).collect();
        let cells = End::BOTH.map(|end| {
            let view = View::of(radar, end);
            let cell = |place: &[f64; 2]| {
                let (range, cos) = view.of_place(*place, 1e-9);
                let row = (range / bin_metres).round() as usize % bins;
                (beam_of_cos(cos, beams) * bins + row) as u32
            };
            places_metres.iter().map(cell).collect()
        });
        let own = |cells: &Vec<u32>| cells.iter().map(|cell| cell % bins as u32).collect();
        Registered { places_metres, bins: cells.each_ref().map(own), cells }
    }
}
