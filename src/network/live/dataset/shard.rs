//! The arrays of some examples, as NumPy files.

use super::{ArrayKind, DatasetPrecision};
use crate::network::live::examples::{EndSamples, Example};
use crate::network::live::features::LiveInput;
use crate::network::live::grid::{
    COARSE_CHANNELS, COARSE_COLUMNS, CONSTANTS, FINE_CHANNELS, FINE_COLUMNS, ROW_CHANNELS, SCALARS,
};
use crate::radar::Radar;
use half::f16;
use num_complex::Complex64;

impl ArrayKind {
    /// Name of the array's file behind the shard's number.
    pub fn name(self) -> &'static str {
        match self {
            ArrayKind::Ends => "ends",
            ArrayKind::Layout(_) => "heard",
            ArrayKind::Fine => "fine",
            ArrayKind::Coarse => "coarse",
            ArrayKind::Rows => "rows",
            ArrayKind::Scalars => "scalars",
            ArrayKind::Constants => "constants",
            ArrayKind::Target(target) => target.array(),
            ArrayKind::Gain => "gain",
        }
    }

    /// Names of the array's axes.
    pub fn axes(self) -> &'static [&'static str] {
        match self {
            ArrayKind::Ends => &["example", "end", "element", "sample"],
            ArrayKind::Layout(_) => &["example", "element", "sample"],
            ArrayKind::Fine | ArrayKind::Coarse => &["example", "channel", "range_bin", "column"],
            ArrayKind::Rows => &["example", "channel", "range_bin"],
            ArrayKind::Scalars => &["example", "scalar"],
            ArrayKind::Constants => &["example", "constant"],
            ArrayKind::Target(_) => &["example", "range_bin", "column"],
            ArrayKind::Gain => &["example"],
        }
    }

    /// The array's shape behind the number of examples.
    pub fn shape(self, radar: &Radar) -> Vec<usize> {
        match self {
            ArrayKind::Ends => vec![2, radar.end_elements, radar.samples],
            ArrayKind::Layout(elements) => vec![elements, radar.samples],
            ArrayKind::Fine => vec![FINE_CHANNELS, radar.samples, FINE_COLUMNS],
            ArrayKind::Coarse => vec![COARSE_CHANNELS, radar.samples, COARSE_COLUMNS],
            ArrayKind::Rows => vec![ROW_CHANNELS, radar.samples],
            ArrayKind::Scalars => vec![SCALARS],
            ArrayKind::Constants => vec![CONSTANTS],
            ArrayKind::Target(_) => vec![radar.samples, radar.elements],
            ArrayKind::Gain => Vec::new(),
        }
    }

    /// NumPy's name of the array's type. Small arrays and samples keep all bits: the thesis' floor lies 230 dB below its echoes.
    pub fn dtype(self, precision: DatasetPrecision) -> &'static str {
        match (self, precision) {
            (ArrayKind::Ends | ArrayKind::Layout(_), _) => "<c16",
            (ArrayKind::Gain, _) => "<f8",
            (ArrayKind::Scalars | ArrayKind::Constants, _) | (_, DatasetPrecision::Single) => "<f4",
            (_, DatasetPrecision::Half) => "<f2",
        }
    }

    /// The whole file of the array for these examples.
    pub fn file(self, examples: &[Example], radar: &Radar, precision: DatasetPrecision) -> Vec<u8> {
        let shape: Vec<usize> = [examples.len()].into_iter().chain(self.shape(radar)).collect();
        let mut bytes = header(self.dtype(precision), &shape);
        for example in examples {
            match self {
                ArrayKind::Ends | ArrayKind::Layout(_) => put_heard(&mut bytes, example),
                ArrayKind::Target(target) => put(&mut bytes, example.target(target).into_iter().flatten(), precision),
                ArrayKind::Gain => bytes.extend(example.gain.to_le_bytes()),
                feature => example.input.iter().for_each(|input| put_feature(&mut bytes, feature, input, precision)),
            }
        }
        bytes
    }
}

fn put_heard(bytes: &mut Vec<u8>, example: &Example) {
    let scale = 10f64.powf(-example.gain);
    let mut put = |sample: &Complex64| {
        bytes.extend((sample.re * scale).to_le_bytes());
        bytes.extend((sample.im * scale).to_le_bytes());
    };
    match &example.heard {
        EndSamples::Ends(ends) => ends.first.iter().chain(&ends.last).for_each(&mut put),
        EndSamples::Elements(samples) => samples.iter().for_each(&mut put),
    }
}

fn put_feature(bytes: &mut Vec<u8>, feature: ArrayKind, input: &LiveInput, precision: DatasetPrecision) {
    match feature {
        ArrayKind::Fine => put(bytes, &input.fine, precision),
        ArrayKind::Coarse => put(bytes, &input.coarse, precision),
        ArrayKind::Rows => put(bytes, &input.rows, precision),
        ArrayKind::Scalars => put(bytes, &input.scalars, DatasetPrecision::Single),
        ArrayKind::Constants => put(bytes, &input.constants, DatasetPrecision::Single),
        ArrayKind::Ends | ArrayKind::Layout(_) | ArrayKind::Target(_) | ArrayKind::Gain => {}
    }
}

fn put<'a>(bytes: &mut Vec<u8>, values: impl IntoIterator<Item = &'a f32>, precision: DatasetPrecision) {
    match precision {
        DatasetPrecision::Single => values.into_iter().for_each(|v| bytes.extend(v.to_le_bytes())),
        DatasetPrecision::Half => values.into_iter().for_each(|v| bytes.extend(half_of(*v).to_le_bytes())),
    }
}

fn header(dtype: &str, shape: &[usize]) -> Vec<u8> {
    let shape: String = shape.iter().map(|n| format!("{n}, ")).collect();
    let mut text = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({}), }}", shape.trim_end());
    const PREFIX_BYTES: usize = 10;
    let padding = (64 - (PREFIX_BYTES + text.len() + 1) % 64) % 64;
    text.extend(std::iter::repeat_n(' ', padding));
    text.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes
}

/// The nearest half-precision number, ties to even; larger numbers become the largest finite one.
fn half_of(value: f32) -> f16 {
    f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_the_largest_half() {
        let halves = [1e9, f32::INFINITY, -1e9, 0.1].map(half_of);
        assert_eq!(halves.map(f16::to_bits), [0x7bff, 0x7bff, 0xfbff, 0x2e66]);
        assert!(half_of(f32::NAN).is_nan());
    }
}
