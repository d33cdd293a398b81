//! `--layout`: other elements than those of the two ends are heard.

use super::recordings::CHIP;
use super::rows::json;
use crate::cli::*;
use std::fs::{read_to_string, write};

const RADAR: &str = "[radar]\nelements = 64\nend_elements = 6\nsamples = 64\n";

fn with_radar() -> TempDir {
    let folder = folder();
    write(folder.path().join("radar.toml"), RADAR).unwrap();
    folder
}

const NESTED: &str = "0-6 13 20 27 34 41 48 55";

#[test]
fn methods_that_hear_the_layout_are_tried_and_rows_name_it() {
    let folder = with_radar();
    let evaluate = |methods: &str, layout: &str| {
        let run = "evaluate --set 2 --count 1 --json --radar radar.toml --rows rows.csv --method";
        call(&folder, &format!("{run} {methods}")).args(["--layout", layout]).assert()
    };
    let run = evaluate("matched-filter,capon,iaa", "nested=6x8").success();
    let run = run.stderr(contains("left out: capon: it hears the two ends of an array"));
    let report: Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    assert_eq!((&report["layout"], report["sets"][0]["methods"].as_array().unwrap().len()), (&NESTED.into(), 2));
    assert!(read_to_string(folder.path().join("rows.csv")).unwrap().contains(NESTED));
    evaluate("matched-filter,iaa", NESTED).success().stderr(contains("holds all 2 rows"));
    evaluate("matched-filter,iaa", "thinned=8").failure().stderr(contains("layout is 0-6 13"));
    evaluate("capon", "nested=6x8").failure().stderr(contains("it hears the two ends of an array"));
    evaluate("iaa", "nested=40x40").failure().stderr(contains("the radar has elements 0 to 63"));
}

#[test]
fn both_ends_of_a_dataset_are_reconstructed_with_their_radar() {
    let folder = with_radar();
    let ends = Array3::from_shape_fn((2, 6, 64), |(_, _, n)| Complex64::from_polar(3.0, 0.9 * n as f64));
    write_npz(&folder.path().join("in.npz"), |out| out.add("ends", &ends)).unwrap();
    write(folder.path().join("other.toml"), RADAR.replace("end_elements = 6", "end_elements = 8")).unwrap();
    let run = "reconstruct in.npz --method iaa -o out.npz --radar";
    let reconstruct = |radar: &str| call(&folder, &format!("{run} {radar}")).assert();
    reconstruct("radar.toml").success().stdout(contains("wrote"));
    reconstruct("other.toml").failure().stderr(contains("[2, 8, 64]"));
    // An archive of `maps` says its radar itself.
    call(&folder, "maps radar.toml -o in.npz").assert().success();
    reconstruct("radar.toml").success();
    reconstruct("other.toml").failure().stderr(contains("--radar names another"));
}

#[test]
fn maps_of_a_layout_are_what_reconstruct_reads() {
    let folder = folder();
    let point = "[[object]]\nkind = \"point\"\nx_metres = 0.2\ny_metres = 2.0\n";
    write(folder.path().join("scene.toml"), format!("{RADAR}{point}")).unwrap();
    let maps = |output: &str, layout: &str| {
        call(&folder, &format!("maps scene.toml --layout {layout} --method iaa -o {output}")).assert()
    };
    maps("maps.npz", "nested=6x8").success();
    let read = |name: &str| NpzReader::new(File::open(folder.path().join(name)).unwrap()).unwrap();
    let numbers: Array1<i64> = read("maps.npz").by_name("layout").unwrap();
    assert_eq!(numbers.to_vec(), [0, 1, 2, 3, 4, 5, 6, 13, 20, 27, 34, 41, 48, 55]);
    let reconstruct =
        |layout: &str| call(&folder, &format!("reconstruct maps.npz -o again.npz --layout {layout}")).assert();
    reconstruct("nested=6x8").success().stdout(contains("(iaa, "));
    reconstruct("nested=6x8 --method nomp").failure().stderr(contains("it hears the two ends of an array"));
    reconstruct("thinned=8").failure().stderr(contains("samples of the layout"));
    let output: Array3<f32> = read("maps.npz").by_name("output").unwrap();
    let reconstructed: Array2<f32> = read("again.npz").by_name("net_output").unwrap();
    assert_eq!(output.index_axis(Axis(0), 0), reconstructed);
    maps("maps.svg", "nested=6x8").success();
    let svg = read_to_string(folder.path().join("maps.svg")).unwrap();
    assert!(svg.contains("Input: nested=6x8") && !svg.contains("Input 1"));
    maps("maps.svg", "nested=40x40").failure().stderr(contains("the radar has elements 0 to 63"));
}

#[test]
fn thresholds_and_robustness_are_those_of_a_layout() {
    let folder = folder();
    let threshold = "threshold --set 1 --count 2 --false-alarm 50 --json --method";
    let found = |of: &str| json(&folder, &format!("{threshold} {of}"));
    let [ends, nested] = ["two-ends", "nested=12x12"].map(|layout| found(&format!("matched-filter --layout {layout}")));
    assert_eq!((&ends["layout"], &nested["layout"]), (&Value::Null, &"nested=12x12".into()));
    assert_ne!(ends["eta"], nested["eta"]);
    assert_eq!(found("capon --layout two-ends")["layout"], Value::Null, "every method hears two ends");
    let refused = call(&folder, &format!("{threshold} capon --layout nested=12x12")).assert().failure();
    refused.stderr(contains("it hears the two ends of an array"));
    let robustness = "robustness --method matched-filter --count 1 --scale 1 --json --layout";
    let [ends, nested] = ["two-ends", "nested=12x12"].map(|layout| json(&folder, &format!("{robustness} {layout}")));
    assert_eq!(nested["layout"], "nested=12x12");
    assert_ne!(ends["rows"][0]["squared_error"], nested["rows"][0]["squared_error"]);
}

#[test]
fn elements_of_a_recording_are_chosen() {
    let folder = folder();
    let reconstruct = |layout: &str| call(&folder, "reconstruct -o out.npz").args([CHIP, "--layout", layout]).assert();
    reconstruct("0-2,5,7").success();
    reconstruct("0-2,8").failure().stderr(contains("the radar has elements 0 to 7"));
}
