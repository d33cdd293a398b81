//! Methods tried on many scenes in the background: their rows, which stay between starts, thumbnails, and the search near a scene.

mod keep;
mod search;
mod store;
mod table;
mod thumbnails;

pub use keep::keep;
pub use store::{is_table_of_rows, write as write_rows_to};
pub use table::RowTable;
#[cfg(test)]
pub use table::tests::some_row;
use thumbnails::Album;
pub use thumbnails::{THUMBNAIL_COLUMNS as THUMBNAIL_WIDTH, THUMBNAIL_ROWS as THUMBNAIL_HEIGHT, Thumbnail};

use super::background::Background;
use super::derived::Failure;
use super::rows::{Plan, RowJob, Teller};
use crate::app::state::{Conditions, State};
use crate::evaluate::campaign::{Campaign, MethodFailure};
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
use store::{Done, begin};
use thumbnails::Thumbnails;

/// Time between two writes to disk while rows come.
const SAVE_INTERVAL: Duration = Duration::from_secs(10);

/// Name of the file that keeps rows between starts.
const ROWS_FILE: &str = "failures.csv";

/// Methods and scenes to be tried.
pub struct FailuresPlan {
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

/// A plan, the table that its rows belong to, and the album of their thumbnails.
pub struct Run {
    plan: FailuresPlan,
    generation: u64,
    album: Album,
}

impl Plan for Run {
    type Row = (u64, Row);
    type End = Vec<MethodFailure>;
    const WHAT: &'static str = "Trying methods";
    const ADVICE: &'static str = "Leave the method out, or try another seed.";

    fn run(&self, teller: &Teller<'_, (u64, Row)>) -> Result<Vec<MethodFailure>, Failure> {
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
            Err(error) if error.is_cancelled() => Err(Failure::Cancelled),
            Err(error) => Err(error.to_string().into()),
        }
    }
}

/// The rows, and the threads that make more.
pub struct Failures {
    /// The run of methods on scenes, whose rows go into the table.
    pub run: RowJob<Run>,
    pub table: RowTable,
    /// The rows last replaced by others.
    before: Option<(Arc<Vec<Row>>, Conditions)>,
    pub thumbnails: Thumbnails,
    /// Files of rows being read and written.
    files: Background<Done>,
    pub search: Search,
    /// The app's own file of rows, if it keeps one.
    file: Option<PathBuf>,
    /// Version of the table in that file.
    kept: u64,
    written: Option<Instant>,
}

impl Failures {
    /// Starts the threads and reads the last session's rows in `folder`; `ctx` draws another frame.
    pub fn start(folder: Option<&Path>, ctx: &Context) -> Failures {
        let wake = platform::waker(ctx);
        let thumbnails = Thumbnails::start(wake.clone());
        let run = RowJob::start(wake.clone());
        let files = Background::new(ctx.clone());
        let file = folder.map(|folder| folder.join(ROWS_FILE));
        if let Some(file) = file.clone().filter(|file| fs::exists(file)) {
            begin(&files, move || Done::Read { kept: store::read(&file), path: file, own: true });
        }
        let search = Search::start(wake);
        let table = RowTable::default();
        Failures { run, table, before: None, thumbnails, files, search, file, kept: 0, written: None }
    }

    /// Starts a run of `plan`. Rows of the same conditions, format and layout stay. Others are replaced, as their figures don't compare.
    pub fn begin(&mut self, plan: FailuresPlan) {
        let Campaign { floor, normalisation, ref radar, .. } = plan.campaign;
        let conditions = Conditions { floor, normalisation, radar: radar.clone() };
        self.take_in_rows();
        let layout = plan.campaign.layout.as_deref().map(ranges).unwrap_or_default();
        if *self.table.conditions() != conditions || !self.table.is_alike(&layout) {
            self.replace(Vec::new(), conditions);
        }
        // The run's times are measured, so it needs the processor.
        self.thumbnails.job.cancel();
        let album = self.thumbnails.album.clone();
        self.run.begin(Run { plan, generation: self.table.generation(), album });
    }

    pub fn clear(&mut self) {
        self.run.cancel();
        self.take_in_rows();
        self.replace(Vec::new(), self.table.conditions().clone());
    }

    /// Replaces all rows; [`Failures::bring_back`] undoes it.
    fn replace(&mut self, rows: Vec<Row>, conditions: Conditions) {
        if !self.table.rows().is_empty() {
            self.before = Some((self.table.rows().clone(), self.table.conditions().clone()));
        }
        self.table.replace(rows, conditions);
    }

