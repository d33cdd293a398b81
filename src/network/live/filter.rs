//! The transforms of Winograd's minimal filtering F(4, 3) (Lavin and Gray 2016): four neighbouring outputs of three taps from six products.

use crate::network::kernels::vector::{Loop, VECTOR_LANES, Vector};

/// Neighbouring outputs that are computed together.
pub(super) const OUTPUTS: usize = 4;
/// Products for these outputs, and inputs of them.
pub(super) const PRODUCTS: usize = 6;

/// The kernel's transform: a row for each product, a column for each tap.
pub(super) const TAP_TRANSFORM: [[f32; 3]; PRODUCTS] = [
    [1.0 / 4.0, 0.0, 0.0],
    [-1.0 / 6.0, -1.0 / 6.0, -1.0 / 6.0],
    [-1.0 / 6.0, 1.0 / 6.0, -1.0 / 6.0],
    [1.0 / 24.0, 1.0 / 12.0, 1.0 / 6.0],
    [1.0 / 24.0, -1.0 / 12.0, 1.0 / 6.0],
    [0.0, 0.0, 1.0],
];

/// Index of the product that all four outputs have with factor 1: the bias is added to it.
pub(super) const BIAS_PRODUCT: usize = 1;

/// Groups of contiguous vectors in a source and in a destination.
#[derive(Debug, Clone, Copy)]
pub(super) struct Groups {
    pub count: usize,
    pub vectors: usize,
    /// Distance from one group to the next in the source and in the destination, values.
    pub steps: [usize; 2],
}

impl Groups {
    /// Least lengths of source and destination, values.
    fn lengths(&self) -> [usize; 2] {
        self.steps.map(|step| if self.count == 0 { 0 } else { (self.count - 1) * step + self.vectors * VECTOR_LANES })
    }

    /// Calls `of` with the offsets of each vector in source and destination.
    #[inline(always)]
    fn each(&self, mut of: impl FnMut([usize; 2])) {
        for group in 0..self.count {
            for at in 0..self.vectors {
                of(self.steps.map(|step| group * step + at * VECTOR_LANES));
            }
        }
    }
}

/// The transform from six neighbouring inputs to the factors of the six products.
pub(super) struct InputTransform<'a> {
    pub groups: Groups,
    pub from: [&'a [f32]; PRODUCTS],
    pub to: [&'a mut [f32]; PRODUCTS],
}

impl Loop for InputTransform<'_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        let InputTransform { groups, from, mut to } = self;
        let [read, written] = groups.lengths();
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

/// The transform from six products to four outputs, `output_step` values from each other.
pub(super) struct OutputTransform<'a> {
    pub groups: Groups,
    pub from: [&'a [f32]; PRODUCTS],
    pub output_step: usize,
    pub to: &'a mut [f32],
}

impl Loop for OutputTransform<'_> {
    #[inline(always)]
    unsafe fn run<V: Vector>(self) {
        let OutputTransform { groups, from, output_step, to } = self;
        let [read, written] = groups.lengths();
        assert!(from.iter().all(|from| from.len() >= read), "products end early");
        assert!(to.len() >= written + (OUTPUTS - 1) * output_step, "the output is too short");
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
                gap.add_product(2.0, wide_gap).store(to.add(write + output_step));
                sum.add_product(4.0, wide_sum).store(to.add(write + 2 * output_step));
                gap.plus(m(from5)).add_product(8.0, wide_gap).store(to.add(write + 3 * output_step));
            }
        });
    }
}
