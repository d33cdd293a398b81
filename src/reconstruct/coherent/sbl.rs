//! Sparse Bayesian learning.

use super::method::{CoherentMethod, TOLD_TO_COHERENT};
use super::model::Update;
use crate::reconstruct::reconstructor::About;

/// Every direction's gain is drawn from a normal distribution of its own variance; the variances under which what was heard is
/// likeliest, most of which turn out zero.
///
/// M. E. Tipping, "Sparse Bayesian learning and the relevance vector machine", J. Mach. Learn. Res. 1, 2001, with MacKay's fixed-point
/// update; for directions of arrival P. Gerstoft, C. F. Mecklenbraeuker, A. Xenaki and S. Nannuru, "Multisnapshot sparse Bayesian
/// learning for DOA", IEEE Signal Process. Lett. 23, 2016.
pub const SBL: CoherentMethod = CoherentMethod {
    about: About {
        name: "sbl",
        description: "the fewest directions that explain what both ends heard as one aperture, and the exact map of them",
        told: TOLD_TO_COHERENT,
        eta: 0.782, // by examples/choose_eta.rs
    },
    update: Update {
        // The variance that makes the posterior gain's square, over how well it is determined, agree with itself.
        next: |share| share.power * share.matched / share.held,
        iterations: 16,
        least_noise: 3e-3,
    },
    least_part: 0.05,
};
