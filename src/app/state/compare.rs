//! Settings of the comparison of two methods: their maps, side by side or flipped.

use super::panel::MapKind;
use serde::{Deserialize, Serialize};

named! {
    /// Layout of the compared maps.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum Layout {
        /// Both outputs above, their differences from the target below.
        #[default]
        Beside = "Side by side",
        /// One of two maps at a time, in the same place.
        #[serde(alias = "Swipe")]
        Flip = "Flip",
    }
}

/// Settings of the panel Compare.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Compare {
    /// Name of the second method; where empty, one other than the first is chosen.
    pub second: String,
    pub layout: Layout,
    pub maps: [MapKind; 2],
    /// Index of the flipped map on screen, 0 or 1.
    pub front: usize,
}

impl Default for Compare {
    fn default() -> Self {
        Compare { second: String::new(), layout: Layout::default(), maps: [MapKind::Output, MapKind::Second], front: 0 }
    }
}

impl Compare {
    /// The maps offered for flipping.
    pub const OFFERED: [MapKind; 9] = [
        MapKind::Input0,
        MapKind::Input1,
        MapKind::Target,
        MapKind::Output,
        MapKind::Second,
        MapKind::OutputAbove,
        MapKind::SecondAbove,
        MapKind::Difference,
        MapKind::SecondDifference,
    ];

    /// The maps to be made. They include both flipped ones, so that the other is there at once.
    pub fn maps(&self) -> Vec<MapKind> {
        match self.layout {
            Layout::Beside => {
                vec![MapKind::Output, MapKind::Second, MapKind::Difference, MapKind::SecondDifference]
            }
            Layout::Flip => self.maps.to_vec(),
        }
    }

    /// Shows the other flipped map; shows the first where the maps were side by side.
    pub fn flip(&mut self) {
        self.front = if self.layout == Layout::Flip { (self.front + 1) % 2 } else { 0 };
        self.layout = Layout::Flip;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flipping_changes_only_the_map_in_front() {
        let mut compare = Compare::default();
        compare.flip();
        let first = compare.clone();
        assert_eq!((first.layout, first.front), (Layout::Flip, 0));
        compare.flip();
        assert_eq!(compare, Compare { front: 1, ..first.clone() });
        compare.flip();
        assert_eq!(compare, first);
        assert_eq!(compare.maps(), [MapKind::Output, MapKind::Second], "both are made, whichever is in front");
    }
}
