//! Which file imports which, and which room which.

use super::source::{Source, tokens};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module's path, without `crate`; empty for the root.
type Module = Vec<String>;

/// Names are followed through so many others; `use a::a` would lead round for ever.
const DEEPEST: usize = 8;

/// One file of `src`.
struct File {
    module: Module,
    /// What it imports under which name, and whether it passes that on.
    uses: Vec<Use>,
    /// Paths in its code, as written.
    paths: Vec<Vec<String>>,
    /// Compiled for tests only.
    test: bool,
}

struct Use {
    /// As written, `crate`, `self` and `super` included.
    path: Vec<String>,
    /// The name it is known by; "*" for all.
    name: String,
    public: bool,
}

/// Every file of `src`.
pub struct House {
    files: BTreeMap<PathBuf, File>,
    modules: BTreeMap<Module, PathBuf>,
}

impl House {
    /// Reads `src`.
    ///
    /// Imports of tests count where `with_tests`. A file that passes on what its children define (`pub use`) doesn't import it: whoever
    /// imports by that name imports the child.
    pub fn read(src: &Path, with_tests: bool) -> House {
        let mut files = BTreeMap::new();
        for path in rust_files(src) {
            let text = std::fs::read_to_string(&path).unwrap();
            let relative = path.strip_prefix(src).unwrap().to_owned();
            let source = Source::new(&text);
            let code = if with_tests { source.code.clone() } else { source.without_tests() };
            let words = tokens(&code);
            let module = module_of(&relative);
            let test = relative.file_stem().is_some_and(|s| s == "tests");
            files.insert(relative, File { uses: uses(&words), paths: paths(&words), module, test });
        }
        let modules = files.iter().map(|(path, file)| (file.module.clone(), path.clone())).collect();
        if !with_tests {
            files.retain(|_, f| !f.test);
        }
        House { files, modules }
    }

    /// Imports of every file: file to files.
    pub fn imports(&self) -> BTreeMap<PathBuf, BTreeSet<PathBuf>> {
        let of = |file: &File| {
            let own = file.uses.iter().filter(|u| !u.public).map(|u| u.path.clone());
            let mut found = BTreeSet::new();
            for path in own.chain(file.paths.iter().cloned()) {
                found.extend(self.resolve(&file.module, &path, 0));
            }
            found.remove(&self.modules[&file.module]);
            found
        };
        self.files.iter().map(|(path, file)| (path.clone(), of(file))).collect()
    }

    /// Imports of every room, `pub use` included: room to rooms.
    pub fn rooms(&self) -> BTreeMap<String, BTreeSet<String>> {
        let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (path, file) in &self.files {
            let room = room_of(path);
            let found = rooms.entry(room.clone()).or_default();
            for path in file.uses.iter().map(|u| &u.path).chain(&file.paths) {
                let target = self.resolve(&file.module, path, 0);
                found.extend(target.iter().map(|t| room_of(t)).filter(|r| *r != room));
            }
        }
        rooms.remove("lib");
        rooms.remove("main");
        for imports in rooms.values_mut() {
            imports.remove("lib");
        }
        rooms
    }

    /// The file that defines what `path` names inside `module`; nothing for other crates' paths.
    fn resolve(&self, module: &[String], path: &[String], depth: usize) -> Option<PathBuf> {
        let (mut at, mut rest) = self.start(module, path, depth)?;
        while let Some((first, after)) = rest.split_first() {
            let child: Module = at.iter().chain([first]).cloned().collect();
            if self.modules.contains_key(&child) {
                (at, rest) = (child, after);
                continue;
            }
            let file = self.files.get(&self.modules[&at])?;
            let passed_on = file.uses.iter().filter(|u| u.public);
            for u in passed_on {
                let target = match u.name.as_str() {
                    "*" => u.path.iter().filter(|p| *p != "*").chain([first]).cloned().collect(),
                    name if name == first => u.path.clone(),
                    _ => continue,
                };
                let whole: Vec<String> = target.into_iter().chain(after.iter().cloned()).collect();
                if let Some(found) = self.resolve(&at, &whole, depth + 1)
                    && (u.name != "*" || found != self.modules[&at])
                {
                    return Some(found);
                }
            }
            break;
        }
        self.modules.get(&at).cloned()
    }

    /// Where a path starts: the module, and what is left of the path.
    fn start<'a>(&self, module: &[String], path: &'a [String], depth: usize) -> Option<(Module, &'a [String])> {
        let (first, mut rest) = path.split_first().filter(|_| depth <= DEEPEST)?;
        let mut at = module.to_vec();
        match first.as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => {
                at.pop();
                while let Some((_, after)) = rest.split_first().filter(|(f, _)| *f == "super") {
                    at.pop();
                    rest = after;
                }
            }
            _ => {
                at.push(first.clone());
                if !self.modules.contains_key(&at) {
                    // A name that was imported: whoever defines it.
                    let file = self.files.get(self.modules.get(module)?)?;
                    let import = file.uses.iter().find(|u| u.name == *first && u.path.len() > 1)?;
                    let imported = self.start(module, &import.path, depth + 1)?;
                    let whole: Module = imported.0.into_iter().chain(imported.1.iter().cloned()).collect();
                    return self.modules.contains_key(&whole).then_some((whole, rest));
                }
            }
        }
        Some((at, rest))
    }
}

