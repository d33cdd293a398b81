//! The panels and maps of the app, by name.

use eframe::egui::Key;
use serde::{Deserialize, Serialize};

/// The place of a panel in arrangement and menus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Editing,
    Result,
    Tool,
    /// A tool for developers of the program and of methods, listed in menus where *Developer* is ticked.
    Developer,
    ViewOf(Panel),
}

/// Facts of a panel from its line of the list.
struct Facts {
    panel: Panel,
    place: Place,
    key: Option<Key>,
    title: &'static str,
    help: &'static str,
}

/// A tile of several views: its first panel; the tile's title, that panel's name among the views, and the tile's purpose.
type SharedTile = (Panel, [&'static str; 3]);

const SHARED: [SharedTile; 5] = [
    (
        Panel::Radar,
        ["Radar", "Constants", "The radar's constants, its elements as they are built, and what disturbs it"],
    ),
    (
        Panel::Cuts,
        ["Cuts", "Profiles", "Range profile and angle cut of all maps through the cursor, and their values under it"],
    ),
    (
        Panel::Chirp,
        ["Waveform", "Chirp", "The chirp sent and its echoes, the beat signal, and range against radial velocity"],
    ),
    (
        Panel::Compare,
        ["Compare", "Methods", "Two methods on this scene, or its maps with another window, floor or radar"],
    ),
    (
        Panel::Failures,
        ["Evaluate", "Rows", "Methods on many scenes: every row, the printed tables, and run time against error"],
    ),
];

/// The enum of all panels, and the facts of each.
macro_rules! ids {
    ($($(#[$meta:meta])* $name:ident $($drawn_by:ident)::+, $place:expr, $key:expr, $title:literal, $help:literal;)*) => {
        /// A panel, in a tile of its own or as one of several views of a tile.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum Panel {
            Map(MapKind),
            $(#[doc = $help] $(#[$meta])* $name,)*
        }

        const FACTS: &[Facts] = {
            use Place::*;
            &[$(Facts { panel: Panel::$name, place: $place, key: $key, title: $title, help: $help }),*]
        };
    };
}

every_panel!(ids);

impl Panel {
    /// The panel's line of the list; `None` for a map.
    fn facts(self) -> Option<&'static Facts> {
        FACTS.iter().find(|facts| facts.panel == self)
    }

    fn place(self) -> Option<Place> {
        self.facts().map(|facts| facts.place)
    }

    /// Whether the panel is a tool, closed at first.
    pub fn is_tool(self) -> bool {
        matches!(self.place(), Some(Place::Tool | Place::Developer))
    }

    /// Whether the panel is for developers of the program and of methods, listed in menus where *Developer* is ticked.
    pub fn is_developer(self) -> bool {
        self.place() == Some(Place::Developer)
    }

    /// All panels with a tile, in the order of menus.
    pub fn tiles() -> Vec<Panel> {
        Panel::all().into_iter().filter(|panel| panel.tile() == *panel).collect()
    }

    /// All panels: editing ones, then maps, then the others, the views of a tile side by side.
    pub fn all() -> Vec<Panel> {
        let listed = |is_editing: bool| {
            let chosen = FACTS.iter().filter(move |facts| (facts.place == Place::Editing) == is_editing);
            chosen.map(|facts| facts.panel)
        };
        listed(true).chain(MapKind::ALL.map(Panel::Map)).chain(listed(false)).collect()
    }

    /// The views of the panel's tile; empty where it has a tile to itself.
    pub fn views(self) -> Vec<Panel> {
        let tile = self.tile();
        let others = FACTS.iter().filter(|facts| facts.place == Place::ViewOf(tile)).map(|facts| facts.panel);
        let views: Vec<Panel> = [tile].into_iter().chain(others).collect();
        if views.len() > 1 { views } else { Vec::new() }
    }

    /// The panel whose tile shows this one.
    pub fn tile(self) -> Panel {
        match self.place() {
            Some(Place::ViewOf(tile)) => tile,
            _ => self,
        }
    }

    fn shared(self) -> Option<&'static [&'static str; 3]> {
        SHARED.iter().find(|(tile, _)| *tile == self.tile()).map(|(_, texts)| texts)
    }

    /// Title of the panel's tile.
    pub fn tile_title(self) -> &'static str {
        self.shared().map_or_else(|| self.title(), |[title, ..]| title)
    }

    /// Name of the panel among the views of its tile.
    pub fn view_title(self) -> &'static str {
        match self {
            Panel::Several => "Settings",
            _ => self.shared().filter(|_| self.tile() == self).map_or_else(|| self.title(), |[_, view, _]| view),
        }
    }

    /// Purpose of the panel's tile.
    pub fn describe_tile(self) -> &'static str {
        self.shared().map_or_else(|| self.describe(), |[.., help]| help)
    }

    /// The key that shows and hides the panel.
    pub fn key(self) -> Option<Key> {
        self.facts().and_then(|facts| facts.key)
    }

    fn texts(self) -> [&'static str; 2] {
        match (self, self.facts()) {
            (Panel::Map(kind), _) => [kind.title(), kind.describe()],
            (_, facts) => facts.map_or([""; 2], |facts| [facts.title, facts.help]),
        }
    }

    pub fn title(self) -> &'static str {
        self.texts()[0]
    }

    /// Purpose of the panel.
    pub fn describe(self) -> &'static str {
        self.texts()[1]
    }
}

