//! Times of each method on this machine, measured with every reconstruction and kept between starts.

use crate::radar::Radar;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

/// Number of the latest times kept of a method.
const TIMES_PER_METHOD: usize = 5;

/// Elements and samples, which decide most of a method's time.
type Shape = (usize, usize);

/// Times of methods, for each shape of radar.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MethodTimes {
    /// Milliseconds, the latest last.
    measured: BTreeMap<String, Vec<(Shape, VecDeque<f64>)>>,
}

fn shape_of(radar: &Radar) -> Shape {
    (radar.elements, radar.samples)
}

impl MethodTimes {
    /// Adds the time of a method on samples of a radar.
    pub fn record(&mut self, radar: &Radar, method: &str, took: Duration) {
        let (shape, of_method) = (shape_of(radar), self.measured.entry(method.to_owned()).or_default());
        let index = of_method.iter().position(|(of, _)| *of == shape).unwrap_or_else(|| {
            of_method.push((shape, VecDeque::new()));
            of_method.len() - 1
        });
        let times = &mut of_method[index].1;
        times.push_back(took.as_secs_f64() * 1e3);
        while times.len() > TIMES_PER_METHOD {
            times.pop_front();
        }
    }

    /// The median of a method's latest times on samples of a radar, milliseconds; `None` where it has not run yet.
    pub fn typical_ms(&self, radar: &Radar, method: &str) -> Option<f64> {
        let (_, times) = self.measured.get(method)?.iter().find(|(shape, _)| *shape == shape_of(radar))?;
        let mut sorted: Vec<f64> = times.iter().copied().filter(|ms| ms.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_typical_time_is_the_median_of_the_latest() {
        let (mut times, radar) = (MethodTimes::default(), Radar::default());
        assert_eq!(times.typical_ms(&radar, "live"), None);
        for ms in [9000, 9000, 9000, 30, 10, 12, 11, 400] {
            times.record(&radar, "live", Duration::from_millis(ms));
        }
        let typical = times.typical_ms(&radar, "live");
        assert_eq!(typical, Some(12.0), "the first are forgotten, one outlier counts little");
        let small = Radar { elements: 128, ..Radar::default() };
        assert_eq!(times.typical_ms(&small, "live"), None);
    }
}
