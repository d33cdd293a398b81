//! Methods on the tables' test scenes, in the background: what the panel asks for and what comes back.

use crate::evaluate::campaign::{Campaign, CampaignError};
use crate::evaluate::sets::SceneSet;
use crate::evaluate::tables::{Estimate, PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed, Tally};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use crate::task::{Reply, Task, Worker};
use std::fmt::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// The printed columns with their names.
pub(super) const PRINTED: [(&str, [Printed; 3]); 3] = [
    ("printed: baseline", PRINTED_BASELINE),
    ("printed: experiment 1", PRINTED_EXPERIMENT_1),
    ("printed: experiment 2", PRINTED_EXPERIMENT_2),
];

/// One method on one test set.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// Test set, 1 to 3.
    pub set: usize,
    pub method: &'static str,
    pub eta: f32,
    pub scenes: usize,
    pub squared_error: Estimate,
    pub detection: Estimate,
    pub false_alarm: Estimate,
    /// P_D where every scene's P_FA is held to the printed one of experiment 2.
    pub detection_at_printed: Option<f64>,
    pub median_milliseconds: f64,
}

/// What is to be evaluated.
#[derive(Clone)]
pub(super) struct Plan {
    pub campaign: Campaign,
    /// Test sets, 1 to 3.
    pub sets: Vec<usize>,
    pub methods: Vec<Arc<dyn Reconstructor>>,
}

impl Plan {
    /// Maps to be made in all.
    pub fn maps(&self) -> usize {
        self.sets.len() * self.methods.len() * self.campaign.count as usize
    }
}

struct Request {
    plan: Plan,
    done: Arc<AtomicUsize>,
    rows: Sender<Row>,
}

/// The worker and what it has found so far.
pub(super) struct Evaluation {
    worker: Worker<Request, Result<(), CampaignError>>,
    done: Arc<AtomicUsize>,
    total: usize,
    arriving: Option<Receiver<Row>>,
    /// What is finished, in the order it was.
    pub rows: Vec<Row>,
    /// How the last run ended, if not well.
    pub ended: Option<String>,
}

impl Evaluation {
    /// Starts the worker, which waits; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> std::io::Result<Evaluation> {
        // Threads of its own: on shared ones the maps would wait for it.
        let threads = || rayon::ThreadPoolBuilder::new().thread_name(|i| format!("evaluation {i}")).build().ok();
        let each = wake.clone();
        let work = move |threads: &mut Option<rayon::ThreadPool>, request: Request, task: &Task| {
            let work = || run(&request, task, &each);
            match threads {
                Some(threads) => threads.install(work),
                None => work(),
            }
        };
        Ok(Evaluation {
            worker: Worker::spawn("evaluation", threads, work, wake)?,
            done: Arc::default(),
            total: 0,
            arriving: None,
            rows: Vec::new(),
            ended: None,
        })
    }

    /// Begins afresh with `plan`.
    pub fn begin(&mut self, plan: Plan) {
        let (rows, arriving) = channel();
        self.total = plan.maps();
        self.done = Arc::default();
        self.arriving = Some(arriving);
        self.rows.clear();
        self.ended = None;
        self.worker.request(Request { plan, done: self.done.clone(), rows });
    }

    /// Stops after the map that is being made.
    pub fn cancel(&self) {
        self.worker.cancel();
    }

    /// The part that is done, while it runs.
    pub fn progress(&self) -> Option<f32> {
        let part = || self.done.load(Ordering::Relaxed) as f32 / self.total.max(1) as f32;
        self.worker.is_busy().then(part)
    }

    /// Takes in what is finished. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        if let Some(arriving) = &self.arriving {
            self.rows.extend(arriving.try_iter());
        }
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: Ok(()), .. } => self.ended = None,
                Reply::Done { result: Err(error), .. } if error.is_cancelled() => {
                    self.ended = Some("cancelled; what was finished stays".to_owned());
                }
                Reply::Done { result: Err(error), .. } => self.ended = Some(error.to_string()),
                Reply::Panicked { message: said, .. } => {
                    self.ended = Some(format!("failed: {said}"));
                    message =
                        Some(format!("The evaluation failed ({said}). Leave the method out, or try another seed."));
                }
            }
        }
        message
    }

    /// The rows as CSV; rates as fractions.
    pub fn to_csv(&self) -> String {
        let mut text = String::from(
            "set,method,eta,scenes,squared_error,squared_error_se,detection,detection_se,false_alarm,false_alarm_se,\
             detection_at_printed_false_alarm,median_milliseconds\n",
        );
        for r in &self.rows {
            let at = r.detection_at_printed.map_or_else(String::new, |d| d.to_string());
            // Writing to a string can't fail.
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{at},{:.3}",
                r.set,
                r.method,
                r.eta,
                r.scenes,
                r.squared_error.mean,
                r.squared_error.standard_error,
                r.detection.mean,
                r.detection.standard_error,
                r.false_alarm.mean,
                r.false_alarm.standard_error,
                r.median_milliseconds
            );
        }
        text
    }
}

/// One method after another, so that each is on screen as soon as it is finished. The scenes are simulated anew for each: that is
/// a small part of the time.
fn run(request: &Request, task: &Task, wake: &impl Fn()) -> Result<(), CampaignError> {
    let plan = &request.plan;
    for &set in &plan.sets {
        let kind = [Kind::Set1, Kind::Set2, Kind::Set3][set - 1];
        for method in &plan.methods {
            let on_map = || {
                request.done.fetch_add(1, Ordering::Relaxed);
                wake();
            };
            let rows = plan.campaign.run(&[SceneSet::Generated(kind)], &[method.as_ref()], task, |_| on_map())?;
            let tally = Tally::of(&rows);
            if tally.scenes() > 0 {
                let row = Row {
                    set,
                    method: method.name(),
                    eta: method.eta(),
                    scenes: tally.scenes(),
                    squared_error: tally.squared_error(),
                    detection: tally.detection(),
                    false_alarm: tally.false_alarm(),
                    detection_at_printed: Some(tally.detection_at_printed().mean).filter(|d| d.is_finite()),
                    median_milliseconds: tally.median_milliseconds(),
                };
                // Nobody listens any more once another run has begun.
                let _superseded = request.rows.send(row);
            }
        }
    }
    Ok(())
}
