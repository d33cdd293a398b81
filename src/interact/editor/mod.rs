//! A document being edited: selection, drags, history.

mod fields;
mod keeping;

pub use keeping::Saved;

use super::blob::BlobHit;
use super::history::Snapshot;
use super::hit::{self, Hit};
use super::{Document, Grip, History, Place, Selection, SelectionMode, Snap, clipboard, grip};
use crate::radar::{Radar, RadarError};
use crate::scene::file::SceneFile;
use crate::scene::{Object, Scene, SceneError};
use std::sync::Arc;

/// Distance of pasted and duplicated objects from their originals, metres.
const COPY_OFFSET_METRES: f64 = 1.0;

#[derive(Debug, Clone)]
struct Drag {
    hit: Hit,
    offset: Place,
    before: Snapshot,
}

/// A document being edited. Its scene is shared: as long as nothing changes, [`Editor::scene`] returns the same [`Arc`].
///
/// Undo brings back documents, so that undoing "open" gives back the one before with its radar, its path and its saved content. An unsaved document
/// that another replaced is not lost either: it stands in [`Editor::left`] until it is saved, discarded, or on screen again.
#[derive(Debug, Clone, Default)]
pub struct Editor {
    document: Document,
    selection: Selection,
    history: History,
    drag: Option<Drag>,
    left: Vec<Document>,
}

impl Editor {
    /// Starts from a `scene` that comes with the program, before the radar of table 3.1.
    pub fn new(scene: Scene) -> Self {
        Editor::of(Document::shipped(SceneFile { scene, ..SceneFile::default() }))
    }

    pub fn of(document: Document) -> Self {
        Editor { document, ..Editor::default() }
    }

    pub fn document(&self) -> &Document {
        &self.document
    }

    pub fn scene(&self) -> &Arc<Scene> {
        self.document.scene()
    }

    pub fn radar(&self) -> &Arc<Radar> {
        self.document.radar()
    }

    /// The selected objects.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// The steps that can be undone and redone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether the document differs from what is on disk.
    pub fn is_modified(&self) -> bool {
        self.document.is_modified()
    }

    /// Ends the current undo step, as when the mouse button or a text field is left.
    pub fn seal(&mut self) {
        self.history.seal();
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot { document: self.document.clone(), selection: self.selection.clone() }
    }

    /// Changes the scene as one undo step, or as part of the last of the same `key`; none where nothing changed. Returns whether anything did.
    pub fn edit(&mut self, key: Option<&str>, change: impl FnOnce(&mut Scene, &mut Selection)) -> bool {
        let before = self.snapshot();
        change(self.document.scene_mut(), &mut self.selection);
        self.selection.clamp(self.scene().objects.len());
        if self.scene() == before.document.scene() {
            self.document = before.document;
            return false;
        }
        self.history.push(key, before);
        true
    }

    /// Changes the radar, as [`Editor::edit`] does the scene.
    /// # Errors
    /// [`RadarError`] for a radar that makes no sense or asks for too much memory; nothing changes then.
    pub fn edit_radar(&mut self, merge_key: Option<&str>, change: impl FnOnce(&mut Radar)) -> Result<bool, RadarError> {
        let mut radar = Radar::clone(self.radar());
        change(&mut radar);
        radar.validate()?;
        if radar == **self.radar() {
            return Ok(false);
        }
        let before = self.snapshot();
        let built = &self.scene().disturbances.elements;
        if radar.elements != self.radar().elements && !built.elements.is_empty() {
            // Elements keep their errors, counted from the first.
            let fitted = built.fitted(radar.elements);
            self.document.scene_mut().disturbances.elements = fitted;
        }
        *self.document.radar_mut() = radar;
        self.history.push(merge_key, before);
        Ok(true)
    }

    pub fn add(&mut self, object: Object) {
        self.edit(None, |scene, selection| {
            *selection = Selection::of([scene.objects.len()]);
            scene.objects.push(object);
        });
    }

    pub fn delete_selected(&mut self) {
        self.edit(None, |scene, selection| {
            for index in std::mem::take(selection).iter().rev() {
                scene.objects.remove(index);
            }
        });
    }

    fn selected_objects(&self) -> Vec<Object> {
        self.selected().cloned().collect()
    }

    fn insert_copies(&mut self, objects: Vec<Object>) -> Result<(), SceneError> {
        self.scene().check_room(&objects)?;
        self.edit(None, |scene, selection| {
            let first = scene.objects.len();
            *selection = Selection::of(first..first + objects.len());
            scene.objects.extend(objects.into_iter().map(|mut o| {
                o.translate(COPY_OFFSET_METRES, 0.0);
                o
            }));
        });
        Ok(())
    }

