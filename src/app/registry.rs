//! The list of panels. A new panel is a file in `panels` and a line here.

/// Hands the list to the macro `$with`. A line has the panel's name, the type that draws it ([`crate::app::content::Content`]), its place, its key, its title
/// and its purpose.
///
/// Places: `editing` and `result` panels have a tile at first, `tool` and `developer` panels once opened. A `view of` another panel shares its tile.
macro_rules! every_panel {
    ($with:ident) => {
        $with! {
            Scene scene::ScenePanel, editing, none, "Scene", "The reflectors before the radar; drag them";
            Controls controls::ControlsPanel, editing, F2, "Settings", "Floor, display and reconstruction settings";
            Inspector inspector::InspectorPanel, editing, F3, "Inspector", "Numbers of what is selected";
            Objects objects::ObjectsPanel, editing, none, "Objects",
                "The scene's objects in a list: click to select, with Ctrl or Shift several";
            Cuts cuts::CutsPanel, result, F4, "Cuts", "Range profile and angle cut of all maps through the cursor";
            Values values::ValuesPanel, view of Cuts, I, "Values", "The value of every map under the pointer";
            Roc roc::RocPanel, result, F6, "ROC", "Detection against false alarm of this scene, over every threshold";
            Guide guide::GuidePanel, tool, F1, "Guide", "The contents of the maps and their reasons, with something to try";
            Lesson lesson::LessonPanel, tool, F5, "Lessons",
                "Questions to answer before the maps are shown, and things to bring about";
            Failures failures::FailuresPanel, tool, E, "Failures",
                "Every scene that methods were tried on, row by row: sort, filter, open, make worse, keep";
            Evaluation evaluation::EvaluationPanel, view of Failures, F9, "Evaluation",
                "Tables 4.1 to 4.3 for any method, beside the printed values";
            #[serde(alias = "Front")]
            RunTime run_time::RunTimePanel, view of Failures, F10, "Run time",
                "Run time against error of the simulation on this machine";
            Radar radar::RadarPanel, tool, W, "Radar", "The radar's constants, and what follows from each";
            Elements elements::ElementsPanel, view of Radar, none, "Elements",
                "Gain, phase and place of each element, dead ones, and calibration on a reflector";
            Disturbances disturbances::DisturbancesPanel, view of Radar, none, "Disturbances",
                "An unsynchronised radar, and a wall that mirrors";
            Found found::FoundPanel, tool, none, "Found", "The method's detections: angle, range and strength";
            Recording recording::RecordingPanel, tool, none, "Recording",
                "How the file of a recording was read, other ways to read it, its frames, and what is doubtful";
            Bounds bounds::BoundsPanel, tool, F8, "Bounds",
                "How well any method could place a reflector, and what looks like it to chosen elements";
            Phasors phasors::PhasorsPanel, tool, A, "Phasors",
                "The contribution of each element to the cell under the cursor, added head to tail";
            Chirp chirp::ChirpPanel, tool, U, "Chirp",
                "Frequency against time of what is sent and what returns, the beat and its spectrum";
            RangeDoppler doppler::DopplerPanel, view of Chirp, Y, "Range-Doppler",
                "Range against radial velocity of several chirps, and a timeline that plays the scene";
            Compare compare::ComparePanel, tool, J, "Compare",
                "Two methods on this scene: side by side, or flipped in place";
            Several several::SeveralPanel, view of Compare, S, "Compare settings",
                "One map for several windows, bandwidths, elements, spacings, floors, noise levels, radars or methods";
            Timing timing::TimingPanel, developer, F7, "Timing",
                "The time of each stage of the last update, and the stages skipped, with the reason";
            Training training::TrainingPanel, developer, F12, "Training", "The loss of a network while it is trained";
        }
    };
}
