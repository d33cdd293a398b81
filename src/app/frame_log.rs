//! Times of every frame as CSV, for `--frame-log`.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// A CSV file with one line a frame.
pub(super) struct FrameLog {
    out: BufWriter<File>,
    began: Instant,
    frame: u64,
}

impl FrameLog {
    /// Creates the file; its times count from `began`.
    pub fn create(path: &Path, began: Instant) -> io::Result<Self> {
        let mut out = BufWriter::new(File::create(path)?);
        writeln!(out, "frame,seconds,ui_ms,previous_frame_ms,maps_requested,pictures_painted,resident_mib")?;
        Ok(FrameLog { out, began, frame: 0 })
    }

    /// Writes one frame: time in the app's own code, and the whole of the previous frame with layout, tessellation and drawing.
    pub fn write(&mut self, ui: Duration, previous: Option<f32>, requested: u64, painted: u64) -> io::Result<()> {
        let (seconds, ui) = (self.began.elapsed().as_secs_f64(), ui.as_secs_f64() * 1e3);
        let previous = previous.map_or_else(String::new, |s| format!("{:.3}", s * 1e3));
        let memory = resident_mib().map_or_else(String::new, |m| format!("{m:.1}"));
        writeln!(self.out, "{},{seconds:.4},{ui:.3},{previous},{requested},{painted},{memory}", self.frame)?;
        self.frame += 1;
        self.out.flush()
    }
}

/// Memory of this process, where the system tells (Linux).
fn resident_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmRSS:"))?;
    line.trim().trim_end_matches("kB").trim().parse::<f64>().ok().map(|k| k / 1024.0)
}
