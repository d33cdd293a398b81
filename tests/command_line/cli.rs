//! The command line from outside: good input, bad input, and nothing half-written.

use super::rows::json;
pub use apertura::evaluate::campaign::Campaign;
pub use apertura::evaluate::rows::read_rows;
pub use apertura::evaluate::sets::SceneSet;
pub use apertura::files::npz::{Npz, write_npz};
pub use apertura::maps::{LogMap, Normalisation};
pub use apertura::radar::Radar;
pub use apertura::reconstruct::{Baseline, Request};
pub use apertura::scene::generate::Kind;
use apertura::scene::npz;
pub use apertura::scene::{Scene, file};
pub use apertura::signal::Floor;
pub use assert_cmd::Command;
pub use ndarray::{Array1, Array2, Array3, Axis, Ix1, Ix2, Ix3};
use ndarray::{array, s};
pub use ndarray_npy::NpzReader;
pub use num_complex::Complex64;
pub use predicates::prelude::PredicateBooleanExt;
pub use predicates::str::contains;
pub use serde_json::Value;
pub use std::collections::BTreeSet;
pub use std::fs::File;
pub use std::path::{Path, PathBuf};
pub use tempfile::TempDir;

/// The program in an empty folder, without a display.
pub fn apertura(folder: &TempDir) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_apertura"));
    command.current_dir(folder).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command
}

pub fn call(folder: &TempDir, arguments: &str) -> Command {
    let mut command = apertura(folder);
    command.args(arguments.split_whitespace());
    command
}

pub fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

const TWO_POINTS: &str = "
[[object]]
kind = \"point\"
x_metres = 3.0
y_metres = 12.0
[[object]]
kind = \"point\"
x_metres = -4.0
y_metres = 20.0
";

#[test]
fn a_range_doppler_map_is_written_as_numbers_or_a_picture() {
    let folder = folder();
    let small = "[radar]\nelements = 64\nsamples = 64\nconvention = \"physical\"\n";
    let moving = TWO_POINTS.replacen("y_metres = 12.0", "y_metres = 2.0\nvelocity_y_metres_per_second = 90.0", 1);
    std::fs::write(folder.path().join("scene.toml"), format!("{small}{moving}")).unwrap();
    let to = |name: &str| call(&folder, &format!("range-doppler scene.toml -o {name} --chirps 32"));
    to("map.npz").assert().success().stderr(contains("beyond the unambiguous 37.5 m/s"));
    let mut archive = Npz::open(&folder.path().join("map.npz")).unwrap();
    assert_eq!(archive.reals::<Ix2>("power").unwrap().dim(), (64, 32));
    assert_eq!(archive.reals::<Ix1>("velocity_metres_per_second").unwrap()[16], 0.0);
    to("map.png").assert().success();
    assert!(std::fs::read(folder.path().join("map.png")).unwrap().starts_with(b"\x89PNG"));
    to("map.txt").assert().failure().stderr(contains(".npz, .png or .svg"));
    to("map.png").args(["--interval", "nan"]).assert().failure().stderr(contains("expected a number"));
    to("map.png").args(["--chirps", "1"]).assert().failure();
    assert_eq!(names(folder.path()), ["map.npz", "map.png", "scene.toml"]);
}

#[test]
fn the_environment_picks_the_instructions_or_is_refused() {
    let folder = folder();
    std::fs::write(folder.path().join("scene.toml"), TWO_POINTS).unwrap();
    let with =
        |set: &str, to: &str| call(&folder, &format!("maps scene.toml -o {to}")).env("APERTURA_SIMD", set).assert();
    with("portable", "a.npz").success();
    with("sse2", "b.npz").failure().stderr(contains("\"sse2\"; expected portable, avx2 or avx512"));
    assert_eq!(names(folder.path()), ["a.npz", "scene.toml"]);
}

