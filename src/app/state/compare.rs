//! Two methods on one scene: which, which maps of them, and how they are laid beside or over each other.

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
        Flip = "Flip",
        /// One of two maps left of an edge, the other right of it.
        Swipe = "Swipe",
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
    /// The two maps that flip, or that an edge parts.
    pub maps: [MapKind; 2],
    /// Which of them is on screen where they flip, 0 or 1.
    pub front: usize,
    /// Where the edge is, as a part of the map's width.
    pub edge: f32,
}

impl Default for Compare {
    fn default() -> Self {
        Compare {
            second: String::new(),
            layout: Layout::default(),
            maps: [MapKind::Output, MapKind::Second],
            front: 0,
            edge: 0.5,
        }
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
            Layout::Flip | Layout::Swipe => self.maps.to_vec(),
        }
    }

    /// Puts the other map in the place of the one on screen; the first one where none was alone there.
    pub fn flip(&mut self) {
        self.front = if self.layout == Layout::Flip { (self.front + 1) % 2 } else { 0 };
        self.layout = Layout::Flip;
    }

    /// Moves the edge to a part of the map's width.
    pub fn swipe(&mut self, edge: f32) {
        if edge.is_finite() {
            self.edge = edge.clamp(0.0, 1.0);
        }
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

    #[test]
    fn the_edge_stays_within_the_map() {
        let mut compare = Compare::default();
        for (to, edge) in [(0.25, 0.25), (1.5, 1.0), (-1.0, 0.0), (f32::NAN, 0.0)] {
            compare.swipe(to);
            assert_eq!(compare.edge, edge);
        }
    }
}
