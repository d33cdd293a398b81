//! Numbers of all selected objects at once.

use super::Editor;
use crate::interact::field::{self, Coordinates, Field, FieldChange, SharedField};
use crate::scene::{Object, Scene, SceneError};

impl Editor {
    pub(super) fn selected(&self) -> impl Iterator<Item = &Object> + Clone {
        let selection: Vec<usize> = self.selection.iter().collect();
        selection.into_iter().filter_map(|i| self.scene().objects.get(i))
    }

    /// The numbers that all selected objects have.
    pub fn shared_fields(&self, coordinates: Coordinates) -> Vec<SharedField> {
        field::shared(self.selected(), coordinates)
    }

    pub fn selected_reflectors(&self) -> usize {
        self.selected().fold(0, |n, o| n.saturating_add(o.reflector_count()))
    }

    /// Changes a number of every selected object that has it. Changes of one number in a row are one step until [`Editor::seal`].
    /// # Errors
    /// [`SceneError::TooMany`] where the scene would hold more than can be simulated; nothing changes then.
    pub fn set_field(&mut self, field: Field, change: FieldChange) -> Result<(), SceneError> {
        let mut changed = Scene::clone(self.scene());
        for index in self.selection.iter() {
            let Some(object) = changed.objects.get_mut(index) else { continue };
            let Some(value) = field.get(object).map(|v| change.of(v)).filter(|v| v.is_finite()) else { continue };
            field.set(object, value);
        }
        changed.check_room(&[])?;
        self.edit(Some(&format!("{field:?}")), |scene, _| *scene = changed);
        Ok(())
    }

    /// Names the selected object, where it is one. Letters in a row are one step until [`Editor::seal`].
    pub fn name_selected(&mut self, name: &str) {
        self.edit(Some("name"), |scene, selection| {
            let object = selection.single().and_then(|index| scene.objects.get_mut(index));
            object.into_iter().for_each(|object| object.set_name(name));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::SelectionMode;
    use crate::scene::Line;

    fn editor() -> Editor {
        let mut scene = Scene::of_points([(0.0, 10.0), (3.0, 12.0), (5.0, 6.0)]);
        scene.objects.push(Object::Line(Line::vertical(2.0, 8.0, 0.5, 10)));
        let mut editor = Editor::new(scene);
        editor.select([0, 1, 3], SelectionMode::Replace);
        editor
    }

    fn all(editor: &Editor, field: Field) -> Vec<f64> {
        editor.scene().objects.iter().filter_map(|o| field.get(o)).collect()
    }

    #[test]
    fn a_number_of_several_objects_is_set_in_one_step() {
        let mut e = editor();
        for x in [1.0, 1.5] {
            e.set_field(Field::X, FieldChange::To(x)).unwrap();
        }
        assert_eq!(all(&e, Field::X), [1.5, 1.5, 5.0, 1.5]);
        e.set_field(Field::Y, FieldChange::By(-1.0)).unwrap();
        assert_eq!(all(&e, Field::Y), [9.0, 11.0, 6.0, 7.0], "what differs stays different");
        assert_eq!(e.history().depth(), 2, "x typed twice is one step");
        e.set_field(Field::Y, FieldChange::To(f64::NAN)).unwrap();
        assert_eq!(e.history().depth(), 2, "what is no number changes nothing");
        e.undo();
        e.undo();
        assert_eq!(all(&e, Field::X), [0.0, 3.0, 5.0, 2.0]);
    }

    #[test]
    fn the_same_number_of_another_object_is_another_step() {
        let mut e = editor();
        e.select([0], SelectionMode::Replace);
        e.set_field(Field::X, FieldChange::To(1.0)).unwrap();
        e.select_neighbour(true);
        e.set_field(Field::X, FieldChange::To(2.0)).unwrap();
        e.undo();
        assert_eq!(all(&e, Field::X), [1.0, 3.0, 5.0, 2.0]);
    }

    #[test]
    fn letters_of_a_name_are_one_step_of_one_object() {
        let mut e = editor();
        e.name_selected("several have no name");
        assert_eq!(e.history().depth(), 0);
        e.select([1], SelectionMode::Replace);
        for name in ["p", "po", "post"] {
            e.name_selected(name);
        }
        e.duplicate_selected().unwrap();
        let called: Vec<String> = e.scene().objects.iter().enumerate().map(|(i, o)| o.called(i)).collect();
        assert_eq!(called, ["point 1", "post", "point 3", "line 4", "point 5"]);
        e.undo();
        e.undo();
        assert_eq!(e.scene().objects[1].called(1), "point 2");
    }

    #[test]
    fn more_reflectors_than_can_be_simulated_are_refused() {
        let mut e = editor();
        assert!(e.set_field(Field::Count, FieldChange::To(1e7)).is_err());
        assert_eq!((all(&e, Field::Count), e.history().depth()), (vec![10.0], 0));
    }
}
