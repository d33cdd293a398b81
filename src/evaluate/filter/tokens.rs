//! The tokens of an expression.

/// A mistake in an expression, with its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}")]
pub struct FilterError {
    /// Place of the mistake, in characters from 1; just after the text where its end is missing something.
    pub column: usize,
    /// The mistake, and what was expected in its place.
    pub message: String,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Text(String),
    Name(Option<String>, String),
    Sign(&'static str),
    End,
}

/// Signs, longer ones before those they begin with.
const SIGNS: [&str; 18] =
    ["&&", "||", "==", "!=", "<=", ">=", "&", "|", "=", "!", "<", ">", "+", "-", "*", "/", "(", ")"];

pub(super) const OPERAND: &str = "expected a column, a number, a name in quotes or (";

pub(super) fn error<T>(at: usize, message: impl Into<String>) -> Result<T, FilterError> {
    Err(FilterError { column: at + 1, message: message.into() })
}

pub(super) fn tokens(text: &[char]) -> Result<Vec<(usize, Token)>, FilterError> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(&c) = text.get(at) {
        let start = at;
        let token = match c {
            _ if c.is_whitespace() => {
                at += 1;
                continue;
            }
            '"' | '\'' => {
                let Some(length) = text[at + 1..].iter().position(|q| *q == c) else {
                    return error(start, "this quote is not closed");
                };
                at += length + 2;
                Token::Text(text[start + 1..at - 1].iter().collect())
            }
            '0'..='9' | '.' => Token::Number(number(text, &mut at)?),
            _ if is_name(c) => {
                let first = name(text, &mut at);
                if text.get(at) == Some(&'.') {
                    at += 1;
                    Token::Name(Some(first), name(text, &mut at))
                } else {
                    Token::Name(None, first)
                }
            }
            _ => {
                let rest: String = text[at..].iter().take(2).collect();
                let Some(sign) = SIGNS.into_iter().find(|sign| rest.starts_with(sign)) else {
                    return error(start, format!("\"{c}\" has no meaning here; {OPERAND}"));
                };
                at += sign.len();
                // Each of these is written twice as well.
                Token::Sign(if matches!(sign, "&&" | "||" | "==") { &sign[1..] } else { sign })
            }
        };
        found.push((start, token));
    }
    found.push((text.len(), Token::End));
    Ok(found)
}

pub(super) fn is_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// A name: letters, digits, underscores, and hyphens between them.
fn name(text: &[char], at: &mut usize) -> String {
    let start = *at;
    while let Some(&c) = text.get(*at) {
        let inside = is_name(c) || c.is_ascii_digit();
        let hyphen = c == '-' && *at > start && text.get(*at + 1).is_some_and(|next| is_name(*next));
        if !(inside || hyphen) {
            break;
        }
        *at += 1;
    }
    text[start..*at].iter().collect()
}

fn number(text: &[char], at: &mut usize) -> Result<f64, FilterError> {
    let start = *at;
    while let Some(&c) = text.get(*at) {
        let exponent = matches!(c, '+' | '-') && *at > start && matches!(text[*at - 1], 'e' | 'E');
        if !(c.is_ascii_alphanumeric() || c == '.' || exponent) {
            break;
        }
        *at += 1;
    }
    let digits: String = text[start..*at].iter().collect();
    match digits.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => error(start, format!("\"{digits}\" is not a number")),
    }
}
