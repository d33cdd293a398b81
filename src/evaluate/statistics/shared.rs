//! Common traits of bad rows: rules that are found on one half of the scenes and tested on the other.

use super::chance::Factorials;
use super::paired::p_text;
use crate::evaluate::filter::{Filter, FilterError};
use crate::evaluate::rows::{Column, Row, Value};
use std::collections::BTreeSet;

/// Of the rules that are shown, at most this part is expected to be chance.
pub const DISCOVERY_RATE: f64 = 0.05;

/// The default filter for bad rows.
pub const USUALLY_BAD: &str = "missed > 0 | merged > 0 | wrong_tooth > 0 | ghosts > 0";

/// Columns known of a scene before a method answers. A rule about an answer's own figures would only repeat that bad rows are bad.
const SCENE_COLUMNS: [Column; 8] = [
    Column::Set,
    Column::Method,
    Column::Objects,
    Column::Reflectors,
    Column::NearestPairColumns,
    Column::NearestPairBins,
    Column::MinRangeMetres,
    Column::StrongestOverWeakestDb,
];

/// Cuts that are tried in a column of numbers: at every tenth of its values.
const CUTS: usize = 10;

/// A rule with its counts on the half of the scenes that tests it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The rule as a filter.
    pub text: String,
    /// Rows of the testing half that satisfy the rule.
    pub rows: usize,
    /// Bad rows among them.
    pub bad: usize,
    /// The other rows of the testing half.
    pub other_rows: usize,
    /// Bad rows among these.
    pub other_bad: usize,
    /// Probability of so many bad rows, or more, if they fell on rows by chance: Fisher's exact test on the testing half.
    pub p_value: f64,
}

impl Rule {
    /// The rule in words.
    pub fn told(&self) -> String {
        let Rule { rows, bad, other_rows, other_bad, .. } = self;
        let [own, other] =
            [(bad, rows), (other_bad, other_rows)].map(|(bad, rows)| 100.0 * *bad as f64 / (*rows).max(1) as f64);
        let p = p_text(self.p_value);
        format!("{own:.0} % of {rows} are bad, {other:.0} % of the other {other_rows} (p = {p})")
    }
}

/// The rules that bad rows have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedTrait {
    /// Bad rows.
    pub bad: usize,
    /// All rows.
    pub rows: usize,
    /// Rules that hold, the surest first.
    pub rules: Vec<Rule>,
    /// Rules that the first half suggested.
    pub tried: usize,
}

/// Rules about a scene's known columns that are true of bad rows more often than of others. `bad` is a filter.
///
/// Scenes of even number suggest rules: of each column the cut, or the name, that separates best. Scenes of odd number test them. Of the rules
/// that hold, at most [`DISCOVERY_RATE`] are expected to be chance (Benjamini and Hochberg, J. R. Statist. Soc. B 57, 1995).
///
/// # Errors
/// [`FilterError`] where `bad` is no filter.
pub fn rules(rows: &[Row], bad: &str) -> Result<SharedTrait, FilterError> {
    let names: BTreeSet<&str> = rows.iter().map(|row| &*row.method).collect();
    let names: Vec<&str> = names.into_iter().collect();
    let mut is_bad = vec![false; rows.len()];
    Filter::parse(bad, &names)?.matching(rows).into_iter().for_each(|row| is_bad[row] = true);
    let half = |odd: bool| -> Vec<usize> { (0..rows.len()).filter(|&i| (rows[i].index % 2 == 1) == odd).collect() };
    let table = Table { rows, bad: &is_bad, factorials: Factorials::up_to(rows.len()) };
    let [suggesting, testing] = [half(false), half(true)];
    let suggested: Vec<Rule> = SCENE_COLUMNS.into_iter().filter_map(|column| table.best(column, &suggesting)).collect();
    let tested: Vec<Rule> = suggested.iter().filter_map(|rule| table.judged(&rule.text, &names, &testing)).collect();
    Ok(SharedTrait {
        bad: is_bad.iter().filter(|b| **b).count(),
        rows: rows.len(),
        tried: suggested.len(),
        rules: held(tested),
    })
}

