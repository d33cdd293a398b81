//! The command line of a method, split into words as in a shell, but without one.

use std::fmt;
use std::str::FromStr;

/// A program and its arguments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine {
    text: String,
    pub(super) words: Vec<String>,
}

impl FromStr for CommandLine {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut words: Vec<String> = Vec::new();
        let (mut word, mut quote) = (None::<String>, None::<char>);
        for c in text.chars() {
            match quote {
                Some(open) if c == open => quote = None,
                Some(_) => word.get_or_insert_default().push(c),
                None if c == '"' || c == '\'' => {
                    quote = Some(c);
                    word.get_or_insert_default();
                }
                None if c.is_whitespace() => words.extend(word.take()),
                None => word.get_or_insert_default().push(c),
            }
        }
        if let Some(quote) = quote {
            return Err(format!("the command {text} has a {quote} without a second one"));
        }
        words.extend(word);
        if words.first().is_none_or(String::is_empty) {
            let expected = "a program with its arguments, such as \"python my_network.py\"";
            return Err(format!("the command is empty; expected {expected}"));
        }
        Ok(CommandLine { text: text.trim().to_owned(), words })
    }
}

impl fmt::Display for CommandLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_keep_spaces() {
        for (text, words) in [
            ("python my_network.py", vec!["python", "my_network.py"]),
            ("  a\tb ", vec!["a", "b"]),
            ("'my program' --name=\"two words\" ''", vec!["my program", "--name=two words", ""]),
            (r#"C:\python.exe "it's""#, vec![r"C:\python.exe", "it's"]),
        ] {
            assert_eq!(text.parse::<CommandLine>().unwrap().words, words, "{text}");
        }
    }

    #[test]
    fn what_is_no_command_is_told() {
        for (text, part) in [("", "is empty"), ("  ", "is empty"), ("''", "is empty"), ("a \"b", "has a \" without")] {
            let told = text.parse::<CommandLine>().unwrap_err().to_string();
            assert!(told.contains(part), "{told}");
        }
    }
}
