//! The iterative adaptive approach.

use super::method::{CoherentMethod, TOLD_TO_COHERENT};
use super::model::Update;
use crate::reconstruct::reconstructor::MethodInfo;

/// The power of every direction by weighted least squares, with weights from the powers of all other directions, iterated until they agree; over
/// the elements with samples.
///
/// T. Yardibi, J. Li, P. Stoica, M. Xue and A. B. Baggeroer, "Source localization and sensing: a nonparametric iterative adaptive
/// approach based on weighted least squares", IEEE Trans. Aerosp. Electron. Syst. 46, 2010; with elements missing, D. Vu, L. Xu,
/// M. Xue and J. Li, "Nonparametric missing sample spectral analysis and its applications to interrupted SAR", IEEE J. Sel. Top.
/// Signal Process. 6, 2012.
pub const IAA: CoherentMethod = CoherentMethod {
    about: MethodInfo {
        name: "iaa",
        description: "weighted least squares for every direction, both ends as one aperture, and the exact map of its peaks",
        prior_knowledge: TOLD_TO_COHERENT,
        eta: 0.809, // by examples/choose_eta.rs
    },
    update: Update {
        // |a^H R^-1 z / a^H R^-1 a|^2
        next: |v| v.matched / (v.norm * v.norm),
        max_iterations: 12,
        min_noise: 1e-4,
    },
    min_peak_part: 0.2,
};
