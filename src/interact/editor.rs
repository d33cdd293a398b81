//! A scene being edited: selection, drags, history.

use super::history::Snapshot;
use super::hit::{self, Hit};
use super::{Grip, History, Place, Selection, SelectionMode, Snap, clipboard, grip};
use crate::radar::Radar;
use crate::scene::{Object, Scene};
use std::sync::Arc;

/// How far pasted and duplicated objects land from their originals, metres.
const COPY_OFFSET_METRES: f64 = 1.0;

/// A drag under way.
#[derive(Debug, Clone)]
struct Drag {
    hit: Hit,
    /// Grip minus pointer when the drag began.
    offset: Place,
    before: Snapshot,
}

/// A scene being edited. The scene is shared: as long as nothing changes, [`Editor::scene`] returns the same [`Arc`].
#[derive(Debug, Clone, Default)]
pub struct Editor {
    scene: Arc<Scene>,
    selection: Selection,
    history: History,
    drag: Option<Drag>,
    saved: Option<Arc<Scene>>,
}

impl Editor {
    /// Starts from a saved `scene`.
    pub fn new(scene: Scene) -> Self {
        let scene = Arc::new(scene);
        Editor { saved: Some(scene.clone()), scene, ..Editor::default() }
    }

    /// The scene as it is now.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What is selected.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// What can be undone and redone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether the scene differs from what was last opened or saved.
    pub fn is_modified(&self) -> bool {
        self.saved.as_ref() != Some(&self.scene)
    }

