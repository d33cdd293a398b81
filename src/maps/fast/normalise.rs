//! Lambda of several fast log maps at once.

use super::FastLogMap;
use crate::maps::lambda::{Normalisation, RangeAngleMap};
use crate::signal::simd::{Kernel, Simd};
use rayon::prelude::*;

const CELLS_AT_ONCE: usize = 1 << 15;

/// Writes Lambda of each log map to the other map of its pair, which has the same shape.
pub fn normalise_into(maps: Vec<(&FastLogMap, &mut RangeAngleMap)>, normalisation: Normalisation) {
    let mut parts = Vec::new();
    for (decades, map) in maps {
        let scale = decades.scale(normalisation);
        let range = (scale.peak - scale.floor) as f32;
        let (floor, slope) = (scale.floor as f32, if range > 0.0 { 1.0 / range } else { 0.0 });
        if let (Some(cells), Some(lambda)) = (decades.cells.as_slice(), map.lambda.as_slice_mut()) {
            let chunks = cells.chunks(CELLS_AT_ONCE).zip(lambda.chunks_mut(CELLS_AT_ONCE));
            parts.extend(chunks.map(|(cells, lambda)| Part { cells, lambda, floor, slope }));
        }
    }
    parts.into_par_iter().for_each(|part| Simd::chosen().run(part));
}

struct Part<'a> {
    cells: &'a [f32],
    lambda: &'a mut [f32],
    floor: f32,
    slope: f32,
}

impl Kernel for Part<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        for (cell, lambda) in self.cells.iter().zip(self.lambda) {
            *lambda = ((cell - self.floor) * self.slope).clamp(0.0, 1.0);
        }
    }
}
