//! Two methods on one scene: which, which maps of them, and how they are laid beside each other or flipped.

use super::panel::MapKind;
use serde::{Deserialize, Serialize};

named! {
    /// How the maps are laid out.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum Layout {
        /// Both outputs above, their differences from the target below.
        #[default]
        Beside = "Side by side",
        /// One of two maps, in the same place as the other.
        #[serde(alias = "Swipe")]
        Flip = "Flip",
    }
}

/// What is compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Compare {
    /// Name of the second method; another than the first where empty.
    pub second: String,
    /// How the maps are laid out.
    pub layout: Layout,
    /// The two maps that flip.
    pub maps: [MapKind; 2],
    /// Which of them is on screen where they flip, 0 or 1.
    pub front: usize,
}

impl Default for Compare {
    fn default() -> Self {
        Compare { second: String::new(), layout: Layout::default(), maps: [MapKind::Output, MapKind::Second], front: 0 }
    }
}

impl Compare {
    /// The maps that may flip.
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

    /// The maps that are looked at. Those that flip are both among them, so that the other is there at once.
    pub fn maps(&self) -> Vec<MapKind> {
        match self.layout {
            Layout::Beside => {
                vec![MapKind::Output, MapKind::Second, MapKind::Difference, MapKind::SecondDifference]
            }
            Layout::Flip => self.maps.to_vec(),
        }
    }

    /// Puts the other map in the place of the one on screen; the first one where none was alone there.
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
