//! Everything that can be shown in a tile, by name.

use serde::{Deserialize, Serialize};

/// Everything that can be shown, each in a tile of its own or as one of several views of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Panel {
    /// The scene's canvas.
    Scene,
    /// Floor, display and reconstruction settings.
    Controls,
    /// The radar's constants and what follows from them.
    Radar,
    /// Numbers of the selected objects.
    Inspector,
    /// The list of objects.
    Objects,
    /// A map.
    Map(MapKind),
    /// Range profile and angle cut through the cursor.
    Cuts,
    /// Elements as they are built; a view of [`Panel::Radar`].
    Elements,
    /// An interferer and a mirror; a view of [`Panel::Radar`].
    Disturbances,
    /// What the method found, as a list.
    Found,
    /// P_D against P_FA.
    Roc,
    /// What each stage cost and what was skipped.
    Timing,
    /// Ambiguity function and Cramer-Rao bound.
    Bounds,
    /// What every element contributes to the cell under the cursor.
    Phasors,
    /// What is sent and what returns, as frequency against time, and the beat; the first view of the tile Waveform.
    Chirp,
    /// Range against radial velocity, and the time at which the scene is looked at; a view of [`Panel::Chirp`].
    RangeDoppler,
    /// Methods on the tables' test sets; a view of [`Panel::Failures`].
    Evaluation,
    /// Scenes on which methods fail, row by row; the first view of the tile Evaluate.
    Failures,
    /// Run time against error; a view of [`Panel::Failures`].
    #[serde(alias = "Front")]
    RunTime,
    /// A training watched.
    Training,
    /// What the maps show and why.
    Guide,
    /// Predict, look, change.
    Lesson,
    /// One map for several values of a constant.
    Several,
    /// Two methods on the scene on screen.
    Compare,
    /// What every map has under the pointer; a view of [`Panel::Cuts`].
    Values,
}

impl Panel {
    /// Tiles that are closed at first: each is a tool for a question of its own.
    pub const TOOLS: [Panel; 11] = [
        Panel::Guide,
        Panel::Lesson,
        Panel::Failures,
        Panel::Radar,
        Panel::Found,
        Panel::Bounds,
        Panel::Phasors,
        Panel::Chirp,
        Panel::Several,
        Panel::Compare,
        Panel::Training,
    ];

    /// Tiles for developers of the program and of methods: menus list them where *Developer* is ticked.
    pub const DEVELOPER: [Panel; 2] = [Panel::Timing, Panel::Training];

