//! Cuts pinned while the cursor moves on.

use super::panel::MapKind;
use super::view::Cursor;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Radar;
use std::sync::Arc;

/// Most pinned cuts; a new one replaces the oldest. Each keeps its maps in memory.
const PINS: usize = 3;

/// A map available for cuts.
#[derive(Debug, Clone)]
pub struct CutMap {
    /// Kind of the map.
    pub kind: MapKind,
    /// Lambda, `[range bins, columns]`.
    pub map: Arc<RangeAngleMap>,
    /// Scale from Lambda to decades of amplitude, where it is known.
    pub scale: Option<LambdaScale>,
}

/// A pinned cut with its radar, cursor and maps.
#[derive(Debug, Clone)]
pub struct PinnedCut {
    /// The radar of the maps.
    pub radar: Radar,
    /// Cursor of the cut.
    pub cursor: Cursor,
    /// The maps.
    pub maps: Vec<CutMap>,
}

/// The pinned cuts, oldest first.
#[derive(Debug, Default)]
pub struct Pins(Vec<PinnedCut>);

impl Pins {
    /// Pins a cut.
    pub fn push(&mut self, pin: PinnedCut) {
        self.0.push(pin);
        let excess = self.0.len().saturating_sub(PINS);
        self.0.drain(..excess);
    }

    /// Removes the cut of this index, if there is one.
    pub fn remove(&mut self, index: usize) {
        if index < self.0.len() {
            self.0.remove(index);
        }
    }

    /// Removes all cuts.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// All pinned cuts.
    pub fn all(&self) -> &[PinnedCut] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_pin_makes_room() {
        let radar = Radar::default();
        let mut pins = Pins::default();
        for bin in 0..5 {
            let cursor = Cursor::at_cell(&radar, f64::from(bin), 700.0);
            pins.push(PinnedCut { radar: radar.clone(), cursor, maps: Vec::new() });
        }
        pins.remove(7);
        pins.remove(0);
        let bins: Vec<f64> = pins.all().iter().map(|p| p.cursor.bin.round()).collect();
        assert_eq!(bins, [3.0, 4.0]);
    }
}
