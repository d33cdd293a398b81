//! Checks of the source against its plan: ARCHITECTURE.md's table of rooms, no import circle, no long function, names.

mod imports;
mod names;
mod source;

use crate::prelude::*;
use imports::{House, circles, rust_files};
use names::{Names, held_files};
use source::Source;

const LONGEST_FUNCTION: usize = 60;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// ARCHITECTURE.md's rooms in order, and the rooms that each may use.
fn table() -> Vec<(String, BTreeSet<String>)> {
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let mut rooms: Vec<(String, BTreeSet<String>)> = Vec::new();
    for line in text.lines().skip_while(|l| *l != "## Rooms").skip(1).take_while(|l| !l.starts_with("## ")) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, room, _, uses, _] = cells.as_slice() else { continue };
        let Some(room) = room.strip_prefix('`').and_then(|r| r.strip_suffix('`')) else { continue };
        let above = || rooms.iter().map(|(name, _)| name.clone());
        let allowed: BTreeSet<String> = match *uses {
            "nothing here" => BTreeSet::new(),
            "everything above" => above().collect(),
            list => list.split(',').map(|name| name.trim().to_owned()).collect(),
        };
        let unknown: Vec<&String> = allowed.iter().filter(|a| !above().any(|name| name == **a)).collect();
        assert!(unknown.is_empty(), "{room} may use {unknown:?}, which don't stand above it in the table");
        rooms.push((room.to_owned(), allowed));
    }
    rooms
}

/// Code that few places have. Only `platform` asks whether it runs on a page; SIMD kernels ask for the processor's instructions.
const RARE_CODE: [(&str, &[&str]); 4] = [
    ("rustfft::", &["maps", "signal", "reconstruct", "benchmark"]),
    ("burn::", &["network"]),
    ("rfd::", &["platform"]),
    ("target_arch", &["platform", "signal/simd", "network/kernels/vector.rs"]),
];

#[test]
fn some_crates_and_the_target_belong_to_few_rooms() {
    let src = root().join("src");
    for (code, places) in RARE_CODE {
        let is_code = |line: &&str| !line.trim_start().starts_with("//");
        let has = |path: &PathBuf| fs::read_to_string(path).unwrap().lines().filter(is_code).any(|l| l.contains(code));
        let may = |path: &PathBuf| places.iter().any(|place| path.starts_with(src.join(place)));
        let (inside, outside): (Vec<_>, Vec<_>) = rust_files(&src).into_iter().filter(has).partition(may);
        assert!(!inside.is_empty() && outside.is_empty(), "{code}: {outside:?}");
    }
}

