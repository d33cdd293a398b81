//! What has to be done so that the sums the engine keeps become another scene. An object that something else hides than before is another
//! one: so a body that moves has itself evaluated, and what it hides or reveals, and nothing else.

use crate::scattering::SeenObject;

pub(super) struct SceneChange {
    /// Whether the active ones are added to the sum at rest first.
    pub settles: bool,
    /// Stay in the sum at rest.
    pub staying: Vec<SeenObject>,
    /// Are evaluated and taken out of the sum at rest.
    pub leaving: Vec<SeenObject>,
    /// Are evaluated and become the active ones.
    pub arriving: Vec<SeenObject>,
}

impl SceneChange {
    pub fn between(rest: &[SeenObject], active: &[SeenObject], scene: &[SeenObject]) -> SceneChange {
        // Both sums are unordered: compare the objects as multisets. Edits touch few of them, so that what is left to
        // search for after walking both lists in step is short.
        let mut unmatched: Vec<&SeenObject> = Vec::new();
        let mut staying = Vec::with_capacity(rest.len());
        let mut arriving: Vec<SeenObject> = Vec::new();
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
        let stirring = SceneChange { settles: false, staying, leaving: Vec::new(), arriving };
        let at_rest = unmatched.is_empty();
        if at_rest && (stirring.arriving == active || count(&stirring.arriving) <= 1) {
            return stirring;
        }
        // The active ones come to rest first, and those of them that are gone or changed leave too.
        let mut settling = SceneChange {
            settles: true,
            staying: stirring.staying.clone(),
            leaving: unmatched.into_iter().cloned().collect(),
            arriving: stirring.arriving.clone(),
        };
        for object in active {
            match settling.arriving.iter().position(|o| o == object) {
                Some(at) => settling.staying.push(settling.arriving.remove(at)),
                None => settling.leaving.push(object.clone()),
            }
        }
        // As long as the active ones alone change, evaluating them again leaves the sum at rest without new rounding errors.
        if at_rest && stirring.cost() <= settling.cost() { stirring } else { settling }
    }

    /// Echoes to evaluate.
    pub fn cost(&self) -> usize {
        count(&self.leaving) + count(&self.arriving)
    }
}

fn count(objects: &[SeenObject]) -> usize {
    objects.iter().map(SeenObject::echo_count).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn points(x: impl IntoIterator<Item = f64>) -> Vec<SeenObject> {
        Scene::of_points(x.into_iter().map(|x| (x, 5.0))).objects.into_iter().map(SeenObject::from).collect()
    }

    #[test]
    fn the_one_that_is_dragged_is_evaluated_alone() {
        let change = SceneChange::between(&points([1.0, 2.0]), &points([3.0]), &points([1.0, 2.0, 3.1]));
        assert!(!change.settles && change.leaving.is_empty());
        assert_eq!((change.staying, change.arriving), (points([1.0, 2.0]), points([3.1])));
    }

    #[test]
    fn unmoved_reflectors_come_to_rest() {
        let change = SceneChange::between(&points([1.0]), &points([2.0, 3.0, 4.0]), &points([1.0, 2.0, 3.1, 4.0]));
        assert!(change.settles);
        assert_eq!(change.staying, points([1.0, 2.0, 4.0]));
        assert_eq!((change.leaving, change.arriving), (points([3.0]), points([3.1])));
    }

    #[test]
    fn what_is_added_beside_active_ones_is_evaluated_alone() {
        let change = SceneChange::between(&points([1.0]), &points([2.0, 3.0]), &points([1.0, 2.0, 3.0, 4.0]));
        assert!(change.settles && change.leaving.is_empty());
        assert_eq!((change.staying, change.arriving), (points([1.0, 2.0, 3.0]), points([4.0])));
    }

    #[test]
    fn a_change_at_rest_settles_the_active_ones() {
        let change = SceneChange::between(&points([1.0, 2.0]), &points([3.0]), &points([1.5, 2.0, 3.0]));
        assert!(change.settles);
        assert_eq!(change.staying, points([2.0, 3.0]));
        assert_eq!((change.leaving, change.arriving), (points([1.0]), points([1.5])));
    }
}
