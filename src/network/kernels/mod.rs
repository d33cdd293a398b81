//! Convolutions without a framework, for processors with AVX-512, with AVX2 and without either: what the live network's engine and the
//! thesis network's are made of.

pub mod convolution;
pub(super) mod vector;
