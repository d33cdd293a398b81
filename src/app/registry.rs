//! The list of panels. A new panel is a file in `panels` and a line here.

/// Hands the list to the macro `$with`. A line has the panel's name, its content ([`crate::app::content::Content`]), its place, its key, its title
/// and its purpose.
///
/// Places: `Editing` and `Result` panels have a tile at first, `Tool` and `Developer` panels once opened. A `ViewOf` another panel shares its tile.
macro_rules! every_panel {
    ($with:ident) => {
        $with! {
            Scene scene::PANEL, Editing, None, "Scene", "The reflectors before the radar; drag them";
            Controls controls::PANEL, Editing, Some(Key::F2), "Settings",
                "Floor, display and reconstruction settings";
            Inspector inspector::PANEL, Editing, Some(Key::F3), "Inspector", "Numbers of what is selected";
            Objects objects::PANEL, Editing, None, "Objects",
                "The scene's objects in a list: click to select, with Ctrl or Shift several";
            Cuts cuts::PANEL, Result, Some(Key::F4), "Cuts",
                "Range profile and angle cut of all maps through the cursor";
            Values values::PANEL, ViewOf(Panel::Cuts), Some(Key::I), "Values",
                "The value of every map under the pointer";
            Roc roc::PANEL, Result, Some(Key::F6), "ROC",
                "Detection against false alarm of this scene, over every threshold";
            Guide guide::PANEL, Tool, Some(Key::F1), "Guide",
                "The contents of the maps and their reasons, with something to try";
            Lesson lesson::PANEL, Tool, Some(Key::F5), "Lessons",
                "Questions to answer before the maps are shown, and challenges to meet in a scene";
            Failures failures::PANEL, Tool, Some(Key::E), "Failures",
                "Every scene that methods were tried on, row by row: sort, filter, open, make worse, keep";
            Evaluation evaluation::PANEL, ViewOf(Panel::Failures), Some(Key::F9), "Evaluation",
                "Tables 4.1 to 4.3 for any method, beside the printed values";
            #[serde(alias = "Front")]
            RunTime run_time::PANEL, ViewOf(Panel::Failures), Some(Key::F10), "Run time",
                "Run time against error of the simulation on this machine";
            Radar radar::PANEL, Tool, Some(Key::W), "Radar", "The radar's constants, and what follows from each";
            Elements elements::PANEL, ViewOf(Panel::Radar), None, "Elements",
                "Gain, phase and place of each element, dead ones, and calibration on a reflector";
            Disturbances disturbances::PANEL, ViewOf(Panel::Radar), None, "Disturbances",
                "An unsynchronised radar, and a wall that mirrors";
            Found found::PANEL, Tool, None, "Found", "The method's detections: angle, range and strength";
            Recording recording::PANEL, Tool, None, "Recording",
                "How the file of a recording was read, other ways to read it, its frames, and the doubts";
            Bounds bounds::PANEL, Tool, Some(Key::F8), "Bounds",
                "The least error with which any method could place a reflector, and the places that chosen elements confuse with it";
            Phasors phasors::PANEL, Tool, Some(Key::A), "Phasors",
                "The contribution of each element to the cell under the cursor, added head to tail";
            Chirp chirp::PANEL, Tool, Some(Key::U), "Chirp",
                "Frequency against time of what is sent and what returns, the beat and its spectrum";
            RangeDoppler doppler::PANEL, ViewOf(Panel::Chirp), Some(Key::Y), "Range-Doppler",
                "Range against radial velocity of several chirps, and a timeline that plays the scene";
            Compare compare::PANEL, Tool, Some(Key::J), "Compare",
                "Two methods on this scene: side by side, or flipped in place";
            Several several::PANEL, ViewOf(Panel::Compare), Some(Key::S), "Compare settings",
                "One map for several windows, bandwidths, elements, spacings, floors, noise levels, radars or methods";
            Timing timing::PANEL, Developer, Some(Key::F7), "Timing",
                "The time of each stage of the last update, and the stages skipped, with the reason";
            Training training::PANEL, Developer, Some(Key::F12), "Training",
                "The loss of a network while it is trained";
        }
    };
}