/// Names that ARCHITECTURE.md and CONTRIBUTING.md give in backticks: a path of Rust, or of a file.
#[test]
fn the_names_that_contributors_read_are_there() {
    let sources: String = held_files().into_iter().map(|(_, text)| text).collect();
    let words: BTreeSet<&str> = sources.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let mut missing = Vec::new();
    for page in ["ARCHITECTURE.md", "CONTRIBUTING.md"] {
        let text = std::fs::read_to_string(root().join(page)).unwrap();
        let prose: String = text.split("```").step_by(2).collect();
        for span in prose.split('`').skip(1).step_by(2) {
            let is_path = span.starts_with("src/") || span.starts_with("tests/") || span.starts_with("scripts/");
            let is_name = span.contains("::") && span.chars().all(|c| c.is_alphanumeric() || "_:".contains(c));
            let is_there = match (is_path && !span.contains(' '), is_name) {
                (true, _) => root().join(span).exists(),
                (_, true) => span.split("::").all(|part| words.contains(part)),
                _ => continue,
            };
            if !is_there {
                missing.push(format!("{page}: {span}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

fn listed<T: std::fmt::Display>(names: impl IntoIterator<Item = T>) -> String {
    let names: Vec<String> = names.into_iter().map(|n| n.to_string()).collect();
    if names.is_empty() { "nothing".into() } else { names.join(", ") }
}

/// A room uses only rooms that stand above it in the table, so no circle can be among them. Tests inside the rooms count.
#[test]
fn every_room_uses_only_what_the_table_says() {
    let rooms = House::read(&root().join("src"), true).rooms();
    let mut wrong = Vec::new();
    let table = table();
    for (room, allowed) in &table {
        let Some(used) = rooms.get(room) else {
            wrong.push(format!("{room} stands in the table, but not in src"));
            continue;
        };
        println!("{room:12} uses {}", listed(used));
        let more: Vec<&String> = used.difference(allowed).collect();
        if !more.is_empty() {
            wrong.push(format!("{room} uses {}, which the table doesn't allow", listed(more)));
        }
    }
    let missing = rooms.keys().filter(|room| !table.iter().any(|(name, _)| name == *room));
    wrong.extend(missing.map(|room| format!("{room} doesn't stand in the table")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let imports = House::read(&root().join("src"), false).imports();
    assert!(imports.values().map(BTreeSet::len).sum::<usize>() > 300, "imports must have been found");
    let found = circles(&imports);
    for circle in &found {
        println!("in a circle:");
        for file in circle {
            let inside = imports[file].intersection(circle).map(|p| p.display());
            println!("    {} imports {}", file.display(), listed(inside));
        }
    }
    assert!(found.is_empty(), "{} circles", found.len());
}

#[test]
fn no_function_is_long() {
    let mut long = Vec::new();
    for (name, text) in held_files().into_iter().filter(|(name, _)| !name.starts_with("python/")) {
        let functions = Source::parse(&text, true).unwrap().functions.into_iter();
        let found = functions.filter(|(_, lines)| *lines > LONGEST_FUNCTION);
        long.extend(found.map(|(function, lines)| format!("{name}: {function} has {lines} lines")));
    }
    assert!(long.is_empty(), "more than {LONGEST_FUNCTION} lines:\n{}", long.join("\n"));
}

#[test]
fn circles_are_found() {
    let graph = |edges: &[(&'static str, &'static str)]| {
        let mut graph: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for (from, to) in edges {
            graph.entry(from).or_default().insert(to);
            graph.entry(to).or_default();
        }
        graph
    };
    assert!(circles(&graph(&[("a", "b"), ("b", "c"), ("a", "c")])).is_empty());
    let circle = circles(&graph(&[("a", "b"), ("b", "c"), ("c", "b"), ("c", "d")]));
    assert_eq!(circle, [BTreeSet::from(["b", "c"])]);
}

/// Paths are followed through `pub use`, `super`, renamed modules and inline test modules.
#[test]
fn imports_are_resolved() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("lib.rs", "pub mod a;\npub mod b;\n");
    write("a/mod.rs", "mod inner;\npub use inner::Thing;\npub struct Own;\n");
    write(
        "a/inner.rs",
        "pub struct Thing;\n#[cfg(test)]\nmod tests {\n    use super::super::Own;\n    use crate::b::C;\n}\n",
    );
    write(
        "b.rs",
        "use crate::a::{self as other, Thing as T};\nfn f() {\n    // super::lib\n    assert!(other::Own, \"crate::a::No\");\n}\n",
    );
    let named = |with_tests: bool| {
        let imports = House::read(folder.path(), with_tests).imports();
        let named = |p: &Path| p.display().to_string();
        imports.iter().flat_map(|(f, to)| to.iter().map(|t| format!("{} {}", named(f), named(t)))).collect::<Vec<_>>()
    };
    assert_eq!(named(false), ["b.rs a/inner.rs", "b.rs a/mod.rs"]);
    assert_eq!(named(true), ["a/inner.rs a/mod.rs", "a/inner.rs b.rs", "b.rs a/inner.rs", "b.rs a/mod.rs"]);
    let rooms = House::read(folder.path(), true).rooms();
    assert_eq!(rooms["b"], BTreeSet::from(["a".to_owned()]));
}

/// The tests of the crate, each as its file and name, and whether it is ignored.
fn tests() -> Vec<(String, bool)> {
    let is_of_the_crate = |file: &str| file.starts_with("src/") || file.starts_with("tests/");
    let mut found = Vec::new();
    for (file, text) in held_files().into_iter().filter(|(file, _)| is_of_the_crate(file)) {
        let Names { tests, ignored, .. } = Names::of(&text);
        found.extend(tests.iter().map(|(name, _)| (format!("{file}::{name}"), ignored.contains(name))));
    }
    found
}

/// The filter in the rest of a line behind `cargo test`, if there is one, and whether ignored tests are meant.
fn filter_in(rest: &str) -> Option<(&str, bool)> {
    let command = rest.split(['`', '#']).next()?;
    let mut words = command.split_whitespace().take_while(|word| *word != "--");
    while let Some(word) = words.next() {
        match word {
            "--test" | "--features" => _ = words.next(),
            option if option.starts_with('-') => {}
            filter => return Some((filter, command.contains("--ignored"))),
        }
    }
    None
}

/// A filter that no test has runs nothing and succeeds.
#[test]
fn every_filter_of_tests_in_the_documents_runs_one() {
    let tests = tests();
    let docs = std::fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(|page| root().join(page));
    let (mut count, mut wrong) = (0, Vec::new());
    for page in docs.filter(|path| path.extension().is_some_and(|ending| ending == "md")).chain(pages) {
        let text = std::fs::read_to_string(&page).unwrap();
        let rests = text.lines().flat_map(|line| line.split("cargo test").skip(1));
        for (filter, are_ignored) in rests.filter_map(filter_in) {
            count += 1;
            if !tests.iter().any(|(name, is_ignored)| name.contains(filter) && *is_ignored == are_ignored) {
                wrong.push(format!("{}: {filter}", page.display()));
            }
        }
    }
    assert!(count > 8 && wrong.is_empty(), "{count} filters, without a test: {wrong:#?}");
}
