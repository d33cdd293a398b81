//! Every method once on the samples on screen: how long each takes on this machine.

use super::method::Basis;
use super::rows::{Plan, Stopped, Teller};
use crate::app::state::State;
use crate::radar::Radar;
use crate::reconstruct::Reconstructor;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is to be measured.
pub struct TimesPlan {
    basis: Basis,
    methods: Vec<Arc<dyn Reconstructor>>,
}

impl TimesPlan {
    /// Every method that works on the radar, once each on the samples on screen.
    ///
    /// # Errors
    /// Where there are no samples of the two ends yet.
    pub fn of(state: &State, basis: Option<Basis>) -> Result<Self, String> {
        let basis = basis.ok_or("Show an output panel first: methods are timed on the samples on screen.")?;
        let works = |method: &&Arc<dyn Reconstructor>| method.check_array(basis.radar()).is_ok();
        let methods = state.methods.all.iter().filter(works).cloned().collect();
        Ok(TimesPlan { basis, methods })
    }

    /// How many methods there are to be timed.
    pub fn count(&self) -> usize {
        self.methods.len()
    }

    /// The radar whose samples they work on.
    pub fn radar(&self) -> &Radar {
        self.basis.radar()
    }
}

impl Plan for TimesPlan {
    /// A method, and how long it took.
    type Row = (&'static str, Duration);
    type End = ();
    const THREAD: &'static str = "method times";
    const WHAT: &'static str = "Timing the methods";
    const ADVICE: &'static str = "Times measured before stay.";

    fn run(&self, teller: &Teller<'_, Self::Row>) -> Result<(), Stopped> {
        for (index, method) in self.methods.iter().enumerate() {
            let began = Instant::now();
            // A method that can't answer these samples has no time; the others still have.
            if self.basis.reconstruct(method.as_ref(), teller.task.quiet()).is_ok() {
                teller.row((method.name(), began.elapsed()));
            }
            if teller.task.is_cancelled() {
                return Err(Stopped::Cancelled);
            }
            teller.part((index + 1) as f32 / self.methods.len() as f32);
        }
        Ok(())
    }
}