/// Circles in a graph: the groups of more than one node that reach each other.
pub fn circles<T: Ord + Clone>(imports: &BTreeMap<T, BTreeSet<T>>) -> Vec<BTreeSet<T>> {
    let reach = |from: &T| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(next) = open.pop() {
            for to in imports.get(next).into_iter().flatten() {
                if seen.insert(to.clone()) {
                    open.push(to);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&T, BTreeSet<T>> = imports.keys().map(|k| (k, reach(k))).collect();
    let group = |k: &T| reached[k].iter().filter(|o| reached.get(o).is_some_and(|r| r.contains(k))).cloned().collect();
    let groups: BTreeSet<BTreeSet<T>> = imports.keys().map(group).filter(|g: &BTreeSet<T>| g.len() > 1).collect();
    groups.into_iter().collect()
}

/// All `.rs` files below a folder.
pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn module_of(relative: &Path) -> Module {
    let mut parts: Module = relative.with_extension("").iter().map(|p| p.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|p| p == "mod") || parts == ["lib"] {
        parts.pop();
    }
    parts
}

fn room_of(relative: &Path) -> String {
    let first = relative.iter().next().unwrap().to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// Every `use` outside of inline modules' own names, flattened.
fn uses(words: &[String]) -> Vec<Use> {
    let mut found = Vec::new();
    for (i, word) in words.iter().enumerate() {
        if word != "use" {
            continue;
        }
        // `pub use`, `pub(crate) use`.
        let public = i > 0 && (words[i - 1] == "pub" || words[i - 1] == ")");
        let end = words[i..].iter().position(|w| w == ";").map_or(words.len(), |n| i + n);
        let nested = depth_of_modules(&words[..i]);
        flatten(&words[i + 1..end], &[], &mut |path, name| {
            // Inside an inline module `super` is one level less far away.
            let path = unnest(path, nested);
            found.push(Use { path, name, public });
        });
    }
    found
}

/// In how many inline modules the end of `words` lies.
fn depth_of_modules(words: &[String]) -> usize {
    let (mut depth, mut modules) = (0usize, Vec::new());
    for (i, word) in words.iter().enumerate() {
        match word.as_str() {
            "{" => {
                depth += 1;
                if i >= 2 && words[i - 2] == "mod" {
                    modules.push(depth);
                }
            }
            "}" => {
                modules.retain(|m| *m != depth);
                depth = depth.saturating_sub(1);
            }
            _ => {}
        }
    }
    modules.len()
}

fn unnest(mut path: Vec<String>, nested: usize) -> Vec<String> {
    for _ in 0..nested {
        match path.first().map(String::as_str) {
            Some("super") if path.get(1).is_some_and(|p| p == "super") => drop(path.remove(0)),
            Some("super") => path[0] = "self".into(),
            _ => break,
        }
    }
    path
}

fn flatten(words: &[String], before: &[String], add: &mut impl FnMut(Vec<String>, String)) {
    let mut path = before.to_vec();
    let mut i = 0;
    while i < words.len() {
        match words[i].as_str() {
            "::" => {}
            "{" => {
                let mut depth = 0;
                let mut start = i + 1;
                for j in i..words.len() {
                    match words[j].as_str() {
                        "{" => depth += 1,
                        "}" => depth -= 1,
                        _ => {}
                    }
                    if (depth == 1 && words[j] == ",") || depth == 0 {
                        if start < j {
                            flatten(&words[start..j], &path, add);
                        }
                        start = j + 1;
                    }
                    if depth == 0 {
                        break;
                    }
                }
                return;
            }
            "as" => {
                add(path, words[i + 1].clone());
                return;
            }
            "self" if !before.is_empty() => {}
            word => path.push(word.into()),
        }
        i += 1;
    }
    if let Some(name) = path.last().cloned() {
        add(path, name);
    }
}

/// Paths in code (not in `use`), `a::b::C`.
fn paths(words: &[String]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut i = 0;
    while i < words.len() {
        if words[i] == "use" {
            i += words[i..].iter().position(|w| w == ";").unwrap_or(0) + 1;
            continue;
        }
        let starts = is_name(&words[i]) && (i == 0 || words[i - 1] != "::");
        let mut path = vec![words[i].clone()];
        let mut j = i;
        while starts && words.get(j + 1).is_some_and(|w| w == "::") && words.get(j + 2).is_some_and(|w| is_name(w)) {
            path.push(words[j + 2].clone());
            j += 2;
        }
        if path.len() > 1 {
            let nested = if path[0] == "super" { depth_of_modules(&words[..i]) } else { 0 };
            found.push(unnest(path, nested));
        }
        i = j + 1;
    }
    found
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}
