//! The end of a process' standard error.

use std::collections::VecDeque;
use std::io::Read;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

const KEPT_BYTES: usize = 2000;

/// The last bytes that were read, shared between the reading thread and the callers.
#[derive(Debug, Clone, Default)]
pub struct Tail(Arc<(Mutex<Kept>, Condvar)>);

#[derive(Debug, Default)]
struct Kept {
    bytes: VecDeque<u8>,
    is_whole: bool,
}

impl Tail {
    /// Reads until the end of `from`.
    pub fn follow(&self, mut from: impl Read) {
        let (kept, ended) = &*self.0;
        let mut bytes = [0; 1024];
        while let Ok(count @ 1..) = from.read(&mut bytes) {
            tracing::debug!("{}", String::from_utf8_lossy(&bytes[..count]).trim_end());
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.bytes.extend(&bytes[..count]);
            let surplus = kept.bytes.len().saturating_sub(KEPT_BYTES);
            kept.bytes.drain(..surplus);
        }
        kept.lock().unwrap_or_else(PoisonError::into_inner).is_whole = true;
        ended.notify_all();
    }

    /// The bytes so far, after waiting up to `wait` for the end: whole lines, where more than one is kept.
    pub fn text(&self, wait: Duration) -> String {
        let (kept, ended) = &*self.0;
        let kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        let (kept, _) =
            ended.wait_timeout_while(kept, wait, |kept| !kept.is_whole).unwrap_or_else(PoisonError::into_inner);
        let bytes: Vec<u8> = kept.bytes.iter().copied().collect();
        let text = String::from_utf8_lossy(&bytes);
        let whole =
            if bytes.len() == KEPT_BYTES { text.split_once('\n').map_or(&*text, |(_, rest)| rest) } else { &text };
        whole.trim_end().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_lines_are_kept_whole() {
        let tail = Tail::default();
        let lines: String = (0..1000).map(|n| format!("line {n}\n")).collect();
        tail.follow(lines.as_bytes());
        let text = tail.text(Duration::ZERO);
        assert!(text.len() < KEPT_BYTES && text.starts_with("line ") && text.ends_with("\nline 999"), "{text}");
    }
}
