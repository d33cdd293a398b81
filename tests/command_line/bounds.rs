//! `apertura bounds`, `apertura layouts` and `apertura robustness` from outside.

use super::rows::json;
use crate::cli::*;

#[test]
fn a_gain_an_end_is_bounded_where_it_is_asked_for() {
    let (folder, bounds) = (folder(), "bounds --layout two-ends --at 5,18 --snr 0");
    let row = |more: &str| json(&folder, &format!("{bounds} --json {more}"))["layouts"][0]["bounds"][0].clone();
    assert!(row("")["gain_per_end"].is_null());
    let asked = row("--gain-per-end");
    let of = |which: &str, what: &str| asked[which][what].as_f64().unwrap();
    assert!((of("alone", "columns") / 0.0021 - 1.0).abs() < 0.04, "{asked}");
    assert!((of("gain_per_end", "columns") / 0.126 - 1.0).abs() < 0.02, "{asked}");
    assert!((of("gain_per_end", "position_millimetres") / 4.8 - 1.0).abs() < 0.02, "{asked}");
    let told =
        contains("one unknown complex gain").and(contains("amplitude, dB")).and(contains("No unbiased estimator"));
    call(&folder, &format!("{bounds} --gain-per-end")).assert().success().stdout(told);
    // 24 elements of 512 samples at 0 dB: 0.64 %.
    assert!((of("alone", "amplitude_db") / 0.0554 - 1.0).abs() < 0.01, "{asked}");
}

#[test]
fn a_budget_is_that_of_the_radar_equation() {
    let folder = folder();
    let snr = json(&folder, "budget --json")["object"]["sample_snr_db"].as_f64().unwrap();
    // 10 square metres at 50 m.
    assert!((snr - Radar::default().link(10.0, 50.0, 1.0).sample.0).abs() < 1e-5, "{snr}");
    let text = "[radar.budget]\nnoise_figure_db = 15.0\n[[object]]\nkind = \"point\"\nx_metres = 0\ny_metres = 50\ncross_section_dbsm = 10\n";
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let report = json(&folder, "budget scene.toml --json");
    for row in [&report["object"], &report["objects"][0]] {
        assert!((snr - 3.0 - row["sample_snr_db"].as_f64().unwrap()).abs() < 1e-9, "{row}");
    }
    let told = contains("point 1").and(contains("falls to 13 dB at"));
    call(&folder, "budget scene.toml").assert().success().stdout(told);
}

#[test]
fn pictures_are_written_where_asked() {
    let (folder, bounds) = (folder(), "bounds --layout two-ends --snr 20,40 --monte-carlo 2 -o new");
    call(&folder, bounds).assert().success().stdout(contains("error / bound"));
    let out = folder.path().join("new");
    let written: Value = serde_json::from_slice(&std::fs::read(out.join("bounds.json")).unwrap()).unwrap();
    let told = [&Value::from("two-ends"), &40.0.into()];
    assert_eq!([&written["layouts"][0]["layout"], &written["monte_carlo"][1]["snr_db"]], told);
    for name in ["bounds.svg", "bounds.png", "ambiguity.png", "monte-carlo.svg", "monte-carlo.png"] {
        let bytes = std::fs::read(out.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(bytes.starts_with(if name.ends_with("png") { b"\x89PNG" } else { b"<svg" }), "{name}");
    }
}

#[test]
fn layouts_are_compared_over_the_same_scenes() {
    let rows = json(&folder(), "layouts --layout two-ends,random=24:3 --count 1 --json");
    for row in rows.as_array().unwrap() {
        assert!(row["elements"] == 24 && row["squared_error"].as_array().unwrap().len() == 3, "{row}");
    }
    let side_lobe = |i: usize| rows[i]["lobes"]["highest_side_lobe"].as_f64().unwrap();
    assert!(side_lobe(0) > 0.98 && side_lobe(1) < 0.8);
}

#[test]
fn robustness_prints_a_line_for_each_case() {
    let run = call(&folder(), "robustness --method bartlett,baseline --count 1 --scale 0,2").assert().success();
    let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
    let lines: Vec<Vec<&str>> = text.lines().skip(1).map(|l| l.split_whitespace().collect()).collect();
    assert_eq!((lines.len(), lines[1][..4].to_vec()), (4, vec!["bartlett", "2", "1", "20"]));
    assert_ne!(lines[2][5], lines[3][5], "elements that are off change the map");
}

#[test]
fn robustness_prints_one_object_on_request() {
    let report = json(&folder(), "robustness --method baseline --count 2 --scale 0,2 --json");
    assert_eq!(["count", "floor"].map(|key| &report[key]), [&Value::from(2), &Value::from("thesis")]);
    let rows = report["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &rows[1]["scale"], &rows[1]["phase_degrees"]), (2, &2.0.into(), &20.0.into()));
    let error = &rows[1]["squared_error"];
    assert!(error["mean"].as_f64().unwrap() > error["standard_error"].as_f64().unwrap());
}
