//! Rows of an evaluation as the app holds them: how they were made, which is open, which are in sight.

use super::view::MapView;
use crate::evaluate::campaign::Campaign;
use crate::evaluate::rows::Row;
use crate::evaluate::sets::{Case, SceneSet};
use crate::evaluate::worsen::{Aim, WorseningMeasure};
use crate::interact::Document;
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::scene::file::SceneFile;
use crate::scene::generate::Kind;
use crate::signal::Floor;
use serde::{Deserialize, Serialize};

/// Whether maps are to show where the method fails, and whether they do.
#[derive(Debug, Clone, Copy, Default)]
pub struct FailureView {
    /// Of this document, once it is known.
    pub wanted: Option<u64>,
    /// Of this document, and the part that is shown.
    pub shown: Option<(u64, MapView)>,
}

/// How rows were made: what a scene needs beside its row to be made again.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Conditions {
    /// What lay beneath the reflectors.
    pub floor: Floor,
    /// How maps were normalised.
    pub normalisation: Normalisation,
    /// The radar of generated scenes; a file says itself which it is for.
    pub radar: Radar,
}

impl Conditions {
    /// The campaign that makes scenes of `seed`.
    pub fn campaign(&self, seed: u64) -> Campaign {
        let Conditions { floor, normalisation, ref radar } = *self;
        Campaign { radar: radar.clone(), seed, floor, normalisation, ..Campaign::default() }
    }

    /// The scene of a row, and its radar.
    ///
    /// # Errors
    /// Why it can't be had any more: its folder or file is gone.
    pub fn case(&self, row: &Row) -> Result<Case, String> {
        let set = SceneSet::by_name(&row.set).map_err(|e| e.to_string())?;
        set.case(&self.radar, &self.campaign(row.seed).generator(), row.index).map_err(|e| e.to_string())
    }

    /// The scene of a row as a document: its own file's where it has one.
    ///
    /// # Errors
    /// As [`Conditions::case`].
    pub fn document(&self, row: &Row) -> Result<Document, String> {
        if let Ok(SceneSet::Folder(folder)) = SceneSet::by_name(&row.set)
            && let Some(path) = folder.file(row.index)
        {
            return Document::read(path).map_err(|e| e.to_string());
        }
        let Case { radar, scene } = self.case(row)?;
        // It can be had again as easily, so that walking through rows leaves no unsaved scenes behind.
        Ok(Document::shipped(SceneFile { scene, radar }))
    }
}

/// Which methods are to be tried, and on which scenes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FailureChoice {
    /// Names of methods.
    pub methods: Vec<&'static str>,
    /// Kinds of generated scenes.
    pub kinds: Vec<Kind>,
    /// Whether the folder of one's own scenes is among the sets.
    pub own: bool,
    /// Generated scenes of each kind.
    pub count: u32,
    /// Their seed.
    pub seed: u64,
}

/// What is to be looked for near the scene on screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchChoice {
    /// Worse scenes, or a repair.
    pub aim: Aim,
    /// What worse means.
    pub measure: WorseningMeasure,
    /// How far objects may move, metres.
    pub within_metres: f64,
    /// Scenes to try.
    pub tries: u32,
}

/// The row whose scene was put on screen last.
#[derive(Debug, Clone)]
pub struct OpenedRow {
    /// The row as it was.
    pub row: Row,
    /// Its index in the table.
    pub index: usize,
    /// The table that it stands in.
    pub generation: u64,
    /// The document that its scene became.
    pub document: u64,
}

/// What the app knows of rows beside the rows themselves.
#[derive(Debug, Default)]
pub struct Failures {
    /// The part of the maps in which the scene's method fails.
    pub view: FailureView,
    /// The row whose scene was put on screen last.
    pub opened: Option<OpenedRow>,
    /// Indices of the rows that the panel showed last, from top to bottom.
    pub in_sight: Vec<usize>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::{Baseline, Request};
    use crate::task::Task;

    #[test]
    fn the_scene_of_a_row_gives_its_figures_again() {
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let conditions = Conditions { floor: Floor::Exact, radar, ..Conditions::default() };
        let campaign = Campaign { count: 2, ..conditions.campaign(5) };
        let sets = [SceneSet::Generated(Kind::Set2)];
        let rows = campaign.run(&sets, &[&Baseline], &Task::default(), |_| ()).unwrap();
        let Case { radar, scene } = conditions.case(&rows[1]).unwrap();
        let (floor, normalisation) = (conditions.floor, conditions.normalisation);
        let trial = crate::evaluate::trial::Trial::new(&radar, &scene, floor, normalisation).unwrap();
        let request = Request { noise: floor.into(), normalisation, ..Request::default() };
        let answer = trial.ask(&Baseline, &request).unwrap();
        assert_eq!(answer.metrics.squared_error, rows[1].squared_error);
        assert_eq!(**conditions.document(&rows[1]).unwrap().scene(), scene);
        let gone = Row { set: "no such folder".into(), ..rows[0].clone() };
        assert!(conditions.document(&gone).unwrap_err().contains("no such folder"));
    }
}