fn held(mut tested: Vec<Rule>) -> Vec<Rule> {
    tested.sort_by(|a, b| a.p_value.total_cmp(&b.p_value));
    let all = tested.len() as f64;
    let holds = |(rank, rule): (usize, &Rule)| rule.p_value <= DISCOVERY_RATE * (rank + 1) as f64 / all;
    let last = tested.iter().enumerate().rev().find(|&(rank, rule)| holds((rank, rule)));
    let count = last.map_or(0, |(rank, _)| rank + 1);
    tested.truncate(count);
    tested
}

struct Table<'a> {
    rows: &'a [Row],
    bad: &'a [bool],
    factorials: Factorials,
}

impl Table<'_> {
    /// The rule about a column that separates bad rows from others best, on the rows `on`; `None` where none is better than chance.
    fn best(&self, column: Column, on: &[usize]) -> Option<Rule> {
        let judged = candidates(column, on.iter().map(|&i| &self.rows[i])).into_iter().map(|(text, is_true)| {
            let chosen: Vec<bool> = on.iter().map(|&i| is_true(&self.rows[i])).collect();
            self.counted(text, on, &chosen)
        });
        judged.flatten().min_by(|a, b| a.p_value.total_cmp(&b.p_value)).filter(|rule| rule.p_value < DISCOVERY_RATE)
    }

    fn judged(&self, text: &str, methods: &[&str], on: &[usize]) -> Option<Rule> {
        let matching = Filter::parse(text, methods).ok()?.matching(self.rows);
        let matching: std::collections::HashSet<usize> = matching.into_iter().collect();
        let chosen: Vec<bool> = on.iter().map(|i| matching.contains(i)).collect();
        self.counted(text.to_owned(), on, &chosen)
    }

    /// The rule with its counts on the rows `on`, of which `chosen` satisfy it; `None` where it is true of all rows or of none.
    fn counted(&self, text: String, on: &[usize], chosen: &[bool]) -> Option<Rule> {
        let count =
            |of: bool, bad: bool| on.iter().zip(chosen).filter(|&(&i, &c)| c == of && (!bad || self.bad[i])).count();
        let [rows, hit, other_rows, other_bad] =
            [(true, false), (true, true), (false, false), (false, true)].map(|(of, bad)| count(of, bad));
        let p_value = self.factorials.at_least(hit, rows, hit + other_bad, on.len());
        (rows > 0 && other_rows > 0).then_some(Rule { text, rows, bad: hit, other_rows, other_bad, p_value })
    }
}

type Truth = Box<dyn Fn(&Row) -> bool>;

/// Rules about a column, each as a filter and as a function.
fn candidates<'a>(column: Column, rows: impl Iterator<Item = &'a Row>) -> Vec<(String, Truth)> {
    let (mut numbers, mut names) = (Vec::new(), BTreeSet::new());
    for row in rows {
        match column.of(row) {
            Value::Number(v) if column != Column::Set => numbers.push(v),
            Value::Number(v) => _ = names.insert(format!("{v}")),
            Value::Text(text) => _ = names.insert(format!("\"{text}\"")),
            Value::Missing => {}
        }
    }
    numbers.sort_by(f64::total_cmp);
    let mut cuts: Vec<f64> =
        (1..CUTS).filter_map(|k| numbers.get(k * numbers.len() / CUTS)).map(|v| rounded(*v)).collect();
    cuts.dedup();
    let of_cut = |cut: f64| -> [(String, Truth); 2] {
        let number = move |row: &Row| column.of(row).number();
        [
            (format!("{} < {cut}", column.name()), Box::new(move |row: &Row| number(row).is_some_and(|v| v < cut))),
            (format!("{} >= {cut}", column.name()), Box::new(move |row: &Row| number(row).is_some_and(|v| v >= cut))),
        ]
    };
    let of_name = |name: String| -> (String, Truth) {
        let text = format!("{} = {name}", column.name());
        let same = move |row: &Row| match column.of(row) {
            Value::Number(v) => format!("{v}") == name,
            Value::Text(text) => format!("\"{text}\"") == name,
            Value::Missing => false,
        };
        (text, Box::new(same))
    };
    cuts.into_iter().flat_map(of_cut).chain(names.into_iter().map(of_name)).collect()
}

