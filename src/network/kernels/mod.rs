//! Convolutions without a framework, with AVX-512, with AVX2 or without either: the kernels of the live network's and the thesis' engine.

pub mod convolution;
pub(super) mod vector;
