//! A training that is watched: its log, which grows.

use crate::files::read_bounded;
use crate::platform::Instant;
use crate::task::{Reply, Task, Worker};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Time between two looks at the log.
pub const LOG_INTERVAL: Duration = Duration::from_secs(1);

/// Most points of a curve; a longer log is thinned.
const POINTS: usize = 4000;

/// What a log says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// Step and loss.
    pub loss: Vec<[f64; 2]>,
    /// Step and smoothed loss, where the log has it.
    pub smoothed: Vec<[f64; 2]>,
    /// Names and values of the last line.
    pub last: Vec<(String, String)>,
    /// Last step.
    pub step: f64,
}

impl Log {
    /// Reads CSV with a heading that names `step` and `loss`; an unfinished last line is left out.
    ///
    /// # Errors
    /// What is wrong, with the line.
    pub fn parse(text: &str) -> Result<Log, String> {
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut lines = whole.lines();
        let Some(heading) = lines.next() else { return Ok(Log::default()) };
        let names: Vec<&str> = heading.split(',').map(str::trim).collect();
        let column = |name: &str| names.iter().position(|n| *n == name);
        let (Some(step), Some(loss)) = (column("step"), column("loss")) else {
            return Err(format!("line 1: expected a heading with step and loss, found \"{heading}\""));
        };
        let smoothed = column("smoothed_loss");
        let rows: Vec<&str> = lines.filter(|l| !l.trim().is_empty()).collect();
        let thin = rows.len().div_ceil(POINTS).max(1);
        let mut log = Log::default();
        for (number, row) in rows.iter().enumerate() {
            if number % thin != 0 && number + 1 != rows.len() {
                continue;
            }
            let values: Vec<&str> = row.split(',').map(str::trim).collect();
            let value = |column: usize| -> Result<f64, String> {
                let text = values.get(column).copied().unwrap_or("");
                text.parse()
                    .map_err(|_| format!("line {}: {} is \"{text}\"; expected a number", number + 2, names[column]))
            };
            log.step = value(step)?;
            log.loss.push([log.step, value(loss)?]);
            if let Some(smoothed) = smoothed {
                log.smoothed.push([log.step, value(smoothed)?]);
            }
            if number + 1 == rows.len() {
                log.last = names.iter().zip(&values).map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
            }
        }
        Ok(log)
    }
}

/// Longer than the log of any training that ends in a lifetime.
const MAX_LOG_BYTES: u64 = 256 << 20;

fn read_log(path: &Path) -> std::io::Result<String> {
    String::from_utf8(read_bounded(path, MAX_LOG_BYTES)?).map_err(std::io::Error::other)
}

/// What is watched.
pub struct Training {
    worker: Worker<PathBuf, Result<Log, String>>,
    path: Option<PathBuf>,
    looked: Option<Instant>,
    log: Option<Log>,
    note: Option<String>,
}

impl Training {
    /// Starts the thread that reads logs, which waits; `wake` is called from it.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> Training {
        let read = |_: &mut (), path: PathBuf, _: &Task| {
            let text = read_log(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            Log::parse(&text).map_err(|e| format!("{}: {e}", path.display()))
        };
        let worker = Worker::spawn("training log", || (), read, wake);
        Training { worker, path: None, looked: None, log: None, note: None }
    }

    /// The log that is followed.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The latest log.
    pub fn log(&self) -> Option<&Log> {
        self.log.as_ref()
    }

    /// What is wrong with it.
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Follows a log.
    pub fn follow(&mut self, path: PathBuf) {
        (self.path, self.log, self.note, self.looked) = (Some(path), None, None, None);
    }

    /// Looks at the log again once a while; called while the panel is visible. Returns when to call again.
    pub fn look(&mut self) -> Option<Duration> {
        let due = self.looked.is_none_or(|t| t.elapsed() >= LOG_INTERVAL);
        if let Some(path) = self.path.clone().filter(|_| due && !self.worker.is_busy()) {
            self.looked = Some(Instant::now());
            self.worker.request(path);
        }
        self.path.as_ref().map(|_| LOG_INTERVAL)
    }

    /// Takes in what was read. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: Ok(log), .. } => self.log = Some(log),
                Reply::Done { result: Err(error), .. } => self.note = Some(error),
                Reply::Panicked { message: said, .. } => message = Some(format!("Reading the log failed: {said}")),
            }
        }
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_are_read_as_they_grow() {
        let text = "step,epoch,loss,smoothed_loss\n1,0,4.0,4.0\n2,0,2.0,3.9\n3,0,1.";
        let log = Log::parse(text).unwrap();
        assert_eq!(log.loss, [[1.0, 4.0], [2.0, 2.0]]);
        assert_eq!(log.smoothed[1], [2.0, 3.9]);
        assert_eq!(log.last[2], ("loss".to_owned(), "2.0".to_owned()));
        assert_eq!(Log::parse("").unwrap(), Log::default());
        let error = Log::parse("step,loss\n1,2\n2,abc\n").unwrap_err();
        assert!(error.contains("line 3") && error.contains("abc"), "{error}");
        assert!(Log::parse("time,value\n1,2\n").unwrap_err().contains("step and loss"));
    }

    #[test]
    fn long_logs_are_thinned_to_their_last_line() {
        let mut text = String::from("step,loss\n");
        for i in 0..3 * POINTS {
            text += &format!("{i},{}\n", 1.0 / (1 + i) as f64);
        }
        let log = Log::parse(&text).unwrap();
        assert!(log.loss.len() <= POINTS + 1);
        assert_eq!(log.step, (3 * POINTS - 1) as f64);
    }

    #[test]
    fn a_log_that_is_missing_is_told() {
        let (wake, woken) = std::sync::mpsc::channel();
        let mut training = Training::start(move || wake.send(()).unwrap());
        training.follow(PathBuf::from("/there/is/no/log.csv"));
        training.look();
        woken.recv_timeout(Duration::from_secs(20)).unwrap();
        training.poll();
        assert!(training.note().unwrap().contains("log.csv"));
    }
}
