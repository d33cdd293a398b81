//! Long work: other Python threads go on meanwhile, Ctrl-C stops it, and progress is reported.

use crate::errors::runtime;
use crate::pool;
use apertura::task::{Task, panic_message};
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Time between two looks at signals and progress.
const TICK: Duration = Duration::from_millis(30);

/// A Python function that takes the part that is done.
pub type Progress<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

enum Event<E, T> {
    Found(E),
    Done(std::thread::Result<T>),
}

/// Sends findings of running work to the thread that waits for it.
pub struct Finder<E, T>(Sender<Event<E, T>>);

impl<E, T> Finder<E, T> {
    pub fn found(&self, event: E) {
        let _ = self.0.send(Event::Found(event));
    }
}

/// Runs `job` on the threads of this process, with the interpreter free for other threads. A signal handler that raises, or `progress`, cancels the
/// task; their exception is raised once the work has stopped.
pub fn run<T: Send>(py: Python<'_>, progress: Progress<'_, '_>, job: impl FnOnce(&Task) -> T + Send) -> PyResult<T> {
    run_watched(py, progress, |task, _: &Finder<(), T>| job(task), |()| Ok(()))
}

/// [`run`], with `on_found` called on this thread for each finding of the job.
pub fn run_watched<T: Send, E: Send>(
    py: Python<'_>,
    progress: Progress<'_, '_>,
    job: impl FnOnce(&Task, &Finder<E, T>) -> T + Send,
    mut on_found: impl FnMut(E) -> PyResult<()>,
) -> PyResult<T> {
    let task = Task::default();
    if rayon::current_thread_index().is_some() {
        return within(py, &task, job, on_found);
    }
    let (sender, mut receiver) = channel();
    let mut raised = None;
    let mut told = 0.0;
    let outcome = pool::current()?.in_place_scope(|scope| {
        let task = &task;
        scope.spawn(move |_| {
            let finder = Finder(sender);
            let done = catch_unwind(AssertUnwindSafe(|| job(task, &finder)));
            let _ = finder.0.send(Event::Done(done));
        });
        loop {
            let receiver = &mut receiver;
            let event = py.detach(move || receiver.recv_timeout(TICK));
            let step = match event {
                Ok(Event::Done(done)) => return Some(done),
                Ok(Event::Found(event)) => {
                    if raised.is_none() {
                        on_found(event)
                    } else {
                        Ok(())
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return None,
                Err(RecvTimeoutError::Timeout) => Ok(()),
            };
            if raised.is_some() {
                continue;
            }
            if let Err(error) = step.and_then(|()| py.check_signals()).and_then(|()| tell(progress, task, &mut told)) {
                task.cancel();
                raised = Some(error);
            }
        }
    });
    if let Some(error) = raised {
        return Err(error);
    }
    match outcome {
        Some(Ok(result)) => {
            if let Some(progress) = progress {
                progress.call1((1.0,))?;
            }
            Ok(result)
        }
        Some(Err(panic)) => Err(runtime(format!("a fault in apertura: {}", panic_message(panic.as_ref())))),
        None => Err(runtime("the work ended without an answer")),
    }
}

/// [`run_watched`] on a thread of the pool that called a function of one's own: it must not wait for the pool. Ctrl-C and progress are those of the
/// work outside.
fn within<T: Send, E: Send>(
    py: Python<'_>,
    task: &Task,
    job: impl FnOnce(&Task, &Finder<E, T>) -> T + Send,
    mut on_found: impl FnMut(E) -> PyResult<()>,
) -> PyResult<T> {
    let (sender, receiver) = channel();
    let finder = Finder(sender);
    let (outcome, receiver) = py.detach(move || {
        let outcome = catch_unwind(AssertUnwindSafe(|| job(task, &finder)));
        (outcome, receiver)
    });
    for event in receiver.try_iter() {
        if let Event::Found(event) = event {
            on_found(event)?;
        }
    }
    outcome.map_err(|panic| runtime(format!("a fault in apertura: {}", panic_message(panic.as_ref()))))
}

fn tell(progress: Progress<'_, '_>, task: &Task, told: &mut f32) -> PyResult<()> {
    let part = task.progress();
    if let (Some(progress), true) = (progress, part > *told && part < 1.0) {
        *told = part;
        progress.call1((part,))?;
    }
    Ok(())
}