/// The enum of maps, with the title and the content of each: first those with a panel of their own, in reading order.
macro_rules! map_kinds {
    ($($kind:ident, $title:literal, $help:literal;)*) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum MapKind {
            $(#[doc = $help] $kind,)*
        }

        impl MapKind {
            const KINDS: &[MapKind] = &[$(MapKind::$kind),*];

            /// Title of the map's panel.
            pub fn title(self) -> &'static str {
                match self { $(MapKind::$kind => $title,)* }
            }

            /// Content of the map in a sentence, for tooltips.
            pub fn describe(self) -> &'static str {
                match self { $(MapKind::$kind => $help,)* }
            }
        }
    };
}

map_kinds! {
    Input0, "Input 0", "The map of the elements at the left end of the array";
    Input1, "Input 1", "The map of the elements at the right end of the array";
    Target, "Target", "The map of all elements: a reconstruction aims for it";
    Output, "Output", "The chosen method's map, from the two ends";
    TargetAbove, "Target > η'", "Cells where the target exceeds η'";
    OutputAbove, "Output > η", "Cells where the output exceeds η: hits, false alarms, and what it misses of the target";
    Difference, "Difference", "Output minus target: red where the output is too bright, blue where it is too dark";
    Doubt, "Doubt", "The error that the method expects of its output: nine of ten cells are nearer to the target than this, on scenes and over \
        noise like those it was trained on";
    Unexplained, "Unexplained", "The rest of a recording, once the echoes of the reflectors laid over it are fitted and taken off";
    Second, "Second output", "The second method's map, from the two ends";
    SecondAbove, "Second output > η", "Cells where the second output exceeds its η";
    SecondDifference, "Second difference", "Second output minus target";
}

/// One of the two methods on screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MethodSlot {
    First,
    /// The second method, of the panel "Compare".
    Second,
}

impl MethodSlot {
    pub const BOTH: [MethodSlot; 2] = [MethodSlot::First, MethodSlot::Second];

    pub fn map(self) -> MapKind {
        match self {
            MethodSlot::First => MapKind::Output,
            MethodSlot::Second => MapKind::Second,
        }
    }
}

impl MapKind {
    /// All maps with a panel of their own, in reading order.
    pub const ALL: [MapKind; 9] = *MapKind::KINDS.first_chunk().expect("nine maps with a panel");

    /// The slot of the method whose output the map is made of, if any.
    pub fn slot(self) -> Option<MethodSlot> {
        match self {
            MapKind::Output | MapKind::OutputAbove | MapKind::Difference | MapKind::Doubt => Some(MethodSlot::First),
            MapKind::Second | MapKind::SecondAbove | MapKind::SecondDifference => Some(MethodSlot::Second),
            _ => None,
        }
    }

    /// Whether the map is made of a method's output.
    pub fn needs_output(self) -> bool {
        self.slot().is_some()
    }

    /// Whether the map is a difference.
    pub fn is_difference(self) -> bool {
        matches!(self, MapKind::Difference | MapKind::SecondDifference)
    }

    /// Whether the map has cells above a threshold.
    pub fn is_above(self) -> bool {
        matches!(self, MapKind::TargetAbove | MapKind::OutputAbove | MapKind::SecondAbove)
    }
}
