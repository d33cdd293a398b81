//! Imports of files and of rooms.

use super::source::Source;
use crate::prelude::*;

/// A module's path, without `crate`; empty for the root.
type Module = Vec<String>;

/// Most names that a path is followed through; `use a::a` would lead round for ever.
const MAX_IMPORT_DEPTH: usize = 8;

struct File {
    module: Module,
    source: Source,
    /// Compiled for tests only.
    test: bool,
}

pub struct House {
    files: BTreeMap<PathBuf, File>,
    modules: BTreeMap<Module, PathBuf>,
}

impl House {
    /// Imports of tests count where `with_tests`. A file that passes on what its children define (`pub use`) doesn't import it:
    /// its importers import the child.
    pub fn read(src: &Path, with_tests: bool) -> House {
        let mut files = BTreeMap::new();
        for path in rust_files(src) {
            let text = std::fs::read_to_string(&path).unwrap();
            let relative = path.strip_prefix(src).unwrap().to_owned();
            let source = Source::parse(&text, with_tests).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            let module = module_of(&relative);
            let test = relative.file_stem().is_some_and(|s| s == "tests");
            files.insert(relative, File { source, module, test });
        }
        let modules = files.iter().map(|(path, file)| (file.module.clone(), path.clone())).collect();
        if !with_tests {
            files.retain(|_, f| !f.test);
        }
        House { files, modules }
    }

    pub fn imports(&self) -> BTreeMap<PathBuf, BTreeSet<PathBuf>> {
        let of = |file: &File| {
            let own = file.source.uses.iter().filter(|u| !u.public).map(|u| u.path.clone());
            let mut found = BTreeSet::new();
            for path in own.chain(file.source.paths.iter().cloned()) {
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
            for path in file.source.uses.iter().map(|u| &u.path).chain(&file.source.paths) {
                let target = self.resolve(&file.module, path, 0);
                found.extend(target.iter().map(|t| room_of(t)).filter(|r| *r != room));
            }
        }
        // The library's root and the programs are no rooms.
        rooms.retain(|room, _| !["lib", "main", "page", "manual", "console"].contains(&room.as_str()));
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
            let passed_on = file.source.uses.iter().filter(|u| u.public);
            for u in passed_on {
                let target = match u.name.as_str() {
                    "*" => u.path.iter().chain([first]).cloned().collect(),
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

    fn start<'a>(&self, module: &[String], path: &'a [String], depth: usize) -> Option<(Module, &'a [String])> {
        let (first, mut rest) = path.split_first().filter(|_| depth <= MAX_IMPORT_DEPTH)?;
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
                    // A name that was imported: its definition.
                    let file = self.files.get(self.modules.get(module)?)?;
                    let import = file.source.uses.iter().find(|u| u.name == *first && u.path.len() > 1)?;
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
