//! `apertura train`, and the training programs beside it, as far as they run without PyTorch.

use crate::cli::*;
use std::process::{Command, Output};

const RECIPE: &str = "
name = \"tiny\"
description = \"one step\"
seed = 3
epochs = 1
batch = 1
loss = \"mean-square\"
validation_scenes = 0
network = { kind = \"thesis\", filters = 1, levels = 1, alive_output = true }
optimizer = { kind = \"sgd\", learning_rate = 0.01, momentum = 0.9 }
scenes = [{ kind = { points = 1 }, count = 2 }]
";

#[test]
fn a_run_goes_on_by_its_own_recipe() {
    let folder = folder();
    std::fs::write(folder.path().join("tiny.toml"), RECIPE).unwrap();
    let run = |arguments: &str| apertura(&folder).args(arguments.split(' ')).assert();
    run("train tiny.toml --output r --steps 1").success().stdout(contains("1 step, 1 map,"));
    std::fs::remove_file(folder.path().join("tiny.toml")).unwrap();
    run("train --resume r").success().stdout(contains("2 steps, 2 maps,"));
    let told = contains("nowhere").and(contains("expected it in the folder of a run"));
    run("train --resume nowhere").failure().stderr(told);
    run("train").failure().stderr(contains("<RECIPE"));
}

/// The output of a training program; `None` where there is no Python.
fn python(program: &str, arguments: &[&str]) -> Option<Output> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("training").join(program);
    match Command::new("python3").arg(path).args(arguments).env("PYTHONDONTWRITEBYTECODE", "1").output() {
        Ok(output) => Some(output),
        Err(error) => {
            eprintln!("not tried, python3 can't be run: {error}");
            None
        }
    }
}

#[test]
fn the_training_programs_say_what_is_missing() {
    let folder = folder();
    let empty = folder.path().to_str().unwrap();
    let export = format!("{empty}/x.safetensors");
    for (program, arguments, expected) in [
        ("train_live.py", vec!["--minutes", "1"], "--out DIR is missing"),
        ("train_thesis.py", vec!["--experiment", "1"], "--out DIR is missing"),
        ("train_live.py", vec!["--out", empty, "--export", &export], "saw no map"),
        ("train_thesis.py", vec!["--experiment", "2", "--out", empty, "--export", &export], "--untrained"),
    ] {
        let Some(output) = python(program, &arguments) else { return };
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(expected), "{program}: {said}");
        assert!(!said.contains("Traceback"), "{said}");
    }
    assert!(!Path::new(&export).exists());
}
