//! The progress of an evaluation: a bar on a terminal, now and then a line elsewhere.

use crate::evaluate::rows::Row;
use crate::platform::console::note;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// The count of finished maps, shown on standard error.
pub struct MapProgress {
    bar: ProgressBar,
    every: Option<Duration>,
    begun: Instant,
    told: Instant,
    done: u64,
    total: u64,
}

impl MapProgress {
    /// The progress of a run of `total` maps; off a terminal a line after each `every`.
    pub fn new(total: u64, every: Duration) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} maps, {eta} left");
        let bar = ProgressBar::new(total).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let every = (!std::io::stderr().is_terminal()).then_some(every);
        let now = Instant::now();
        MapProgress { bar, every, begun: now, told: now, done: 0, total }
    }

    pub fn row(&mut self, row: &Row) {
        self.done += 1;
        self.bar.set_message(row.set.to_string());
        self.bar.inc(1);
        if self.every.is_some_and(|every| self.told.elapsed() >= every) && self.done < self.total {
            self.told = Instant::now();
            note(&self.line(&row.set, self.begun.elapsed()));
        }
    }

    fn line(&self, set: &str, so_far: Duration) -> String {
        let left = so_far.mul_f64((self.total - self.done) as f64 / self.done as f64);
        let [so_far, left] = [so_far, left].map(HumanDuration);
        format!("{} of {} maps, now set {set}; {so_far} so far, about {left} left", self.done, self.total)
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_much_is_left() {
        let progress = MapProgress { done: 30, ..MapProgress::new(120, Duration::from_secs(30)) };
        let line = progress.line("walls", Duration::from_secs(60));
        assert_eq!(line, "30 of 120 maps, now set walls; 60 seconds so far, about 3 minutes left");
    }
}
