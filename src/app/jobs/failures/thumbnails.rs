//! Small maps of the scenes of rows, a byte per cell; only the latest are kept.

use super::table::RowKey;
use crate::app::jobs::derived::Failure;
use crate::app::jobs::rows::{Plan, RowJob, Teller};
use crate::app::state::{Conditions, Methods};
use crate::evaluate::Target;
use crate::evaluate::rows::Row;
use crate::evaluate::trial::{TimedAnswer, Trial};
use crate::maps::RangeAngleMap;
use crate::picture::in_place;
use crate::platform;
use crate::radar::{LayoutKind, Radar};
use crate::reconstruct::{Reconstructor, Request};
use crate::task::panic_message;
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};

pub const THUMBNAIL_COLUMNS: usize = 96;
pub const THUMBNAIL_ROWS: usize = 48;
/// Most thumbnails that are kept, some 5 MB.
const MAX_THUMBNAILS: usize = 512;

/// Lambda of a map scaled to 0 to 255, `[THUMBNAIL_ROWS, THUMBNAIL_COLUMNS]` row by row from the smallest range and from left to right. Each cell has the largest value of the
/// cells it covers.
pub type Bytes = Box<[u8]>;

/// The two maps of a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Thumbnail {
    pub target: Bytes,
    pub output: Bytes,
}

impl Thumbnail {
    pub fn of(trial: &Trial, answer: &TimedAnswer) -> Thumbnail {
        Thumbnail { target: shrunk(&trial.radar, &trial.target), output: shrunk(&trial.radar, &answer.found.lambda) }
    }
}

fn shrunk(radar: &Radar, map: &RangeAngleMap) -> Bytes {
    let drawn = radar.left_to_right(&map.lambda);
    let placed = in_place(radar, drawn);
    let cells = placed.as_ref().map_or(drawn, |placed| placed.view());
    let (rows, columns) = cells.dim();
    // The largest value of the covered cells, so that no point is lost.
    let mut small = vec![0.0f32; THUMBNAIL_COLUMNS * THUMBNAIL_ROWS];
    for ((row, column), lambda) in cells.indexed_iter() {
        let cell = &mut small[row * THUMBNAIL_ROWS / rows * THUMBNAIL_COLUMNS + column * THUMBNAIL_COLUMNS / columns];
        *cell = cell.max(*lambda);
    }
    // A map of fewer cells repeats some of them.
    let at = |y: usize, x: usize| (y * rows / THUMBNAIL_ROWS, x * columns / THUMBNAIL_COLUMNS);
    let few = |i: usize| {
        let (y, x) = (i / THUMBNAIL_COLUMNS, i % THUMBNAIL_COLUMNS);
        let large = small[i];
        if rows < THUMBNAIL_ROWS || columns < THUMBNAIL_COLUMNS { large.max(cells[at(y, x)]) } else { large }
    };
    (0..small.len()).map(|i| (few(i) * 255.0 + 0.5) as u8).collect()
}

/// A thumbnail, or the reason why there is none.
pub type Made = Result<Arc<Thumbnail>, String>;

/// The latest thumbnails, by table and row, with the time of their last use.
#[derive(Default)]
struct Cache {
    made: HashMap<(u64, RowKey), (Made, u64)>,
    clock: u64,
}

impl Cache {
    fn get(&mut self, key: &(u64, RowKey)) -> Option<Made> {
        self.clock += 1;
        let (made, used) = self.made.get_mut(key)?;
        *used = self.clock;
        Some(made.clone())
    }

    fn insert(&mut self, key: (u64, RowKey), made: Made) {
        self.clock += 1;
        self.made.insert(key, (made, self.clock));
        if self.made.len() > MAX_THUMBNAILS
            && let Some(oldest) = self.made.values().map(|(_, used)| *used).min()
        {
            self.made.retain(|_, (_, used)| *used > oldest);
        }
    }
}

/// The thumbnails of all tables, shared with the thread that makes them.
#[derive(Clone, Default)]
pub struct Album(Arc<Mutex<Cache>>);

impl Album {
    /// The thumbnail of a row of table `generation`, if the album has it.
    pub fn get(&self, generation: u64, row: &Row) -> Option<Made> {
        platform::lock(&self.0).get(&(generation, RowKey::of(row)))
    }

    pub fn insert(&self, generation: u64, row: &Row, made: Made) {
        platform::lock(&self.0).insert((generation, RowKey::of(row)), made);
    }
}

pub struct MissingThumbnails {
    generation: u64,
    conditions: Conditions,
    rows: Vec<(Row, Option<Arc<dyn Reconstructor>>)>,
    album: Album,
}

/// The maker of thumbnails of rows from files, one after the other.
pub struct Thumbnails {
    pub album: Album,
    pub job: RowJob<MissingThumbnails>,
    asked: Vec<RowKey>,
}

impl Thumbnails {
    /// Starts the thread, idle at first; `wake` is called from it.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> Thumbnails {
        Thumbnails { album: Album::default(), job: RowJob::start(wake), asked: Vec::new() }
    }

    /// Asks for the missing thumbnails of `rows`, unless all of them are being made.
    pub fn ask<'a>(
        &mut self,
        generation: u64,
        conditions: &Conditions,
        rows: impl Iterator<Item = &'a Row>,
        methods: &Methods,
    ) {
        let missing: Vec<&Row> = rows.filter(|row| self.album.get(generation, row).is_none()).collect();
        let keys: Vec<RowKey> = missing.iter().map(|row| RowKey::of(row)).collect();
        if keys.is_empty() || (self.job.progress().is_some() && keys.iter().all(|key| self.asked.contains(key))) {
            return;
        }
        self.job.cancel();
        let rows = missing.into_iter().map(|row| (row.clone(), methods.called(&row.method).cloned())).collect();
        let album = self.album.clone();
        self.job.begin(MissingThumbnails { generation, conditions: conditions.clone(), rows, album });
        self.asked = keys;
    }
}

