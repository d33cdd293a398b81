//! Undo and redo of the guide's buttons, which change scene, radar and view together.

use crate::radar::Radar;
use crate::scene::Scene;
use crate::view::View;
use std::sync::Arc;

/// Scene, radar and view at one moment.
#[derive(Debug, Clone, Default)]
pub struct Setup {
    pub view: View,
    pub radar: Radar,
    pub scene: Arc<Scene>,
    /// Number of steps in the editor's history.
    pub depth: usize,
}

impl Setup {
    /// Whether scene and radar are the same as in `now`.
    fn is(&self, now: &Setup) -> bool {
        Arc::ptr_eq(&self.scene, &now.scene) && self.radar == now.radar
    }
}

/// The change made by a button of the guide.
#[derive(Debug, Clone)]
pub struct GuidedStep {
    pub before: Setup,
    pub after: Setup,
}

/// The guide's changes and those that were undone.
#[derive(Debug, Default)]
pub struct Guided {
    done: Vec<GuidedStep>,
    undone: Vec<GuidedStep>,
}

impl Guided {
    pub fn push(&mut self, before: Setup, after: Setup) {
        self.undone.clear();
        self.done.push(GuidedStep { before, after });
    }

    /// The change to undo, if the guide made the last one.
    pub fn undo(&mut self, now: &Setup) -> Option<GuidedStep> {
        let step = self.done.pop_if(|step| step.after.is(now))?;
        self.undone.push(step.clone());
        Some(step)
    }

    /// The change to redo, if its undo was the last change.
    pub fn redo(&mut self, now: &Setup) -> Option<GuidedStep> {
        let step = self.undone.pop_if(|step| step.before.is(now))?;
        self.done.push(step.clone());
        Some(step)
    }

    /// Whether undo would take back a change of the guide.
    pub fn can_undo(&self, now: &Setup) -> bool {
        self.done.last().is_some_and(|step| step.after.is(now))
    }
}
