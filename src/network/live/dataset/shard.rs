//! The arrays of some examples, as NumPy files.

use super::manifest::ArrayEntry;
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
    /// The array's name in file names, type, axes and shape. Samples have double precision: the thesis' floor is 230 dB below its echoes.
    pub fn entry(self, radar: &Radar, precision: DatasetPrecision) -> (&'static str, ArrayEntry) {
        let Radar { samples, elements, end_elements, .. } = *radar;
        let cells = if precision == DatasetPrecision::Half { "<f2" } else { "<f4" };
        let (name, dtype, axes, shape): (_, _, &[&str], _) = match self {
            ArrayKind::Ends => ("ends", "<c16", &["end", "element", "sample"], vec![2, end_elements, samples]),
            ArrayKind::Layout(elements) => ("heard", "<c16", &["element", "sample"], vec![elements, samples]),
            ArrayKind::Fine => ("fine", cells, &PICTURE_AXES, vec![FINE_CHANNELS, samples, FINE_COLUMNS]),
            ArrayKind::Coarse => ("coarse", cells, &PICTURE_AXES, vec![COARSE_CHANNELS, samples, COARSE_COLUMNS]),
            ArrayKind::Rows => ("rows", cells, &["channel", "range_bin"], vec![ROW_CHANNELS, samples]),
            ArrayKind::Scalars => ("scalars", "<f4", &["scalar"], vec![SCALARS]),
            ArrayKind::Constants => ("constants", "<f4", &["constant"], vec![CONSTANTS]),
            ArrayKind::Target(target) => (target.array(), cells, &["range_bin", "column"], vec![samples, elements]),
            ArrayKind::Gain => ("gain", "<f8", &[], Vec::new()),
        };
        let axes = ["example"].iter().chain(axes).map(|axis| (*axis).to_owned()).collect();
        (name, ArrayEntry { dtype: dtype.to_owned(), axes, shape })
    }

    /// Bytes of the array's file for these examples.
    pub fn file(self, examples: &[Example], radar: &Radar, precision: DatasetPrecision) -> Vec<u8> {
        let (_, ArrayEntry { dtype, shape, .. }) = self.entry(radar, precision);
        let shape: Vec<usize> = [examples.len()].into_iter().chain(shape).collect();
        let mut bytes = header(&dtype, &shape);
        for example in examples {
            let input = |of: fn(&LiveInput) -> &[f32]| example.input.as_ref().map_or([].as_slice(), of);
            match self {
                ArrayKind::Ends | ArrayKind::Layout(_) => put_samples(&mut bytes, example),
                ArrayKind::Fine => put(&mut bytes, input(|input| &input.fine), precision),
                ArrayKind::Coarse => put(&mut bytes, input(|input| &input.coarse), precision),
                ArrayKind::Rows => put(&mut bytes, input(|input| &input.rows), precision),
                ArrayKind::Scalars => put(&mut bytes, input(|input| &input.scalars), DatasetPrecision::Single),
                ArrayKind::Constants => put(&mut bytes, input(|input| &input.constants), DatasetPrecision::Single),
                ArrayKind::Target(target) => put(&mut bytes, example.target(target).into_iter().flatten(), precision),
                ArrayKind::Gain => bytes.extend(example.gain.to_le_bytes()),
            }
        }
        bytes
    }
}

const PICTURE_AXES: [&str; 3] = ["channel", "range_bin", "column"];

fn put_samples(bytes: &mut Vec<u8>, example: &Example) {
    let scale = 10f64.powf(-example.gain);
    let mut put = |sample: &Complex64| {
        bytes.extend((sample.re * scale).to_le_bytes());
        bytes.extend((sample.im * scale).to_le_bytes());
    };
    match &example.end_samples {
        EndSamples::Ends(ends) => ends.first.iter().chain(&ends.last).for_each(&mut put),
        EndSamples::Elements(samples) => samples.iter().for_each(&mut put),
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

/// The nearest half-precision number, ties to even. Numbers out of its range become the largest finite one.
fn half_of(value: f32) -> f16 {
    f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_become_the_largest_half() {
        let halves = [1e9, f32::INFINITY, -1e9, 0.1].map(half_of);
        assert_eq!(halves.map(f16::to_bits), [0x7bff, 0x7bff, 0xfbff, 0x2e66]);
        assert!(half_of(f32::NAN).is_nan());
    }
}