/// The scene simulated last, with its row, for further rows of the scene.
type Last<'a> = Option<(&'a Row, Trial)>;

impl Plan for MissingThumbnails {
    type Row = ();
    type End = ();
    const WHAT: &'static str = "Drawing small maps";
    const ADVICE: &'static str = "Their rows stay.";

    fn run(&self, teller: &Teller<'_, ()>) -> Result<(), Failure> {
        let mut last: Last<'_> = None;
        for (row, method) in &self.rows {
            // A method that panics on one row would otherwise do so in every frame.
            let made = catch_unwind(AssertUnwindSafe(|| one(self, row, method.as_deref(), teller, &mut last)));
            if teller.task.is_cancelled() {
                return Err(Failure::Cancelled);
            }
            self.album.insert(self.generation, row, made.unwrap_or_else(|panic| Err(panic_message(panic.as_ref()))));
            teller.part(0.5);
        }
        Ok(())
    }
}

fn one<'a>(
    plan: &MissingThumbnails,
    row: &'a Row,
    method: Option<&dyn Reconstructor>,
    teller: &Teller<'_, ()>,
    last: &mut Last<'a>,
) -> Made {
    let method = method.ok_or_else(|| format!("there is no method \"{}\" here", row.method))?;
    let Conditions { floor, normalisation, .. } = plan.conditions;
    let scene = |of: &Row| (of.set.clone(), of.seed, of.index, of.layout.clone());
    let (_, trial) = match last.take().filter(|(of, _)| scene(of) == scene(row)) {
        Some(same) => last.insert(same),
        None => {
            let case = plan.conditions.case(row)?;
            let layout = row.layout.parse().ok().and_then(|layout: LayoutKind| layout.numbers(&case.radar).ok());
            let (layout, target) = (layout.as_deref(), Target::Measured);
            let trial = Trial::against(target, layout, &case.radar, &case.scene, floor, normalisation);
            let trial = trial.map_err(|e| e.to_string())?;
            last.insert((row, trial))
        }
    };
    let request = Request { noise: floor.into(), normalisation, task: teller.task.clone(), ..Request::default() };
    let answer = trial.ask(method, &request).map_err(|e| e.to_string())?;
    Ok(Arc::new(Thumbnail::of(trial, &answer)))
}

#[cfg(test)]
mod tests {
    use super::super::some_row;
    use super::*;
    use crate::radar::Convention;
    use ndarray::Array2;

    #[test]
    fn no_point_is_lost_however_large_or_small_the_map() {
        for (rows, columns) in [(512, 1024), (256, 1024), (48, 96), (32, 64), (1, 128), (50, 100)] {
            let mut lambda = Array2::zeros((rows, columns));
            lambda[[rows - 1, columns / 3]] = 1.0;
            let small = shrunk(&Radar::default(), &RangeAngleMap { lambda });
            assert_eq!(small.len(), THUMBNAIL_COLUMNS * THUMBNAIL_ROWS);
            let bright: Vec<usize> = (0..small.len()).filter(|i| small[*i] == 255).collect();
            let far =
                |i: &usize| i / THUMBNAIL_COLUMNS + THUMBNAIL_ROWS / rows.min(THUMBNAIL_ROWS) + 1 >= THUMBNAIL_ROWS;
            assert!(!bright.is_empty() && bright.iter().all(far), "{rows}, {columns}: {bright:?}");
            let is_near = |i: &usize| (i % THUMBNAIL_COLUMNS).abs_diff(THUMBNAIL_COLUMNS / 3) <= 1;
            assert!(bright.iter().any(is_near), "{rows}, {columns}: {bright:?}");
        }
    }

    #[test]
    fn left_is_left_in_a_small_map_of_either_convention() {
        for convention in Convention::ALL {
            let radar = Radar { elements: 128, ..Radar::default() }.in_convention(convention);
            let mut lambda = Array2::zeros((64, 128));
            lambda[[20, radar.column_of_cos(-0.5) as usize]] = 1.0;
            let small = shrunk(&radar, &RangeAngleMap { lambda });
            let bright = small.iter().position(|v| *v == 255).unwrap() % THUMBNAIL_COLUMNS;
            assert!(bright.abs_diff(THUMBNAIL_COLUMNS / 4) <= 1, "{convention:?}: column {bright}");
        }
    }

    #[test]
    fn ten_thousand_rows_leave_a_bounded_album() {
        let album = Album::default();
        let thumbnail = Arc::new(Thumbnail { target: Box::default(), output: Box::default() });
        for index in 0..10_000 {
            album.insert(1, &some_row(index, "live"), Ok(thumbnail.clone()));
        }
        assert!(platform::lock(&album.0).made.len() <= MAX_THUMBNAILS);
        assert!(album.get(1, &some_row(9999, "live")).is_some(), "the latest stay");
        assert!(album.get(2, &some_row(9999, "live")).is_none(), "another table's are others");
    }
}
