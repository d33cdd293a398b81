//! The change from the sums that the engine keeps to another scene. An object also counts as changed when other objects hide it than before.

use crate::scattering::ObjectWithOccluders;

pub(super) struct SceneChange {
    /// Whether the active objects are first added to the sum at rest.
    pub settles: bool,
    /// Objects that stay in the sum at rest.
    pub staying: Vec<ObjectWithOccluders>,
    /// Objects to evaluate and subtract from the sum at rest.
    pub leaving: Vec<ObjectWithOccluders>,
    /// Objects to evaluate as the active ones.
    pub arriving: Vec<ObjectWithOccluders>,
}

impl SceneChange {
    pub fn between(
        rest: &[ObjectWithOccluders],
        active: &[ObjectWithOccluders],
        scene: &[ObjectWithOccluders],
    ) -> SceneChange {
        // Both sums are unordered, so objects are compared as multisets. Edits touch few: few remain to be searched for after a pass in step.
        let mut unmatched: Vec<&ObjectWithOccluders> = Vec::new();
        let mut staying = Vec::with_capacity(rest.len());
        let mut arriving: Vec<ObjectWithOccluders> = Vec::new();
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
        // The active objects are added to the sum at rest first; those that are gone or changed then leave it.
        let (staying, arriving) = (stirring.staying.clone(), stirring.arriving.clone());
        let leaving = unmatched.into_iter().cloned().collect();
        let mut settling = SceneChange { settles: true, staying, leaving, arriving };
        for object in active {
            match settling.arriving.iter().position(|o| o == object) {
                Some(at) => settling.staying.push(settling.arriving.remove(at)),
                None => settling.leaving.push(object.clone()),
            }
        }
        // As long as only active objects change, evaluating them again adds no rounding errors to the sum at rest.
        if at_rest && stirring.cost() <= settling.cost() { stirring } else { settling }
    }

    pub fn cost(&self) -> usize {
        count(&self.leaving) + count(&self.arriving)
    }
}

fn count(objects: &[ObjectWithOccluders]) -> usize {
    objects.iter().map(ObjectWithOccluders::echo_count).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn points(x: &[f64]) -> Vec<ObjectWithOccluders> {
        Scene::of_points(x.iter().map(|x| (*x, 5.0))).objects.into_iter().map(ObjectWithOccluders::from).collect()
    }

    #[test]
    fn what_is_dragged_or_added_is_evaluated_alone() {
        type Points = &'static [f64];
        let cases: [([Points; 3], bool, [Points; 3]); 4] = [
            ([&[1.0, 2.0], &[3.0], &[1.0, 2.0, 3.1]], false, [&[1.0, 2.0], &[], &[3.1]]),
            ([&[1.0], &[2.0, 3.0, 4.0], &[1.0, 2.0, 3.1, 4.0]], true, [&[1.0, 2.0, 4.0], &[3.0], &[3.1]]),
            ([&[1.0], &[2.0, 3.0], &[1.0, 2.0, 3.0, 4.0]], true, [&[1.0, 2.0, 3.0], &[], &[4.0]]),
            ([&[1.0, 2.0], &[3.0], &[1.5, 2.0, 3.0]], true, [&[2.0, 3.0], &[1.0], &[1.5]]),
        ];
        for (given, settles, expected) in cases {
            let [rest, active, scene] = given.map(points);
            let change = SceneChange::between(&rest, &active, &scene);
            assert_eq!(change.settles, settles, "{given:?}");
            assert_eq!([change.staying, change.leaving, change.arriving], expected.map(points), "{given:?}");
        }
    }
}
