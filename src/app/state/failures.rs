//! State of the rows in the app: their conditions, the opened row, the rows in sight.

use super::view::MapView;
use crate::evaluate::campaign::Campaign;
use crate::evaluate::rows::Row;
use crate::evaluate::sets::{SceneCase, SceneSet};
use crate::interact::Document;
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::scene::file::SceneFile;
use crate::scene::generate::Kind;
use crate::signal::Floor;
use serde::{Deserialize, Serialize};

/// Conditions of rows: the values needed beside a row to make its scene again.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Conditions {
    pub floor: Floor,
    pub normalisation: Normalisation,
    /// Radar of generated scenes. A file has its own.
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
    /// The reason why there is none: its folder or file is gone.
    pub fn case(&self, row: &Row) -> Result<SceneCase, String> {
        let set = SceneSet::by_name(&row.set).map_err(|e| e.to_string())?;
        set.case(&self.radar, &self.campaign(row.seed).generator(), row.index).map_err(|e| e.to_string())
    }

    /// The scene of a row as a document; that of its own file where it has one.
    ///
    /// # Errors
    /// As [`Conditions::case`].
    pub fn document(&self, row: &Row) -> Result<Document, String> {
        if let Ok(SceneSet::Folder(folder)) = SceneSet::by_name(&row.set)
            && let Some(path) = folder.file(row.index)
        {
            return Document::read(path).map_err(|e| e.to_string());
        }
        let SceneCase { radar, scene } = self.case(row)?;
        // The scene can be made again, so opening many rows leaves no unsaved scenes behind.
        Ok(Document::shipped(SceneFile { scene, radar }))
    }
}

/// The methods to try and the scenes to try them on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FailureChoice {
    pub methods: Vec<&'static str>,
    pub kinds: Vec<Kind>,
    /// Whether the user's own scenes are among the sets.
    pub own: bool,
    /// Generated scenes of each kind.
    pub count: u32,
    pub seed: u64,
}

/// The row whose scene was opened last.
#[derive(Debug, Clone)]
pub struct OpenedRow {
    pub row: Row,
    pub index: usize,
    pub generation: u64,
    pub document: u64,
}

/// State of the rows in the app beside the table itself.
#[derive(Debug, Default)]
pub struct Failures {
    /// Id of a document whose failing part of the maps is to be shown once it is known.
    pub wanted: Option<u64>,
    /// Id of the document whose failing part is shown, and that part.
    pub shown: Option<(u64, MapView)>,
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
        let SceneCase { radar, scene } = conditions.case(&rows[1]).unwrap();
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
