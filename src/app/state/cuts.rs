//! Cuts pinned while the cursor moves on.

use super::panel::MapKind;
use super::view::Cursor;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Radar;
use std::sync::Arc;

/// Most pinned cuts; a new one replaces the oldest. Each keeps its maps in memory.
const MAX_PINNED_CUTS: usize = 3;

#[derive(Debug, Clone)]
pub struct CutMap {
    pub kind: MapKind,
    /// Lambda, `[range bins, columns]`.
    pub map: Arc<RangeAngleMap>,
    /// Scale from Lambda to decades of amplitude, where it is known.
    pub scale: Option<LambdaScale>,
}

#[derive(Debug, Clone)]
pub struct PinnedCut {
    pub radar: Radar,
    pub cursor: Cursor,
    pub maps: Vec<CutMap>,
}

/// Adds a cut to the pinned ones, the oldest first.
pub fn pin_cut(pins: &mut Vec<PinnedCut>, pin: PinnedCut) {
    pins.push(pin);
    pins.drain(..pins.len().saturating_sub(MAX_PINNED_CUTS));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_pin_makes_room() {
        let radar = Radar::default();
        let mut pins = Vec::new();
        for bin in 0..5 {
            let cursor = Cursor::at_cell(&radar, f64::from(bin), 700.0);
            pin_cut(&mut pins, PinnedCut { radar: radar.clone(), cursor, maps: Vec::new() });
        }
        let bins: Vec<f64> = pins.iter().map(|p| p.cursor.bin.round()).collect();
        assert_eq!(bins, [2.0, 3.0, 4.0]);
    }
}
