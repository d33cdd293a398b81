//! Long work that finds one row after another, on a thread of its own: it can be watched and cancelled, and what it found stays.

use crate::platform;
use crate::task::{Reply, Task, Worker};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Why work ended early.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stopped {
    /// Somebody asked it to.
    Cancelled,
    /// It can't be done, and why.
    Failed(String),
}

/// What the work tells while it runs.
pub struct Teller<'a, R> {
    rows: Sender<R>,
    wake: &'a (dyn Fn() + Sync),
    /// Where it reports its progress, and whether it is to stop.
    pub task: &'a Task,
}

impl<R> Teller<'_, R> {
    /// A row is finished.
    pub fn row(&self, row: R) {
        // Nobody listens any more once another run has begun.
        let _superseded = self.rows.send(row);
        (self.wake)();
    }

    /// So much is done, from 0 to 1.
    pub fn part(&self, part: f32) {
        self.task.set_progress(part);
        (self.wake)();
    }
}

/// The worker, and what it has found so far.
pub struct RowJob<P, R, E> {
    worker: Worker<(P, Sender<R>), Result<E, Stopped>>,
    arriving: Option<Receiver<R>>,
    rows: Vec<R>,
    end: Option<E>,
    note: Option<String>,
}

impl<P: Send + Sync + 'static, R: Send + 'static, E: Send + 'static> RowJob<P, R, E> {
    /// Starts the thread called `name`, which waits; `work` turns a plan into rows, `wake` is called from the thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(
        name: &'static str,
        work: impl Fn(&P, &Teller<'_, R>) -> Result<E, Stopped> + Send + Sync + 'static,
        wake: impl Fn() + Clone + Send + Sync + 'static,
    ) -> std::io::Result<Self> {
        // Threads of its own: on shared ones the maps would wait for it.
        let threads = move || platform::pool(name);
        let each = wake.clone();
        let run = move |threads: &mut Option<rayon::ThreadPool>, (plan, rows): (P, Sender<R>), task: &Task| {
            let teller = Teller { rows, wake: &each, task };
            match threads {
                Some(threads) => threads.install(|| work(&plan, &teller)),
                None => work(&plan, &teller),
            }
        };
        let worker = Worker::spawn(name, threads, run, wake)?;
        Ok(RowJob { worker, arriving: None, rows: Vec::new(), end: None, note: None })
    }

    /// Begins afresh with `plan`.
    pub fn begin(&mut self, plan: P) {
        let (rows, arriving) = channel();
        self.arriving = Some(arriving);
        self.rows.clear();
        (self.end, self.note) = (None, None);
        self.worker.request((plan, rows));
    }

    /// Stops soon; what was found stays.
    pub fn cancel(&mut self) {
        self.worker.cancel();
    }

    /// The part that is done, while it runs.
    pub fn progress(&self) -> Option<f32> {
        self.worker.is_busy().then(|| self.worker.progress().unwrap_or(0.0))
    }

    /// What was found so far.
    pub fn rows(&self) -> &[R] {
        &self.rows
    }

    /// Hands over what was found since the last time; it is not among [`RowJob::rows`] any more.
    pub fn take_rows(&mut self) -> Vec<R> {
        std::mem::take(&mut self.rows)
    }

    /// What the whole run came to, once it has ended well.
    pub fn end(&self) -> Option<&E> {
        self.end.as_ref()
    }

    /// How the last run ended, if not well.
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Takes in what is finished. Returns what a panic said.
    pub fn poll(&mut self) -> Option<String> {
        let mut panicked = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: Ok(end), .. } => self.end = Some(end),
                Reply::Done { result: Err(Stopped::Cancelled), .. } => {
                    self.note = Some("cancelled; what was finished stays".to_owned());
                }
                Reply::Done { result: Err(Stopped::Failed(why)), .. } => self.note = Some(why),
                Reply::Panicked { message, .. } => {
                    self.note = Some(format!("failed: {message}"));
                    panicked = Some(message);
                }
            }
        }
        if let Some(arriving) = &self.arriving {
            self.rows.extend(arriving.try_iter());
        }
        panicked
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::Instant;
    use std::time::Duration;

    fn rest<P: Send + Sync + 'static, R: Send + 'static, E: Send + 'static>(
        job: &mut RowJob<P, R, E>,
    ) -> Option<String> {
        let deadline = Instant::now() + Duration::from_secs(20);
        while job.progress().is_some() {
            assert!(Instant::now() < deadline, "it never ends");
            std::thread::sleep(Duration::from_millis(1));
        }
        job.poll()
    }

    #[test]
    fn rows_stay_however_the_work_ends() {
        let work = |plan: &u32, teller: &Teller<'_, u32>| {
            (0..*plan).for_each(|i| teller.row(i));
            match plan {
                3 => Err(Stopped::Failed("three".to_owned())),
                4 => Err(Stopped::Cancelled),
                5 => panic!("five"),
                _ => Ok(*plan),
            }
        };
        let mut job = RowJob::start("test", work, || ()).unwrap();
        for (plan, note, panicked) in [
            (2, None, None),
            (3, Some("three"), None),
            (4, Some("cancelled; what was finished stays"), None),
            (5, Some("failed: five"), Some("five")),
        ] {
            job.begin(plan);
            assert_eq!(rest(&mut job).as_deref(), panicked);
            assert_eq!((job.rows().len(), job.note(), job.end().is_some()), (plan as usize, note, plan == 2));
        }
    }
}
