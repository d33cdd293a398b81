//! The sets and methods of a whole run, and their text in rows.

use super::lines::MAX_ROWS;

const MAX_PAIRS: usize = 10_000;

/// The sets and methods of a whole run, shards of other machines included.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct WholeRun {
    /// Name and number of scenes of each set.
    pub sets: Vec<(String, u32)>,
    /// Names of the methods.
    pub methods: Vec<String>,
}

impl WholeRun {
    /// The run over these sets, each with its number of scenes, by these methods.
    /// # Errors
    /// The first set or method that is given a second time: its scenes would count twice.
    pub fn new(sets: Vec<(String, u32)>, methods: Vec<String>) -> Result<WholeRun, String> {
        let names: Vec<&String> = sets.iter().map(|(name, _)| name).collect();
        for (what, names) in [("set", names), ("method", methods.iter().collect())] {
            if let Some((_, name)) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
                return Err(format!("{what} \"{name}\" is given twice; expected each {what} once"));
            }
        }
        Ok(WholeRun { sets, methods })
    }

    /// The sets as text, for [`Row::whole`](super::Row::whole).
    pub fn sets_text(&self) -> String {
        let sets = self.sets.iter().map(|(name, count)| format!("{} x {count}", listed(name)));
        sets.collect::<Vec<_>>().join("; ")
    }

    /// The methods as text, for [`Row::methods`](super::Row::methods).
    pub fn methods_text(&self) -> String {
        self.methods.iter().map(|m| listed(m)).collect::<Vec<_>>().join("; ")
    }

    /// Reads the texts of [`WholeRun::sets_text`] and [`WholeRun::methods_text`]; `None` for other text, and for more scenes than a run can have.
    pub fn read(sets: &str, methods: &str) -> Option<WholeRun> {
        let set = |text: &str| {
            let (name, count) = text.rsplit_once(" x ")?;
            Some((unlisted(name), count.trim().parse().ok()?)).filter(|(name, _)| !name.is_empty())
        };
        let sets: Vec<(String, u32)> = sets.split(';').map(set).collect::<Option<_>>()?;
        let methods: Vec<String> = methods.split(';').map(unlisted).collect();
        let are_few = sets.iter().all(|(_, count)| *count as usize <= MAX_ROWS)
            && sets.len().saturating_mul(methods.len()) <= MAX_PAIRS;
        (are_few && methods.iter().all(|name| !name.is_empty())).then_some(WholeRun { sets, methods })
    }
}

fn listed(name: &str) -> String {
    name.replace('%', "%25").replace(';', "%3B")
}

fn unlisted(name: &str) -> String {
    name.trim().replace("%3B", ";").replace("%25", "%")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_given_twice_is_refused() {
        let sets = |names: [&str; 2]| names.map(|n| (n.to_owned(), 3)).to_vec();
        let methods = |names: [&str; 2]| names.map(str::to_owned).to_vec();
        assert!(WholeRun::new(sets(["1", "2"]), methods(["live", "nomp"])).is_ok());
        let twice = WholeRun::new(sets(["1", "1"]), methods(["live", "nomp"])).unwrap_err();
        assert_eq!(twice, "set \"1\" is given twice; expected each set once");
        let twice = WholeRun::new(sets(["1", "2"]), methods(["live", "live"])).unwrap_err();
        assert_eq!(twice, "method \"live\" is given twice; expected each method once");
    }

    #[test]
    fn a_whole_run_is_read_as_it_was_written() {
        let sets = vec![("my; 5 x 5 % scenes".to_owned(), 7), ("3".to_owned(), 12)];
        let whole = WholeRun::new(sets, vec!["live".to_owned(), "nomp".to_owned()]).unwrap();
        assert_eq!(WholeRun::read(&whole.sets_text(), &whole.methods_text()), Some(whole));
        for (sets, methods) in [("1 times 4", "live"), ("1 x 4294967295", "live"), ("1 x 4", "live;"), ("", "")] {
            assert_eq!(WholeRun::read(sets, methods), None, "{sets} {methods}");
        }
    }
}
