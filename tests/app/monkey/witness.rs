//! The unsaved documents, and those that must still be there after a kill.

use super::FILES;
use crate::session::*;

#[derive(Clone)]
struct Kept {
    scene: Arc<Scene>,
    name: String,
}

impl Kept {
    fn of(document: &Document) -> Kept {
        Kept { scene: document.scene().clone(), name: document.name() }
    }

    fn same(&self, other: &Kept) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene) && self.name == other.name
    }

    fn is(&self, document: &Document) -> bool {
        **document.scene() == *self.scene && document.name() == self.name
    }
}

type Moment = Vec<Kept>;

/// The moments since everything was last known to be on disk, that one first.
#[derive(Default)]
pub struct Witness {
    moments: Vec<Moment>,
}

fn unsaved(app: &App) -> Moment {
    let editor = &app.editor;
    let on_screen = Some(editor.document()).filter(|d| d.is_modified());
    editor.left().iter().chain(on_screen).map(Kept::of).collect()
}

impl Witness {
    pub fn look(&mut self, app: &App) {
        let now = unsaved(app);
        if app.is_kept() {
            self.moments.clear();
        }
        let same = |m: &Moment| m.len() == now.len() && m.iter().zip(&now).all(|(a, b)| a.same(b));
        if !self.moments.last().is_some_and(same) {
            self.moments.push(now);
        }
    }

    /// Checks that a window started after a kill has all documents of one of the moments. The error names those missing of the first.
    pub fn compare(&self, app: &App) -> Result<(), String> {
        let editor = &app.editor;
        let back = |kept: &Kept| editor.left().iter().chain([editor.document()]).any(|d| kept.is(d));
        if self.moments.is_empty() || self.moments.iter().any(|m| m.iter().all(back)) {
            return Ok(());
        }
        let missing: Vec<&str> = self.moments[0].iter().filter(|k| !back(k)).map(|k| k.name.as_str()).collect();
        let there: Vec<String> = editor.left().iter().chain([editor.document()]).map(Document::title).collect();
        Err(format!("{missing:?} were lost, {} moments after they were kept; there are {there:?}", self.moments.len()))
    }
}

pub fn files_are_whole(folder: &Path, app: &App) {
    for name in FILES {
        Document::read(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
    }
    let document = app.editor.document();
    if let Some(path) = document.path().filter(|_| !document.is_modified()) {
        let on_disk = Document::read(path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((on_disk.scene(), on_disk.radar()), (document.scene(), document.radar()), "{}", path.display());
    }
}
