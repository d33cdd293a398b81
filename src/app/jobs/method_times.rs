//! Every method once on the samples on screen: how long each takes on this machine.

use super::method::Basis;
use super::rows::{RowJob, Stopped, Teller};
use crate::app::state::State;
use crate::reconstruct::Reconstructor;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is to be measured.
struct Plan {
    basis: Basis,
    methods: Vec<Arc<dyn Reconstructor>>,
}

/// A method, and how long it took.
type Row = (&'static str, Duration);

/// The worker, and the radar of what it measures.
pub struct MeasuredMethods {
    job: RowJob<Plan, Row, ()>,
    radar: Option<crate::radar::Radar>,
}

impl MeasuredMethods {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> std::io::Result<Self> {
        Ok(MeasuredMethods { job: RowJob::start("method times", run, wake)?, radar: None })
    }

    /// Measures every method that works on the radar, once each on the samples on screen.
    ///
    /// # Errors
    /// Where there are no samples of the two ends yet.
    pub fn begin(&mut self, state: &State, basis: Option<Basis>) -> Result<String, String> {
        let basis = basis.ok_or("Show an output panel first: methods are timed on the samples on screen.")?;
        let works = |method: &&Arc<dyn Reconstructor>| method.check_array(basis.radar()).is_ok();
        let methods: Vec<_> = state.methods.all.iter().filter(works).cloned().collect();
        let said = format!("Timing {} methods on the scene on screen.", methods.len());
        self.radar = Some(basis.radar().clone());
        self.job.begin(Plan { basis, methods });
        Ok(said)
    }

    /// Stops soon; times that were measured stay.
    pub fn cancel(&mut self) {
        self.job.cancel();
    }

    /// The part that is done, while it measures.
    pub fn progress(&self) -> Option<f32> {
        self.job.progress()
    }

    /// Takes in what was measured. Returns a message for the user.
    pub fn poll(&mut self, state: &mut State) -> Option<String> {
        let failed = self.job.poll();
        if let Some(radar) = &self.radar {
            for (method, took) in self.job.take_rows() {
                state.method_times.record(radar, method, took);
            }
        }
        failed.map(|said| format!("Timing the methods failed ({said}). Times measured before stay."))
    }
}

fn run(plan: &Plan, teller: &Teller<'_, Row>) -> Result<(), Stopped> {
    for (index, method) in plan.methods.iter().enumerate() {
        let began = Instant::now();
        // A method that can't answer these samples has no time; the others still have.
        if plan.basis.reconstruct(method.as_ref(), teller.task.quiet()).is_ok() {
            teller.row((method.name(), began.elapsed()));
        }
        if teller.task.is_cancelled() {
            return Err(Stopped::Cancelled);
        }
        teller.part((index + 1) as f32 / plan.methods.len() as f32);
    }
    Ok(())
}
