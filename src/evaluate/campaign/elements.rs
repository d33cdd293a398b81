//! The elements that measure the scenes of a campaign.

use crate::files::sha256;
use crate::radar::{BuiltArray, Radar, Tolerances};

/// The elements that measure the scenes of a campaign.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Elements {
    /// The elements that each scene names.
    #[default]
    OfScenes,
    /// The same elements for all scenes.
    Built(BuiltArray),
    /// Elements drawn anew for each scene with these standard deviations.
    Drawn(Tolerances),
}

impl Elements {
    /// The elements of scene `index` in place of its own, `None` for [`Elements::OfScenes`]; `seed` is that of the scenes.
    pub(super) fn of(&self, radar: &Radar, seed: u64, index: u32) -> Option<BuiltArray> {
        match self {
            Elements::OfScenes => None,
            Elements::Built(array) => Some(array.clone()),
            Elements::Drawn(tolerances) => Some(tolerances.build(radar, seed.wrapping_add(index.into()))),
        }
    }

    pub(super) fn text(&self) -> String {
        match self {
            Elements::OfScenes => String::new(),
            Elements::Built(array) => {
                let digest = sha256::of_pieces([format!("{array:?}").as_bytes()]);
                format!("built {}", sha256::short(&digest))
            }
            Elements::Drawn(Tolerances { gain, phase_degrees, position_millimetres }) => {
                format!("drawn {} dB {phase_degrees} degrees {position_millimetres} mm", gain.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;

    #[test]
    fn elements_are_drawn_anew_for_each_scene() {
        let radar = Radar { elements: 16, end_elements: 4, samples: 16, ..Radar::default() };
        let tolerances = Tolerances { gain: Decibels(0.5), phase_degrees: 5.0, position_millimetres: 0.0 };
        let drawn = Elements::Drawn(tolerances);
        assert_ne!(drawn.of(&radar, 1, 0), drawn.of(&radar, 1, 1));
        let expected = (drawn.of(&radar, 2, 0), "drawn 0.5 dB 5 degrees 0 mm".to_owned());
        assert_eq!((drawn.of(&radar, 1, 1), drawn.text()), expected);
        assert_eq!((Elements::OfScenes.of(&radar, 1, 0), Elements::OfScenes.text()), (None, String::new()));
    }
}
