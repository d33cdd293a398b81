//! Convolutions without a framework, for processors with AVX-512, with AVX2 and without either: the kernels of the live network's engine and of
//! the thesis network's.

pub mod convolution;
pub(super) mod vector;
