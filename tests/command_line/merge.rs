//! `apertura evaluate --shard` and `--merge`: rows of several runs are put together, or refused with a reason.

use super::rows::{json, without_times};
use crate::cli::*;

/// Rows of an older program, without their conditions: the first columns alone.
pub fn older(folder: &TempDir, name: &str, to: &str) {
    let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
    let old = |line: &str| line.split(',').take(21).collect::<Vec<_>>().join(",") + "\n";
    std::fs::write(folder.path().join(to), text.lines().map(old).collect::<String>()).unwrap();
}

#[test]
fn older_rows_are_read_with_each_other_alone() {
    let folder = folder();
    for shard in ["0", "1"] {
        call(&folder, &format!("evaluate --set 1 --count 4 --shard {shard}/2 --rows {shard}.csv")).assert().success();
        older(&folder, &format!("{shard}.csv"), &format!("old-{shard}.csv"));
    }
    let both = call(&folder, "evaluate --merge old-0.csv old-1.csv").assert().success();
    let both = both.stderr(contains("don't say what made them"));
    let new = call(&folder, "evaluate --merge 0.csv 1.csv").assert().success();
    let without_line = |output: &[u8]| without_times(output).into_iter().skip(1).collect::<Vec<_>>();
    assert_eq!(without_line(&both.get_output().stdout), without_line(&new.get_output().stdout));
    let mixed = call(&folder, "evaluate --merge old-0.csv 1.csv").assert().failure().stdout("");
    mixed.stderr(contains("version is not recorded in old-0.csv").and(contains("2 in 1.csv")));
    let gaps = call(&folder, "evaluate --merge old-1.csv").assert().failure();
    gaps.stderr(contains("set 1, baseline: 2 of 4 scenes (number 0, 2)"));
}

#[test]
fn what_lacks_of_a_run_is_listed() {
    let folder = folder();
    let evaluate = "evaluate --method baseline,bartlett --set 1,2 --count 4";
    for shard in ["0", "1"] {
        call(&folder, &format!("{evaluate} --shard {shard}/2 --rows {shard}.csv")).assert().success();
    }
    let path = |name: &str| folder.path().join(name);
    let text = std::fs::read_to_string(path("1.csv")).unwrap();
    let whole: Vec<&str> = text.lines().collect();
    std::fs::write(path("half.csv"), &text[..text.len() - 7]).unwrap();
    std::fs::write(path("header.csv"), format!("{}\n", whole[0])).unwrap();
    for (files, part) in [
        ("0.csv", "set 2, bartlett: 2 of 4 scenes (shard 1/2)"),
        ("0.csv half.csv", "half.csv ends within a line"),
        ("0.csv header.csv", "header.csv holds no row"),
    ] {
        call(&folder, &format!("evaluate --merge {files}")).assert().failure().stdout("").stderr(contains(part));
        let partial = call(&folder, &format!("evaluate --merge {files} --partial --json")).assert().success();
        let found: Value = serde_json::from_slice(&partial.stderr(contains(part)).get_output().stdout).unwrap();
        assert!(found["missing"][0]["missing"].as_u64().unwrap() > 0, "{files}");
    }
    call(&folder, "evaluate --merge header.csv --partial").assert().failure().stderr(contains("holds no row"));
    let found = json(&folder, "evaluate --merge 0.csv 1.csv --json");
    assert_eq!((&found["missing"], &found["count"]), (&Value::Array(Vec::new()), &4.into()));
    assert_eq!((&found["floor"], &found["carrier"]), (&"thesis".into(), &"one-way".into()), "rows say it");
}
