//! Keys that pages name.

use super::pages::all;
use apertura::app::{Entry, listed, listed_on_a_page};

/// Pages in which a letter that begins a sentence is a key.
const OF_THE_WINDOW: [&str; 6] =
    ["README.md", "assets/guide.md", "docs/window.md", "docs/first-minutes.md", "docs/failures.md", "docs/words.md"];

/// Beginning of the sentence with the keys that a browser keeps from the program.
const OF_THE_BROWSER: &str = "the browser keeps";

fn written(entry: &Entry) -> Option<String> {
    let key = entry.key?;
    let (m, name) = (key.modifiers, key.logical_key.name());
    let modifiers = [(m.command, "Ctrl+"), (m.shift, "Shift+"), (m.alt, "Alt+")];
    Some(modifiers.iter().filter(|(is, _)| *is).map(|(_, name)| *name).collect::<String>() + name)
}

/// Keys in a sentence: function keys, keys with a modifier, a letter in brackets, after "press" or at the beginning.
fn keys(sentence: &str, is_of_the_window: bool) -> Vec<String> {
    let words: Vec<&str> = sentence.split_whitespace().collect();
    let mut found = Vec::new();
    for (at, word) in words.iter().enumerate() {
        let bare = word.trim_matches(|c: char| !c.is_alphanumeric());
        let is_letter = bare.len() == 1 && bare.chars().all(|c| c.is_ascii_uppercase());
        let is_function = bare.strip_prefix('F').is_some_and(|n| n.len() <= 2 && n.parse::<u8>().is_ok());
        let has_modifier = ["Ctrl+", "Shift+", "Alt+"].iter().any(|m| bare.starts_with(m) && bare.len() > m.len());
        let after = word.strip_prefix('(').and_then(|word| word.strip_prefix(bare));
        let is_bracketed = after.is_some_and(|rest| rest.starts_with([')', ',', ';']));
        let next = words.get(at + 1).and_then(|next| next.chars().next());
        let begins = at == 0 && bare != "A" && (word.ends_with(':') || next.is_some_and(char::is_lowercase));
        let is_pressed = at > 0 && words[at - 1].eq_ignore_ascii_case("press");
        if is_function || has_modifier || is_of_the_window && is_letter && (is_bracketed || begins || is_pressed) {
            found.push(bare.to_owned());
        }
    }
    found
}

/// Whether the sentence is about the command: a word of its name or tooltip begins like one of the sentence.
fn speaks_of(sentence: &str, entry: &Entry) -> bool {
    let about = format!("{} {}", entry.name, entry.tooltip).to_lowercase();
    let words = about.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() >= 4);
    let beginnings = words.map(|word| word.chars().take(5).collect::<String>());
    let sentence = sentence.to_lowercase();
    beginnings.filter(|b| !["show", "hide", "with"].contains(&b.as_str())).any(|b| sentence.contains(&b))
}

#[test]
fn every_key_that_pages_name_runs_what_they_say() {
    let entries: Vec<Entry> = listed().iter().cloned().chain(listed_on_a_page()).collect();
    let (mut faults, mut count) = (Vec::new(), 0);
    for page in all() {
        let is_of_the_window = OF_THE_WINDOW.contains(&page.name.as_str());
        let clauses = page.text.iter().flat_map(|unit| unit.split(". ")).flat_map(|sentence| sentence.split("; "));
        for sentence in clauses.filter(|clause| !clause.starts_with(OF_THE_BROWSER)) {
            for key in keys(sentence, is_of_the_window) {
                count += 1;
                let having = || entries.iter().filter(|e| written(e).as_ref() == Some(&key));
                if !having().any(|entry| speaks_of(sentence, entry)) {
                    let names: Vec<_> = having().map(|e| e.name.clone()).collect();
                    faults.push(format!("{}: {key} runs {names:?}: {sentence}", page.name));
                }
            }
        }
    }
    assert!(faults.is_empty() && count > 20, "{count} keys\n{}", faults.join("\n"));
}
