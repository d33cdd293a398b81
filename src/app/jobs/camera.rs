//! Pictures of the window, in which no message stands before the panels.

use crate::platform::Instant;
use eframe::egui::{ColorImage, Context};
use std::sync::Arc;
use std::time::Duration;

/// A picture that has not come after so long never comes: messages are shown again.
const PATIENCE: Duration = Duration::from_secs(2);

/// Takes pictures of the window.
pub struct Camera {
    wake: Context,
    /// Held once more by every picture on its way.
    on_its_way: Arc<()>,
    latest: Option<Instant>,
}

impl Camera {
    /// Of the window that `wake` draws.
    pub fn new(wake: Context) -> Camera {
        Camera { wake, on_its_way: Arc::new(()), latest: None }
    }

    /// Asks for a picture of this frame or the next, and does `then` with it.
    pub fn take(&mut self, now: Instant, then: impl FnOnce(Arc<ColorImage>) + Send + 'static) {
        self.latest = Some(now);
        let (token, wake) = (self.on_its_way.clone(), self.wake.clone());
        self.wake.request_screenshot(move |picture| {
            then(picture);
            drop(token);
            wake.request_repaint();
        });
    }

    /// Whether a picture is on its way: nothing may stand before the panels meanwhile.
    pub fn is_taking(&self, now: Instant) -> bool {
        Arc::strong_count(&self.on_its_way) > 1 && self.latest.is_some_and(|at| now.duration_since(at) < PATIENCE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_never_comes_is_given_up() {
        let (mut camera, now) = (Camera::new(Context::default()), Instant::now());
        assert!(!camera.is_taking(now));
        camera.take(now, |_| {});
        assert!(camera.is_taking(now) && !camera.is_taking(now + PATIENCE));
    }
}
