//! Half-precision floats (IEEE 754 binary16) as bits.

const MAX_HALF: f32 = 65504.0;

/// The half nearest to `value`, ties to even; what is larger than any becomes the largest.
pub fn half_bits(value: f32) -> u16 {
    let value = if value.is_nan() { return 0x7e00 } else { value.clamp(-MAX_HALF, MAX_HALF) };
    let sign = ((value.to_bits() >> 16) & 0x8000) as u16;
    let magnitude = value.abs();
    // Below 2^-14 halves stand 2^-24 apart; above, a half keeps 10 bits behind the point.
    let bits = if magnitude < 6.103_515_6e-5 {
        (magnitude * 16_777_216.0).round_ties_even() as u32
    } else {
        let bits = magnitude.to_bits();
        let dropped = bits & 0x1fff;
        let kept = (bits >> 13) - (112 << 10);
        kept + u32::from(dropped > 0x1000 || (dropped == 0x1000 && kept & 1 == 1))
    };
    sign | bits as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number that a finite half stands for.
    fn value(bits: u16) -> f32 {
        let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
        let magnitude = match exponent {
            0 => fraction * (-24f32).exp2(),
            _ => (1024.0 + fraction) * ((exponent - 25) as f32).exp2(),
        };
        if bits >> 15 == 1 { -magnitude } else { magnitude }
    }

    #[test]
    fn every_half_is_itself() {
        for bits in (0..=u16::MAX).filter(|bits| bits >> 10 & 31 != 31) {
            assert_eq!(half_bits(value(bits)), bits);
        }
    }

    #[test]
    fn numbers_between_go_to_the_nearest() {
        for bits in (0..0x7bffu16).step_by(7) {
            let (low, high) = (value(bits), value(bits + 1));
            let middle = 0.5 * (low + high);
            assert_eq!(half_bits(0.75 * low + 0.25 * high), bits);
            assert_eq!(half_bits(0.25 * low + 0.75 * high), bits + 1);
            assert_eq!(half_bits(middle) & 1, 0, "ties go to the even one");
        }
    }

    #[test]
    fn what_is_too_large_is_the_largest() {
        assert_eq!([1e9, f32::INFINITY, -1e9].map(half_bits), [0x7bff, 0x7bff, 0xfbff]);
        assert_eq!(half_bits(f32::NAN), 0x7e00);
    }
}
