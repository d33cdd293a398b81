//! Filters over rows: `live.squared_error > 800 & objects >= 4`.
//!
//! A column's name is that of the row itself; after a method's name and a dot it is that of this method's row on the same scene, so that
//! methods can be held against each other: `live.squared_error > 2 * nomp.squared_error`. Names of methods and sets stand in quotes:
//! `method = "live" & set != "walls"`.
//!
//! | | |
//! |---|---|
//! | `\|` `&` `!` | or, and, not, binding more in this order; also `\|\|` and `&&` |
//! | `=` `!=` `<` `<=` `>` `>=` | comparisons; also `==` |
//! | `+` `-` `*` `/` | arithmetic on numbers; a minus after a name wants a space before it, since methods' names have hyphens |
//! | `( )` | grouping |
//!
//! A figure that a scene doesn't have makes any comparison false.

mod complete;
mod expression;
mod parse;
mod tokens;

pub use complete::{Completion, complete};
pub use tokens::FilterError;

use super::rows::Row;
use expression::{Predicate, Scenes};

/// An expression that is true or false of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    root: Predicate,
}

impl Filter {
    /// Reads an expression about rows of `methods`.
    /// # Errors
    /// [`FilterError`] points at the mistake and says what was expected there.
    pub fn parse(text: &str, methods: &[impl AsRef<str>]) -> Result<Filter, FilterError> {
        let methods: Vec<&str> = methods.iter().map(AsRef::as_ref).collect();
        parse::parse(text, &methods).map(|root| Filter { root })
    }

    /// Indices of the rows for which the expression is true, in order.
    pub fn matching(&self, rows: &[Row]) -> Vec<usize> {
        let scenes = Scenes::new(rows);
        (0..rows.len()).filter(|&i| self.root.holds(&rows[i], &scenes)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::rows::tests::row;

    const METHODS: [&str; 2] = ["live", "matched-filter-coherent"];

    /// Six rows: three scenes by two methods; the second is worse by its scene's number.
    fn rows() -> Vec<Row> {
        let of = |index: u32, method: &str| Row {
            squared_error: 500.0 + 300.0 * f64::from(index) + if method == "live" { 0.0 } else { f64::from(index) },
            objects: 3 + index as usize,
            detection: (index != 2).then_some(0.5),
            doubt: (method == "live").then_some(700.0),
            ..row(["1", "3", "walls"][index as usize], index, method)
        };
        (0..3).flat_map(|i| METHODS.map(|m| of(i, m))).collect()
    }

    fn matching(text: &str) -> Vec<usize> {
        Filter::parse(text, &METHODS).unwrap_or_else(|e| panic!("{text}: {e}")).matching(&rows())
    }

    #[test]
    fn rows_are_chosen_by_figures_of_any_method() {
        for (text, expected) in [
            ("squared_error > 800", &[3, 4, 5][..]),
            ("live.squared_error >= 800 & objects >= 4", &[2, 3, 4, 5]),
            ("matched-filter-coherent.squared_error > live.squared_error", &[2, 3, 4, 5]),
            ("matched-filter-coherent.squared_error - live.squared_error = 2", &[4, 5]),
            ("method = \"live\"", &[0, 2, 4]),
            ("method == 'live' && !(objects = 4)", &[0, 4]),
            ("set = 3 | set = \"walls\"", &[2, 3, 4, 5]),
            ("set != 1", &[2, 3, 4, 5]),
            ("set < 3", &[0, 1]),
            ("detection = 0.5", &[0, 1, 2, 3]),
            ("squared_error > live.doubt", &[2, 3, 4, 5]),
            ("doubt > 0", &[0, 2, 4]),
            ("detection != 0.5", &[]),
            ("! detection = 0.5", &[4, 5]),
            ("objects * 2 + 1 > 1e1", &[4, 5]),
            ("-objects < -4 || objects / 0 < 1", &[4, 5]),
            ("objects = 3 | objects = 4 & method = 'live'", &[0, 1, 2]),
            ("(objects = 3 | objects = 4) & method = 'live'", &[0, 2]),
        ] {
            assert_eq!(matching(text), expected, "{text}");
        }
    }
}
