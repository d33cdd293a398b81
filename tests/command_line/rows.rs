//! `apertura evaluate --rows` and `--scenes`: the rows, the tables printed of them, and a row's scene by hand.

use crate::cli::*;
use apertura::evaluate::rows::{Column, Row};
use apertura::evaluate::{Estimate, squared_error};
use apertura::maps::RangeAngleMap;

const METHOD: &str = if cfg!(feature = "network") { "live" } else { "matched-filter-incoherent" };

pub fn rows(folder: &TempDir, name: &str) -> Vec<Row> {
    read_rows(std::fs::File::open(folder.path().join(name)).unwrap()).unwrap()
}

pub fn json(folder: &TempDir, arguments: &str) -> Value {
    let output = call(folder, arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The JSON reader may miss the last bit.
fn same(a: &Value, b: f64) -> bool {
    a.as_f64().is_some_and(|a| (a - b).abs() <= 4e-16 * b.abs())
}

/// Rows without the columns that differ from run to run: their times, and the shard that found them.
pub fn figures(rows: Vec<Row>) -> Vec<Row> {
    rows.into_iter().map(|r| Row { milliseconds: 0.0, shard: None, ..r }).collect()
}

pub fn without_times(table: &[u8]) -> Vec<String> {
    let text = String::from_utf8(table.to_vec()).unwrap();
    text.lines().skip(1).map(|l| l.rsplit_once(' ').map_or(l, |(rest, _)| rest).trim_end().to_owned()).collect()
}

#[test]
fn the_printed_means_are_those_of_the_rows() {
    let folder = folder();
    let evaluate = "evaluate --method bartlett,baseline --set 1,3 --count 5 --seed 4";
    let whole = json(&folder, &format!("{evaluate} --json --rows whole.csv"));
    let all = rows(&folder, "whole.csv");
    assert_eq!(all.len(), 2 * 2 * 5);
    for set in whole["sets"].as_array().unwrap() {
        for method in set["methods"].as_array().unwrap() {
            let own =
                || all.iter().filter(|r| set["set"] == r.set.parse::<u32>().unwrap() && *r.method == method["name"]);
            let mean = |value: fn(&Row) -> Option<f64>| Estimate::of(&own().filter_map(value).collect::<Vec<_>>()).mean;
            assert_eq!(own().count(), 5);
            assert!(same(&method["squared_error"]["mean"], mean(|r| Some(r.squared_error))));
            let mut errors: Vec<f64> = own().map(|r| r.squared_error).collect();
            errors.sort_by(f64::total_cmp);
            assert!(same(&method["squared_error"]["median"], errors[2]));
            assert!(same(&method["detection"]["mean"], mean(|r| r.detection)));
            assert!(same(&method["false_alarm"]["mean"], mean(|r| Some(r.false_alarm))));
            assert!(same(&method["detection_at_printed_false_alarm"]["detection"], mean(|r| r.detection_at_printed)));
            assert!(same(&method["missed"]["mean"], mean(|r| Some(r.missed as f64))));
            assert!(same(&method["ghosts"]["mean"], mean(|r| Some(r.ghosts as f64))));
        }
    }
    for part in ["0", "1"] {
        call(&folder, &format!("{evaluate} --shard {part}/2 --rows {part}.csv")).assert().success();
    }
    assert_eq!((rows(&folder, "0.csv").len(), rows(&folder, "1.csv").len()), (12, 8));
    let printed = |arguments: &str| {
        let output = call(&folder, arguments).assert().success();
        without_times(&output.get_output().stdout)
    };
    let merged = printed("evaluate --merge 1.csv 0.csv --rows merged.csv");
    assert_eq!(merged, printed("evaluate --merge whole.csv"));
    assert_eq!(merged, printed(evaluate), "figure for figure");
    assert_eq!(figures(rows(&folder, "merged.csv")), figures(all));
}

#[test]
fn echoes_of_bodies_stand_in_rows_tables_and_json() {
    let folder = folder();
    let evaluate = "evaluate --method baseline --set 1,bodies --count 2 --seed 4 --rows rows.csv";
    let report = json(&folder, &format!("{evaluate} --json"));
    let all = rows(&folder, "rows.csv");
    assert!(all.iter().all(|row| row.echoes.is_some() == (row.set == "bodies")), "points have no such figure");
    let mut sum = apertura::evaluate::echoes::EchoTally::default();
    all.iter().filter_map(Row::echo_tally).for_each(|echoes| sum.add(&echoes));
    let of = |set: usize| &report["sets"][set]["methods"][0]["echoes"];
    assert!(of(0).is_null());
    assert_eq!((&of(1)["there"], &of(1)["found"]), (&serde_json::json!(sum.there), &serde_json::json!(sum.found)));
    assert_eq!(of(1)["below_db"], serde_json::json!([0, 10, 20, 30, 40, 50]));
    assert!(sum.there.iter().skip(1).sum::<usize>() > 0, "weak echoes count: {sum:?}");
    assert!(same(&of(1)["detection"], sum.part().unwrap()));
    let weakest = format!("{} of {}", sum.found[5], sum.there[5]);
    let told = contains("echoes found").and(contains(weakest));
    call(&folder, "evaluate --merge rows.csv").assert().success().stdout(told);
}

#[test]
fn the_part_of_cells_within_doubt_is_that_of_the_rows() {
    let folder = folder();
    let names = "set,index,seed,method,eta,squared_error,detection,false_alarm,detection_at_printed,milliseconds,objects,reflectors,\
                 missed,ghosts,nearest_pair_columns,nearest_pair_bins,min_range_metres,strongest_over_weakest_db,doubt,within_doubt\n";
    let part = |i: u32| if i.is_multiple_of(2) { 0.875 } else { 0.925 };
    let row = |i: u32| format!("1,{i},0,live,0.8,{i},0.9,0.01,,5,3,3,0,0,,,5,0,{i},{}\n", part(i));
    let rows: String = (0..20).map(row).collect();
    std::fs::write(folder.path().join("rows.csv"), format!("{names}{rows}")).unwrap();
    let report = json(&folder, "evaluate --merge rows.csv --json");
    assert!(same(&report["sets"][0]["methods"][0]["within_doubt"]["mean"], 0.9), "{report}");
    let expected =
        "doubt of live: the error of 90.00 \u{b1} 0.574 % of the cells is at most their doubt; 90 % is the aim";
    call(&folder, "evaluate --merge rows.csv").assert().success().stdout(contains(expected));
}

/// The SE of the map of `reconstruct` against the map of `maps`.
pub fn error_by_hand(folder: &Path) -> f64 {
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
    call(&folder, &evaluate).assert().success();
    assert_eq!(rows(&folder, "rows.csv").len(), 2);
    for row in &rows(&folder, "rows.csv") {
        let Row { set, seed, index, .. } = row;
        call(&folder, &format!("scenes --set {set} --seed {seed} --index {index} -o s.toml")).assert().success();
        call(&folder, "maps s.toml -o maps.npz").assert().success();
        call(&folder, &format!("reconstruct maps.npz --method {METHOD} -o out.npz")).assert().success();
        assert_eq!(error_by_hand(folder.path()), row.squared_error, "scene {index} of {set}");
        assert_eq!(row.doubt.is_some(), METHOD == "live", "scene {index} of {set}");
    }
    // The last one alone in a folder is a test set with the same figures.
    std::fs::create_dir(folder.path().join("own")).unwrap();
    std::fs::rename(folder.path().join("s.toml"), folder.path().join("own/s.toml")).unwrap();
    call(&folder, &format!("evaluate --method {METHOD} --scenes own --rows own.csv")).assert().success();
    let (own, all) = (rows(&folder, "own.csv"), rows(&folder, "rows.csv"));
    let last = all.last().unwrap();
    assert_eq!((own.len(), &*own[0].set, own[0].index, own[0].seed), (1, "own", 0, 0));
    let elsewhere = [Column::Set, Column::Index, Column::Seed, Column::Milliseconds];
    for column in Column::FIGURES.iter().filter(|column| !elsewhere.contains(column)) {
        assert!(column.is_same(&own[0], last), "{column:?}");
    }
}

#[test]
fn without_a_terminal_lines_tell_the_progress() {
    let folder = folder();
    for (command, lines) in [
        ("evaluate --set 1 --count 3", ["1 of 3 maps, now set 1;", "2 of 3 maps"]),
        ("layouts --layout two-ends --count 1", ["1 of 3 maps, now set 1, two-ends;", "2 of 3 maps, now set 2"]),
        ("bounds --layout two-ends --snr 20,40 --monte-carlo 1", ["1 of 2 ratios, the last 20 dB;", "left"]),
        (
            "bench --algorithms plan --reflectors 10 --repeats 1",
            [" of 100 percent, the last plan of 10 reflectors;", "left"],
        ),
    ] {
        let told = call(&folder, &format!("{command} --progress 0")).assert().success();
        told.stderr(contains(lines[0]).and(contains(lines[1])).and(contains("so far, about")));
    }
}

#[test]
#[cfg(feature = "network")]
fn a_networks_rows_say_which_weights_it_had() {
    let folder = folder();
    let found = json(&folder, "evaluate --method live,baseline --set 1 --count 1 --json --rows rows.csv");
    let methods = &found["sets"][0]["methods"];
    assert_eq!((&methods[0]["optimiser"], &methods[1]["weights"]), (&"AdamW".into(), &Value::Null));
    let of_row = rows(&folder, "rows.csv")[0].weights.clone();
    assert_eq!((methods[0]["weights"].as_str(), of_row.len()), (Some(&*of_row), 12));
    let text = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    std::fs::write(folder.path().join("other.csv"), text.replace(&*of_row, "0123456789ab")).unwrap();
    let told = contains("weights is").and(contains("0123456789ab in other.csv"));
    call(&folder, "evaluate --merge rows.csv other.csv").assert().failure().stderr(told);
    let table = call(&folder, "evaluate --merge rows.csv").assert().success();
    table.stdout(contains("live (AdamW; eta 0.").and(contains("at each scene's own")).and(contains("  median")));
}

#[test]
fn a_detector_gets_columns_of_its_own() {
    let folder = folder();
    let run = "evaluate --method baseline --set 1 --count 2 --rows";
    call(&folder, &format!("{run} without.csv")).assert().success();
    let with = format!("{run} with.csv --cfar os:guard=2x2:training=4x8:rate=1e-3");
    let table = call(&folder, &with).assert().success();
    table.stdout(contains("by os:guard=2x2:training=4x8:rate=0.001"));
    call(&folder, &with).assert().success().stderr(contains("holds all 2 rows of this run already"));
    let has_rate = |file: &str| rows(&folder, file).iter().all(|row| row.cfar_false_alarm.is_some());
    assert_eq!(["with.csv", "without.csv"].map(has_rate), [true, false]);
    let other = call(&folder, &format!("{run} with.csv")).assert().failure();
    other.stderr(contains("cfar is os:guard=2x2:training=4x8:rate=0.001 there and nothing here"));
    let merged = call(&folder, "evaluate --merge with.csv without.csv").assert().failure();
    merged.stderr(contains("cfar"));
    call(&folder, "evaluate --merge with.csv --json").assert().success().stdout(contains("\"detector\": \"os:"));
    let wrong = call(&folder, "evaluate --cfar ca:training=0x0").assert().failure();
    wrong.stderr(contains("there are no training cells"));
}

#[test]
fn rows_name_the_radar_of_a_file() {
    let folder = folder();
    std::fs::write(folder.path().join("wide.toml"), "[radar]\nbandwidth_hz = 1e9\n").unwrap();
    call(&folder, "evaluate --set 1 --count 1 --radar wide.toml --rows rows.csv").assert().success();
    assert_eq!(&*rows(&folder, "rows.csv")[0].radar, "bandwidth_hz=1000000000.0");
    let both = call(&folder, "evaluate --set 1 --count 1 --radar wide.toml --carrier two-way").output().unwrap();
    assert!(String::from_utf8_lossy(&both.stderr).contains("cannot be used with"), "{both:?}");
}