    /// Copies the selected objects a little aside and selects the copies.
    /// # Errors
    /// [`SceneError::TooMany`] where the scene has no room for them; nothing changes then.
    pub fn duplicate_selected(&mut self) -> Result<(), SceneError> {
        let mut copies = self.selected_objects();
        copies.iter_mut().for_each(|copy| copy.set_name(""));
        self.insert_copies(copies)
    }

    /// The selected objects as TOML; `None` where nothing is selected.
    pub fn copy(&self) -> Option<String> {
        (!self.selection.is_empty()).then(|| clipboard::to_text(self.selected_objects()))
    }

    /// Adds the objects in `text` and selects them; returns how many.
    /// # Errors
    /// [`clipboard::PasteError`] says what is wrong with the text; nothing changes then.
    pub fn paste(&mut self, text: &str) -> Result<usize, clipboard::PasteError> {
        let objects = clipboard::from_text(text, self.radar())?;
        let count = objects.len();
        self.insert_copies(objects)?;
        Ok(count)
    }

    /// Moves the selected objects. Nudges in a row are one step until [`Editor::seal`].
    pub fn nudge(&mut self, dx_metres: f64, dy_metres: f64) {
        self.edit(Some("nudge"), |scene, selection| {
            for i in selection.iter() {
                scene.objects[i].translate(dx_metres, dy_metres);
            }
        });
    }

    /// Selects objects, and ends the current undo step: edits of others are another step.
    pub fn select(&mut self, indices: impl IntoIterator<Item = usize>, mode: SelectionMode) {
        self.seal();
        self.selection.pick(indices, mode);
        self.selection.clamp(self.document.scene().objects.len());
    }

    /// Selects the object after or before the one that was picked last.
    pub fn select_neighbour(&mut self, forward: bool) {
        let next = self.selection.neighbour(self.scene().objects.len(), forward);
        self.select(next, SelectionMode::Replace);
    }

    pub fn select_all(&mut self) {
        self.select(0..self.scene().objects.len(), SelectionMode::Replace);
    }

    /// The grip under `at`.
    pub fn hit(&self, at: Place, metres_per_point: f64) -> Option<Hit> {
        hit::test(self.scene(), &self.selection, at, metres_per_point)
    }

    /// Smallest rectangle that holds every object.
    pub fn bounds(&self) -> Option<(Place, Place)> {
        grip::bounds(self.scene())
    }

    /// Starts dragging a hit part; an object that is not selected becomes the selection first.
    pub fn begin_drag(&mut self, hit: Hit, pointer: Place) {
        let offset = Place::new(hit.place.x_metres - pointer.x_metres, hit.place.y_metres - pointer.y_metres);
        let before = self.snapshot();
        if !self.selection.contains(hit.object) {
            self.selection = Selection::of([hit.object]);
        }
        self.drag = Some(Drag { hit, offset, before });
    }

    /// Starts dragging the object whose blob was hit on a map, by the reflector behind it.
    pub fn grab(&mut self, blob: BlobHit) {
        if let Some(hit) = blob.as_hit(self.scene()) {
            self.begin_drag(hit, blob.place);
        }
    }

    /// The part of an object that is being dragged.
    pub fn dragged(&self) -> Option<Hit> {
        self.drag.as_ref().map(|d| d.hit)
    }

    /// Moves the dragged part to the pointer. All selected objects move along with a body. Returns whether anything changed.
    pub fn drag_to(&mut self, pointer: Place, snap: Snap) -> bool {
        let Some(drag) = &self.drag else { return false };
        let target = Place::new(pointer.x_metres + drag.offset.x_metres, pointer.y_metres + drag.offset.y_metres);
        // Directions don't snap to the grid of places.
        let target = if drag.hit.grip == Grip::Turn { target } else { snap.apply(self.radar(), target) };
        let start = drag.before.document.scene();
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
        let changed = moved != **self.scene();
        if changed {
            self.document.set_scene(Arc::new(moved));
        }
        changed
    }

    /// Ends the drag: one undo step, if anything moved.
    pub fn end_drag(&mut self) {
        if let Some(drag) = self.drag.take()
            && drag.before.document.scene() != self.scene()
        {
            self.history.push(None, drag.before);
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

    /// Redoes the step that was undone last; false where there is none.
    pub fn redo(&mut self) -> bool {
        self.cancel_drag();
        let now = self.snapshot();
        self.history.redo(now).map(|after| self.restore(after)).is_some()
    }

    fn restore(&mut self, snapshot: Snapshot) {
        self.replace(snapshot.document);
        self.selection = snapshot.selection;
    }
}

#[cfg(test)]
mod tests;