    /// Says that the scene as it is now is on disk.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.scene.clone());
    }

    /// Says that the scene as it is now is nowhere on disk, as after restoring it from an autosave.
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Ends the current undo step, as when the mouse button or a text field is left.
    pub fn seal(&mut self) {
        self.history.seal();
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot { scene: self.scene.clone(), selection: self.selection.clone() }
    }

    /// Changes the scene as one undo step, or as part of the last one where both carry the same `merge_key`. Nothing is recorded
    /// where nothing changed. Returns whether something did.
    pub fn edit(
        &mut self,
        label: &str,
        merge_key: Option<&str>,
        change: impl FnOnce(&mut Scene, &mut Selection),
    ) -> bool {
        let before = self.snapshot();
        change(Arc::make_mut(&mut self.scene), &mut self.selection);
        self.selection.clamp(self.scene.objects.len());
        if self.scene == before.scene {
            self.scene = before.scene;
            return false;
        }
        self.history.push(label, merge_key, before);
        true
    }

    /// Opens another scene. Can be undone.
    pub fn open(&mut self, label: &str, scene: Scene) {
        self.edit(label, None, |s, selection| {
            *s = scene;
            *selection = Selection::default();
        });
        self.mark_saved();
    }

    /// Adds an object and selects it.
    pub fn add(&mut self, object: Object) {
        let label = format!("add {}", object.kind());
        self.edit(&label, None, |scene, selection| {
            *selection = Selection::of([scene.objects.len()]);
            scene.objects.push(object);
        });
    }

    /// Deletes the selected objects.
    pub fn delete_selected(&mut self) {
        self.edit("delete", None, |scene, selection| {
            for index in std::mem::take(selection).iter().rev() {
                scene.objects.remove(index);
            }
        });
    }

    fn selected_objects(&self) -> Vec<Object> {
        self.selection.iter().filter_map(|i| self.scene.objects.get(i)).cloned().collect()
    }

    fn insert_copies(&mut self, label: &str, objects: Vec<Object>) {
        self.edit(label, None, |scene, selection| {
            let first = scene.objects.len();
            *selection = Selection::of(first..first + objects.len());
            scene.objects.extend(objects.into_iter().map(|mut o| {
                o.translate(COPY_OFFSET_METRES, 0.0);
                o
            }));
        });
    }

    /// Copies the selected objects a little aside and selects the copies.
    pub fn duplicate_selected(&mut self) {
        self.insert_copies("duplicate", self.selected_objects());
    }

    /// The selected objects as TOML; `None` where nothing is selected.
    pub fn copy(&self) -> Option<String> {
        (!self.selection.is_empty()).then(|| clipboard::to_text(self.selected_objects()))
    }

    /// Adds the objects in `text` and selects them; returns how many.
    ///
    /// # Errors
    /// [`clipboard::PasteError`] says what is wrong with the text; nothing changes then.
    pub fn paste(&mut self, text: &str, radar: &Radar) -> Result<usize, clipboard::PasteError> {
        let objects = clipboard::from_text(text, radar)?;
        let count = objects.len();
        self.insert_copies("paste", objects);
        Ok(count)
    }

    /// Moves the selected objects. Nudges in a row are one step until [`Editor::seal`].
    pub fn nudge(&mut self, dx_metres: f64, dy_metres: f64) {
        self.edit("nudge", Some("nudge"), |scene, selection| {
            for i in selection.iter() {
                scene.objects[i].translate(dx_metres, dy_metres);
            }
        });
    }

    /// Selects objects.
    pub fn select(&mut self, indices: impl IntoIterator<Item = usize>, mode: SelectionMode) {
        self.selection.pick(indices, mode);
        self.selection.clamp(self.scene.objects.len());
    }

    /// Selects every object.
    pub fn select_all(&mut self) {
        self.select(0..self.scene.objects.len(), SelectionMode::Replace);
    }

    /// The grip under `at`.
    pub fn hit(&self, at: Place, metres_per_point: f64) -> Option<Hit> {
        hit::test(&self.scene, &self.selection, at, metres_per_point)
    }

    /// Smallest rectangle that holds every object.
    pub fn bounds(&self) -> Option<(Place, Place)> {
        grip::bounds(&self.scene)
    }

    /// Starts dragging what was hit; an object that is not selected becomes the selection first.
    pub fn begin_drag(&mut self, hit: Hit, pointer: Place) {
        let offset = Place::new(hit.place.x_metres - pointer.x_metres, hit.place.y_metres - pointer.y_metres);
        let before = self.snapshot();
        if !self.selection.contains(hit.object) {
            self.selection = Selection::of([hit.object]);
        }
        self.drag = Some(Drag { hit, offset, before });
    }

    /// What is being dragged.
    pub fn dragged(&self) -> Option<Hit> {
        self.drag.as_ref().map(|d| d.hit)
    }

    /// Moves what is dragged to the pointer. All selected objects move along with a body. Returns whether something changed.
    pub fn drag_to(&mut self, pointer: Place, snap: Snap, radar: &Radar) -> bool {
        let Some(drag) = &self.drag else { return false };
        let target = Place::new(pointer.x_metres + drag.offset.x_metres, pointer.y_metres + drag.offset.y_metres);
        let target = snap.apply(radar, target);
        let start = &drag.before.scene;
        let Some(grabbed) = start.objects.get(drag.hit.object) else { return false };
        let mut moved = Scene::clone(start);
        if drag.hit.grip == Grip::Body {
            let centre = Place::from(grabbed.centre_metres());
            for i in self.selection.iter() {
                moved.objects[i].translate(target.x_metres - centre.x_metres, target.y_metres - centre.y_metres);
            }
        } else {
            moved.objects[drag.hit.object] = grip::move_grip(grabbed, drag.hit.grip, target);
        }
        let changed = moved != *self.scene;
        if changed {
            self.scene = Arc::new(moved);
        }
        changed
    }

    /// Ends the drag: one undo step, if anything moved.
    pub fn end_drag(&mut self) {
        if let Some(drag) = self.drag.take()
            && drag.before.scene != self.scene
        {
            self.history.push("drag", None, drag.before);
        }
    }

    /// Puts everything back where it was before the drag.
    pub fn cancel_drag(&mut self) {
        if let Some(drag) = self.drag.take() {
            self.restore(drag.before);
        }
    }

    /// Undoes the last step; false where there is none.
    pub fn undo(&mut self) -> bool {
        self.cancel_drag();
        let now = self.snapshot();
        self.history.undo(now).map(|before| self.restore(before)).is_some()
    }

    /// Redoes what was undone last; false where there is nothing.
    pub fn redo(&mut self) -> bool {
        self.cancel_drag();
        let now = self.snapshot();
        self.history.redo(now).map(|after| self.restore(after)).is_some()
    }

    fn restore(&mut self, snapshot: Snapshot) {
        self.scene = snapshot.scene;
        self.selection = snapshot.selection;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Point;

    fn editor() -> Editor {
        Editor::new(Scene::of_points([(0.0, 10.0), (3.0, 12.0)]))
    }

    fn place_of(editor: &Editor, index: usize) -> [f64; 2] {
        editor.scene().objects[index].centre_metres()
    }

    #[test]
    fn a_drag_keeps_the_distance_to_the_pointer_and_is_one_step() {
        let (mut e, radar) = (editor(), Radar::default());
        let pointer = Place::new(0.3, 10.2);
        let hit = e.hit(pointer, 0.1).unwrap();
        e.begin_drag(hit, pointer);
        for i in 1..=300 {
            assert!(e.drag_to(Place::new(0.3 + 0.01 * f64::from(i), 10.2), Snap::Off, &radar));
        }
        e.end_drag();
        let [x, y] = place_of(&e, 0);
        assert!((x - 3.0).abs() < 1e-12 && (y - 10.0).abs() < 1e-12);
        assert_eq!(e.history().depth(), 1);
        assert!(e.undo() && place_of(&e, 0) == [0.0, 10.0]);
        assert!(e.redo() && (place_of(&e, 0)[0] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_click_that_moves_nothing_leaves_no_step() {
        let mut e = editor();
        let hit = e.hit(Place::new(0.0, 10.0), 0.1).unwrap();
        e.begin_drag(hit, Place::new(0.0, 10.0));
        e.end_drag();
        assert_eq!(e.history().depth(), 0);
        assert_eq!(e.selection().single(), Some(0));
        assert!(!e.is_modified());
    }

    #[test]
    fn a_selection_moves_together_and_a_cancelled_drag_comes_back() {
        let (mut e, radar) = (editor(), Radar::default());
        e.select_all();
        let hit = e.hit(Place::new(3.0, 12.0), 0.1).unwrap();
        e.begin_drag(hit, Place::new(3.0, 12.0));
        e.drag_to(Place::new(4.0, 11.0), Snap::Off, &radar);
        assert_eq!(place_of(&e, 0), [1.0, 9.0]);
        e.cancel_drag();
        assert_eq!(place_of(&e, 0), [0.0, 10.0]);
        assert_eq!(e.history().depth(), 0);
    }

    #[test]
    fn everything_can_be_undone() {
        let (mut e, radar) = (editor(), Radar::default());
        let start = e.scene().clone();
        e.add(Object::Point(Point::new(5.0, 5.0)));
        e.duplicate_selected();
        e.nudge(0.1, 0.0);
        e.nudge(0.1, 0.0);
        let text = e.copy().unwrap();
        e.paste(&text, &radar).unwrap();
        e.select([0, 1], SelectionMode::Replace);
        e.delete_selected();
        e.open("open", Scene::default());
        assert_eq!(e.history().depth(), 6, "add, duplicate, nudges, paste, delete, open");
        while e.undo() {}
        assert_eq!(*e.scene(), start);
        while e.redo() {}
        assert!(e.scene().objects.is_empty());
    }

    #[test]
    fn an_edit_after_undo_forgets_what_was_undone() {
        let mut e = editor();
        e.nudge(1.0, 0.0);
        assert_eq!(e.history().depth(), 0, "nothing selected, nothing moved");
        e.select([0], SelectionMode::Replace);
        e.nudge(1.0, 0.0);
        e.seal();
        e.nudge(1.0, 0.0);
        assert_eq!(e.history().depth(), 2, "sealed: a new step");
        e.undo();
        e.nudge(0.0, 1.0);
        assert!(!e.redo());
    }

    #[test]
    fn bad_text_changes_nothing() {
        let mut e = editor();
        let before = e.scene().clone();
        assert!(e.paste("kind = 3", &Radar::default()).is_err());
        assert!(Arc::ptr_eq(&before, e.scene()));
    }
}
