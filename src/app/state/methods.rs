//! The reconstruction methods that the app offers.

use crate::radar::Radar;
use crate::reconstruct::Reconstructor;
use std::sync::Arc;

/// Methods for any radar and scene, in place of one that refuses the radar.
const FALLBACK_METHODS: [&str; 2] = ["capon", "baseline"];

/// Every method, and the preferred one.
#[derive(Default)]
pub struct Methods {
    pub all: Vec<Arc<dyn Reconstructor>>,
    /// Name of the method in use where the user chose none.
    preferred: &'static str,
}

impl Methods {
    pub fn new(all: Vec<Arc<dyn Reconstructor>>) -> Self {
        Methods { all, preferred: crate::methods::preferred().name() }
    }

    #[cfg(feature = "live")]
    pub fn add(&mut self, method: Arc<dyn Reconstructor>) {
        self.all.retain(|other| other.name() != method.name());
        self.all.push(method);
    }

    pub fn called(&self, name: &str) -> Option<&Arc<dyn Reconstructor>> {
        self.all.iter().find(|method| method.name() == name)
    }

    pub fn named(&self, name: &str) -> Option<&Arc<dyn Reconstructor>> {
        self.called(name).or_else(|| self.called(self.preferred)).or_else(|| self.all.first())
    }

    /// A method that works on samples of `radar`, other than the one called `name`, if there is one.
    pub fn instead_of(&self, name: &str, radar: &Radar) -> Option<&'static str> {
        let preferred = crate::methods::preferred_for(radar).name();
        let works = |other: &&str| *other != name && self.called(other).is_some_and(|m| m.check_array(radar).is_ok());
        [preferred].into_iter().chain(FALLBACK_METHODS).find(|other| works(other))
    }

    /// A method that makes maps from the elements of `layout`, if there is one.
    pub fn hearing(&self, radar: &Radar, layout: &[usize]) -> Option<&'static str> {
        let preferred = crate::methods::preferred_for_layout(radar, layout).name();
        let mut able = self.all.iter().filter(|method| method.check_elements(radar, layout).is_ok());
        let first = able.clone().next();
        able.find(|method| method.name() == preferred).or(first).map(|method| method.name())
    }

    /// The method to compare with the one called `first`: the one called `name`, else a robust one, else any other.
    pub fn second_to(&self, first: Option<&str>, name: &str) -> Option<&Arc<dyn Reconstructor>> {
        let other = |m: &&Arc<dyn Reconstructor>| Some(m.name()) != first;
        let plain = || FALLBACK_METHODS.iter().rev().find_map(|name| self.called(name).filter(other));
        self.called(name).or_else(plain).or_else(|| self.all.iter().find(other)).or_else(|| self.all.first())
    }

    /// The next method after the one called `name` that `is_able`; the first follows the last.
    pub fn after(&self, name: &str, is_able: impl Fn(&dyn Reconstructor) -> bool) -> Option<&'static str> {
        let index = self.all.iter().position(|m| m.name() == name).unwrap_or(0);
        let others = self.all.iter().cycle().skip(index + 1).take(self.all.len());
        others.map(AsRef::as_ref).find(|method| is_able(*method)).map(Reconstructor::name)
    }
}
