//! `apertura threshold` from outside.

use super::cli::program as apertura;

#[test]
fn a_threshold_keeps_the_rate_on_the_scenes_that_chose_it() {
    let run = apertura(&["threshold", "--method", "baseline", "--false-alarm", "40", "--set", "1,2", "--count", "2"])
        .args(["--check", "1", "--json"])
        .assert()
        .success();
    let report: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let number = |name: &str| report[name].as_f64().unwrap();
    assert_eq!((number("scenes"), number("wanted")), (4.0, 0.4));
    assert!((4.0 * number("false_alarm") + 1.0) / 5.0 <= 0.4, "{report}");
    assert!((0.0..1.0).contains(&number("eta")), "{report}");
    assert!((number("left_to_scenes") - (5.0 * 0.4 - 1.0) / 4.0).abs() < 1e-12, "{report}");
    assert_eq!([number("scenes_within_a_tenth"), report["check"]["scenes"].as_f64().unwrap()], [15.0, 2.0]);
    assert_ne!(report["check"]["false_alarm"], report["false_alarm"], "other scenes");
}
