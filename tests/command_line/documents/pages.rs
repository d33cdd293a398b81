//! The project's pages, taken apart: blocks of code, spans of code, and text.

use crate::cli::*;

pub struct Page {
    /// Path of its file, from the project's folder on.
    pub name: String,
    /// Blocks of code: the language, and the lines.
    pub blocks: Vec<(String, String)>,
    pub spans: Vec<String>,
    /// All else, a line of a table or list or a paragraph each.
    pub text: Vec<String>,
}

impl Page {
    pub fn read(name: &str) -> Page {
        let whole = std::fs::read_to_string(root().join(name)).unwrap();
        let (mut blocks, mut prose) = (Vec::<(String, String)>::new(), String::new());
        let mut is_code = false;
        for line in whole.lines() {
            match line.trim_start().strip_prefix("```") {
                Some(language) if !is_code => blocks.push((language.to_owned(), String::new())),
                Some(_) => {}
                None if is_code => blocks.last_mut().unwrap().1 += &format!("{line}\n"),
                None => prose += &format!("{line}\n"),
            }
            is_code ^= line.trim_start().starts_with("```");
        }
        let pieces: Vec<&str> = prose.split('`').collect();
        assert!(pieces.len() % 2 == 1 && !is_code, "{name}: a span or block of code has no end");
        let spans = pieces.iter().skip(1).step_by(2).map(|span| span.replace('\n', " ")).collect();
        let plain = pieces.into_iter().step_by(2).collect::<Vec<_>>().join("\u{b7}");
        Page { name: name.to_owned(), blocks, spans, text: units(&plain) }
    }

    /// The lines of its blocks for a shell; a line that goes on after a backslash is one.
    pub fn shell_lines(&self) -> Vec<String> {
        let shells = self.blocks.iter().filter(|(language, _)| ["sh", "bat"].contains(&language.as_str()));
        shells.flat_map(|(_, text)| text.replace("\\\n", " ").lines().map(str::to_owned).collect::<Vec<_>>()).collect()
    }
}

fn units(plain: &str) -> Vec<String> {
    let mut units = vec![String::new()];
    for line in plain.lines() {
        let begins = line.trim().is_empty() || ["|", "* ", "- ", "#"].iter().any(|mark| line.starts_with(mark));
        if begins || line.starts_with(|c: char| c.is_ascii_digit()) {
            units.push(String::new());
        }
        let last = units.last_mut().unwrap();
        *last = format!("{last} {line}");
    }
    let parts = units.iter().flat_map(|unit| unit.split('|')).map(|unit| unit.trim().trim_start_matches("* "));
    parts.filter(|part| !part.is_empty()).map(str::to_owned).collect()
}

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn all() -> Vec<Page> {
    let mut names: Vec<PathBuf> = std::fs::read_dir(root().join("docs")).unwrap().map(|e| e.unwrap().path()).collect();
    names.retain(|path| path.extension().is_some_and(|e| e == "md"));
    names.sort();
    let docs = names.iter().map(|path| path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned());
    let others =
        "README.md CONTRIBUTING.md ARCHITECTURE.md assets/guide.md python/README.md training/README.md".split(' ');
    others.map(str::to_owned).chain(docs).map(|name| Page::read(&name)).collect()
}
