//! `apertura threshold` from outside.

use super::rows::json;
use crate::cli::*;

#[test]
fn a_threshold_keeps_the_rate_on_the_scenes_that_chose_it() {
    let threshold = "threshold --method baseline --false-alarm 40 --set 1,2 --count 2 --check 1 --json";
    let report = json(&folder(), threshold);
    let number = |name: &str| report[name].as_f64().unwrap();
    assert_eq!((number("scenes"), number("wanted")), (4.0, 0.4));
    assert!((4.0 * number("false_alarm") + 1.0) / 5.0 <= 0.4, "{report}");
    assert!((0.0..1.0).contains(&number("eta")), "{report}");
    assert!((number("left_to_scenes") - (5.0 * 0.4 - 1.0) / 4.0).abs() < 1e-12, "{report}");
    assert_eq!([number("scenes_within_a_tenth"), report["check"]["scenes"].as_f64().unwrap()], [15.0, 2.0]);
    assert_ne!(report["check"]["false_alarm"], report["false_alarm"], "other scenes");
}
