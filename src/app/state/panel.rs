//! Everything that can be shown in a tile, by name.

use eframe::egui::Key;
use serde::{Deserialize, Serialize};

/// Where a panel stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// It edits, and has a tile at first.
    Editing,
    /// It shows what came of the scene, and has a tile at first.
    Result,
    /// It is a tool for a question of its own: closed at first.
    Tool,
    /// It is for developers of the program and of methods: menus list it where *Developer* is ticked.
    Developer,
    /// It shares the tile of another.
    ViewOf(Panel),
}

/// What is known of a panel without drawing it.
struct Facts {
    panel: Panel,
    place: Place,
    key: Option<Key>,
    title: &'static str,
    help: &'static str,
}

/// A tile of several views: the panel that stands for it, its title, that panel's name among the views, and what the tile is for.
struct SharedTile {
    tile: Panel,
    title: &'static str,
    view: &'static str,
    help: &'static str,
}

const SHARED: [SharedTile; 5] = [
    SharedTile {
        tile: Panel::Radar,
        title: "Radar",
        view: "Constants",
        help: "The radar's constants, its elements as they are built, and what disturbs it",
    },
    SharedTile {
        tile: Panel::Cuts,
        title: "Cuts",
        view: "Profiles",
        help: "Range profile and angle cut of all maps through the cursor, and their values under it",
    },
    SharedTile {
        tile: Panel::Chirp,
        title: "Waveform",
        view: "Chirp",
        help: "The chirp sent and its echoes, the beat signal, and range against radial velocity",
    },
    SharedTile {
        tile: Panel::Compare,
        title: "Compare",
        view: "Methods",
        help: "Two methods on this scene, or its maps with another window, floor or radar",
    },
    SharedTile {
        tile: Panel::Failures,
        title: "Evaluate",
        view: "Rows",
        help: "Methods on many scenes: every row, the printed tables, and run time against error",
    },
];

/// What a line of the list says of its place and its key.
macro_rules! listed_as {
    (editing) => {
        Place::Editing
    };
    (result) => {
        Place::Result
    };
    (tool) => {
        Place::Tool
    };
    (developer) => {
        Place::Developer
    };
    (view $tile:ident) => {
        Place::ViewOf(Panel::$tile)
    };
    (key none) => {
        None
    };
    (key $key:ident) => {
        Some(Key::$key)
    };
}

/// The names of all panels, and what is known of each.
macro_rules! ids {
    ($($(#[$meta:meta])* $name:ident $($drawn_by:ident)::+, $place:ident $(of $tile:ident)?, $key:ident, $title:literal, $help:literal;)*) => {
        /// Everything that can be shown, each in a tile of its own or as one of several views of a tile.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum Panel {
            /// A map.
            Map(MapKind),
            $(#[doc = $help] $(#[$meta])* $name,)*
        }

        const FACTS: &[Facts] = &[$(Facts {
            panel: Panel::$name,
            place: listed_as!($place $($tile)?),
            key: listed_as!(key $key),
            title: $title,
            help: $help,
        }),*];
    };
}

every_panel!(ids);

impl Panel {
    /// What the list says of it; nothing of maps.
    fn facts(self) -> Option<&'static Facts> {
        FACTS.iter().find(|facts| facts.panel == self)
    }

    fn place(self) -> Option<Place> {
        self.facts().map(|facts| facts.place)
    }

    /// Whether it is a tool for a question of its own, which is closed at first.
    pub fn is_tool(self) -> bool {
        matches!(self.place(), Some(Place::Tool | Place::Developer))
    }

    /// Whether it is for developers of the program and of methods: menus list it where *Developer* is ticked.
    pub fn is_developer(self) -> bool {
        self.place() == Some(Place::Developer)
    }

    /// All panels that have a tile, in the order menus list them.
    pub fn tiles() -> Vec<Panel> {
        Panel::all().into_iter().filter(|panel| panel.tile() == *panel).collect()
    }

    /// All panels, the views of a tile side by side, the maps behind what edits.
    pub fn all() -> Vec<Panel> {
        let listed = |is_editing: bool| {
            let chosen = FACTS.iter().filter(move |facts| (facts.place == Place::Editing) == is_editing);
            chosen.map(|facts| facts.panel)
        };
        listed(true).chain(MapKind::ALL.map(Panel::Map)).chain(listed(false)).collect()
    }

    /// The views of the tile that this is one of; none where it has a tile to itself.
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

    fn shared(self) -> Option<&'static SharedTile> {
        SHARED.iter().find(|shared| shared.tile == self.tile())
    }

    /// Title of its tile.
    pub fn tile_title(self) -> &'static str {
        self.shared().map_or_else(|| self.title(), |shared| shared.title)
    }

    /// Its name among the views of its tile.
    pub fn view_title(self) -> &'static str {
        match self {
            Panel::Several => "Settings",
            _ => self.shared().filter(|shared| shared.tile == self).map_or_else(|| self.title(), |shared| shared.view),
        }
    }

    /// What its tile is for.
    pub fn describe_tile(self) -> &'static str {
        self.shared().map_or_else(|| self.describe(), |shared| shared.help)
    }

    /// The key that shows and hides it.
    pub fn key(self) -> Option<Key> {
        self.facts().and_then(|facts| facts.key)
    }

    /// Its title.
    pub fn title(self) -> &'static str {
        match (self, self.facts()) {
            (Panel::Map(kind), _) => kind.title(),
            (_, facts) => facts.map_or("", |facts| facts.title),
        }
    }

    /// What it is for.
    pub fn describe(self) -> &'static str {
        match (self, self.facts()) {
            (Panel::Map(kind), _) => kind.describe(),
            (_, facts) => facts.map_or("", |facts| facts.help),
        }
    }
}

