//! Radars before which the objects of a kind of scenes find room.

use super::Kind;
use crate::radar::Radar;

/// A kind of scenes whose objects find no room before a radar.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("scenes of {kind} need a radar that sees {needed_metres} m far; this one sees {found_metres:.1} m")]
pub struct NoRoom {
    pub kind: Kind,
    pub needed_metres: f64,
    pub found_metres: f64,
}

impl Kind {
    /// Checks that the objects of the kind's scenes have room before `radar`.
    /// # Errors
    /// [`NoRoom`] names the kind and both ranges.
    pub fn check_room(self, radar: &Radar) -> Result<(), NoRoom> {
        self.check_room_within(radar.max_range_metres())
    }

    /// [`Kind::check_room`] before every radar that sees this far.
    /// # Errors
    /// As [`Kind::check_room`].
    pub fn check_room_within(self, found_metres: f64) -> Result<(), NoRoom> {
        let needed_metres = self.needed_range_metres();
        if needed_metres > found_metres {
            return Err(NoRoom { kind: self, needed_metres, found_metres });
        }
        Ok(())
    }
}
