//! The transforms of Winograd's minimal filtering F(4, 3) (Lavin and Gray 2016): four neighbouring outputs of a filter with three taps cost
//! six products.

use crate::network::kernels::vector::{LANES, Loop, Vector};

pub(super) const OUTPUTS: usize = 4;
/// Products for these outputs, and as many inputs.
pub(super) const PRODUCTS: usize = 6;

/// The kernel's transform: a row for each product, a column for each tap.
pub(super) const OF_TAPS: [[f32; 3]; PRODUCTS] = [
    [1.0 / 4.0, 0.0, 0.0],
    [-1.0 / 6.0, -1.0 / 6.0, -1.0 / 6.0],
    [-1.0 / 6.0, 1.0 / 6.0, -1.0 / 6.0],
    [1.0 / 24.0, 1.0 / 12.0, 1.0 / 6.0],
    [1.0 / 24.0, -1.0 / 12.0, 1.0 / 6.0],
    [0.0, 0.0, 1.0],
];

/// The product that enters each output with factor 1, so that a bias added there reaches all four.
pub(super) const OF_BIAS: usize = 1;

/// Groups of contiguous vectors, as many in the source as in the destination.
#[derive(Debug, Clone, Copy)]
pub(super) struct Groups {
    pub many: usize,
    pub vectors: usize,
    /// Distance from one group to the next in the source, and in the destination.
    pub steps: [usize; 2],
}

impl Groups {
    /// Values that source and destination must hold.
    fn reach(&self) -> [usize; 2] {
        self.steps.map(|step| if self.many == 0 { 0 } else { (self.many - 1) * step + self.vectors * LANES })
    }

    #[inline(always)]
    fn each(&self, mut of: impl FnMut([usize; 2])) {
        for group in 0..self.many {
            for at in 0..self.vectors {
                of(self.steps.map(|step| group * step + at * LANES));
            }
        }
    }
}

/// The input's transform, from six neighbouring inputs to the factors of the six products.
pub(super) struct Spread<'a> {
    pub groups: Groups,
    pub from: [&'a [f32]; PRODUCTS],
    pub to: [&'a mut [f32]; PRODUCTS],
}

impl Loop for Spread<'_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        let Spread { groups, from, mut to } = self;
        let [read, written] = groups.reach();
        assert!(
            from.iter().all(|from| from.len() >= read) && to.iter().all(|to| to.len() >= written),
            "lines end early"
        );
        let [from0, from1, from2, from3, from4, from5] = from.map(|from| from.as_ptr());
        let [to0, to1, to2, to3, to4, to5] = to.each_mut().map(|to| to.as_mut_ptr());
        groups.each(|[read, write]| {
            // SAFETY: all offsets lie within the checked slices, and the caller promises the features.
            unsafe {
                let d = |from: *const f32| V::load(from.add(read));
                let (d1, d2, d3, d4) = (d(from1), d(from2), d(from3), d(from4));
                let (even, odd) = (d4.add_product(-4.0, d2), d3.add_product(-4.0, d1));
                let (far, near) = (d4.minus(d2), d3.minus(d1));
                d4.add_product(-5.0, d2).add_product(4.0, d(from0)).store(to0.add(write));
                even.plus(odd).store(to1.add(write));
                even.minus(odd).store(to2.add(write));
                far.add_product(2.0, near).store(to3.add(write));
                far.add_product(-2.0, near).store(to4.add(write));
                d(from5).add_product(-5.0, d3).add_product(4.0, d1).store(to5.add(write));
            }
        });
    }
}

/// The output's transform, from six products to four outputs that lie `apart` values from each other.
pub(super) struct Gather<'a> {
    pub groups: Groups,
    pub from: [&'a [f32]; PRODUCTS],
    pub apart: usize,
    pub to: &'a mut [f32],
}

impl Loop for Gather<'_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        let Gather { groups, from, apart, to } = self;
        let [read, written] = groups.reach();
        assert!(from.iter().all(|from| from.len() >= read), "products end early");
        assert!(to.len() >= written + (OUTPUTS - 1) * apart, "the output is too short");
        let [from0, from1, from2, from3, from4, from5] = from.map(|from| from.as_ptr());
        let to = to.as_mut_ptr();
        groups.each(|[read, write]| {
            // SAFETY: all offsets lie within the checked slices, and the caller promises the features.
            unsafe {
                let m = |from: *const f32| V::load(from.add(read));
                let (m1, m2, m3, m4) = (m(from1), m(from2), m(from3), m(from4));
                let (sum, gap) = (m1.plus(m2), m1.minus(m2));
                let (wide_sum, wide_gap) = (m3.plus(m4), m3.minus(m4));
                m(from0).plus(sum).plus(wide_sum).store(to.add(write));
                gap.add_product(2.0, wide_gap).store(to.add(write + apart));
                sum.add_product(4.0, wide_sum).store(to.add(write + 2 * apart));
                gap.plus(m(from5)).add_product(8.0, wide_gap).store(to.add(write + 3 * apart));
            }
        });
    }
}
