//! Sparse Bayesian learning.

use super::method::{CoherentMethod, TOLD_TO_COHERENT};
use super::model::Update;
use crate::reconstruct::reconstructor::MethodInfo;

/// Each direction's gain has a normal distribution with its own variance. The powers are the variances of maximum likelihood; most are zero.
///
/// M. E. Tipping, "Sparse Bayesian learning and the relevance vector machine", J. Mach. Learn. Res. 1, 2001, with MacKay's fixed-point
/// update; for directions of arrival P. Gerstoft, C. F. Mecklenbraeuker, A. Xenaki and S. Nannuru, "Multisnapshot sparse Bayesian
/// learning for DOA", IEEE Signal Process. Lett. 23, 2016.
pub const SBL: CoherentMethod = CoherentMethod {
    about: MethodInfo {
        name: "sbl",
        description: "the fewest directions that explain what both ends heard as one aperture, and the exact map of them",
        prior_knowledge: TOLD_TO_COHERENT,
        eta: 0.782, // by examples/choose_eta.rs
    },
    update: Update {
        // MacKay's update: the squared mean of the posterior gain over its degrees of freedom.
        next: |v| v.power * v.matched / v.norm,
        max_iterations: 16,
        min_noise: 3e-3,
    },
    min_peak_part: 0.05,
};
