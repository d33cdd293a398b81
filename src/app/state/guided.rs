//! What the guide set up, so that undo takes all of it back: the scene, its radar, and how they are looked at.

use crate::radar::Radar;
use crate::scene::Scene;
use crate::view::View;
use std::sync::Arc;

/// Everything that a button of the guide changes, at one moment.
#[derive(Debug, Clone)]
pub struct Setup {
    /// How it was looked at.
    pub view: View,
    /// The radar.
    pub radar: Radar,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Steps of the scene's history.
    pub depth: usize,
}

impl Setup {
    /// Whether nothing was edited between this and `now`.
    fn is(&self, now: &Setup) -> bool {
        Arc::ptr_eq(&self.scene, &now.scene) && self.radar == now.radar
    }
}

/// A button's doing.
#[derive(Debug, Clone)]
pub struct GuidedStep {
    /// As it was before.
    pub before: Setup,
    /// As it was after.
    pub after: Setup,
}

/// What the guide did, and what of it was undone.
#[derive(Debug, Default)]
pub struct Guided {
    done: Vec<GuidedStep>,
    undone: Vec<GuidedStep>,
}

impl Guided {
    /// Notes a step.
    pub fn push(&mut self, before: Setup, after: Setup) {
        self.undone.clear();
        self.done.push(GuidedStep { before, after });
    }

    /// The step that undo takes back, if the guide did the last thing.
    pub fn undo(&mut self, now: &Setup) -> Option<GuidedStep> {
        let step = self.done.pop_if(|step| step.after.is(now))?;
        self.undone.push(step.clone());
        Some(step)
    }

    /// The step that redo does again, if undo of it was the last thing.
    pub fn redo(&mut self, now: &Setup) -> Option<GuidedStep> {
        let step = self.undone.pop_if(|step| step.before.is(now))?;
        self.done.push(step.clone());
        Some(step)
    }

    /// Whether undo would take a step of the guide back.
    pub fn can_undo(&self, now: &Setup) -> bool {
        self.done.last().is_some_and(|step| step.after.is(now))
    }
}
