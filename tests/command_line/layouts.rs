//! `--layout`: other elements than those of the two ends are heard.

use crate::cli::*;
use assert_cmd::assert::Assert;
use std::fs::{read_to_string, write};

fn radar(folder: &Path) -> PathBuf {
    let path = folder.join("radar.toml");
    write(&path, "[radar]\nelements = 64\nend_elements = 6\nsamples = 64\n").unwrap();
    path
}

const NESTED: &str = "0-6 13 20 27 34 41 48 55";

#[test]
fn methods_that_hear_the_layout_are_tried_and_rows_name_it() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.csv");
    let evaluate = |methods: &str, layout: &str| {
        let mut command = program(&["evaluate", "--set", "2", "--count", "1", "--json", "--method", methods]);
        command.arg("--radar").arg(radar(folder.path())).args(["--layout", layout, "--rows"]).arg(&rows);
        command.assert()
    };
    let run = evaluate("matched-filter,capon,iaa", "nested=6x8").success();
    let run = run.stderr(contains("left out: capon: it hears the two ends of an array"));
    let report: Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    assert_eq!((&report["layout"], report["sets"][0]["methods"].as_array().unwrap().len()), (&NESTED.into(), 2));
    assert!(read_to_string(&rows).unwrap().contains(NESTED));
    evaluate("matched-filter,iaa", NESTED).success().stderr(contains("holds all 2 rows"));
    evaluate("matched-filter,iaa", "thinned=8").failure().stderr(contains("layout is 0-6 13"));
    evaluate("capon", "nested=6x8").failure().stderr(contains("it hears the two ends of an array"));
    evaluate("iaa", "nested=40x40").failure().stderr(contains("the radar has elements 0 to 63"));
}

#[test]
fn both_ends_of_a_dataset_are_reconstructed_with_their_radar() {
    let folder = tempfile::tempdir().unwrap();
    let [input, output, other] = ["in.npz", "out.npz", "other.toml"].map(|name| folder.path().join(name));
    let ends = Array3::from_shape_fn((2, 6, 64), |(_, _, n)| Complex64::from_polar(3.0, 0.9 * n as f64));
    write_npz(&input, |out| out.add("ends", &ends)).unwrap();
    let reconstruct = |radar: &Path| {
        let mut command = program(&["reconstruct", "--method", "iaa", "-o"]);
        command.arg(&output).arg(&input).arg("--radar").arg(radar);
        command.assert()
    };
    reconstruct(&radar(folder.path())).success().stdout(contains("wrote"));
    write(&other, "[radar]\nelements = 64\nend_elements = 8\nsamples = 64\n").unwrap();
    reconstruct(&other).failure().stderr(contains("[2, 8, 64]"));
    // An archive of `maps` says its radar itself.
    let mut maps = program(&["maps", "-o"]);
    maps.arg(&input).arg(radar(folder.path())).assert().success();
    reconstruct(&radar(folder.path())).success();
    reconstruct(&other).failure().stderr(contains("--radar names another"));
}

#[test]
fn maps_of_a_layout_are_what_reconstruct_reads() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[[object]]\nkind = \"point\"\nx_metres = 0.2\ny_metres = 2.0\n";
    write(&scene, read_to_string(radar(folder.path())).unwrap() + text).unwrap();
    let maps = |output: &Path, layout: &str| {
        program(&["maps", "--layout", layout, "--method", "iaa"]).arg(&scene).arg("-o").arg(output).assert()
    };
    let (archive, again) = (folder.path().join("maps.npz"), folder.path().join("again.npz"));
    maps(&archive, "nested=6x8").success();
    let read = |path: &Path| NpzReader::new(File::open(path).unwrap()).unwrap();
    let numbers: Array1<i64> = read(&archive).by_name("layout").unwrap();
    assert_eq!(numbers.to_vec(), [0, 1, 2, 3, 4, 5, 6, 13, 20, 27, 34, 41, 48, 55]);
    let reconstruct = |layout: &str, method: &[&str]| {
        let mut command = program(&["reconstruct", "--layout", layout]);
        command.args(method).arg(&archive).arg("-o").arg(&again).assert()
    };
    reconstruct("nested=6x8", &[]).success().stdout(contains("(iaa, "));
    reconstruct("nested=6x8", &["--method", "nomp"]).failure().stderr(contains("it hears the two ends of an array"));
    reconstruct("thinned=8", &[]).failure().stderr(contains("samples of the layout"));
    let output: Array3<f32> = read(&archive).by_name("output").unwrap();
    let reconstructed: Array2<f32> = read(&again).by_name("net_output").unwrap();
    assert_eq!(output.index_axis(Axis(0), 0), reconstructed);
    let picture = folder.path().join("maps.svg");
    maps(&picture, "nested=6x8").success();
    let svg = read_to_string(&picture).unwrap();
    assert!(svg.contains("Input: nested=6x8") && !svg.contains("Input 1"));
    maps(&picture, "nested=40x40").failure().stderr(contains("the radar has elements 0 to 63"));
}

#[test]
fn thresholds_and_robustness_are_those_of_a_layout() {
    let threshold = ["threshold", "--set", "1", "--count", "2", "--false-alarm", "50", "--json", "--method"];
    let found = |method: &str, layout: &str| program(&threshold).arg(method).args(["--layout", layout]).assert();
    let report = |run: Assert| serde_json::from_slice::<Value>(&run.get_output().stdout).unwrap();
    let [ends, nested] = ["two-ends", "nested=12x12"].map(|layout| report(found("matched-filter", layout).success()));
    assert_eq!((&ends["layout"], &nested["layout"]), (&Value::Null, &"nested=12x12".into()));
    assert_ne!(ends["eta"], nested["eta"]);
    assert_eq!(report(found("capon", "two-ends").success())["layout"], Value::Null, "every method hears two ends");
    found("capon", "nested=12x12").failure().stderr(contains("it hears the two ends of an array"));
    let robustness = ["robustness", "--method", "matched-filter", "--count", "1", "--scale", "1", "--json", "--layout"];
    let robustness = |layout: &str| report(program(&robustness).arg(layout).assert().success());
    let [ends, nested] = ["two-ends", "nested=12x12"].map(robustness);
    assert_eq!(nested["layout"], "nested=12x12");
    assert_ne!(ends["rows"][0]["squared_error"], nested["rows"][0]["squared_error"]);
}

#[test]
fn elements_of_a_recording_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let chip = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/recordings/chip-8.toml");
    let reconstruct = |layout: &str| {
        let mut command = program(&["reconstruct", chip, "--layout", layout, "-o"]);
        command.arg(folder.path().join("out.npz")).assert()
    };
    reconstruct("0-2,5,7").success();
    reconstruct("0-2,8").failure().stderr(contains("the radar has elements 0 to 7"));
}