/// `v` rounded to three digits, as a user would type it.
fn rounded(v: f64) -> f64 {
    format!("{v:.2e}").parse().unwrap_or(v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::rows::tests::row;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Rows of scenes whose nearest two objects are 0 to 100 columns apart; `miss` is the probability that an object is missed at that distance.
    fn rows(count: u32, seed: u64, miss: impl Fn(f64) -> f64) -> Vec<Row> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut of = |index: u32| {
            let apart = rng.random_range(0.0..100.0);
            let missed = usize::from(rng.random::<f64>() < miss(apart));
            let objects = rng.random_range(3..=6);
            let min_range_metres = Some(rng.random_range(2.0..30.0));
            let set = ["2", "3", "walls"][index as usize / 2 % 3];
            Row {
                missed,
                objects,
                min_range_metres,
                nearest_pair_columns: Some(apart),
                merged: None,
                ..row(set, index, "live")
            }
        };
        (0..count).map(&mut of).collect()
    }

    #[test]
    fn near_pairs_are_named_where_they_are_missed() {
        let rows = rows(400, 1, |apart| if apart < 20.0 { 0.7 } else { 0.05 });
        let shared = rules(&rows, USUALLY_BAD).unwrap();
        let first = &shared.rules[0];
        assert!(first.text.starts_with("nearest_pair_columns < "), "{shared:?}");
        let cut: f64 = first.text.rsplit(' ').next().unwrap().parse().unwrap();
        assert!((15.0..=31.0).contains(&cut) && first.p_value < 1e-6, "{first:?}");
        assert_eq!(first.rows + first.other_rows, 200, "the half that did not suggest it");
        let filter = Filter::parse(&first.text, &["live"]).unwrap().matching(&rows);
        assert_eq!(filter.iter().filter(|&&i| rows[i].index % 2 == 1).count(), first.rows);
    }

    /// Of tables in which rows are bad by chance alone, 5 % at most have a rule, give or take 2.2 for a hundred tables.
    #[test]
    fn chance_is_seldom_taken_for_a_rule() {
        let found =
            (0..100).filter(|seed| !rules(&rows(200, 100 + seed, |_| 0.3), USUALLY_BAD).unwrap().rules.is_empty());
        let found = found.count();
        assert!(found <= 11, "{found} of 100 tables");
    }

    #[test]
    fn sets_are_named_in_quotes() {
        let mut all = rows(300, 5, |_| 0.0);
        for row in &mut all {
            row.missed = usize::from(row.set == "walls");
        }
        let shared = rules(&all, "missed > 0").unwrap();
        assert_eq!(shared.rules[0].text, "set = \"walls\"");
        assert_eq!((shared.rules[0].bad, shared.rules[0].rows, shared.rules[0].other_bad), (50, 50, 0));
        assert_eq!((shared.bad, shared.rows), (100, 300));
    }

    #[test]
    fn where_all_or_none_are_bad_there_is_no_rule() {
        let all = rows(50, 7, |_| 1.0);
        for bad in ["missed > 0", "missed > 5"] {
            assert!(rules(&all, bad).unwrap().rules.is_empty());
        }
        assert!(rules(&[], USUALLY_BAD).unwrap().rules.is_empty() && rules(&all, "missed >").is_err());
    }
}
