//! The value of a parsed expression for a row.

use crate::evaluate::rows::{Column, Row, Value};
use std::collections::HashMap;

/// A parsed expression that is true or false.
#[derive(Debug, Clone, PartialEq)]
pub enum Predicate {
    Or(Box<[Predicate; 2]>),
    And(Box<[Predicate; 2]>),
    Not(Box<Predicate>),
    /// One of the signs = != < <= > >= between two values.
    Compare(Box<Term>, &'static str, Box<Term>),
}

/// A parsed expression with a value.
#[derive(Debug, Clone, PartialEq)]
pub enum Term {
    Number(f64),
    Text(String),
    Column(Option<String>, Column),
    /// One of the signs + - * / between two numbers.
    Arithmetic(Box<Term>, &'static str, Box<Term>),
    Negative(Box<Term>),
}

type Key<'a> = (&'a str, u64, u32);

/// All rows by scene and method.
pub struct Scenes<'a> {
    rows: HashMap<(Key<'a>, &'a str), &'a Row>,
}

fn key(row: &Row) -> Key<'_> {
    (&row.set, row.seed, row.index)
}

impl<'a> Scenes<'a> {
    pub fn new(rows: &'a [Row]) -> Self {
        Scenes { rows: rows.iter().map(|row| ((key(row), &*row.method), row)).collect() }
    }

    fn value(&self, row: &'a Row, method: Option<&'a str>, column: Column) -> Value<'a> {
        match method {
            None => column.of(row),
            Some(method) => self.rows.get(&(key(row), method)).map_or(Value::Missing, |row| column.of(row)),
        }
    }
}

impl Predicate {
    pub fn holds<'a>(&'a self, row: &'a Row, scenes: &Scenes<'a>) -> bool {
        match self {
            Predicate::Or(both) => both.iter().any(|t| t.holds(row, scenes)),
            Predicate::And(both) => both.iter().all(|t| t.holds(row, scenes)),
            Predicate::Not(inner) => !inner.holds(row, scenes),
            Predicate::Compare(a, sign, b) => compare(a.value(row, scenes), sign, b.value(row, scenes)),
        }
    }
}

fn compare(a: Value<'_>, sign: &str, b: Value<'_>) -> bool {
    let order = match (a, b) {
        (Value::Number(a), Value::Number(b)) => a.partial_cmp(&b),
        (Value::Text(a), Value::Text(b)) => Some(a.cmp(&b)),
        (Value::Missing, _) | (_, Value::Missing) => None,
        // A set's number against another set's name.
        _ => return sign == "!=",
    };
    order.is_some_and(|order| match sign {
        "=" => order.is_eq(),
        "!=" => order.is_ne(),
        "<" => order.is_lt(),
        "<=" => order.is_le(),
        ">" => order.is_gt(),
        _ => order.is_ge(),
    })
}

impl Term {
    fn value<'a>(&'a self, row: &'a Row, scenes: &Scenes<'a>) -> Value<'a> {
        let number = |term: &'a Term| term.value(row, scenes).number();
        let found = match self {
            Term::Number(v) => Some(*v),
            Term::Text(text) => return Value::Text(text.into()),
            Term::Column(method, column) => return scenes.value(row, method.as_deref(), *column),
            Term::Negative(inner) => number(inner).map(|v| -v),
            Term::Arithmetic(a, sign, b) => number(a).zip(number(b)).map(|(a, b)| match *sign {
                "+" => a + b,
                "-" => a - b,
                "*" => a * b,
                _ => a / b,
            }),
        };
        found.map_or(Value::Missing, Value::Number)
    }
}
