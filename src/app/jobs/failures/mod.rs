//! Methods on many scenes, row by row, in the background; the rows from start to start; their thumbnails; the search near one of them.

mod keep;
mod search;
mod store;
mod table;
mod thumbnails;

pub use keep::keep;
pub use store::{is_table_of_rows, write as write_rows_to};
pub use table::RowTable;
#[cfg(test)]
pub use table::some_row;
pub use thumbnails::{Album, HEIGHT as THUMBNAIL_HEIGHT, Thumbnail, WIDTH as THUMBNAIL_WIDTH};

use super::rows::{Plan, RowJob, Stopped, Teller};
use crate::app::state::{Conditions, State};
use crate::evaluate::campaign::{Campaign, Unfit};
use crate::evaluate::rows::{FORMAT, Row, WHY_NO_OTHER_FORMAT};
use crate::evaluate::sets::SceneSet;
use crate::platform::{self, Instant, fs};
use crate::radar::ranges;
use crate::reconstruct::Reconstructor;
use crate::signal::Floor;
use eframe::egui::Context;
use search::Search;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use store::{Done, Store};
use thumbnails::Thumbnails;

/// While rows come, those there are go to disk so often.
const SAVE_INTERVAL: Duration = Duration::from_secs(10);

/// Name of the file that rows are kept in from start to start.
const FILE: &str = "failures.csv";

/// What is to be tried.
pub struct FailuresPlan {
    /// Radar, floor, scenes.
    pub campaign: Campaign,
    pub sets: Vec<SceneSet>,
    pub methods: Vec<Arc<dyn Reconstructor>>,
}

impl FailuresPlan {
    fn maps(&self) -> usize {
        let scenes: u32 = self.sets.iter().map(|set| self.campaign.scenes(set)).sum();
        scenes as usize * self.methods.len()
    }
}

/// A plan, the table that its rows go to, and the album of their small maps.
struct Run {
    plan: FailuresPlan,
    generation: u64,
    album: Album,
}

impl Plan for Run {
    type Row = (u64, Row);
    type End = Vec<Unfit>;
    const THREAD: &'static str = "failures";
    const WHAT: &'static str = "Trying methods";
    const ADVICE: &'static str = "Leave the method out, or try another seed.";

    fn run(&self, teller: &Teller<'_, (u64, Row)>) -> Result<Vec<Unfit>, Stopped> {
        let Run { plan, generation, album } = self;
        let methods: Vec<&dyn Reconstructor> = plan.methods.iter().map(AsRef::as_ref).collect();
        let (mut done, total) = (0, plan.maps().max(1));
        let found = plan.campaign.run_fit(&plan.sets, &methods, teller.task, |row, trial, answer| {
            album.insert(*generation, row, Ok(Arc::new(Thumbnail::of(trial, answer))));
            done += 1;
            teller.task.set_progress(done as f32 / total as f32);
            teller.row((*generation, row.clone()));
        });
        match found {
            Ok((_, unfit)) => Ok(unfit),
            Err(error) if error.is_cancelled() => Err(Stopped::Cancelled),
            Err(error) => Err(Stopped::Failed(error.to_string())),
        }
    }
}

/// The rows there are, and the threads that make more.
pub struct Failures {
    run: RowJob<Run>,
    table: RowTable,
    /// The rows that others took the place of last.
    before: Option<(Arc<Vec<Row>>, Conditions)>,
    thumbnails: Thumbnails,
    store: Store,
    /// The search near the scene on screen.
    pub search: Search,
    /// The app's own file, if it keeps any.
    file: Option<PathBuf>,
    /// What of the table is in that file.
    kept: u64,
    written: Option<Instant>,
}