    /// Number of the rows last replaced.
    pub fn before(&self) -> Option<usize> {
        self.before.as_ref().map(|(rows, _)| rows.len())
    }

    pub fn bring_back(&mut self) {
        self.run.cancel();
        if let Some((rows, conditions)) = self.before.take() {
            self.replace(Arc::unwrap_or_clone(rows), conditions);
        }
    }

    /// Reads the rows of a file, which replace all others once read.
    pub fn open(&mut self, path: PathBuf) {
        self.run.cancel();
        begin(&self.files, move || Done::Read { kept: store::read(&path), path, own: false });
    }

    /// Whether files or thumbnails are under way.
    pub fn is_busy(&self) -> bool {
        self.files.is_busy() || self.thumbnails.job.progress().is_some()
    }

    /// Whether the app's own file holds every row.
    pub fn is_kept(&self) -> bool {
        self.kept == self.table.version()
    }

    fn take_in_rows(&mut self) {
        let mut room = true;
        for (generation, row) in self.run.take_rows() {
            // Rows for a table that was replaced come too late.
            room &= generation != self.table.generation() || self.table.add(row);
        }
        if !room {
            self.run.cancel();
        }
    }

    /// Takes in finished work. Returns messages for the user.
    pub fn poll(&mut self) -> Vec<String> {
        let mut errors = Vec::from_iter(self.run.poll());
        self.take_in_rows();
        errors.extend(self.thumbnails.job.poll());
        for done in self.files.finished() {
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
                    // One message is enough; the next change tries again.
                    self.kept = self.table.version();
                }
            }
        }
        errors
    }

    /// Takes in the last session's rows. Rows of this session are newer.
    fn restore(&mut self, rows: Vec<Row>, conditions: Conditions) {
        if self.table.version() == 0 {
            self.table.replace(rows, conditions);
            self.kept = self.table.version();
        } else if *self.table.conditions() == conditions && rows.iter().all(|row| row.version == Some(FORMAT)) {
            let missing: Vec<Row> = rows.into_iter().filter(|row| !self.table.has(row)).collect();
            missing.into_iter().for_each(|row| _ = self.table.add(row));
        }
    }

    /// Renames a file that can't be read, so that it isn't overwritten.
    fn set_aside(&self, path: &Path, error: &str) -> String {
        let aside = path.with_extension("unreadable.csv");
        let moved = match fs::rename(path, &aside) {
            Ok(()) => format!("The file is now {}.", aside.display()),
            Err(error) => format!("It will be written over, as it can't be moved: {error}"),
        };
        format!("The rows of the last session can't be read: {error}\n{moved}")
    }

    /// Asks for thumbnails of the rows in sight, and writes changed rows to disk. Returns the time until the next write, if one waits.
    pub fn ask(&mut self, state: &State, shown: bool) -> Option<Duration> {
        let runs = self.run.progress().is_some();
        if shown && !runs {
            let rows = state.failures.in_sight.iter().filter_map(|index| self.table.rows().get(*index));
            self.thumbnails.ask(self.table.generation(), self.table.conditions(), rows, &state.methods);
        }
        let file = self.file.as_ref()?;
        if self.is_kept() || self.files.is_busy() {
            return None;
        }
        let wait = self.written.filter(|_| runs).and_then(|when| SAVE_INTERVAL.checked_sub(when.elapsed()));
        if wait.is_none() {
            let (rows, conditions, version) =
                (self.table.rows().clone(), self.table.conditions().clone(), self.table.version());
            let file = file.clone();
            begin(&self.files, move || {
                store::write(&file, &rows, &conditions).map_or_else(Done::Unwritten, |()| Done::Wrote(version))
            });
            self.written = Some(Instant::now());
        }
        wait
    }

    /// Writes changed rows to disk as the window closes.
    ///
    /// # Errors
    /// The reason why they could not be written.
    pub fn keep_now(&mut self) -> Result<(), String> {
        // A write under way would otherwise overwrite this one.
        while self.files.is_busy() {
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

/// A message about rows of an older format, whose floor has another level.
fn said_of_older(rows: &[Row]) -> Option<String> {
    let row = rows.first().filter(|row| row.version != Some(FORMAT) && row.floor.is_none_or(|f| f == Floor::Thesis))?;
    let format = row.version.map_or("an older format".to_owned(), |version| format!("format {version}"));
    Some(format!(
        "These rows are of {format}: {WHY_NO_OTHER_FORMAT}. Their scenes and small maps have the floor of now."
    ))
}
