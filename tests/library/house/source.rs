//! Rust as rustfmt leaves it, read as far as imports and lengths of functions need.

/// A file's text without comments, strings and characters, cut into words and signs; knows which belong to tests.
pub struct Source {
    /// Code with everything else blanked; lines as in the file.
    pub code: String,
}

impl Source {
    pub fn new(text: &str) -> Source {
        let mut code: Vec<char> = text.chars().collect();
        let mut i = 0;
        while i < code.len() {
            let end = match code[i] {
                '/' if code.get(i + 1) == Some(&'/') => until(&code, i, "\n"),
                '/' if code.get(i + 1) == Some(&'*') => until(&code, i + 2, "*/"),
                '"' => string_end(&code, i),
                'r' if !word_before(&code, i) && raw_string(&code, i) => raw_string_end(&code, i),
                '\'' => match character_end(&code, i) {
                    Some(end) => end,
                    None => i + 1, // a lifetime
                },
                _ => {
                    i += 1;
                    continue;
                }
            };
            let end = end.min(code.len());
            code[i..end].iter_mut().filter(|c| **c != '\n').for_each(|c| *c = ' ');
            i = end;
        }
        Source { code: code.into_iter().collect() }
    }

    /// Lines of every function, signature included, with its name: from `fn` to the brace at the same depth.
    pub fn functions(&self) -> Vec<(String, usize)> {
        let lines: Vec<&str> = self.code.lines().collect();
        let mut found = Vec::new();
        for (start, line) in lines.iter().enumerate() {
            let indent = line.len() - line.trim_start().len();
            let words: Vec<&str> = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
            let Some(at) = words.iter().position(|w| *w == "fn") else { continue };
            let (Some(name), true) = (words.get(at + 1).filter(|n| !n.is_empty()), starts_item(line)) else { continue };
            let closes =
                |l: &&str| l.len() > indent && l.starts_with(&" ".repeat(indent)) && l[indent..].starts_with('}');
            // Without a body, or all on one line.
            let whole = lines[start..].iter().take_while(|l| !l.contains('{') && !l.contains(';')).count();
            if lines.get(start + whole).is_none_or(|l| l.trim_end().ends_with([';', '}']) && !closes(l)) {
                continue;
            }
            if let Some(length) = lines[start..].iter().position(closes) {
                found.push(((*name).to_owned(), length + 1));
            }
        }
        found
    }

    /// The code without modules that are compiled for tests only.
    pub fn without_tests(&self) -> String {
        let mut kept = String::new();
        let mut lines = self.code.lines().peekable();
        while let Some(line) = lines.next() {
            let indent = line.len() - line.trim_start().len();
            if line.trim() == "#[cfg(test)]" {
                // An item ends where a line at its own depth closes it.
                for inner in lines.by_ref() {
                    let own = inner.len() - inner.trim_start().len() == indent && !inner.trim().is_empty();
                    if own && inner.trim_end().ends_with([';', '}']) {
                        break;
                    }
                }
                continue;
            }
            kept.push_str(line);
            kept.push('\n');
        }
        kept
    }
}

/// Words and signs of blanked code; `::` is one sign.
pub fn tokens(code: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut rest = code.chars().peekable();
    while let Some(c) = rest.next() {
        if c.is_alphanumeric() || c == '_' {
            let mut word = String::from(c);
            while let Some(more) = rest.next_if(|c| c.is_alphanumeric() || *c == '_') {
                word.push(more);
            }
            found.push(word);
        } else if c == ':' && rest.next_if_eq(&':').is_some() {
            found.push("::".into());
        } else if !c.is_whitespace() {
            found.push(c.into());
        }
    }
    found
}

fn starts_item(line: &str) -> bool {
    let line = line.trim_start();
    ["fn ", "pub", "const ", "unsafe ", "async ", "extern "].iter().any(|start| line.starts_with(start))
}

fn until(code: &[char], from: usize, sign: &str) -> usize {
    let sign: Vec<char> = sign.chars().collect();
    (from..code.len()).find(|i| code[*i..].starts_with(&sign)).map_or(code.len(), |i| i + sign.len())
}

fn string_end(code: &[char], start: usize) -> usize {
    let mut i = start + 1;
    while i < code.len() && code[i] != '"' {
        i += if code[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

fn word_before(code: &[char], i: usize) -> bool {
    i > 0 && (code[i - 1].is_alphanumeric() && code[i - 1] != 'b' || code[i - 1] == '_')
}

fn raw_string(code: &[char], i: usize) -> bool {
    let hashes = code[i + 1..].iter().take_while(|c| **c == '#').count();
    code.get(i + 1 + hashes) == Some(&'"')
}

fn raw_string_end(code: &[char], i: usize) -> usize {
    let hashes = code[i + 1..].iter().take_while(|c| **c == '#').count();
    until(code, i + 2 + hashes, &format!("\"{}", "#".repeat(hashes)))
}

/// The end of a character, or `None` for a lifetime.
fn character_end(code: &[char], i: usize) -> Option<usize> {
    if code.get(i + 1) == Some(&'\\') {
        return Some(until(code, i + 3, "'"));
    }
    (code.get(i + 2) == Some(&'\'')).then_some(i + 3)
}

#[test]
fn comments_strings_and_characters_are_blanked() {
    let text =
        "let a = \"fn b() {\"; // crate::c\nlet d = 'e'; let f: &'static str = r#\"crate::g\"#; /* crate::h */ i";
    let words = tokens(&Source::new(text).code).join(" ");
    assert_eq!(words, "let a = ; let d = ; let f : & static str = ; i");
}

#[test]
fn functions_are_measured() {
    let text = "fn one() {\n    two();\n}\n\nimpl A {\n    pub fn three(\n        &self,\n    ) -> u8 {\n        fn four() {\n        }\n    }\n    fn five(&self);\n    fn six() {}\n}\n";
    let found = Source::new(text).functions();
    let expected = [("one", 3), ("three", 6), ("four", 2)];
    assert_eq!(found, expected.map(|(name, lines)| (name.to_owned(), lines)));
}

#[test]
fn test_modules_are_left_out() {
    let text = "use a;\n#[cfg(test)]\nmod tests {\n    use b;\n}\n#[cfg(test)]\nmod c;\nuse d;\n";
    assert_eq!(tokens(&Source::new(text).without_tests()).join(" "), "use a ; use d ;");
}
