//! The parser of expressions.

use super::expression::{Predicate, Term};
use super::tokens::{FilterError, OPERAND, Token, error, tokens};
use crate::evaluate::rows::Column;

const MAX_NESTING: usize = 50;
/// Longest expression, characters.
const MAX_EXPRESSION_CHARACTERS: usize = 2000;

pub(super) fn parse(text: &str, methods: &[&str]) -> Result<Predicate, FilterError> {
    let characters: Vec<char> = text.chars().collect();
    if characters.len() > MAX_EXPRESSION_CHARACTERS {
        return error(
            MAX_EXPRESSION_CHARACTERS,
            format!("an expression may have {MAX_EXPRESSION_CHARACTERS} characters"),
        );
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

    /// Whether the next token is one of `signs`, which is then taken.
    fn take(&mut self, signs: &[&str]) -> Option<&'static str> {
        match self.peek() {
            Token::Sign(sign) if signs.contains(sign) => {
                let sign = *sign;
                self.next += 1;
                Some(sign)
            }
            _ => None,
        }
    }

    /// `a | b`
    fn either(&mut self) -> Result<Part, FilterError> {
        self.joined("|", Self::both, Predicate::Or)
    }

    /// `a & b`
    fn both(&mut self) -> Result<Part, FilterError> {
        self.joined("&", Self::not, Predicate::And)
    }

    fn joined(
        &mut self,
        sign: &str,
        part: fn(&mut Self) -> Result<Part, FilterError>,
        join: fn(Box<[Predicate; 2]>) -> Predicate,
    ) -> Result<Part, FilterError> {
        let start = self.at();
        let mut found = part(self)?;
        loop {
            let end = self.at();
            if self.take(&[sign]).is_none() {
                return Ok(found);
            }
            let left = found.truth(start, end)?;
            let start = self.at();
            let right = part(self)?.truth(start, self.at())?;
            found = Part::Truth(join(Box::new([left, right])));
        }
    }

    /// `! a`
    fn not(&mut self) -> Result<Part, FilterError> {
        if self.take(&["!"]).is_some() {
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
        let Some(sign) = self.take(&["=", "!=", "<", "<=", ">", ">="]) else { return Ok(left) };
        let left = left.term(start)?;
        let start = self.at();
        let right = self.sum()?.term(start)?;
        let text = |term: &Term| matches!(term, Term::Text(_) | Term::Column(_, Column::Method));
        let number = |term: &Term| !text(term) && !matches!(term, Term::Column(_, Column::Set));
        if (text(&left) && number(&right)) || (number(&left) && text(&right)) {
            return error(start, "a name and a number are never equal; names of methods stand in quotes");
        }
        Ok(Part::Truth(Predicate::Compare(Box::new(left), sign, Box::new(right))))
    }

    fn sum(&mut self) -> Result<Part, FilterError> {
        self.arithmetic(Self::product, &["+", "-"])
    }

    /// `a * b`
    fn product(&mut self) -> Result<Part, FilterError> {
        self.arithmetic(Self::operand, &["*", "/"])
    }

    fn arithmetic(
        &mut self,
        part: fn(&mut Self) -> Result<Part, FilterError>,
        signs: &[&str],
    ) -> Result<Part, FilterError> {
        let mut start = self.at();
        let mut found = part(self)?;
        while let Some(sign) = self.take(signs) {
            let left = numeric(found.term(start)?, start)?;
            start = self.at();
            let right = numeric(part(self)?.term(start)?, start)?;
            found = Part::Term(Term::Arithmetic(Box::new(left), sign, Box::new(right)));
        }
        Ok(found)
    }

    fn operand(&mut self) -> Result<Part, FilterError> {
        let start = self.at();
        if self.take(&["-"]).is_some() {
            let inner = self.deeper(Self::operand)?.term(start)?;
            return Ok(Part::Term(Term::Negative(Box::new(numeric(inner, start)?))));
        }
        if self.take(&["("]).is_some() {
            let inner = self.deeper(Self::either)?;
            return match self.take(&[")"]) {
                Some(_) => Ok(inner),
                None => error(self.at(), "expected ) for the bracket that is open"),
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
        if self.depth == MAX_NESTING {
            return error(self.at(), format!("brackets and signs are nested more than {MAX_NESTING} deep"));
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
            None if name.is_empty() => error(at, "expected a column"),
            None => {
                let meant = nearest(name).map_or_else(String::new, |near| format!("; is {near} meant?"));
                error(at, format!("there is no column \"{name}\"{meant}"))
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

fn nearest(name: &str) -> Option<&'static str> {
    let like = |column: &Column| (edits(name, column.name()), column.name());
    let (edits, column) = Column::FIGURES.iter().map(like).min()?;
    (edits <= 1 + name.chars().count() / 4).then_some(column)
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
