//! Times of every frame as CSV, for `--frame-log`.

use crate::files::memory::resident_bytes;
use crate::platform::Instant;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

pub struct FrameLog {
    out: BufWriter<File>,
    began: Instant,
    frame: u64,
    /// Start of the frame that is being drawn, and the thread's processor time at that moment, milliseconds.
    current: (Instant, Option<f64>),
}

impl FrameLog {
    /// Creates the file; its times count from `began`.
    pub fn create(path: &Path, began: Instant) -> io::Result<Self> {
        let mut out = BufWriter::new(File::create(path)?);
        writeln!(out, "frame,seconds,ui_ms,previous_frame_ms,maps_requested,pictures_painted,resident_mib,ui_cpu_ms")?;
        Ok(FrameLog { out, began, frame: 0, current: (began, None) })
    }

    pub fn begin_frame(&mut self) {
        self.current = (Instant::now(), processor_ms());
    }

    /// Writes a line for the frame that began last. It has the time in the app's own code, by the clock and on a processor, which other programs don't
    /// lengthen. It also has the whole time of the previous frame with layout, tessellation and drawing.
    pub fn write(&mut self, previous: Option<f32>, requested: u64, painted: u64) -> io::Result<()> {
        let (frame_began, processor_began) = self.current;
        let (seconds, ui) = (self.began.elapsed().as_secs_f64(), frame_began.elapsed().as_secs_f64() * 1e3);
        let text = |v: Option<f64>, digits: usize| v.map_or_else(String::new, |v| format!("{v:.digits$}"));
        let processor = text(processor_ms().zip(processor_began).map(|(now, then)| now - then), 3);
        let previous = text(previous.map(|seconds| f64::from(seconds * 1e3)), 3);
        let memory = text(resident_bytes().map(|bytes| bytes as f64 / f64::from(1 << 20)), 1);
        writeln!(
            self.out,
            "{},{seconds:.4},{ui:.3},{previous},{requested},{painted},{memory},{processor}",
            self.frame
        )?;
        self.frame += 1;
        self.out.flush()
    }
}

/// Milliseconds that this thread has run on a processor, where the system tells (Linux).
fn processor_ms() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse::<f64>().ok().map(|nanoseconds| nanoseconds / 1e6)
}
