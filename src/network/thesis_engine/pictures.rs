//! Channels-last pictures with a margin that repeats the opposite edge. A kernel at an edge reads the margin, and needs no bounds check.

use rayon::prelude::*;
use std::ops::Range;

/// Cells of a [`Parted`] picture's margin, in each of its parts: the reach of the larger kernel, of five by five cells, beside its middle.
const MARGIN: usize = 2;

/// A picture that continues circularly beyond all four edges. In a line all even cells lie side by side, and after them all odd ones. A kernel
/// of dilation 2 on an even cell reads even cells alone, and one on an odd cell odd cells; likewise for rows. So the dilated convolution is an
/// ordinary one of each of four parts, and a 2x2 max-pool takes the largest of the four outputs at the same place of the parts.
/// `[h + 4 MARGIN, 2, w / 2 + 2 MARGIN, c]`; height and width must be even.
#[derive(Debug, Default)]
pub(super) struct Parted {
    pub(super) h: usize,
    pub(super) w: usize,
    pub(super) c: usize,
    data: Vec<f32>,
}

impl Parted {
    pub(super) fn reset(&mut self, h: usize, w: usize, c: usize) {
        (self.h, self.w, self.c) = (h, w, c);
        self.data.resize((h + 2 * Self::MARGIN_ROWS) * self.line(), 0.0);
    }

    /// Rows above and below the picture: half of them belong to each part.
    const MARGIN_ROWS: usize = 2 * MARGIN;

    fn part(&self) -> usize {
        self.w / 2 + 2 * MARGIN
    }

    fn line(&self) -> usize {
        2 * self.part() * self.c
    }

    pub(super) fn row_cells(&self) -> usize {
        4 * self.part()
    }

    /// The input of a kernel of `size` by `size` cells, from the row `y` of the picture and the first cell of the part `odd` on.
    pub(super) fn seen(&self, y: usize, odd: usize, size: usize) -> &[f32] {
        let before = size / 2;
        let row = y + Self::MARGIN_ROWS - 2 * before;
        &self.data[row * self.line() + (odd * self.part() + MARGIN - before) * self.c..]
    }

    /// Fills the picture and its margin: `write` gets the number of each row and a [`PictureLine`] to put it into, and a buffer of its thread.
    pub(super) fn fill(&mut self, write: impl Fn(usize, &mut PictureLine<'_>, &mut Vec<f32>) + Sync) {
        let (size, part, c) = (self.line(), self.part(), self.c);
        let inside = Self::MARGIN_ROWS * size..(Self::MARGIN_ROWS + self.h) * size;
        self.data[inside].par_chunks_mut(size).enumerate().for_each_init(Vec::new, |buffer, (y, cells)| {
            let mut line = PictureLine { cells, part, c };
            write(y, &mut line, buffer);
            line.close();
        });
        for row in (0..Self::MARGIN_ROWS).chain(Self::MARGIN_ROWS + self.h..2 * Self::MARGIN_ROWS + self.h) {
            // A picture with fewer rows than its margin is repeated.
            let from = Self::MARGIN_ROWS + beyond(row, Self::MARGIN_ROWS, self.h);
            self.data.copy_within(from * size..(from + 1) * size, row * size);
        }
    }
}

/// The place within `0..size` to which place `at`, counted from `margin` before the first, wraps around.
fn beyond(at: usize, margin: usize, size: usize) -> usize {
    (at + margin * (size - 1)) % size
}

pub(super) struct PictureLine<'a> {
    cells: &'a mut [f32],
    part: usize,
    c: usize,
}

impl PictureLine<'_> {
    pub(super) fn cell(&mut self, x: usize) -> &mut [f32] {
        &mut self.cells[(x % 2 * self.part + MARGIN + x / 2) * self.c..][..self.c]
    }

    fn close(&mut self) {
        let (c, inside) = (self.c, self.part - 2 * MARGIN);
        for cells in self.cells.chunks_exact_mut(self.part * c) {
            for at in (0..MARGIN).chain(MARGIN + inside..self.part) {
                let from = MARGIN + beyond(at, MARGIN, inside);
                cells.copy_within(from * c..(from + 1) * c, at * c);
            }
        }
    }
}

/// A picture with one cell of zeros around it, `[h + 2, w + 2, c]`.
#[derive(Debug, Default)]
pub(super) struct Bordered {
    pub(super) h: usize,
    pub(super) w: usize,
    pub(super) c: usize,
    data: Vec<f32>,
}

impl Bordered {
    /// Resizes the picture to `h` rows, `w` cells a row and `c` channels, with a border of zeros; the cells are left to be overwritten.
    pub(super) fn reset(&mut self, h: usize, w: usize, c: usize) {
        if (self.h, self.w, self.c) != (h, w, c) {
            (self.h, self.w, self.c) = (h, w, c);
            self.data.clear();
            self.data.resize((h + 2) * self.line(), 0.0);
        }
    }

    fn line(&self) -> usize {
        (self.w + 2) * self.c
    }

    pub(super) fn row_cells(&self) -> usize {
        self.w + 2
    }

    pub(super) fn seen(&self, y: usize, x: usize) -> &[f32] {
        &self.data[y * self.line() + x * self.c..]
    }

    pub(super) fn row(&self, y: usize) -> &[f32] {
        &self.seen(y + 1, 1)[..self.w * self.c]
    }

    pub(super) fn fill(&mut self, write: impl Fn(usize, &mut [f32], &mut Vec<f32>) + Sync) {
        let (size, c) = (self.line(), self.c);
        let inside: Range<usize> = size..(1 + self.h) * size;
        self.data[inside].par_chunks_mut(size).enumerate().for_each_init(Vec::new, |buffer, (y, line)| {
            let cells = c..line.len() - c;
            write(y, &mut line[cells], buffer);
        });
    }
}
