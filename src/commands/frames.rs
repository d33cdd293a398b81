//! Every frame of a recording, one after another.

use super::CommandError;
use crate::files::write_atomically;
use crate::recording::Recording;
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, ImageFormat, RgbaImage};
use std::io;
use std::path::Path;
use std::time::Duration;

/// Time from frame to frame of an animation.
const INTERVAL: Duration = Duration::from_millis(100);

/// The frames of a recording. Beside the one that was opened, one is held at a time.
pub struct Frames(Recording);

impl Frames {
    pub fn of(recording: Recording) -> Frames {
        Frames(recording)
    }

    pub fn opened(&self) -> &Recording {
        &self.0
    }

    /// Number of frames; 1 where the file counts none.
    pub fn count(&self) -> usize {
        self.0.origin.as_ref().map_or(1, |origin| origin.frames.max(1) as usize)
    }

    /// Frame `n`, read as the one that was opened.
    ///
    /// # Errors
    /// [`CommandError`] names the file and the fault of the frame.
    pub fn at(&self, n: usize) -> Result<Recording, CommandError> {
        let Some(origin) = &self.0.origin else { return Ok(self.0.clone()) };
        let frame = origin.with(origin.taken, n as u64).map_err(CommandError::failed)?;
        Ok(Recording { radar: self.0.radar.clone(), ..frame })
    }

    /// Writes a GIF of all frames, each the picture (PNG) that `draw` makes of it.
    ///
    /// # Errors
    /// [`CommandError`] of the first frame that can't be read or drawn, or of the file.
    pub fn animate(
        &self,
        path: &Path,
        draw: impl Fn(&Recording) -> Result<Vec<u8>, CommandError>,
    ) -> Result<(), CommandError> {
        let picture = |n: usize| -> Result<RgbaImage, CommandError> {
            let png = draw(&self.at(n)?)?;
            let read = image::load_from_memory_with_format(&png, ImageFormat::Png).map_err(CommandError::failed)?;
            Ok(read.into_rgba8())
        };
        let written: io::Result<()> = write_atomically(path, |out| {
            let mut gif = GifEncoder::new_with_speed(out, 20);
            gif.set_repeat(Repeat::Infinite).map_err(io::Error::other)?;
            for n in 0..self.count() {
                let delay = Delay::from_saturating_duration(INTERVAL);
                let frame = Frame::from_parts(picture(n).map_err(io::Error::other)?, 0, 0, delay);
                gif.encode_frame(frame).map_err(io::Error::other)?;
            }
            Ok(())
        });
        written.map_err(|source| CommandError::File { path: path.to_owned(), source })
    }
}