impl Failures {
    /// Starts the threads and reads what the last session left in `folder`; `ctx` draws another frame.
    pub fn start(folder: Option<&Path>, ctx: &Context) -> Failures {
        let wake = platform::waker(ctx);
        let thumbnails = Thumbnails::start(wake.clone());
        let run = RowJob::start(wake.clone());
        let store = Store::new(ctx.clone());
        let file = folder.map(|folder| folder.join(FILE));
        if let Some(file) = file.as_ref().filter(|file| fs::exists(file)) {
            store.read(file.clone(), true);
        }
        let search = Search::start(wake);
        let table = RowTable::default();
        Failures { run, table, before: None, thumbnails, store, search, file, kept: 0, written: None }
    }

    /// Tries what `plan` says. Rows made under the same conditions stay; others, and those of an older format, make room, as figures don't
    /// compare.
    pub fn begin(&mut self, plan: FailuresPlan) {
        let Campaign { floor, normalisation, ref radar, .. } = plan.campaign;
        let conditions = Conditions { floor, normalisation, radar: radar.clone() };
        self.take_in_rows();
        let layout = plan.campaign.layout.as_deref().map(ranges).unwrap_or_default();
        if *self.table.conditions() != conditions || !self.table.is_of_this_format() || !self.table.hears(&layout) {
            self.replace(Vec::new(), conditions);
        }
        self.thumbnails.stop();
        let album = self.thumbnails.album.clone();
        self.run.begin(Run { plan, generation: self.table.generation(), album });
    }

    /// Stops after the map that is being made; the rows stay.
    pub fn cancel(&mut self) {
        self.run.cancel();
    }

    /// Forgets every row.
    pub fn clear(&mut self) {
        self.run.cancel();
        self.take_in_rows();
        self.replace(Vec::new(), self.table.conditions().clone());
    }

    /// Puts other rows in the place of all, which [`Failures::bring_back`] brings back.
    fn replace(&mut self, rows: Vec<Row>, conditions: Conditions) {
        if !self.table.rows().is_empty() {
            self.before = Some((self.table.rows().clone(), self.table.conditions().clone()));
        }
        self.table.replace(rows, conditions);
    }

    /// How many rows there were before others took their place.
    pub fn before(&self) -> Option<usize> {
        self.before.as_ref().map(|(rows, _)| rows.len())
    }

    /// Brings them back.
    pub fn bring_back(&mut self) {
        self.run.cancel();
        if let Some((rows, conditions)) = self.before.take() {
            self.replace(Arc::unwrap_or_clone(rows), conditions);
        }
    }

    /// Reads the rows of a file; they take the place of all as soon as they are read.
    pub fn open(&mut self, path: PathBuf) {
        self.run.cancel();
        self.store.read(path, false);
    }

    /// The rows.
    pub fn table(&self) -> &RowTable {
        &self.table
    }

    /// The part that is done, while methods are tried.
    pub fn progress(&self) -> Option<f32> {
        self.run.progress()
    }

    /// Methods that the last run went on without, and on which scenes.
    pub fn unfit(&self) -> &[Unfit] {
        self.run.end().map_or(&[], Vec::as_slice)
    }

    /// How the last run ended, if not well.
    pub fn note(&self) -> Option<&str> {
        self.run.note()
    }

    /// Small maps of rows.
    pub fn album(&self) -> &Album {
        &self.thumbnails.album
    }

    /// Whether files or thumbnails are under way.
    pub fn is_busy(&self) -> bool {
        self.store.is_busy() || self.thumbnails.is_busy()
    }

    /// Whether the app's own file holds every row.
    pub fn is_kept(&self) -> bool {
        self.kept == self.table.version()
    }

    fn take_in_rows(&mut self) {
        let mut room = true;
        for (generation, row) in self.run.take_rows() {
            // Those of a table that another took the place of come too late.
            room &= generation != self.table.generation() || self.table.add(row);
        }
        if !room {
            self.run.cancel();
        }
    }

