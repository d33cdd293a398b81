//! Errors of a `.cfg`, and the largest counts that one may ask for.

/// An error of reading a `.cfg`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ProfileError {
    /// A line can't be understood.
    #[error("line {line}: {message}")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// The fault and the expected value.
        message: String,
    },
    /// A command is missing.
    #[error("has no line \"{0}\"; expected profileCfg, channelCfg, chirpCfg and frameCfg")]
    Missing(&'static str),
    /// A frame uses a chirp that no line defines.
    #[error("frameCfg uses chirp {0}, which no chirpCfg defines")]
    UndefinedChirp(usize),
    /// The text is of another dialect.
    #[error("is a text of another dialect, {name}, which is not read; what would help is {helps}")]
    Dialect {
        /// Its name.
        name: &'static str,
        /// A remedy.
        helps: &'static str,
    },
    /// There is no such sub-frame.
    #[error("has {found} sub-frames; expected recording.capture.sub_frame = 0 to {}", found - 1)]
    NoSubFrame {
        /// Number of sub-frames in the text.
        found: usize,
    },
}

/// Most chirps in a loop, samples in a chirp and loops in a frame that the hardware knows, with room to spare.
pub(super) const MOST_CHIRPS: usize = 512;
pub(super) const MOST_SAMPLES: usize = 65536;
pub(super) const MOST_LOOPS: usize = 65536;
