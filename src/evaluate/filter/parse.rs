//! The parser of expressions.

use super::expression::{Arithmetic, Comparison, Predicate, Term};
use super::tokens::{FilterError, OPERAND, SIGNS, Token, error, tokens};
use crate::evaluate::rows::Column;
use std::fmt::Write;

const DEEPEST_NESTING: usize = 50;
/// Longest expression, characters.
const LONGEST_EXPRESSION: usize = 2000;

pub(super) fn parse(text: &str, methods: &[&str]) -> Result<Predicate, FilterError> {
    let characters: Vec<char> = text.chars().collect();
    if characters.len() > LONGEST_EXPRESSION {
        return error(LONGEST_EXPRESSION, format!("an expression may have {LONGEST_EXPRESSION} characters"));
    }
    let tokens = tokens(&characters)?;
    let mut parser = Parser { tokens: &tokens, methods, next: 0, depth: 0 };
    let start = parser.at();
    let whole = parser.either()?;
    match parser.peek() {
        Token::End => whole.truth(start, parser.at()),
        Token::Sign(")") => error(parser.at(), "this bracket was never opened"),
        _ => error(parser.at(), "expected &, | or the end"),
    }
}

enum Part {
    Truth(Predicate),
    Term(Term),
}

impl Part {
    /// The part as a predicate. An error points at `start`, the part's first character, or at `end`, where a comparison is missing after a column.
    fn truth(self, start: usize, end: usize) -> Result<Predicate, FilterError> {
        match self {
            Part::Truth(truth) => Ok(truth),
            Part::Term(Term::Column(..)) => error(end, "expected a comparison after the column, as in objects >= 4"),
            Part::Term(_) => error(start, "expected a comparison, as in objects >= 4"),
        }
    }

    fn term(self, start: usize) -> Result<Term, FilterError> {
        match self {
            Part::Term(term) => Ok(term),
            Part::Truth(_) => error(start, "expected a value, found something true or false"),
        }
    }
}

struct Parser<'a> {
    tokens: &'a [(usize, Token)],
    methods: &'a [&'a str],
    next: usize,
    depth: usize,
}

impl Parser<'_> {
    fn peek(&self) -> &Token {
        &self.tokens[self.next].1
    }

    fn at(&self) -> usize {
        self.tokens[self.next].0
    }

    fn take(&mut self, sign: &str) -> bool {
        let found = *self.peek() == Token::Sign(SIGNS.iter().find(|(s, _)| *s == sign).map_or("", |(s, _)| s));
        self.next += usize::from(found);
        found
    }

    /// `a | b`
    fn either(&mut self) -> Result<Part, FilterError> {
        let start = self.at();
        let mut found = self.both()?;
        while self.at_sign("|") {
            let left = found.truth(start, self.at())?;
            self.next += 1;
            let start = self.at();
            let right = self.both()?.truth(start, self.at())?;
            found = Part::Truth(Predicate::Or(Box::new([left, right])));
        }
        Ok(found)
    }

    /// `a & b`
    fn both(&mut self) -> Result<Part, FilterError> {
        let start = self.at();
        let mut found = self.not()?;
        while self.at_sign("&") {
            let left = found.truth(start, self.at())?;
            self.next += 1;
            let start = self.at();
            let right = self.not()?.truth(start, self.at())?;
            found = Part::Truth(Predicate::And(Box::new([left, right])));
        }
        Ok(found)
    }

    fn at_sign(&self, sign: &str) -> bool {
        matches!(self.peek(), Token::Sign(s) if *s == sign)
    }

    /// `! a`
    fn not(&mut self) -> Result<Part, FilterError> {
        if self.take("!") {
            let start = self.at();
            let inner = self.deeper(Self::not)?.truth(start, self.at())?;
            return Ok(Part::Truth(Predicate::Not(Box::new(inner))));
        }
        self.comparison()
    }

    /// `a < b`
    fn comparison(&mut self) -> Result<Part, FilterError> {
        let start = self.at();
        let left = self.sum()?;
        let how = match self.peek() {
            Token::Sign("=") => Comparison::Equal,
            Token::Sign("!=") => Comparison::Unequal,
            Token::Sign("<") => Comparison::Less,
            Token::Sign("<=") => Comparison::LessOrEqual,
            Token::Sign(">") => Comparison::Greater,
            Token::Sign(">=") => Comparison::GreaterOrEqual,
            _ => return Ok(left),
        };
        let left = left.term(start)?;
        self.next += 1;
        let start = self.at();
        let right = self.sum()?.term(start)?;
        let text = |term: &Term| matches!(term, Term::Text(_) | Term::Column(_, Column::Method));
        let number = |term: &Term| !text(term) && !matches!(term, Term::Column(_, Column::Set));
        if (text(&left) && number(&right)) || (number(&left) && text(&right)) {
            return error(start, "a name and a number are never equal; names of methods stand in quotes");
        }
        Ok(Part::Truth(Predicate::Compare(Box::new(left), how, Box::new(right))))
    }

    fn sum(&mut self) -> Result<Part, FilterError> {
        self.arithmetic(Self::product, &[("+", Arithmetic::Plus), ("-", Arithmetic::Minus)])
    }

    /// `a * b`
    fn product(&mut self) -> Result<Part, FilterError> {
        self.arithmetic(Self::operand, &[("*", Arithmetic::Times), ("/", Arithmetic::Over)])
    }

    fn arithmetic(
        &mut self,
        part: fn(&mut Self) -> Result<Part, FilterError>,
        signs: &[(&str, Arithmetic)],
    ) -> Result<Part, FilterError> {
        let mut start = self.at();
        let mut found = part(self)?;
        while let Some((_, sign)) = signs.iter().find(|(s, _)| self.at_sign(s)) {
            let left = numeric(found.term(start)?, start)?;
            self.next += 1;
            start = self.at();
            let right = numeric(part(self)?.term(start)?, start)?;
            found = Part::Term(Term::Arithmetic(Box::new(left), *sign, Box::new(right)));
        }
        Ok(found)
    }

    fn operand(&mut self) -> Result<Part, FilterError> {
        let start = self.at();
        if self.take("-") {
            let inner = self.deeper(Self::operand)?.term(start)?;
            return Ok(Part::Term(Term::Negative(Box::new(numeric(inner, start)?))));
        }
        if self.take("(") {
            let inner = self.deeper(Self::either)?;
            return if self.take(")") {
                Ok(inner)
            } else {
                error(self.at(), "expected ) for the bracket that is open")
            };
        }
        let term = match self.peek().clone() {
            Token::Number(value) => Term::Number(value),
            Token::Text(text) => Term::Text(text),
            Token::Name(method, column) => self.column(start, method, &column)?,
            Token::Sign(sign) => return error(start, format!("\"{sign}\" has nothing before it; {OPERAND}")),
            Token::End => return error(start, OPERAND),
        };
        self.next += 1;
        Ok(Part::Term(term))
    }

    fn deeper(&mut self, inner: fn(&mut Self) -> Result<Part, FilterError>) -> Result<Part, FilterError> {
        if self.depth == DEEPEST_NESTING {
            return error(self.at(), format!("brackets and signs are nested more than {DEEPEST_NESTING} deep"));
        }
        self.depth += 1;
        let found = inner(self);
        self.depth -= 1;
        found
    }

    fn column(&self, start: usize, method: Option<String>, name: &str) -> Result<Term, FilterError> {
        let at = method.as_ref().map_or(start, |m| start + m.chars().count() + 1);
        if let Some(method) = &method
            && !self.methods.contains(&method.as_str())
        {
            let known = self.methods.join(", ");
            return error(start, format!("there are no rows by \"{method}\"; there are some by {known}"));
        }
        match Column::by_name(name) {
            Some(column) => Ok(Term::Column(method, column)),
            None if self.methods.contains(&name) && method.is_none() => {
                let end = at + name.chars().count();
                error(
                    end,
                    format!("expected a dot and a column, as in {name}.squared_error; or quotes around \"{name}\""),
                )
            }
            None => {
                let mut message =
                    if name.is_empty() { "expected a column".into() } else { format!("there is no column \"{name}\"") };
                if let Some(near) = nearest(name) {
                    // Writing to a string can't fail.
                    let _ = write!(message, "; is {near} meant?");
                }
                error(at, message)
            }
        }
    }
}

