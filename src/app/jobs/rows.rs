//! Long work on a thread of its own that finds one row after another. It can be cancelled, and its rows stay.

use super::derived::Failure;
use crate::platform;
use crate::task::{Reply, Task, Worker};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The way for running work to report rows and progress.
pub struct Teller<'a, R> {
    rows: Sender<R>,
    wake: &'a (dyn Fn() + Sync),
    /// The task that takes its progress and tells whether to stop.
    pub task: &'a Task,
}

impl<R> Teller<'_, R> {
    /// Reports a finished row.
    pub fn row(&self, row: R) {
        // Another run may have begun; then the receiver is gone.
        let _superseded = self.rows.send(row);
        (self.wake)();
    }

    /// Reports the finished part, 0 to 1.
    pub fn part(&self, part: f32) {
        self.task.set_progress(part);
        (self.wake)();
    }
}

/// Long work and all its inputs.
pub trait Plan: Send + Sync + 'static {
    type Row: Send + 'static;
    /// Result of the whole run.
    type End: Send + 'static;
    /// Subject of the message about a panic, at the beginning of a sentence. It is the name of the thread, too.
    const WHAT: &'static str;
    /// The user's remedy after a panic, as a sentence.
    const ADVICE: &'static str;

    /// Does the work.
    ///
    /// # Errors
    /// The reason why it ended early.
    fn run(&self, teller: &Teller<'_, Self::Row>) -> Result<Self::End, Failure>;
}

type Asked<P> = (Arc<P>, Sender<<P as Plan>::Row>);

/// The worker of one kind of plan, and the rows so far.
pub struct RowJob<P: Plan> {
    worker: Worker<Asked<P>, Result<P::End, Failure>>,
    plan: Option<Arc<P>>,
    arriving: Option<Receiver<P::Row>>,
    rows: Vec<P::Row>,
    end: Option<P::End>,
    note: Option<String>,
}

impl<P: Plan> RowJob<P> {
    /// Starts the thread, idle at first; `wake` is called from it.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> Self {
        let each = wake.clone();
        let run =
            move |threads: &mut Option<rayon::ThreadPool>, (plan, rows): (Arc<P>, Sender<P::Row>), task: &Task| {
                let teller = Teller { rows, wake: &each, task };
                let end = match threads {
                    Some(threads) => threads.install(|| plan.run(&teller)),
                    None => plan.run(&teller),
                }?;
                if task.is_cancelled() { Err(Failure::Cancelled) } else { Ok(end) }
            };
        // Threads of its own: on shared ones the maps would wait for the work.
        let worker = Worker::spawn(P::WHAT, || platform::pool(P::WHAT), run, wake);
        RowJob { worker, plan: None, arriving: None, rows: Vec::new(), end: None, note: None }
    }

    /// Begins a run of `plan` without the earlier rows.
    pub fn begin(&mut self, plan: P) {
        let (rows, arriving) = channel();
        let plan = Arc::new(plan);
        self.arriving = Some(arriving);
        self.rows.clear();
        (self.end, self.note) = (None, None);
        self.worker.request((plan.clone(), rows));
        self.plan = Some(plan);
    }

    /// The plan of the last run, unless it was dropped.
    pub fn plan(&self) -> Option<&P> {
        self.plan.as_deref()
    }

    /// Drops the last run with its rows.
    pub fn forget(&mut self) {
        self.cancel();
        self.rows.clear();
        (self.plan, self.arriving) = (None, None);
    }

    /// Stops soon; finished rows stay.
    pub fn cancel(&mut self) {
        self.worker.cancel();
    }

    /// Finished part of the run, 0 to 1, while it runs.
    pub fn progress(&self) -> Option<f32> {
        self.worker.is_busy().then(|| self.worker.progress().unwrap_or(0.0))
    }

    pub fn rows(&self) -> &[P::Row] {
        &self.rows
    }

    /// Removes and returns the rows since the last call.
    pub fn take_rows(&mut self) -> Vec<P::Row> {
        std::mem::take(&mut self.rows)
    }

    /// Result of the whole run, if it ended well.
    pub fn end(&self) -> Option<&P::End> {
        self.end.as_ref()
    }

    /// The reason why the last run ended early, if it did.
    pub fn note(&self) -> Option<&str> {
        self.plan.as_ref().and(self.note.as_deref())
    }

    /// Takes in finished work. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let mut panicked = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: Ok(end), .. } => self.end = Some(end),
                Reply::Done { result: Err(Failure::Cancelled), .. } => {
                    self.note = Some("cancelled; what was finished stays".to_owned());
                }
                Reply::Done { result: Err(Failure::Because(why)), .. } => self.note = Some(why),
                Reply::Panicked { message, .. } => {
                    self.note = Some(format!("failed: {message}"));
                    panicked = Some(format!("{} failed ({message}). {}", P::WHAT, P::ADVICE));
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

    /// A plan with this many rows; 3, 4 and 5 end early in different ways.
    struct Count(u32);

    impl Plan for Count {
        type Row = u32;
        type End = u32;
        const WHAT: &'static str = "Counting";
        const ADVICE: &'static str = "Try another number.";

        fn run(&self, teller: &Teller<'_, u32>) -> Result<u32, Failure> {
            (0..self.0).for_each(|i| teller.row(i));
            match self.0 {
                3 => Err(Failure::Because("three".to_owned())),
                4 => Err(Failure::Cancelled),
                5 => panic!("five"),
                count => Ok(count),
            }
        }
    }

    fn rest(job: &mut RowJob<Count>) -> Option<String> {
        let deadline = Instant::now() + Duration::from_secs(20);
        while job.progress().is_some() {
            assert!(Instant::now() < deadline, "it never ends");
            std::thread::yield_now();
        }
        job.poll()
    }

    #[test]
    fn rows_stay_however_the_work_ends() {
        let mut job = RowJob::start(|| ());
        for (count, note, told) in [
            (2, None, None),
            (3, Some("three"), None),
            (4, Some("cancelled; what was finished stays"), None),
            (5, Some("failed: five"), Some("Counting failed (five). Try another number.")),
        ] {
            job.begin(Count(count));
            assert_eq!(rest(&mut job).as_deref(), told);
            assert_eq!((job.rows().len(), job.note(), job.end().is_some()), (count as usize, note, count == 2));
        }
    }
}
