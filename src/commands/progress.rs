//! The progress of long work on standard error: a bar on a terminal, now and then a line elsewhere.

use crate::platform::console::note;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// How often progress is told.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct ProgressArg {
    /// Seconds between lines of progress if standard error is no terminal
    #[arg(long, value_name = "SECONDS", default_value_t = 30)]
    progress: u32,
}

impl ProgressArg {
    /// The progress of `total` steps, which are called `unit` in the plural.
    pub fn of(self, total: u64, unit: &'static str) -> StepProgress {
        StepProgress::new(total, unit, Duration::from_secs(self.progress.into()))
    }
}

/// The count of finished steps.
pub struct StepProgress {
    bar: ProgressBar,
    every: Option<Duration>,
    begun: Instant,
    told: Instant,
    done: u64,
    total: u64,
    unit: &'static str,
}

impl StepProgress {
    fn new(total: u64, unit: &'static str, every: Duration) -> Self {
        let template = format!("{{msg}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left");
        let style = ProgressStyle::with_template(&template);
        let bar = ProgressBar::new(total).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let every = (!std::io::stderr().is_terminal()).then_some(every);
        let now = Instant::now();
        StepProgress { bar, every, begun: now, told: now, done: 0, total, unit }
    }

    /// Counts one step more; `place` says where the work is, as in "now set 2".
    pub fn step(&mut self, place: impl Display) {
        self.reach(self.done + 1, place);
    }

    /// Counts `done` steps in all.
    pub fn reach(&mut self, done: u64, place: impl Display) {
        self.done = done;
        self.bar.set_message(place.to_string());
        self.bar.set_position(done);
        let is_due = self.every.is_some_and(|every| self.told.elapsed() >= every);
        if is_due && (1..self.total).contains(&done) {
            self.told = Instant::now();
            note(&self.line(&place, self.begun.elapsed()));
        }
    }

    fn line(&self, place: &impl Display, so_far: Duration) -> String {
        let left = so_far.mul_f64((self.total - self.done) as f64 / self.done as f64);
        let [so_far, left] = [so_far, left].map(HumanDuration);
        format!("{} of {} {}, {place}; {so_far} so far, about {left} left", self.done, self.total, self.unit)
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
        let progress = StepProgress { done: 30, ..StepProgress::new(120, "maps", Duration::from_secs(30)) };
        let line = progress.line(&"now set walls", Duration::from_secs(60));
        assert_eq!(line, "30 of 120 maps, now set walls; 60 seconds so far, about 3 minutes left");
    }
}