fn numeric(term: Term, start: usize) -> Result<Term, FilterError> {
    match term {
        Term::Text(_) | Term::Column(_, Column::Method) => error(start, "expected a number, found a name"),
        term => Ok(term),
    }
}

/// The column whose name is most like `name`, if any is like it.
fn nearest(name: &str) -> Option<&'static str> {
    let like = |column: &Column| (edits(name, column.name()), column.name());
    let (edits, column) = Column::FIGURES.iter().map(like).min()?;
    (edits <= 1 + name.chars().count() / 4 && !name.is_empty()).then_some(column)
}

/// Characters to add, drop or change between `a` and `b` (Levenshtein distance).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut before = std::mem::replace(&mut row[0], i + 1);
        for (j, to) in b.iter().enumerate() {
            let changed = before + usize::from(from != *to);
            before = row[j + 1];
            row[j + 1] = changed.min(before + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_point_at_the_mistake() {
        let methods = ["live", "nomp"];
        for (text, column, part) in [
            ("", 1, "expected a column"),
            ("objects", 8, "expected a comparison after the column"),
            ("objects >", 10, "expected a column, a number"),
            ("objects > 4 &", 14, "expected a column, a number"),
            ("objects > 4 objects < 3", 13, "expected &, | or the end"),
            ("objets > 4", 1, "there is no column \"objets\"; is objects meant?"),
            ("live.sqared_error > 4", 6, "is squared_error meant?"),
            ("lvie.squared_error > 4", 1, "no rows by \"lvie\"; there are some by live, nomp"),
            ("live > 4", 5, "expected a dot and a column, as in live.squared_error"),
            ("live. > 4", 6, "expected a column"),
            ("(objects > 4", 13, "expected ) for the bracket"),
            ("objects > 4)", 12, "never opened"),
            ("objects > 4.4.4", 11, "\"4.4.4\" is not a number"),
            ("objects > 1e999", 11, "is not a number"),
            ("method = 3", 10, "never equal"),
            ("method = \"live", 10, "not closed"),
            ("method + 1 = 3", 1, "expected a number, found a name"),
            ("objects # 3", 9, "\"#\" has no meaning"),
            ("* 3", 1, "\"*\" has nothing before it"),
            ("(objects > 3) + 1 > 2", 1, "expected a value"),
            ("3", 1, "expected a comparison"),
            ("ünlike > 3 & objects", 1, "there is no column \"ünlike\""),
            ("objects > 1 & ünlike > 3", 15, "there is no column"),
        ] {
            let found = parse(text, &methods).unwrap_err();
            assert!(found.column == column && found.message.contains(part), "{text}: {found}");
        }
    }

    #[test]
    fn no_expression_is_too_much() {
        for text in ["(".repeat(1900), "!".repeat(1900), "-".repeat(1900), "objects > 1 &".repeat(1900)] {
            assert!(parse(&text, &["live"]).is_err());
        }
        let many = "objects > 1 | ".repeat(100) + "objects > 2";
        assert!(parse(&many, &["live"]).is_ok());
    }
}
