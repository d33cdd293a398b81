//! Every frame of a recording, one after another.

use super::CommandError;
use crate::files::write_atomically;
use crate::recording::Recording;
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, ImageFormat, RgbaImage};
use std::path::Path;
use std::time::Duration;

const FRAME_INTERVAL: Duration = Duration::from_millis(100);

/// Number of frames; 1 where the file counts none.
pub fn count(opened: &Recording) -> usize {
    opened.origin.as_ref().map_or(1, |origin| origin.frames.max(1) as usize)
}

/// Frame `n` of the recording of which one frame is opened, read as that one.
pub fn frame(opened: &Recording, n: usize) -> Result<Recording, CommandError> {
    let Some(origin) = &opened.origin else { return Ok(opened.clone()) };
    Ok(Recording { radar: opened.radar.clone(), ..origin.with(origin.taken, n as u64)? })
}

/// Writes a GIF of all frames, each the picture (PNG) that `draw` makes of it. Beside the one that is opened, one is held at a time.
pub fn animate(
    opened: &Recording,
    path: &Path,
    draw: impl Fn(&Recording) -> Result<Vec<u8>, CommandError>,
) -> Result<(), CommandError> {
    let picture = |n: usize| -> Result<RgbaImage, CommandError> {
        let png = draw(&frame(opened, n)?)?;
        Ok(image::load_from_memory_with_format(&png, ImageFormat::Png)?.into_rgba8())
    };
    let written: Result<(), CommandError> = write_atomically(path, |out| {
        let mut gif = GifEncoder::new_with_speed(out, 20);
        gif.set_repeat(Repeat::Infinite)?;
        for n in 0..count(opened) {
            let delay = Delay::from_saturating_duration(FRAME_INTERVAL);
            gif.encode_frame(Frame::from_parts(picture(n)?, 0, 0, delay))?;
        }
        Ok(())
    });
    written.map_err(CommandError::on(path))
}
