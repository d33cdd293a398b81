//! The instruction set of kernels: the best of the processor, or that of [`SIMD_VARIABLE`].

use rustfft::{Fft, FftNum, FftPlanner, FftPlannerScalar};
use std::fmt;
use std::str::FromStr;
use std::sync::{Arc, OnceLock};

/// The environment variable with the name of an instruction set: `portable`, `avx2` or `avx512`.
///
/// It holds for the kernels of this crate: simulation, transforms of maps, the live network. `faer`, `burn` and the fit's short transforms of
/// `rustfft` use the instructions of the processor.
pub const SIMD_VARIABLE: &str = "APERTURA_SIMD";

/// An instruction set that kernels are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Simd {
    /// The instructions of every machine of the target; no fused multiply-add.
    Portable,
    Avx2,
    /// AVX-512 F, DQ, BW and VL.
    Avx512,
}

/// A reason for which the instruction set that [`SIMD_VARIABLE`] names can't be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SimdError {
    #[error("{SIMD_VARIABLE} is \"{0}\"; expected portable, avx2 or avx512")]
    Unknown(String),
    #[error("{SIMD_VARIABLE} asks for {asked}, which this processor lacks; it has {}", names(has))]
    Missing { asked: Simd, has: Vec<Simd> },
}

fn names(sets: &[Simd]) -> String {
    sets.iter().map(|set| set.name()).collect::<Vec<_>>().join(", ")
}

impl fmt::Display for Simd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Simd {
    type Err = SimdError;

    fn from_str(s: &str) -> Result<Self, SimdError> {
        Simd::ALL.into_iter().find(|set| set.name() == s).ok_or_else(|| SimdError::Unknown(s.to_owned()))
    }
}

impl Simd {
    /// Every set, slowest first, whether this processor has it or not.
    pub const ALL: [Simd; 3] = [Simd::Portable, Simd::Avx2, Simd::Avx512];

    /// Name in reports and in [`SIMD_VARIABLE`].
    pub fn name(self) -> &'static str {
        match self {
            Simd::Portable => "portable",
            Simd::Avx2 => "avx2",
            Simd::Avx512 => "avx512",
        }
    }

    /// The set to compute with: the one that [`SIMD_VARIABLE`] names, else the best that this processor has. Looked up once.
    ///
    /// An unusable set is ignored, with a warning in the log; programs refuse to start with it ([`Simd::requested`]).
    pub fn chosen() -> Simd {
        static CHOSEN: OnceLock<Simd> = OnceLock::new();
        *CHOSEN.get_or_init(|| match Simd::requested() {
            Ok(requested) => requested.unwrap_or_else(Simd::best),
            Err(error) => {
                tracing::warn!("{error}; using {}", Simd::best());
                Simd::best()
            }
        })
    }

    /// The set that [`SIMD_VARIABLE`] names; `None` where it is not set or empty.
    /// # Errors
    /// [`SimdError`] when it names no set, or one that this processor lacks.
    pub fn requested() -> Result<Option<Simd>, SimdError> {
        match std::env::var_os(SIMD_VARIABLE) {
            Some(name) if !name.is_empty() => Simd::on_this_processor(&name.to_string_lossy()).map(Some),
            _ => Ok(None),
        }
    }

    fn on_this_processor(name: &str) -> Result<Simd, SimdError> {
        let (asked, has) = (name.parse()?, Simd::available());
        if has.contains(&asked) { Ok(asked) } else { Err(SimdError::Missing { asked, has }) }
    }

    /// The best that this processor has; [`Simd::chosen`] may choose less.
    pub fn best() -> Simd {
        static BEST: OnceLock<Simd> = OnceLock::new();
        *BEST.get_or_init(|| Simd::available().pop().unwrap_or(Simd::Portable))
    }

    /// All that this processor has, slowest first.
    pub fn available() -> Vec<Simd> {
        #[allow(unused_mut)] // only x86-64 has more
        let mut found = vec![Simd::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                found.push(Simd::Avx2);
                if is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512vl")
                {
                    found.push(Simd::Avx512);
                }
            }
        }
        found
    }

    /// Runs `kernel` with these instructions, or with the best there are if this machine lacks them.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2,fma")]
            fn avx2<K: Kernel>(kernel: K) -> K::Output {
                kernel.run::<true>()
            }
            #[target_feature(enable = "avx512f,avx512dq,avx512bw,avx512vl,avx2,fma")]
            fn avx512<K: Kernel>(kernel: K) -> K::Output {
                kernel.run::<true>()
            }
            match self.min(Simd::best()) {
                Simd::Portable => {}
                // SAFETY: `Simd::best` has found these features on this machine.
                Simd::Avx2 => return unsafe { avx2(kernel) },
                // SAFETY: as above.
                Simd::Avx512 => return unsafe { avx512(kernel) },
            }
        }
        kernel.run::<false>()
    }

    /// A forward transform of `len` points by rustfft with these instructions alone (rustfft has none beyond AVX2).
    pub fn forward_fft<T: FftNum>(self, len: usize) -> Arc<dyn Fft<T>> {
        // On targets whose only set is portable, rustfft may use the target's other instructions.
        if self == Simd::Portable && Simd::best() != Simd::Portable {
            FftPlannerScalar::new().plan_fft_forward(len)
        } else {
            FftPlanner::new().plan_fft_forward(len)
        }
    }
}

/// Work that is compiled for several instruction sets.
///
/// Functions that it calls must be `#[inline(always)]`, and its loops `for` loops: a closure passed to `map`, `for_each` or `array::from_fn` may be
/// compiled separately, without the instructions, where every fused multiply-add is a call.
pub trait Kernel {
    type Output;

    /// Does the work; `FMA` says whether fused multiply-add is an instruction (elsewhere it is a slow call).
    fn run<const FMA: bool>(self) -> Self::Output;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unusable_instructions_are_refused() {
        for set in Simd::ALL {
            assert_eq!(set.name().parse(), Ok(set));
            match Simd::on_this_processor(set.name()) {
                Ok(found) => assert!(found == set && Simd::available().contains(&set)),
                Err(error) => {
                    assert!(!Simd::available().contains(&set));
                    let text = error.to_string();
                    assert!(text.contains(set.name()) && text.contains("it has portable"), "{text}");
                }
            }
        }
        let error = Simd::on_this_processor("sse2").unwrap_err().to_string();
        assert_eq!(error, "APERTURA_SIMD is \"sse2\"; expected portable, avx2 or avx512");
        assert_eq!(Simd::available()[0], Simd::Portable);
    }

    #[test]
    fn transforms_agree_on_every_instruction_set() {
        use num_complex::Complex64;
        for len in [12, 60, 512] {
            let input: Vec<_> = (0..len).map(|n| Complex64::cis((n * n) as f64 * 0.37)).collect();
            let transformed = |set: Simd| {
                let mut data = input.clone();
                set.forward_fft(len).process(&mut data);
                data
            };
            let expected = transformed(Simd::Portable);
            for set in Simd::available() {
                for (a, b) in transformed(set).iter().zip(&expected) {
                    assert!((a - b).norm() < 1e-12, "{len} points, {set}: {a} for {b}");
                }
            }
        }
    }
}
