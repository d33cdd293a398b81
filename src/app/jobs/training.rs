//! The growing log of a training.

use super::derived::{Failure, Query};
use crate::files::read_bounded;
use crate::platform::Instant;
use crate::task::Task;
use std::path::PathBuf;
use std::time::Duration;

/// Time between two looks at the log.
pub const LOG_INTERVAL: Duration = Duration::from_secs(1);

/// Most points of a curve; a longer log is thinned.
const MAX_CURVE_POINTS: usize = 4000;

/// The curves and the last line of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    pub loss: Vec<[f64; 2]>,
    /// Points of step and smoothed loss, where the log has it.
    pub smoothed: Vec<[f64; 2]>,
    pub last: Vec<(String, String)>,
    pub step: f64,
}

impl Log {
    /// Reads CSV with a heading that names `step` and `loss`; an unfinished last line is left out.
    ///
    /// # Errors
    /// The error, with its line.
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
        let thin = rows.len().div_ceil(MAX_CURVE_POINTS).max(1);
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

/// Largest log, bytes: larger than that of any training that ends in a lifetime.
const MAX_LOG_BYTES: u64 = 256 << 20;

/// A log that is followed.
pub struct Watched {
    pub path: PathBuf,
    since: Instant,
}

impl Watched {
    /// Follows the log at `path` from now on.
    pub fn of(path: PathBuf) -> Watched {
        Watched { path, since: Instant::now() }
    }

    pub fn query(&self) -> LogQuery {
        LogQuery { path: self.path.clone(), look: self.since.elapsed().as_secs() / LOG_INTERVAL.as_secs() }
    }
}

/// A query of a log, with the number of the look.
#[derive(Clone, PartialEq)]
pub struct LogQuery {
    path: PathBuf,
    look: u64,
}

impl Query for LogQuery {
    type Value = Log;
    type State = ();
    const WHAT: &'static str = "Reading the log";
    const ADVICE: &'static str = "Open it again.";

    fn compute(&self, (): &mut (), _: &Task) -> Result<Log, Failure> {
        let told = |error: String| format!("{}: {error}", self.path.display());
        let text = read_bounded(&self.path, MAX_LOG_BYTES).map_err(|e| told(e.to_string()))?;
        let text = String::from_utf8(text).map_err(|e| told(e.to_string()))?;
        Ok(Log::parse(&text).map_err(told)?)
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
        for i in 0..3 * MAX_CURVE_POINTS {
            text += &format!("{i},{}\n", 1.0 / (1 + i) as f64);
        }
        let log = Log::parse(&text).unwrap();
        assert!(log.loss.len() <= MAX_CURVE_POINTS + 1);
        assert_eq!(log.step, (3 * MAX_CURVE_POINTS - 1) as f64);
    }

    #[test]
    fn a_log_that_is_missing_is_told() {
        let query = Watched::of(PathBuf::from("/there/is/no/log.csv")).query();
        let Err(Failure::Because(why)) = query.compute(&mut (), &Task::default()) else {
            panic!("there is no such file")
        };
        assert!(why.contains("log.csv"), "{why}");
    }
}
