//! What has to be done so that the sums the engine keeps become another scene.

use crate::scene::Object;

/// What has to be done so that two groups of objects become a scene.
pub(super) struct Change {
    /// Stay in the sum at rest.
    pub staying: Vec<Object>,
    /// Are evaluated and taken out of the sum at rest, after the active ones were added to it. Empty if the active ones alone changed.
    pub leaving: Vec<Object>,
    /// Are evaluated and become the active ones.
    pub arriving: Vec<Object>,
}

impl Change {
    pub fn between(rest: &[Object], active: &[Object], scene: &[Object]) -> Change {
        // Both sums are unordered: compare the objects as multisets. Edits touch few of them, so that what is left to
        // search for after walking both lists in step is short.
        let mut unmatched: Vec<&Object> = Vec::new();
        let mut staying = Vec::with_capacity(rest.len());
        let mut arriving: Vec<Object> = Vec::new();
        let mut old = rest.iter().peekable();
        for object in scene {
            if old.peek().is_some_and(|o| *o == object) {
                old.next();
                staying.push(object.clone());
            } else if let Some(at) = unmatched.iter().position(|o| *o == object) {
                staying.push(unmatched.remove(at).clone());
            } else {
                // Skip ahead in the old list if the object is there.
                let ahead = old.clone().position(|o| o == object);
                match ahead {
                    Some(ahead) => {
                        unmatched.extend(old.by_ref().take(ahead));
                        old.next();
                        staying.push(object.clone());
                    }
                    None => arriving.push(object.clone()),
                }
            }
        }
        unmatched.extend(old);
        if unmatched.is_empty() {
            return Change { staying, leaving: Vec::new(), arriving };
        }
        // Something at rest changed: the active ones come to rest first, and those of them that are gone or changed leave too.
        let mut leaving: Vec<Object> = unmatched.into_iter().cloned().collect();
        for object in active {
            match arriving.iter().position(|o| o == object) {
                Some(at) => staying.push(arriving.remove(at)),
                None => leaving.push(object.clone()),
            }
        }
        Change { staying, leaving, arriving }
    }

    /// Reflectors to evaluate.
    pub fn cost(&self) -> usize {
        self.leaving.iter().chain(&self.arriving).map(Object::reflector_count).sum()
    }
}
