//! `--method-command`: a program of one's own as a method.

use apertura::evaluate::rows::read_rows;
use assert_cmd::Command;
use ndarray::{Array2, Array3};
use ndarray_npy::{NpzReader, ReadNpyExt, WriteNpyExt};
use num_complex::Complex64;
use predicates::str::contains;
use std::fs::{self, File};
use std::path::Path;

fn apertura(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_apertura"));
    command.current_dir(folder);
    command
}

/// What the script answers: a map that rises with range.
fn answer() -> Array2<f32> {
    Array2::from_shape_fn((512, 1024), |(bin, _)| bin as f32 / 512.0)
}

/// Reads a question as docs/own-network.md says: its line, and as many bytes as the line names.
const READ: &str = r#"while IFS= read -r line; do
  id=${line#*\"id\":}; id=${id%%,*}
  case $line in *'"ask":"hello"'*)
    echo '{"apertura":1,"id":0,"name":"mine","eta":0.125,"weights":"0f","arrays":[]}'; continue ;;
  esac
  bytes=${line##*\"bytes\":}; bytes=${bytes%%\}*}
  head -c "$bytes" > question.npy
"#;

/// Answers the map in map.npy.
const ANSWER: &str =
    r#"echo '{"apertura":1,"id":'"$id"',"arrays":[{"name":"lambda","bytes":'"$(wc -c < map.npy)"'}]}'; cat map.npy"#;

/// A shell script that is called "mine" and does `on_question` for every map it is asked for.
fn script_that(folder: &Path, map: &Array2<f32>, on_question: &str) {
    let mut bytes = Vec::new();
    map.write_npy(&mut bytes).unwrap();
    fs::write(folder.join("map.npy"), &bytes).unwrap();
    fs::write(folder.join("mine.sh"), format!("{READ}{on_question}\ndone\n")).unwrap();
}

/// A script that answers the same map each time.
fn script(folder: &Path) {
    script_that(folder, &answer(), ANSWER);
}

const COMMAND: [&str; 2] = ["--method-command", "sh mine.sh"];

#[test]
fn rows_name_the_method_that_the_command_says() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path());
    let arguments = ["evaluate", "--set", "1", "--count", "2", "--rows", "rows.csv"];
    apertura(folder.path()).args(arguments).args(COMMAND).assert().success().stdout(contains("mine"));
    let rows = read_rows(File::open(folder.path().join("rows.csv")).unwrap()).unwrap();
    assert_eq!(rows.iter().map(|row| (&*row.method, row.eta)).collect::<Vec<_>>(), [("mine", 0.125); 2]);
    assert_eq!(rows[0].weights, "0f");
}

#[test]
fn a_map_is_written_by_the_command() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path());
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
fn the_command_is_told_the_samples() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path());
    apertura(folder.path()).args(["evaluate", "--set", "1", "--count", "1"]).args(COMMAND).assert().success();
    let question = fs::read(folder.path().join("question.npy")).unwrap();
    let samples = Array3::<Complex64>::read_npy(&question[..]).unwrap();
    assert_eq!(samples.dim(), (2, 12, 512));
}

/// What `apertura evaluate` says of a script that does `on_question`.
fn told(map: &Array2<f32>, on_question: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    script_that(folder.path(), map, on_question);
    let asked = ["evaluate", "--set", "1", "--count", "2", "--method-seconds", "5"];
    let failed = apertura(folder.path()).args(asked).args(COMMAND).assert().failure();
    String::from_utf8(failed.get_output().stderr.clone()).unwrap()
}

#[test]
fn a_command_that_fails_is_told_with_its_last_words() {
    let whole = answer();
    let narrow = Array2::zeros((512, 24));
    let mut hole = answer();
    hole[[7, 9]] = f32::NAN;
    let answers = format!("echo thinking >&2; {ANSWER}");
    for (case, map, on_question, parts) in [
        ("it ends", &whole, "echo out of memory >&2; exit 7", ["mine: it ended (exit status: 7)", "out of memory"]),
        ("it hangs", &whole, "echo thinking >&2; sleep 100", ["no answer within 5 s", "thinking"]),
        (
            "it prints",
            &whole,
            "echo thinking >&2; echo epoch 1",
            ["wrote \"epoch 1\" on its standard output", "thinking"],
        ),
        ("a wrong shape", &narrow, &answers, ["512", "thinking"]),
        ("NaN", &hole, &answers, ["NaN", "thinking"]),
    ] {
        let told = told(map, on_question);
        for part in parts {
            assert!(told.contains(part), "{case}: \"{part}\" is not in {told}");
        }
    }
}

#[test]
fn commands_that_are_no_methods_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let baseline = READ.replace("\"mine\"", "\"baseline\"") + "done\n";
    fs::write(folder.path().join("baseline.sh"), baseline).unwrap();
    for (command, part) in [
        ("", "the command is empty"),
        ("/nowhere/program", "/nowhere/program: it can't be started"),
        ("sh -c 'echo hello'", "wrote \"hello\" on its standard output"),
        ("sh -c 'read line; echo {}'", "expected"),
        ("sh baseline.sh", "a method of this program is called \"baseline\""),
    ] {
        let asked = ["evaluate", "--count", "1", "--method-command", command];
        apertura(folder.path()).args(asked).assert().failure().stderr(contains(part));
    }
}

#[test]
fn the_method_may_stand_beside_others() {
    let folder = tempfile::tempdir().unwrap();
    script(folder.path());
    let arguments = ["evaluate", "--set", "1", "--count", "1", "--method", "mine,baseline"];
    let found = apertura(folder.path()).args(arguments).args(COMMAND).assert().success();
    found.stdout(contains("mine (eta 0.125)")).stdout(contains("baseline"));
}
