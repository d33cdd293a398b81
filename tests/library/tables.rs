//! Tables in the documents are as new as the weights and the floor that they were made with.

use crate::prelude::*;
use std::process::Output;

fn check(root: &Path) -> Output {
    Command::new("python3").arg(root.join("scripts/tables")).arg("--check").output().expect("python3 runs")
}

fn complaints(root: &Path) -> String {
    String::from_utf8(check(root).stderr).unwrap()
}

#[test]
fn no_table_is_older_than_its_weights_and_floor() {
    let said = check(Path::new(env!("CARGO_MANIFEST_DIR")));
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
}

fn tree(root: &Path) {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["scripts", "src/signal", "assets/weights", "docs"] {
        std::fs::create_dir_all(root.join(folder)).unwrap();
    }
    for file in ["scripts/tables", "src/signal/floor.rs", "assets/weights/live.safetensors"] {
        std::fs::copy(here.join(file), root.join(file)).unwrap();
    }
    let sha256 = methods::by_name("live").unwrap().weights(&Radar::default()).unwrap().sha256;
    let floor = std::fs::read_to_string(root.join("src/signal/floor.rs")).unwrap();
    let floor = floor.lines().find_map(|line| line.strip_prefix("const THESIS_ROUNDING_FACTOR: f64 = ")).unwrap();
    let floor = floor.trim_end_matches(';').replace(' ', "");
    let table = |name: &str, options: &str, made: &str| {
        format!(
            "<!-- table {name}: apertura evaluate {options} -->\n<!-- made with {made} -->\n| 1 ± 1 |\n<!-- /table -->\n"
        )
    };
    let tables = [
        table("both", "--method hybrid --count 5", &format!("floor {floor}, live {sha256}")),
        table("floor", "--method baseline", &format!("floor {floor}")),
        table("weights", "--method nomp,live --floor snr=40", &format!("live {sha256}")),
    ];
    std::fs::write(root.join("docs/page.md"), tables.concat()).unwrap();
}

#[test]
fn other_weights_or_another_floor_make_tables_stale() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    tree(root);
    assert!(check(root).status.success(), "{}", complaints(root));
    let [weights, floor] = ["assets/weights/live.safetensors", "src/signal/floor.rs"].map(|name| root.join(name));

    let shipped = std::fs::read(&weights).unwrap();
    let mut changed = shipped.clone();
    *changed.last_mut().unwrap() ^= 1;
    std::fs::write(&weights, changed).unwrap();
    let said = complaints(root);
    let holds = !check(root).status.success() && said.contains("table both was") && said.contains("table weights was");
    assert!(holds, "{said}");
    assert!(!said.contains("table floor"), "{said}");

    std::fs::write(&weights, shipped).unwrap();
    std::fs::write(&floor, "const THESIS_ROUNDING_FACTOR: f64 = 1.5 / 12.0;").unwrap();
    let said = complaints(root);
    assert!(said.contains("table both was") && said.contains("table floor was"), "{said}");
    assert!(!said.contains("table weights"), "{said}");
}

#[test]
fn a_table_with_standard_errors_stands_between_markers() {
    let folder = tempfile::tempdir().unwrap();
    tree(folder.path());
    let page = folder.path().join("docs/other.md");
    std::fs::write(&page, "| `live` | 3 ± 1 |\n").unwrap();
    let said = complaints(folder.path());
    assert!(said.contains("docs/other.md") && said.contains("no markers"), "{said}");
    std::fs::write(&page, "<!-- record: another machine -->\n| `live` | 3 ± 1 |\n<!-- /record -->\n").unwrap();
    assert!(check(folder.path()).status.success(), "{}", complaints(folder.path()));
}