    /// Tiles that are shared by several views, each with its name and its views, the first of which stands for the tile.
    const SHARED: &'static [(&'static str, &'static [Panel])] = &[
        ("Radar", &[Panel::Radar, Panel::Elements, Panel::Disturbances]),
        ("Cuts", &[Panel::Cuts, Panel::Values]),
        ("Waveform", &[Panel::Chirp, Panel::RangeDoppler]),
        ("Evaluate", &[Panel::Failures, Panel::Evaluation, Panel::RunTime]),
    ];

    /// All panels that have a tile, in the order menus list them.
    pub fn tiles() -> Vec<Panel> {
        let mut all = vec![Panel::Scene, Panel::Controls, Panel::Inspector, Panel::Objects];
        all.extend(MapKind::ALL.map(Panel::Map));
        all.extend([Panel::Cuts, Panel::Roc, Panel::Timing]);
        all.extend(Panel::TOOLS);
        all
    }

    /// All panels, the views of a tile side by side.
    pub fn all() -> Vec<Panel> {
        let views = |tile: Panel| {
            if tile.views().is_empty() { vec![tile] } else { tile.views().to_vec() }
        };
        Panel::tiles().into_iter().flat_map(views).collect()
    }

    /// The views of the tile that this is one of; none where it has a tile to itself.
    pub fn views(self) -> &'static [Panel] {
        let shared = Panel::SHARED.iter().find(|(_, views)| views.contains(&self));
        shared.map_or(&[], |(_, views)| *views)
    }

    /// The panel whose tile shows this one.
    pub fn tile(self) -> Panel {
        self.views().first().copied().unwrap_or(self)
    }

    /// Title of its tile.
    pub fn tile_title(self) -> &'static str {
        let shared = Panel::SHARED.iter().find(|(_, views)| views.contains(&self));
        shared.map_or_else(|| self.title(), |(title, _)| *title)
    }

    /// Its name among the views of its tile.
    pub fn view_title(self) -> &'static str {
        match self {
            Panel::Radar => "Constants",
            Panel::Cuts => "Profiles",
            Panel::Failures => "Rows",
            Panel::Evaluation => "Tables",
            other => other.title(),
        }
    }

    /// What its tile is for.
    pub fn describe_tile(self) -> &'static str {
        match self.tile() {
            Panel::Radar => "The radar's constants, its elements as they are built, and what disturbs it",
            Panel::Cuts => "Range profile and angle cut of all maps through the cursor, and their values under it",
            Panel::Chirp => "What is sent and what returns, the beat, and range against radial velocity",
            Panel::Failures => "Methods on many scenes: every row, the printed tables, and run time against error",
            other => other.describe(),
        }
    }

    /// Its title.
    pub fn title(self) -> &'static str {
        match self {
            Panel::Scene => "Scene",
            Panel::Controls => "Settings",
            Panel::Radar => "Radar",
            Panel::Inspector => "Inspector",
            Panel::Objects => "Objects",
            Panel::Map(kind) => kind.title(),
            Panel::Cuts => "Cuts",
            Panel::Elements => "Elements",
            Panel::Disturbances => "Disturbances",
            Panel::Found => "Found",
            Panel::Roc => "ROC",
            Panel::Timing => "Timing",
            Panel::Bounds => "Bounds",
            Panel::Phasors => "Phasors",
            Panel::Chirp => "Chirp",
            Panel::RangeDoppler => "Range-Doppler",
            Panel::Evaluation => "Evaluation",
            Panel::Failures => "Failures",
            Panel::RunTime => "Run time",
            Panel::Training => "Training",
            Panel::Guide => "Guide",
            Panel::Lesson => "Lessons",
            Panel::Several => "Compare settings",
            Panel::Compare => "Compare",
            Panel::Values => "Values",
        }
    }

    /// What it is for.
    pub fn describe(self) -> &'static str {
        match self {
            Panel::Scene => "The reflectors before the radar; drag them",
            Panel::Controls => "Floor, display and reconstruction settings",
            Panel::Radar => "The radar's constants, and what follows from each",
            Panel::Inspector => "Numbers of what is selected",
            Panel::Objects => "The scene's objects in a list: click to select, with Ctrl or Shift several",
            Panel::Map(kind) => kind.describe(),
            Panel::Cuts => "Range profile and angle cut of all maps through the cursor",
            Panel::Elements => "Gain, phase and place of each element, dead ones, and calibration on a reflector",
            Panel::Disturbances => "An unsynchronised radar, and a wall that mirrors",
            Panel::Found => "What the method found: angle, range and strength",
            Panel::Roc => "Detection against false alarm of this scene, over every threshold",
            Panel::Timing => "What each stage of the last update cost, and what was skipped and why",
            Panel::Bounds => "How well any method could place a reflector, and what looks like it to chosen elements",
            Panel::Chirp => "Frequency against time of what is sent and what returns, the beat and its spectrum",
            Panel::RangeDoppler => {
                "Range against radial velocity of several chirps, and a timeline that plays the scene"
            }
            Panel::Phasors => "What every element contributes to the cell under the cursor, added head to tail",
            Panel::Evaluation => "Tables 4.1 to 4.3 for any method, beside the printed values",
            Panel::Failures => {
                "Every scene that methods were tried on, row by row: sort, filter, open, make worse, keep"
            }
            Panel::RunTime => "Run time against error of the simulation on this machine",
            Panel::Training => "The loss of a network while it is trained",
            Panel::Guide => "What the maps show and why, with something to try",
            Panel::Several => {
                "One map for several values of a constant: window, bandwidth, elements, spacing, SNR, method"
            }
            Panel::Compare => "Two methods on this scene: side by side, flipped in place, or parted by an edge",
            Panel::Values => "What every map has under the pointer",
            Panel::Lesson => "Questions to answer before the maps are shown, and things to bring about",
        }
    }
}

/// One of the maps on screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum MapKind {
    /// The first end's map.
    Input0,
    /// The last end's map.
    Input1,
    /// The whole array's map.
    Target,
    /// The map that the chosen method makes from the two ends.
    Output,
    /// Target > eta'.
    TargetAbove,
    /// Output > eta.
    OutputAbove,
    /// Output minus target.
    Difference,
    /// A recording minus the reflectors laid over it.
    Unexplained,
    /// How far off the method expects its output to be.
    Doubt,
    /// What the second method of the panel "Compare" makes of the two ends.
    Second,
    /// Second output > its eta.
    SecondAbove,
    /// Second output minus target.
    SecondDifference,
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

    /// Title of its panel.
    pub fn title(self) -> &'static str {
        match self {
            MapKind::Input0 => "Input 0",
            MapKind::Input1 => "Input 1",
            MapKind::Target => "Target",
            MapKind::Output => "Output",
            MapKind::TargetAbove => "Target > η'",
            MapKind::OutputAbove => "Output > η",
            MapKind::Difference => "Difference",
            MapKind::Unexplained => "Unexplained",
            MapKind::Doubt => "Doubt",
            MapKind::Second => "Second output",
            MapKind::SecondAbove => "Second output > η",
            MapKind::SecondDifference => "Second difference",
        }
    }

    /// What it shows, for tooltips.
    pub fn describe(self) -> &'static str {
        match self {
            MapKind::Input0 => "What the elements at the left end of the array see",
            MapKind::Input1 => "What the elements at the right end of the array see",
            MapKind::Target => "What all elements see: the map that a reconstruction aims for",
            MapKind::Output => "What the chosen method makes of the two ends",
            MapKind::TargetAbove => "Cells where the target exceeds η'",
            MapKind::OutputAbove => {
                "Cells where the output exceeds η: hits, false alarms, and what it misses of the target"
            }
            MapKind::Difference => "Output minus target: red where the output is too bright, blue where it is too dark",
            MapKind::Unexplained => {
                "What reflectors laid over a recording leave of it: their echoes are fitted and taken off"
            }
            MapKind::Doubt => {
                "How far off the method expects its output to be: nine of ten cells are nearer to the target than this, on scenes and over \
                 noise like those it was trained on"
            }
            MapKind::Second => "What the second method makes of the two ends",
            MapKind::SecondAbove => "Cells where the second output exceeds its η",
            MapKind::SecondDifference => "Second output minus target",
        }
    }

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
