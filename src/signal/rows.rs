//! Sets of range bins: the rows of profiles and maps that may be non-zero.

use std::ops::Range;

/// A set of range bins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rows {
    bins: Vec<bool>,
}

impl Rows {
    pub fn none(bins: usize) -> Self {
        Rows { bins: vec![false; bins] }
    }

    pub fn all(bins: usize) -> Self {
        Rows { bins: vec![true; bins] }
    }

    pub fn contains(&self, bin: usize) -> bool {
        self.bins.get(bin).copied().unwrap_or(false)
    }

    pub fn count(&self) -> usize {
        self.bins.iter().filter(|b| **b).count()
    }

    pub fn is_empty(&self) -> bool {
        !self.bins.contains(&true)
    }

    /// Adds the bins from `first` to `last`, both included; bins past either end wrap around, as ranges do.
    pub fn insert_wrapped(&mut self, first: f64, last: f64) {
        let len = self.bins.len();
        let span = last - first;
        if span.is_nan() || span >= len as f64 - 1.0 {
            self.bins.fill(true);
            return;
        }
        let start = first.rem_euclid(len as f64) as usize;
        let end = start + span as usize + 1;
        self.bins[start.min(len)..end.min(len)].fill(true);
        self.bins[..end.saturating_sub(len)].fill(true);
    }

    pub fn extend(&mut self, other: &Rows) {
        self.bins.iter_mut().zip(&other.bins).for_each(|(a, b)| *a |= *b);
    }

    /// Neighbouring bins as ranges, lowest first.
    pub fn runs(&self) -> Vec<Range<usize>> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        for (bin, _) in self.bins.iter().enumerate().filter(|(_, has)| **has) {
            match runs.last_mut() {
                Some(run) if run.end == bin => run.end += 1,
                _ => runs.push(bin..bin + 1),
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_wrap_around() {
        let mut rows = Rows::none(10);
        rows.insert_wrapped(-2.0, 1.0);
        rows.insert_wrapped(25.0, 26.0);
        assert_eq!(rows.runs(), [0..2, 5..7, 8..10]);
        assert_eq!(rows.count(), 6);
        rows.insert_wrapped(3.0, 1e18);
        assert_eq!(rows, Rows::all(10));
        let mut rows = Rows::none(10);
        rows.insert_wrapped(f64::NAN, 2.0);
        assert_eq!(rows, Rows::all(10), "a place that is not known may be anywhere");
    }
}
