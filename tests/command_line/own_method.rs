//! `--method-command`: a program of one's own as a method.

use apertura::evaluate::rows::{Part, read_rows};
use assert_cmd::Command;
use ndarray::Array2;
use ndarray_npy::{NpzReader, WriteNpyExt};
use predicates::str::contains;
use std::fs::{self, File};
use std::path::Path;

/// Maps that a script answers at most.
const ANSWERS: usize = 4;

fn apertura(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_apertura"));
    command.current_dir(folder);
    command
}

/// What the script answers: a map that rises with range.
fn answer() -> Array2<f32> {
    Array2::from_shape_fn((512, 1024), |(bin, _)| bin as f32 / 512.0)
}

/// A shell script that is called "mine": it answers the same map, then runs `rest`.
fn script(folder: &Path, rest: &str) {
    let mut map = Vec::new();
    answer().write_npy(&mut map).unwrap();
    fs::write(folder.join("map.npy"), &map).unwrap();
    let mut text = "echo '{\"apertura\":1,\"name\":\"mine\",\"eta\":0.125,\"weights\":\"0f\"}'\n".to_owned();
    for id in 1..=ANSWERS {
        let length = map.len();
        text += &format!(
            "echo '{{\"apertura\":1,\"id\":{id},\"arrays\":[{{\"name\":\"lambda\",\"bytes\":{length}}}]}}'\ncat map.npy\n"
        );
    }
    fs::write(folder.join("mine.sh"), text + rest + "\n").unwrap();
}

const COMMAND: [&str; 2] = ["--method-command", "sh mine.sh"];

#[test]
fn rows_name_the_method_that_the_command_says() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path(), "cat > /dev/null");
    let arguments = ["evaluate", "--set", "1", "--count", "2", "--rows", "rows.csv"];
    apertura(folder.path()).args(arguments).args(COMMAND).assert().success().stdout(contains("mine"));
    let rows = read_rows(File::open(folder.path().join("rows.csv")).unwrap()).unwrap();
    assert_eq!(rows.iter().map(|row| (row.method.as_str(), row.eta)).collect::<Vec<_>>(), [("mine", 0.125); 2]);
    let origin = rows[0].origin.as_ref().unwrap();
    assert_eq!(origin.text(Part::Weights), "0f");
}

#[test]
fn a_map_is_written_by_the_command() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path(), "cat > /dev/null");
    apertura(folder.path()).args(["scenes", "--set", "1", "--count", "1", "-o", "."]).assert().success();
    let scene = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().path());
    let scene = scene.into_iter().find(|p| p.extension().is_some_and(|e| e == "toml" || e == "npz")).unwrap();
    apertura(folder.path()).arg("maps").arg(&scene).args(["-o", "in.npz"]).assert().success();
    let written = apertura(folder.path()).args(["reconstruct", "in.npz", "-o", "out.npz"]).args(COMMAND).assert();
    written.success().stdout(contains("(mine, "));
    let mut npz = NpzReader::new(File::open(folder.path().join("out.npz")).unwrap()).unwrap();
    let map: Array2<f32> = npz.by_name("net_output").unwrap();
    assert_eq!(map, answer());
}

#[test]
fn a_command_that_ends_is_told_with_its_last_words() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path(), "echo out of memory >&2; exit 7");
    let arguments = ["evaluate", "--set", "1", "--count", "6"];
    let failed = apertura(folder.path()).args(arguments).args(COMMAND).assert().failure();
    failed.stderr(contains("mine: it ended (exit status: 7)")).stderr(contains("out of memory"));
}

#[test]
fn commands_that_are_no_methods_are_told() {
    let folder = tempfile::tempdir().unwrap();
    for (command, part) in [
        ("", "the command is empty"),
        ("/nowhere/program", "/nowhere/program: it can't be started"),
        ("sh -c 'echo hello'", "wrote \"hello\" on its standard output"),
        ("echo {\"apertura\":1,\"name\":\"baseline\"}", "wrote"),
        ("echo '{\"apertura\":1,\"name\":\"baseline\"}'", "a method of this program is called \"baseline\""),
    ] {
        let asked = ["evaluate", "--count", "1", "--method-command", command];
        apertura(folder.path()).args(asked).assert().failure().stderr(contains(part));
    }
}

#[test]
fn the_method_may_stand_beside_others() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path(), "cat > /dev/null");
    let arguments = ["evaluate", "--set", "1", "--count", "1", "--method", "mine,baseline"];
    let found = apertura(folder.path()).args(arguments).args(COMMAND).assert().success();
    found.stdout(contains("mine (eta 0.125)")).stdout(contains("baseline"));
}
