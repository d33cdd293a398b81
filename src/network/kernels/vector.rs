//! Vectors of sixteen `f32`, for processors with AVX-512, with AVX2 and without either.

use crate::signal::simd::Simd;

/// Numbers in a vector. The channels of every tensor are padded to a multiple of it.
pub const VECTOR_LANES: usize = 16;

/// Sixteen numbers in registers. Every method must be inlined into a function that has the vector's CPU features.
pub trait Vector: Copy {
    /// Cells and vectors of a tile: its sums fit into the registers together with the weights and one value.
    const TILE: [usize; 2];
    /// # Safety
    /// `from` must hold 16 values, and the CPU must have the features.
    unsafe fn load(from: *const f32) -> Self;
    /// # Safety
    /// `to` must have room for 16 values, and the CPU must have the features.
    unsafe fn store(self, to: *mut f32);
    /// `self + value * weight`.
    /// # Safety
    /// The CPU must have the features.
    unsafe fn add_product(self, value: f32, weight: Self) -> Self;
    /// # Safety
    /// The CPU must have the features.
    unsafe fn plus(self, other: Self) -> Self;
    /// # Safety
    /// The CPU must have the features.
    unsafe fn minus(self, other: Self) -> Self;
    /// The larger of each pair of numbers; that of `other` where one is NaN.
    /// # Safety
    /// The CPU must have the features.
    #[cfg(feature = "network")]
    unsafe fn larger(self, other: Self) -> Self;
}

/// A loop over vectors, compiled for each instruction set.
pub trait Loop {
    /// Runs the loop. Must be inlined.
    /// # Safety
    /// The CPU must have the features.
    unsafe fn run<V: Vector>(self);
}

/// Runs `of` with the instructions `simd`, or the best available ones if this machine lacks them.
#[inline]
#[cfg_attr(not(target_arch = "x86_64"), expect(unused_variables, reason = "there is no choice of instructions"))]
pub fn run<L: Loop>(simd: Simd, of: L) {
    #[cfg(target_arch = "x86_64")]
    match simd.min(Simd::best()) {
        // SAFETY: `Simd::best` has found the features on this machine.
        Simd::Avx512 => return unsafe { x86::run_avx512(of) },
        // SAFETY: as above.
        Simd::Avx2 => return unsafe { x86::run_avx2(of) },
        Simd::Portable => {}
    }
    // SAFETY: needs no feature.
    unsafe { of.run::<Portable>() };
}

/// Vectors without special instructions, and without fused multiplication and addition.
#[derive(Clone, Copy)]
pub struct Portable([f32; VECTOR_LANES]);

impl Vector for Portable {
    const TILE: [usize; 2] = [2, 1];
    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the caller's promise.
        Portable(unsafe { from.cast::<[f32; VECTOR_LANES]>().read() })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the caller's promise.
        unsafe { to.cast::<[f32; VECTOR_LANES]>().write(self.0) }
    }
    #[inline(always)]
    unsafe fn add_product(self, value: f32, weight: Self) -> Self {
        Portable(std::array::from_fn(|l| self.0[l] + value * weight.0[l]))
    }
    #[inline(always)]
    unsafe fn plus(self, other: Self) -> Self {
        Portable(std::array::from_fn(|l| self.0[l] + other.0[l]))
    }
    #[inline(always)]
    unsafe fn minus(self, other: Self) -> Self {
        Portable(std::array::from_fn(|l| self.0[l] - other.0[l]))
    }
    #[inline(always)]
    #[cfg(feature = "network")]
    unsafe fn larger(self, other: Self) -> Self {
        Portable(std::array::from_fn(|l| if self.0[l] > other.0[l] { self.0[l] } else { other.0[l] }))
    }
}

#[cfg(target_arch = "x86_64")]
pub mod x86 {
    use super::{Loop, Vector};
    use std::arch::x86_64::*;

    #[derive(Clone, Copy)]
    pub struct Avx512(__m512);

    impl Vector for Avx512 {
        const TILE: [usize; 2] = [8, 2];
        #[inline(always)]
        unsafe fn load(from: *const f32) -> Self {
            // SAFETY: the caller's promise, here and below.
            Avx512(unsafe { _mm512_loadu_ps(from) })
        }
        #[inline(always)]
        unsafe fn store(self, to: *mut f32) {
            unsafe { _mm512_storeu_ps(to, self.0) }
        }
        #[inline(always)]
        unsafe fn add_product(self, value: f32, weight: Self) -> Self {
            Avx512(unsafe { _mm512_fmadd_ps(_mm512_set1_ps(value), weight.0, self.0) })
        }
        #[inline(always)]
        unsafe fn plus(self, other: Self) -> Self {
            Avx512(unsafe { _mm512_add_ps(self.0, other.0) })
        }
        #[inline(always)]
        unsafe fn minus(self, other: Self) -> Self {
            Avx512(unsafe { _mm512_sub_ps(self.0, other.0) })
        }
        #[inline(always)]
        #[cfg(feature = "network")]
        unsafe fn larger(self, other: Self) -> Self {
            Avx512(unsafe { _mm512_max_ps(self.0, other.0) })
        }
    }

    #[derive(Clone, Copy)]
    pub struct Avx2(__m256, __m256);

    impl Vector for Avx2 {
        const TILE: [usize; 2] = [6, 1];
        #[inline(always)]
        unsafe fn load(from: *const f32) -> Self {
            unsafe { Avx2(_mm256_loadu_ps(from), _mm256_loadu_ps(from.add(8))) }
        }
        #[inline(always)]
        unsafe fn store(self, to: *mut f32) {
            unsafe {
                _mm256_storeu_ps(to, self.0);
                _mm256_storeu_ps(to.add(8), self.1);
            }
        }
        #[inline(always)]
        unsafe fn add_product(self, value: f32, weight: Self) -> Self {
            unsafe {
                let value = _mm256_set1_ps(value);
                Avx2(_mm256_fmadd_ps(value, weight.0, self.0), _mm256_fmadd_ps(value, weight.1, self.1))
            }
        }
        #[inline(always)]
        unsafe fn plus(self, other: Self) -> Self {
            unsafe { Avx2(_mm256_add_ps(self.0, other.0), _mm256_add_ps(self.1, other.1)) }
        }
        #[inline(always)]
        unsafe fn minus(self, other: Self) -> Self {
            unsafe { Avx2(_mm256_sub_ps(self.0, other.0), _mm256_sub_ps(self.1, other.1)) }
        }
        #[inline(always)]
        #[cfg(feature = "network")]
        unsafe fn larger(self, other: Self) -> Self {
            unsafe { Avx2(_mm256_max_ps(self.0, other.0), _mm256_max_ps(self.1, other.1)) }
        }
    }

    /// # Safety
    /// The CPU must have the features.
    #[target_feature(enable = "avx512f")]
    pub unsafe fn run_avx512(of: impl Loop) {
        // SAFETY: the caller's promise.
        unsafe { of.run::<Avx512>() };
    }

    /// # Safety
    /// The CPU must have the features.
    #[target_feature(enable = "avx2,fma")]
    pub unsafe fn run_avx2(of: impl Loop) {
        // SAFETY: the caller's promise.
        unsafe { of.run::<Avx2>() };
    }
}