    /// Takes in what is finished. Returns messages for the user.
    pub fn poll(&mut self) -> Vec<String> {
        let mut errors = Vec::from_iter(self.run.poll());
        self.take_in_rows();
        errors.extend(self.thumbnails.poll());
        for done in self.store.poll() {
            match done {
                Done::Read { own, kept: Ok((rows, conditions)), .. } => {
                    errors.extend(said_of_older(&rows));
                    if own { self.restore(rows, conditions) } else { self.replace(rows, conditions) }
                }
                Done::Read { own: true, path, kept: Err(error) } => errors.push(self.set_aside(&path, &error)),
                Done::Read { kept: Err(error), .. } => errors.push(format!("{error}\nThe rows on screen were kept.")),
                Done::Wrote(version) => self.kept = version,
                Done::Unwritten(error) => {
                    errors.push(format!("Rows can't be kept for the next start: {error}"));
                    // Once is enough; the next change tries again.
                    self.kept = self.table.version();
                }
            }
        }
        errors
    }

    /// Takes in what the last session left. Rows of this one are newer.
    fn restore(&mut self, rows: Vec<Row>, conditions: Conditions) {
        if self.table.version() == 0 {
            self.table.replace(rows, conditions);
            self.kept = self.table.version();
        } else if *self.table.conditions() == conditions && rows.iter().all(|row| row.version == Some(FORMAT)) {
            let missing: Vec<Row> = rows.into_iter().filter(|row| !self.table.has(row)).collect();
            missing.into_iter().for_each(|row| _ = self.table.add(row));
        }
    }

    /// Moves a file that can't be read out of the way, so that it isn't overwritten.
    fn set_aside(&self, path: &Path, error: &str) -> String {
        let aside = path.with_extension("unreadable.csv");
        let moved = match fs::rename(path, &aside) {
            Ok(()) => format!("The file is now {}.", aside.display()),
            Err(error) => format!("It will be written over, as it can't be moved: {error}"),
        };
        format!("The rows of the last session can't be read: {error}\n{moved}")
    }

    /// Asks for thumbnails of the rows in sight, and keeps what changed. Returns when to come again, if something waits.
    pub fn ask(&mut self, state: &State, shown: bool) -> Option<Duration> {
        let runs = self.progress().is_some();
        if shown && !runs {
            let rows = state.failures.in_sight.iter().filter_map(|index| self.table.rows().get(*index));
            let method = |name: &str| state.methods.all.iter().find(|m| m.name() == name).cloned();
            self.thumbnails.ask(self.table.generation(), self.table.conditions(), rows, method);
        }
        let file = self.file.as_ref()?;
        if self.is_kept() || self.store.is_busy() {
            return None;
        }
        let wait = self.written.filter(|_| runs).and_then(|when| SAVE_INTERVAL.checked_sub(when.elapsed()));
        if wait.is_none() {
            let (rows, conditions) = (self.table.rows().clone(), self.table.conditions().clone());
            self.store.write(file.clone(), rows, conditions, self.table.version());
            self.written = Some(Instant::now());
        }
        wait
    }

    /// Writes what isn't on disk yet: the window is closing.
    ///
    /// # Errors
    /// Why it could not be written.
    pub fn keep_now(&mut self) -> Result<(), String> {
        // A write under way would otherwise come after this one.
        while self.store.is_busy() {
            std::thread::sleep(Duration::from_millis(1));
        }
        self.poll();
        match &self.file {
            Some(file) if !self.is_kept() => {
                store::write(file, self.table.rows(), self.table.conditions())?;
                self.kept = self.table.version();
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// A sentence about rows whose floor has another level than that of scenes now.
fn said_of_older(rows: &[Row]) -> Option<String> {
    let row = rows.first().filter(|row| row.version != Some(FORMAT) && row.floor.is_none_or(|f| f == Floor::Thesis))?;
    let format = row.version.map_or("an older format".to_owned(), |version| format!("format {version}"));
    Some(format!(
        "These rows are of {format}: {WHY_NO_OTHER_FORMAT}. Their scenes and small maps have the floor of now."
    ))
}