#[test]
fn maps_have_the_layout_of_the_authors_program() {
    let folder = folder();
    std::fs::write(folder.path().join("scene.toml"), TWO_POINTS).unwrap();
    call(&folder, "maps scene.toml -o maps.npz").assert().success().stdout(contains("maps.npz"));
    let mut found = Npz::open(&folder.path().join("maps.npz")).unwrap();
    assert_eq!(found.reals::<Ix1>("all_point_x").unwrap(), array![3.0, -4.0]);
    assert_eq!(found.reals::<Ix1>("all_point_y").unwrap(), array![12.0, 20.0]);
    for key in ["sub0", "sub1"] {
        assert_eq!(found.complexes::<Ix2>(key).unwrap().dim(), (512, 12), "{key}");
    }
    let full = found.reals::<Ix3>("polar_full").unwrap();
    assert_eq!(full.dim(), (1, 512, 1024));
    assert!(full.iter().any(|v| *v < -10.0) && full.iter().any(|v| *v > 0.0), "decades, not normalised");
    let input = found.reals::<Ix3>("polar_partial_mag_phase").unwrap();
    assert_eq!(input.dim(), (4, 512, 1024));
    let magnitude = input.slice(s![0, .., ..]).mapv(|v| v * v) + input.slice(s![1, .., ..]).mapv(|v| v * v);
    let (min, max) = magnitude.iter().fold((f64::MAX, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    assert!(min < 1e-12 && (max - 1.0).abs() < 1e-9, "Lambda runs from 0 to 1, found {min} to {max}");
    for (key, count) in [("range_metres", 512), ("cos_theta", 1024), ("element_x_metres", 1024)] {
        assert_eq!(found.reals::<Ix1>(key).unwrap().len(), count, "{key}");
    }
    assert!(!found.has("output"), "no method was asked for");
    call(&folder, "maps maps.npz -o again.npz").assert().success();
    let again = Npz::open(&folder.path().join("again.npz")).unwrap().reals::<Ix3>("polar_full").unwrap();
    assert_eq!(again, full);
}

#[test]
fn a_start_without_display_draws_the_default_scene() {
    let folder = folder();
    let drawn = apertura(&folder).assert().success().stdout(contains("apertura.png"));
    let told = String::from_utf8(drawn.get_output().stderr.clone()).unwrap();
    assert!(told.contains("drawing its panels to a picture instead") && told.lines().count() == 1, "{told}");
    let picture = folder.path().join("apertura.png");
    assert!(image::open(&picture).unwrap().width() > 1000);
    std::fs::write(&picture, "another program's file").unwrap();
    apertura(&folder).assert().success().stdout(contains("apertura-2.png"));
    assert_eq!(std::fs::read(&picture).unwrap(), b"another program's file");
    assert_eq!(names(folder.path()), ["apertura-2.png", "apertura.png"]);
}

#[test]
fn a_start_without_display_draws_the_output_of_the_asked_method() {
    let folder = folder();
    std::fs::write(folder.path().join("s.toml"), TWO_POINTS).unwrap();
    let drawn = |method: &[&str]| {
        apertura(&folder).arg("s.toml").args(method).assert().success();
        std::fs::read(folder.path().join("apertura.png")).unwrap()
    };
    assert_ne!(drawn(&["--method", "matched-filter"]), drawn(&[]));
}

#[test]
fn a_start_without_display_draws_the_scene_that_was_asked_for() {
    let folder = folder();
    apertura(&folder).arg("missing.toml").assert().failure().stderr(contains("error: missing.toml"));
    // A radar of another shape, which the default method doesn't take.
    std::fs::write(folder.path().join("s.toml"), format!("[radar]\nelements = 128\n{TWO_POINTS}")).unwrap();
    apertura(&folder).arg("s.toml").assert().success();
    call(&folder, "maps s.toml -o s.png").assert().success();
    assert_eq!(names(folder.path()), ["apertura.png", "s.png", "s.toml"]);
}

#[test]
fn scenes_are_the_same_for_the_same_seed_in_both_formats() {
    let folder = folder();
    for (dir, format) in [("a", "toml"), ("b", "toml"), ("c", "npz")] {
        call(&folder, &format!("scenes --set 3 --count 2 --seed 5 -o {dir} --format {format}")).assert().success();
    }
    let path = |dir: &str, name: &str| folder.path().join(dir).join(name);
    assert_eq!(names(&folder.path().join("a")), ["set3-seed5-0000.toml", "set3-seed5-0001.toml"]);
    let (a, b) = (path("a", "set3-seed5-0001.toml"), path("b", "set3-seed5-0001.toml"));
    assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(b).unwrap());
    let positions: Vec<_> =
        file::load(&a).unwrap().scene.reflectors().iter().map(|r| (r.x_metres, r.y_metres)).collect();
    let archive = npz::read(&path("c", "set3-seed5-0001.npz")).unwrap().reflectors();
    assert_eq!(archive.iter().map(|r| (r.x_metres, r.y_metres)).collect::<Vec<_>>(), positions);
}

#[test]
fn bodies_saved_as_positions_are_told_once_a_run() {
    let folder = folder();
    for (arguments, lines) in [
        ("scenes --set bodies --index 0 -o b.npz", 1),
        ("scenes --set bodies --count 2 --format npz -o b", 1),
        ("scenes --set bodies --index 0 -o b.toml", 0),
        ("scenes --set 2 --index 0 -o p.npz", 0),
    ] {
        let done = call(&folder, arguments).assert().success();
        let told = String::from_utf8(done.get_output().stderr.clone()).unwrap();
        let is_of_bodies = told.lines().all(|line| line.contains("a body becomes points"));
        assert!(told.lines().count() == lines && is_of_bodies, "{arguments}: {told}");
    }
}

#[test]
fn an_empty_scene_has_neither_peak_nor_echo() {
    let folder = folder();
    std::fs::write(folder.path().join("empty.toml"), "name = \"empty\"\n").unwrap();
    let maps = call(&folder, "maps empty.toml -o in.npz").assert().success();
    maps.stdout(contains("there is no peak").and(contains("spans").not()));
    let found = call(&folder, "reconstruct in.npz -o out.npz --method iaa").assert().success();
    found.stdout(contains("no echo found"));
}

#[test]
fn evaluate_prints_the_documented_object() {
    let (folder, start) = (folder(), std::time::Instant::now());
    let run = || json(&folder, "evaluate --method baseline --set 1 --count 2 --seed 3 --json");
    let (first, second) = (run(), run());
    assert_eq!((&first["count"], &first["seed"], &first["floor"]), (&2.into(), &3.into(), &"thesis".into()));
    let set = &first["sets"][0];
    assert_eq!((&set["set"], &set["printed"]["baseline"]["squared_error"]), (&1.into(), &20565.3.into()));
    let method = &set["methods"][0];
    assert_eq!(method["name"], "baseline");
    for key in ["squared_error", "detection", "false_alarm"] {
        assert!(method[key]["mean"].is_f64() && method[key]["standard_error"].is_f64(), "{key}");
        assert_eq!(method[key], second["sets"][0]["methods"][0][key], "{key} repeats");
    }
    let at = &method["detection_at_printed_false_alarm"];
    assert_eq!((&at["false_alarm"], &at["threshold"]), (&0.0037.into(), &"each scene's own".into()));
    let at = at["detection"].as_f64().unwrap();
    // The ROC knows 4097 thresholds; the right one lies above the largest whose rate is too high.
    let [most, least] = [0.0, 2.0 / 4096.0].map(|above| detection_by_hand(0.0037, above));
    assert!((least..=most).contains(&at), "{least} to {most}, not {at}");
    let milliseconds = method["median_milliseconds"].as_f64().unwrap();
    assert!((1e-3..1e3 * start.elapsed().as_secs_f64()).contains(&milliseconds), "{milliseconds}");
}

/// Mean P_D of the baseline on the first two scenes of set 1, seed 3, each `above` the threshold that as many dark cells exceed as the rate says.
fn detection_by_hand(false_alarm: f64, above: f32) -> f64 {
    let campaign = Campaign { seed: 3, ..Campaign::default() };
    let of_scene = |index| {
        let trial = campaign.trial(&SceneSet::Generated(Kind::Set1), &campaign.generator(), index).unwrap();
        let answer = trial.ask(&Baseline, &Request { noise: campaign.floor.into(), ..Request::default() }).unwrap();
        let cells = || trial.target.lambda.iter().zip(&answer.found.lambda.lambda);
        let mut dark: Vec<f32> = cells().filter(|(t, _)| **t <= 0.9).map(|(_, o)| *o).collect();
        dark.sort_by(|a, b| b.total_cmp(a));
        let eta = dark[(false_alarm * dark.len() as f64) as usize] + above;
        let bright: Vec<f32> = cells().filter(|(t, _)| **t > 0.9).map(|(_, o)| *o).collect();
        bright.iter().filter(|o| **o > eta).count() as f64 / bright.len() as f64
    };
    (of_scene(0) + of_scene(1)) / 2.0
}

#[test]
fn evaluate_shows_ours_beside_the_printed() {
    let told = contains("Table 4.2").and(contains("11334.99")).and(contains("1341.22")).and(contains("baseline"));
    call(&folder(), "evaluate --set 2 --count 2").assert().success().stdout(told).stderr("");
}

#[test]
fn bad_input_leaves_no_file() {
    let folder = folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("good.toml", TWO_POINTS);
    write("key.toml", "[[object]]\nkind = \"point\"\nx_metres = 1\nz_metres = 2\n");
    write("text.npz", "not an archive");
    write("scene.yaml", TWO_POINTS);
    write("recording.toml", "[recording]\nfile = \"a.npz\"\n");
    write_npz(&folder.path().join("half.npz"), |out| out.add("all_point_x", &array![1.0])).unwrap();
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    call(&folder, "evaluate --count 1 --set 1 --rows good.csv").assert().success();
    let before = names(folder.path());
    for (arguments, part) in [
        ("maps missing.toml -o out.npz", "No such file"),
        ("maps key.toml -o out.npz", "key.toml: line 4"),
        ("maps text.npz -o out.npz", "numpy.savez"),
        ("maps half.npz -o out.npz", "all_point_y"),
        ("maps scene.yaml -o out.npz", ".toml or .npz"),
        ("maps good.toml -o out.gif", "a scene has no frames"),
        ("maps good.toml -o out.bmp", ".npz, .png"),
        ("maps good.toml -o nowhere/out.npz", "nowhere"),
        ("maps good.toml -o out.npz --carrier sideways", "one-way"),
        ("maps good.toml -o out.png --method magic", "baseline"),
        ("scenes --set 4 --count 1 -o d", "1, 2 or 3"),
        ("maps good.toml -o out.png --config a.cfg", "good.toml: --config is that of a raw capture"),
        ("maps good.toml -o out.npz --cfar ca", "out.npz: --cfar is a picture's"),
        ("maps good.toml -o out.npz --colours grey", "--colours is a picture's"),
        ("range-doppler good.toml -o out.png --config a.cfg", "--config is that of a raw capture"),
        ("range-doppler good.toml -o out.npz --normalisation db=40", "--normalisation is a picture's"),
        ("range-doppler good.toml -o out.npz --static-clutter-out", "--static-clutter-out is a recording's"),
        ("budget recording.toml", "recording.toml: line 1, column 1: this is a recording; expected a scene"),
        ("worsen recording.toml --method baseline -o w.toml", "this is a recording; expected a scene"),
        ("scenes --set 1 --count 1 -o good.toml", "good.toml: is a file; expected a folder"),
        ("scenes --set 1 --index 1 -o good.toml/a.toml", "good.toml: is a file; expected a folder"),
        ("scenes --set 1 -o s", "--count"),
        ("evaluate --method magic", "baseline"),
        ("evaluate --set 1,9", "1, 2 or 3"),
        ("evaluate --merge good.csv good.csv", "stands in good.csv and in good.csv"),
        ("evaluate --merge missing.csv", "missing.csv"),
        ("evaluate --scenes empty", "no scene in this folder"),
        ("evaluate --scenes missing", "missing"),
        ("evaluate --count 2 --shard 3/4", "has no scene"),
        ("evaluate --rows no/where.csv --count 1 --set 1", "where.csv"),
        ("worsen missing.toml --method baseline -o w.toml", "missing.toml"),
        ("worsen good.csv --method baseline -o w.toml", "good.csv"),
        ("worsen good.toml --method baseline -o w.npz", "expected a name ending in .toml"),
        ("bench --others missing.py", "missing.py: "),
    ] {
        call(&folder, arguments).assert().failure().stdout("").stderr(contains(part));
    }
    assert_eq!(names(folder.path()), before, "nothing was written");
}