/// The maps on screen: the name of each, its title, and what it shows.
macro_rules! map_kinds {
    ($($kind:ident, $title:literal, $help:literal;)*) => {
        /// One of the maps on screen.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum MapKind {
            $(#[doc = $help] $kind,)*
        }

        impl MapKind {
            /// Title of its panel.
            pub fn title(self) -> &'static str {
                match self { $(MapKind::$kind => $title,)* }
            }

            /// What it shows, for tooltips.
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
    Unexplained, "Unexplained", "The rest of a recording, once the echoes of the reflectors laid over it are fitted and taken off";
    Doubt, "Doubt", "How far off the method expects its output to be: nine of ten cells are nearer to the target than this, on scenes and over \
        noise like those it was trained on";
    Second, "Second output", "The second method's map, from the two ends";
    SecondAbove, "Second output > η", "Cells where the second output exceeds its η";
    SecondDifference, "Second difference", "Second output minus target";
}

/// Which of the two methods on screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MethodSlot {
    /// The one that was chosen for the whole window.
    First,
    /// The one that the panel "Compare" sets beside it.
    Second,
}

impl MethodSlot {
    /// Both.
    pub const BOTH: [MethodSlot; 2] = [MethodSlot::First, MethodSlot::Second];

    /// The map that its method makes.
    pub fn map(self) -> MapKind {
        match self {
            MethodSlot::First => MapKind::Output,
            MethodSlot::Second => MapKind::Second,
        }
    }
}

impl MapKind {
    /// All that have a panel of their own, in reading order.
    pub const ALL: [MapKind; 9] = [
        MapKind::Input0,
        MapKind::Input1,
        MapKind::Target,
        MapKind::Output,
        MapKind::TargetAbove,
        MapKind::OutputAbove,
        MapKind::Difference,
        MapKind::Doubt,
        MapKind::Unexplained,
    ];

    /// The method of whose output it is made, if it is made of one.
    pub fn slot(self) -> Option<MethodSlot> {
        match self {
            MapKind::Output | MapKind::OutputAbove | MapKind::Difference | MapKind::Doubt => Some(MethodSlot::First),
            MapKind::Second | MapKind::SecondAbove | MapKind::SecondDifference => Some(MethodSlot::Second),
            _ => None,
        }
    }

    /// Whether it is made of a method's output.
    pub fn needs_output(self) -> bool {
        self.slot().is_some()
    }

    /// Whether it shows a difference.
    pub fn is_difference(self) -> bool {
        matches!(self, MapKind::Difference | MapKind::SecondDifference)
    }

    /// Whether it shows cells above a threshold.
    pub fn is_above(self) -> bool {
        matches!(self, MapKind::TargetAbove | MapKind::OutputAbove | MapKind::SecondAbove)
    }
}
