//! Completions of a filter at the cursor.

use super::tokens::is_name;
use crate::evaluate::rows::Column;

/// Candidates that may replace the word before the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// First character of the word, counted from 0; the word ends at the cursor.
    pub start: usize,
    /// The candidates, likeliest first. A method's name ends with a dot: a column follows.
    pub candidates: Vec<String>,
}

/// Candidates for the word that ends at `cursor` (characters from 0) in an expression about rows of `methods`.
/// Inside quotes the candidates are methods; after a method and a dot, columns; elsewhere both.
pub fn complete(text: &str, cursor: usize, methods: &[impl AsRef<str>]) -> Completion {
    let before: Vec<char> = text.chars().take(cursor).collect();
    let methods = methods.iter().map(AsRef::as_ref);
    let quote = open_quote(&before);
    let start = quote.map_or_else(|| word_start(&before), |quote| quote + 1);
    let word: String = before[start..].iter().collect();
    let columns = || Column::FIGURES.iter().map(|c| c.name().to_owned());
    let (start, word, all): (usize, String, Vec<String>) = match word.split_once('.') {
        _ if quote.is_some() => (start, word, methods.map(str::to_owned).collect()),
        Some((method, column)) => (start + method.chars().count() + 1, column.to_owned(), columns().collect()),
        None => (start, word, columns().chain(methods.map(|m| format!("{m}."))).collect()),
    };
    // Names that begin with the word stand before names that contain it.
    let (begin, rest): (Vec<String>, Vec<String>) = all.into_iter().partition(|name| name.starts_with(&word));
    let inside = rest.into_iter().filter(|name| name.contains(&word));
    let candidates = begin.into_iter().chain(inside).filter(|name| *name != word).collect();
    Completion { start, candidates }
}

fn open_quote(before: &[char]) -> Option<usize> {
    let mut open = None;
    for (i, c) in before.iter().enumerate() {
        match open {
            None if matches!(c, '"' | '\'') => open = Some(i),
            Some(start) if before[start] == *c => open = None,
            _ => {}
        }
    }
    open
}

fn word_start(before: &[char]) -> usize {
    let in_word = |c: char| is_name(c) || c.is_ascii_digit() || matches!(c, '.' | '-');
    let length = before.iter().rev().take_while(|c| in_word(**c)).count();
    let start = before.len() - length;
    // A minus or a number is no beginning of a name.
    start + before[start..].iter().take_while(|c| !is_name(**c)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> (usize, Vec<String>) {
        let found = complete(text, text.chars().count(), &["live", "matched-filter-coherent", "nomp"]);
        (found.start, found.candidates)
    }

    #[test]
    fn every_known_name_is_offered() {
        assert_eq!(at("mi"), (0, ["milliseconds", "missed", "min_range_metres"].map(String::from).into()));
        assert_eq!(at("objects > 3 & li"), (14, vec!["live.".into(), "milliseconds".into()]));
        assert_eq!(at("matched-f"), (0, vec!["matched-filter-coherent.".into()]));
        assert_eq!(at("live.sq"), (5, vec!["squared_error".into()]));
        assert_eq!(at("live.").1.len(), Column::FIGURES.len());
        assert_eq!(at("method = \"no"), (10, vec!["nomp".into()]));
        assert_eq!(at("method = 'nomp' & gh"), (18, vec!["ghosts".into()]));
        assert_eq!(at("").1.len(), Column::FIGURES.len() + 3);
        assert_eq!(at("objects"), (0, vec![]));
    }

    #[test]
    fn the_cursor_may_stand_anywhere() {
        let text = "live.squ > 3 & ü";
        for cursor in 0..30 {
            let found = complete(text, cursor, &["live"]);
            assert!(found.start <= cursor);
        }
        assert_eq!(complete(text, 8, &["live"]).candidates, ["squared_error"]);
    }
}
