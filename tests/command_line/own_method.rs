//! `--method-command`: a program of one's own as a method.

use crate::cli::*;
use ndarray_npy::{ReadNpyExt, WriteNpyExt};
use std::fs;

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

const ANSWER: &str =
    r#"echo '{"apertura":1,"id":'"$id"',"arrays":[{"name":"lambda","bytes":'"$(wc -c < map.npy)"'}]}'; cat map.npy"#;

/// A shell script that is called "mine" and does `on_question` for every map it is asked for; [`ANSWER`] answers the same map each time.
fn script(folder: &TempDir, on_question: &str) {
    let mut bytes = Vec::new();
    answer().write_npy(&mut bytes).unwrap();
    fs::write(folder.path().join("map.npy"), &bytes).unwrap();
    fs::write(folder.path().join("mine.sh"), format!("{READ}{on_question}\ndone\n")).unwrap();
}

const COMMAND: [&str; 2] = ["--method-command", "sh mine.sh"];

#[test]
fn rows_name_the_method_that_the_command_says() {
    let folder = folder();
    script(&folder, ANSWER);
    let arguments = ["evaluate", "--set", "1", "--count", "2", "--method", "mine,baseline", "--rows", "rows.csv"];
    let found = apertura(&folder).args(arguments).args(COMMAND).assert().success();
    found.stdout(contains("mine (eta 0.125)").and(contains("baseline")));
    let rows = read_rows(File::open(folder.path().join("rows.csv")).unwrap()).unwrap();
    let own: Vec<_> = rows.iter().filter(|row| row.method == "mine").map(|row| (row.eta, &*row.weights)).collect();
    assert_eq!(own, [(0.125, "0f"); 2]);
    let question = fs::read(folder.path().join("question.npy")).unwrap();
    assert_eq!(Array3::<Complex64>::read_npy(&question[..]).unwrap().dim(), (2, 12, 512), "the samples of both ends");
}

#[test]
fn a_map_is_written_by_the_command() {
    let folder = folder();
    script(&folder, ANSWER);
    call(&folder, "scenes --set 1 --index 0 -o scene.toml").assert().success();
    call(&folder, "maps scene.toml -o in.npz").assert().success();
    let written = apertura(&folder).args(["reconstruct", "in.npz", "-o", "out.npz"]).args(COMMAND).assert();
    written.success().stdout(contains("(mine, "));
    let map = Npz::open(&folder.path().join("out.npz")).unwrap().reals::<Ix2>("net_output").unwrap();
    assert_eq!(map, answer().mapv(f64::from));
}

#[test]
fn a_command_with_the_name_of_a_method_is_refused() {
    let folder = folder();
    let baseline = READ.replace("\"mine\"", "\"baseline\"") + "done\n";
    fs::write(folder.path().join("baseline.sh"), baseline).unwrap();
    let asked = ["evaluate", "--count", "1", "--method-command", "sh baseline.sh"];
    let refused = apertura(&folder).args(asked).assert().failure();
    refused.stderr(contains("a method of this program is called \"baseline\""));
}
