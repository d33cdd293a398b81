//! `apertura evaluate --rows` where the file is there already: a run goes on, and a file of other content stays.

use super::merge::older;
use super::rows::{figures, rows, without_times};
use crate::cli::*;

fn begin(folder: &TempDir, arguments: &str) -> std::process::Child {
    std::process::Command::new(env!("CARGO_BIN_EXE_apertura"))
        .current_dir(folder)
        .args(arguments.split_whitespace())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap()
}

fn lines(folder: &TempDir, name: &str) -> usize {
    std::fs::read(folder.path().join(name)).map_or(0, |bytes| bytes.iter().filter(|b| **b == b'\n').count())
}

#[test]
fn a_killed_run_goes_on_where_its_rows_end() {
    let folder = folder();
    let evaluate = "evaluate --method baseline,bartlett,music --set 3 --count 8 --seed 2 --rows";
    let mut run = begin(&folder, &format!("{evaluate} killed.csv"));
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(120);
    while lines(&folder, "killed.csv") < 3 && std::time::Instant::now() < deadline {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    let kept = rows(&folder, "killed.csv");
    assert!((2..24).contains(&kept.len()), "{} rows before the run was killed", kept.len());
    // Half a line, as a run that is killed while it writes leaves it.
    let path = folder.path().join("killed.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("{text}3,7,2,base")).unwrap();
    let on = call(&folder, &format!("{evaluate} killed.csv")).assert().success();
    let printed = without_times(&on.stderr(contains("of 24 rows of this run already")).get_output().stdout);
    let whole = call(&folder, &format!("{evaluate} whole.csv")).assert().success();
    assert_eq!(printed, without_times(&whole.get_output().stdout));
    let all = rows(&folder, "killed.csv");
    assert_eq!(figures(all.clone()), figures(rows(&folder, "whole.csv")));
    assert!(kept.iter().all(|row| all.contains(row)), "the rows that were there are not found again");
    let again = call(&folder, &format!("{evaluate} killed.csv")).assert().success();
    again.stderr(contains("holds all 24 rows of this run"));
    assert_eq!(rows(&folder, "killed.csv"), all);
}

#[test]
fn rows_of_something_else_are_not_written_over() {
    let folder = folder();
    call(&folder, "evaluate --set 1 --count 1 --rows rows.csv").assert().success();
    older(&folder, "rows.csv", "old.csv");
    let text = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    std::fs::write(folder.path().join("format-1.csv"), text.replace(",2,0.2.0,thesis,", ",1,0.1.0,thesis,")).unwrap();
    let wide: String = text.lines().enumerate().map(|(i, line)| format!("note{i},{line}\n")).collect();
    std::fs::write(folder.path().join("wide.csv"), wide).unwrap();
    std::fs::write(folder.path().join("notes.csv"), "day,what\n1,rain\n").unwrap();
    for (arguments, part) in [
        ("--count 1 --floor exact --rows rows.csv", "floor is thesis there and exact here"),
        ("--count 1 --seed 4 --rows rows.csv", "seed is 0 there and 4 here"),
        ("--count 2 --rows rows.csv", "whole is 1 x 1 there and 1 x 2 here"),
        ("--count 1 --method bartlett --rows rows.csv", "rows of set 1 by baseline"),
        ("--count 1 --rows old.csv", "an older program wrote them"),
        ("--count 1 --rows format-1.csv", "version is 1 there and 2 here: the floor \"thesis\" is 1.8 dB quieter"),
        ("--count 1 --rows notes.csv", "there is no column"),
        ("--count 1 --rows wide.csv", "its columns are not those"),
    ] {
        let name = arguments.split_whitespace().last().unwrap();
        let before = std::fs::read(folder.path().join(name)).unwrap();
        let refused = call(&folder, &format!("evaluate --set 1 {arguments}")).assert().failure().stdout("");
        refused.stderr(contains(part).and(contains("--overwrite")));
        assert_eq!(std::fs::read(folder.path().join(name)).unwrap(), before);
    }
    call(&folder, "evaluate --set 1 --count 1 --rows notes.csv --overwrite").assert().success();
    assert_eq!(rows(&folder, "notes.csv").len(), 1);
    call(&folder, "evaluate --set 2 --count 1 --rows two.csv").assert().success();
    let merged = call(&folder, "evaluate --merge rows.csv --rows two.csv").assert().failure();
    merged.stderr(contains("two.csv: it holds other rows"));
}
