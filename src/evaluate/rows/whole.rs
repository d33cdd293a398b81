//! All that a run was to find: its sets and methods, and how rows write them down.

use super::MAX_ROWS;

/// Most pairs of set and method that one run may have.
const MAX_PAIRS: usize = 10_000;

/// All that a run was to find, shards of other machines included.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Whole {
    /// Name and number of scenes of each set.
    pub sets: Vec<(String, u32)>,
    /// Names of the methods.
    pub methods: Vec<String>,
}

/// A set or method that is named twice: its scenes would count twice.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} \"{name}\" is given twice; expected each {what} once")]
pub struct GivenTwice {
    what: &'static str,
    name: String,
}

impl Whole {
    /// The run over these sets, each with its number of scenes, by these methods.
    ///
    /// # Errors
    /// [`GivenTwice`] names the first set or method that is there already.
    pub fn new(sets: Vec<(String, u32)>, methods: Vec<String>) -> Result<Whole, GivenTwice> {
        let names: Vec<&String> = sets.iter().map(|(name, _)| name).collect();
        if let Some(name) = first_repeated(&names) {
            return Err(GivenTwice { what: "set", name: name.clone() });
        }
        match first_repeated(&methods.iter().collect::<Vec<_>>()) {
            Some(name) => Err(GivenTwice { what: "method", name: name.clone() }),
            None => Ok(Whole { sets, methods }),
        }
    }

    /// The sets as they are written in their column.
    pub(super) fn sets_text(&self) -> String {
        let sets = self.sets.iter().map(|(name, count)| format!("{} x {count}", listed(name)));
        sets.collect::<Vec<_>>().join("; ")
    }

    /// The methods as they are written in theirs.
    pub(super) fn methods_text(&self) -> String {
        self.methods.iter().map(|m| listed(m)).collect::<Vec<_>>().join("; ")
    }

    /// The same, if no file asks for more work than a run can be.
    pub(super) fn bounded(self) -> Option<Whole> {
        let scenes = self.sets.iter().all(|(_, count)| *count as usize <= MAX_ROWS);
        (scenes && self.sets.len().saturating_mul(self.methods.len()) <= MAX_PAIRS).then_some(self)
    }
}

fn first_repeated<'a>(names: &[&'a String]) -> Option<&'a String> {
    names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)).map(|(_, name)| *name)
}

/// A name in a list whose names are separated by semicolons.
fn listed(name: &str) -> String {
    name.replace('%', "%25").replace(';', "%3B")
}

fn unlisted(name: &str) -> String {
    name.trim().replace("%3B", ";").replace("%25", "%")
}

/// Reads what [`Whole::sets_text`] wrote; `None` where it is something else.
pub(super) fn sets(text: &str) -> Option<Vec<(String, u32)>> {
    let set = |text: &str| {
        let (name, count) = text.rsplit_once(" x ")?;
        Some((unlisted(name), count.trim().parse().ok()?)).filter(|(name, _)| !name.is_empty())
    };
    text.split(';').map(set).collect()
}

/// Reads what [`Whole::methods_text`] wrote; `None` where a name is missing.
pub(super) fn methods(text: &str) -> Option<Vec<String>> {
    let names: Vec<String> = text.split(';').map(unlisted).collect();
    names.iter().all(|name| !name.is_empty()).then_some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_given_twice_is_refused() {
        let sets = |names: [&str; 2]| names.map(|n| (n.to_owned(), 3)).to_vec();
        let methods = |names: [&str; 2]| names.map(str::to_owned).to_vec();
        assert!(Whole::new(sets(["1", "2"]), methods(["live", "nomp"])).is_ok());
        let twice = Whole::new(sets(["1", "1"]), methods(["live", "nomp"])).unwrap_err();
        assert_eq!(twice.to_string(), "set \"1\" is given twice; expected each set once");
        let twice = Whole::new(sets(["1", "2"]), methods(["live", "live"])).unwrap_err();
        assert_eq!(twice.to_string(), "method \"live\" is given twice; expected each method once");
    }
}
