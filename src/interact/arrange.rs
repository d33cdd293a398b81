//! Several objects in a row: aligned, or the same distance from each other.

use super::grip::extent;
use super::{Editor, Place};
use crate::scene::{Object, Scene};

/// What objects are aligned by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alignment {
    /// Their left ends.
    Left,
    /// Their right ends.
    Right,
    /// Their middles, along the array: one behind the other.
    Centre,
    /// Their ends that are nearest to the array's axis.
    Near,
    /// Their far ends.
    Far,
    /// Their middles, ahead of the array: one beside the other.
    Middle,
}

/// Which way objects are distributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// Along the array.
    X,
    /// Ahead of it.
    Y,
}

impl Alignment {
    /// All of them.
    pub const ALL: [Alignment; 6] =
        [Alignment::Left, Alignment::Centre, Alignment::Right, Alignment::Near, Alignment::Middle, Alignment::Far];

    fn along(self) -> Along {
        match self {
            Alignment::Left | Alignment::Centre | Alignment::Right => Along::X,
            Alignment::Near | Alignment::Middle | Alignment::Far => Along::Y,
        }
    }

    fn of(self, low: f64, high: f64) -> f64 {
        match self {
            Alignment::Left | Alignment::Near => low,
            Alignment::Right | Alignment::Far => high,
            Alignment::Centre | Alignment::Middle => (low + high) / 2.0,
        }
    }
}

impl Along {
    /// Both.
    pub const BOTH: [Along; 2] = [Along::X, Along::Y];

    fn of(self, place: Place) -> f64 {
        match self {
            Along::X => place.x_metres,
            Along::Y => place.y_metres,
        }
    }

    fn translate(self, object: &mut Object, by: f64) {
        match self {
            Along::X => object.translate(by, 0.0),
            Along::Y => object.translate(0.0, by),
        }
    }

    fn ends(self, object: &Object) -> [f64; 2] {
        let (low, high) = extent(object);
        [self.of(low), self.of(high)]
    }

    fn middle(self, object: &Object) -> f64 {
        let [low, high] = self.ends(object);
        (low + high) / 2.0
    }
}

fn align(scene: &mut Scene, indices: &[usize], alignment: Alignment) {
    let along = alignment.along();
    let ends = indices.iter().map(|i| along.ends(&scene.objects[*i]));
    let [low, high] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| [a.min(c), b.max(d)]);
    for &i in indices {
        let object = &mut scene.objects[i];
        let [own_low, own_high] = along.ends(object);
        along.translate(object, alignment.of(low, high) - alignment.of(own_low, own_high));
    }
}

fn distribute(scene: &mut Scene, indices: &[usize], along: Along) {
    let mut order = indices.to_vec();
    order.sort_by(|a, b| along.middle(&scene.objects[*a]).total_cmp(&along.middle(&scene.objects[*b])));
    let [Some(first), Some(last)] = [order.first(), order.last()].map(|i| i.map(|i| along.middle(&scene.objects[*i])))
    else {
        return;
    };
    let step = (last - first) / order.len().saturating_sub(1).max(1) as f64;
    for (rank, &i) in order.iter().enumerate() {
        let object = &mut scene.objects[i];
        let by = first + rank as f64 * step - along.middle(object);
        along.translate(object, by);
    }
}

impl Editor {
    /// Aligns the selected objects, as one step.
    pub fn align(&mut self, alignment: Alignment) {
        let indices: Vec<usize> = self.selection().iter().collect();
        self.edit("align", None, |scene, _| align(scene, &indices, alignment));
    }

    /// Puts the middles of the selected objects the same distance apart, between those that are outermost, as one step.
    pub fn distribute(&mut self, along: Along) {
        let indices: Vec<usize> = self.selection().iter().collect();
        self.edit("distribute", None, |scene, _| distribute(scene, &indices, along));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::SelectionMode;
    use crate::scene::{GaussianCluster, Line, Point};

    /// A point, a line and a cluster, and a point that isn't selected.
    fn editor() -> Editor {
        let objects = vec![
            Object::Point(Point::new(0.0, 10.0)),
            Object::Line(Line { direction_degrees: 0.0, ..Line::vertical(4.0, 6.0, 1.0, 3) }),
            Object::Gaussian(GaussianCluster { seed: 3, ..GaussianCluster::new([-5.0, 20.0], [1.0, 2.0], 5) }),
            Object::Point(Point::new(9.0, 9.0)),
        ];
        let mut editor = Editor::new(Scene { objects, ..Scene::default() });
        editor.select([0, 1, 2], SelectionMode::Replace);
        editor
    }

    fn centres(editor: &Editor) -> Vec<[f64; 2]> {
        editor.scene().objects.iter().map(Object::centre_metres).collect()
    }

    #[test]
    fn an_alignment_is_one_undo_step() {
        let before = centres(&editor());
        for (alignment, x, y) in [
            (Alignment::Left, Some([-6.0, -5.0, -5.0]), None),
            (Alignment::Right, Some([6.0, 5.0, 5.0]), None),
            (Alignment::Centre, Some([0.0, 0.0, 0.0]), None),
            (Alignment::Near, None, Some([6.0, 6.0, 8.0])),
            (Alignment::Far, None, Some([22.0, 22.0, 20.0])),
            (Alignment::Middle, None, Some([14.0, 14.0, 14.0])),
        ] {
            let mut e = editor();
            e.align(alignment);
            for (i, [got_x, got_y]) in centres(&e).into_iter().enumerate() {
                let wanted = |to: Option<[f64; 3]>, old: f64| to.and_then(|t| t.get(i).copied()).unwrap_or(old);
                let (wanted_x, wanted_y) = (wanted(x, before[i][0]), wanted(y, before[i][1]));
                let off = (got_x - wanted_x).hypot(got_y - wanted_y);
                assert!(off < 1e-12, "{alignment:?}: {i} at {got_x}, {got_y}");
            }
            assert!(e.undo() && !e.undo() && centres(&e) == before);
        }
    }

    #[test]
    fn middles_are_distributed_evenly_between_the_outermost() {
        let mut e = editor();
        e.distribute(Along::X);
        assert_eq!(centres(&e)[..3], [[0.0, 10.0], [5.0, 6.0], [-5.0, 20.0]]);
        e.distribute(Along::Y);
        assert_eq!(centres(&e)[..3], [[0.0, 13.0], [5.0, 6.0], [-5.0, 20.0]]);
        assert_eq!((centres(&e)[3], e.history().depth()), ([9.0, 9.0], 1), "along x they were even already");
        e.select([], SelectionMode::Replace);
        e.distribute(Along::X);
        e.align(Alignment::Left);
        assert_eq!(e.history().depth(), 1, "nothing selected, nothing moved");
    }
}
