//! `apertura evaluate --rows`, `--shard`, `--merge`, `--scenes`; a row's scene by hand; `apertura worsen`.

use apertura::evaluate::rows::{Row, read_rows};
use apertura::evaluate::{Estimate, squared_error};
use apertura::files::npz::Npz;
use apertura::maps::{LogMap, Normalisation, RangeAngleMap};
use apertura::scene::file;
use assert_cmd::Command;
use ndarray::{Axis, Ix2, Ix3};
use predicates::str::contains;
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// The one whose figures are reproduced by hand.
const METHOD: &str = if cfg!(feature = "network") { "live" } else { "matched-filter-incoherent" };

fn apertura(folder: &TempDir, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_apertura"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn rows(folder: &TempDir, name: &str) -> Vec<Row> {
    read_rows(std::fs::File::open(folder.path().join(name)).unwrap()).unwrap()
}

fn json(folder: &TempDir, arguments: &str) -> Value {
    let output = apertura(folder, arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The JSON reader may miss the last bit.
fn same(a: &Value, b: f64) -> bool {
    a.as_f64().is_some_and(|a| (a - b).abs() <= 4e-16 * b.abs())
}

/// A table's lines without the times at their ends.
fn without_times(table: &[u8]) -> Vec<String> {
    let text = String::from_utf8(table.to_vec()).unwrap();
    text.lines().skip(1).map(|l| l.rsplit_once(' ').map_or(l, |(rest, _)| rest).trim_end().to_owned()).collect()
}

#[test]
fn the_printed_means_are_those_of_the_rows_and_shards_add_up() {
    let folder = folder();
    let evaluate = "evaluate --method bartlett,baseline --set 1,3 --count 5 --seed 4";
    let whole = json(&folder, &format!("{evaluate} --json --rows whole.csv"));
    let all = rows(&folder, "whole.csv");
    assert_eq!(all.len(), 2 * 2 * 5);
    for set in whole["sets"].as_array().unwrap() {
        for method in set["methods"].as_array().unwrap() {
            let own =
                || all.iter().filter(|r| set["set"] == r.set.parse::<u32>().unwrap() && r.method == method["name"]);
            let mean = |value: fn(&Row) -> Option<f64>| Estimate::of(&own().filter_map(value).collect::<Vec<_>>()).mean;
            assert_eq!(own().count(), 5);
            assert!(same(&method["squared_error"]["mean"], mean(|r| Some(r.squared_error))));
            assert!(same(&method["detection"]["mean"], mean(|r| r.detection)));
            assert!(same(&method["false_alarm"]["mean"], mean(|r| Some(r.false_alarm))));
            assert!(same(&method["detection_at_printed_false_alarm"]["detection"], mean(|r| r.detection_at_printed)));
            assert!(same(&method["missed"]["mean"], mean(|r| Some(r.missed as f64))));
            assert!(same(&method["ghosts"]["mean"], mean(|r| Some(r.ghosts as f64))));
        }
    }
    for part in ["0", "1"] {
        apertura(&folder, &format!("{evaluate} --shard {part}/2 --rows {part}.csv")).assert().success();
    }
    assert_eq!((rows(&folder, "0.csv").len(), rows(&folder, "1.csv").len()), (12, 8));
    let printed = |arguments: &str| {
        let output = apertura(&folder, arguments).assert().success();
        without_times(&output.get_output().stdout)
    };
    let merged = printed("evaluate --merge 1.csv 0.csv --rows merged.csv");
    assert_eq!(merged, printed("evaluate --merge whole.csv"));
    assert_eq!(merged, printed(evaluate), "figure for figure");
    let figures = |rows: Vec<Row>| rows.into_iter().map(|r| Row { milliseconds: 0.0, ..r }).collect::<Vec<_>>();
    assert_eq!(figures(rows(&folder, "merged.csv")), figures(all));
}

/// The SE of what `reconstruct` wrote against what `maps` wrote.
fn error_by_hand(folder: &Path) -> f64 {
    let open = |name: &str| Npz::open(&folder.join(name)).unwrap();
    let decades = open("maps.npz").reals::<Ix3>("polar_full").unwrap().index_axis_move(Axis(0), 0);
    let output = open("out.npz").reals::<Ix2>("net_output").unwrap();
    let output = RangeAngleMap { lambda: output.mapv(|v| v as f32) };
    squared_error(&LogMap::new(decades).normalise(Normalisation::MinMax), &output)
}

#[test]
fn a_row_can_be_reproduced_by_hand_to_the_last_digit() {
    let folder = folder();
    let evaluate = format!("evaluate --method {METHOD} --set 2,walls --count 2 --shard 1/2 --seed 9 --rows rows.csv");
    apertura(&folder, &evaluate).assert().success();
    assert_eq!(rows(&folder, "rows.csv").len(), 2);
    for row in &rows(&folder, "rows.csv") {
        let Row { set, seed, index, .. } = row;
        apertura(&folder, &format!("scenes --set {set} --seed {seed} --index {index} -o s.toml")).assert().success();
        apertura(&folder, "maps s.toml -o maps.npz").assert().success();
        apertura(&folder, &format!("reconstruct maps.npz --method {METHOD} -o out.npz")).assert().success();
        assert_eq!(error_by_hand(folder.path()), row.squared_error, "scene {index} of {set}");
    }
    // The last one alone in a folder is a test set with the same figures.
    std::fs::create_dir(folder.path().join("own")).unwrap();
    std::fs::rename(folder.path().join("s.toml"), folder.path().join("own/s.toml")).unwrap();
    apertura(&folder, &format!("evaluate --method {METHOD} --scenes own --rows own.csv")).assert().success();
    let (own, all) = (rows(&folder, "own.csv"), rows(&folder, "rows.csv"));
    let last = all.last().unwrap();
    let place = Row { set: "own".into(), index: 0, seed: 0, milliseconds: own[0].milliseconds, ..last.clone() };
    assert_eq!(own, [place]);
}

#[test]
fn what_is_wrong_with_rows_is_named() {
    let folder = folder();
    std::fs::write(folder.path().join("bad.csv"), "set,index\n1,2\n").unwrap();
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    apertura(&folder, "evaluate --count 1 --set 1 --rows good.csv").assert().success();
    let good = std::fs::read_to_string(folder.path().join("good.csv")).unwrap();
    std::fs::write(folder.path().join("word.csv"), good.replace("\n1,0,", "\n1,zero,")).unwrap();
    for (arguments, part) in [
        ("evaluate --merge bad.csv", "bad.csv: line 1: there is no column \"seed\""),
        ("evaluate --merge word.csv", "word.csv: line 2, column index: \"zero\""),
        ("evaluate --merge good.csv good.csv", "stands in good.csv and in good.csv"),
        ("evaluate --merge missing.csv", "missing.csv"),
        ("evaluate --scenes empty", "no scene in this folder"),
        ("evaluate --scenes missing", "missing"),
        ("evaluate --shard 2/2", "I from 0 to N - 1"),
        ("evaluate --count 2 --shard 3/4", "has no scene"),
        ("evaluate --rows no/where.csv --count 1 --set 1", "where.csv"),
        ("scenes --set 1 --index 1 -o s.gif", ".toml or .npz"),
        ("scenes --set 1 -o s", "--count"),
        ("worsen missing.toml --method baseline -o w.toml", "missing.toml"),
        ("worsen good.csv --method baseline -o w.toml", "good.csv"),
    ] {
        apertura(&folder, arguments).assert().failure().stdout("").stderr(contains(part));
    }
}

#[test]
fn worsen_repeats_itself_and_what_it_writes_is_as_bad_as_it_says() {
    let folder = folder();
    apertura(&folder, "scenes --set 2 --seed 3 --index 1 -o s.toml").assert().success();
    let worsen = "worsen s.toml --method baseline --tries 24 --within 1.5 --seed 5 -o";
    let output = apertura(&folder, &format!("{worsen} w.toml")).assert().success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    apertura(&folder, &format!("{worsen} again.toml")).assert().success();
    let [found, again] = ["w.toml", "again.toml"].map(|name| file::load(&folder.path().join(name)).unwrap().scene);
    assert_eq!(found, again);
    let start = file::load(&folder.path().join("s.toml")).unwrap().scene;
    for (a, b) in start.objects.iter().zip(&found.objects) {
        let ([ax, ay], [bx, by]) = (a.centre_metres(), b.centre_metres());
        assert!((bx - ax).hypot(by - ay) <= 1.5 + 1e-9);
    }
    apertura(&folder, "maps w.toml -o maps.npz").assert().success();
    apertura(&folder, "reconstruct maps.npz --method baseline -o out.npz").assert().success();
    let after = text.lines().find(|l| l.starts_with("after")).unwrap();
    assert!(after.contains(&format!("SE {:.1},", error_by_hand(folder.path()))), "{text}");
    apertura(&folder, "worsen s.toml --method baseline --tries 8 --within 0 -o x.toml")
        .assert()
        .failure()
        .stderr(contains("expected a number from 0.000001 to 1000"));
}

/// Within 2 m and a minute, five times the squared error for four of five starts of set 1.
#[test]
#[ignore = "minutes; prints what the search finds for the live network"]
#[cfg(feature = "network")]
fn worsen_finds_trouble_for_the_live_network() {
    let folder = folder();
    let mut factors: Vec<f64> = (0..5)
        .map(|index| {
            apertura(&folder, &format!("scenes --set 1 --seed 11 --index {index} -o s.toml")).assert().success();
            let start = std::time::Instant::now();
            let arguments = "worsen s.toml --method live --within 2 --minutes 1 -o w.toml";
            let output = apertura(&folder, arguments).assert().success();
            let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
            let error = |line: &str| {
                let line = text.lines().find(|l| l.starts_with(line)).unwrap();
                line.split("SE ").nth(1).unwrap().split(',').next().unwrap().parse::<f64>().unwrap()
            };
            println!("{:.0} s\n{text}", start.elapsed().as_secs_f64());
            error("after") / error("before")
        })
        .collect();
    factors.sort_by(f64::total_cmp);
    println!("{factors:.1?}");
    assert!(factors[1] >= 5.0);
}
