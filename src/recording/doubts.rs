//! Warnings about a recording that looks wrong but may be right.

use super::Recorded;
use crate::maps::channels_range_transform;
use crate::radar::{Carrier, Radar};

/// Least part of the power in the far half of the range axis for which the beat's sign is doubted.
const MIN_FAR_PART: f64 = 0.9;
/// Largest element spacing of a two-way carrier without ambiguous directions, wavelengths: 1/4, and a margin for a carrier off the middle of the band.
const MAX_SPACING_WAVELENGTHS: f64 = 0.26;
/// Least samples of a chirp for which the halves of the range axis are compared.
const MIN_SAMPLES: usize = 8;

/// Warnings, a sentence each, about unlikely samples or radars. There are none without `is_physical`: texts of format 1 are read as they are.
pub(super) fn doubts(radar: &Radar, samples: &Recorded, is_physical: bool) -> Vec<String> {
    let mut doubts = Vec::new();
    if !is_physical {
        return doubts;
    }
    let spacing = radar.element_spacing_metres / radar.wavelength_metres();
    match radar.carrier {
        Carrier::TwoWay if spacing > MAX_SPACING_WAVELENGTHS => doubts.push(format!(
            "Elements stand {spacing:.2} wavelengths apart, and the carrier is two-way: directions beyond cos θ = {:.2} fold to the other side. In \
             the two-way reading an element stands halfway between its transmitter and its receiver, so a filled array has a quarter of a wavelength.",
            0.25 / spacing
        )),
        Carrier::OneWay if spacing < 0.3 => doubts.push(format!(
            "Elements stand {spacing:.2} wavelengths apart, and the carrier is one-way. A filled array of virtual elements has half a \
             wavelength; a quarter of one belongs to carrier = \"two-way\"."
        )),
        Carrier::OneWay | Carrier::TwoWay => {}
    }
    if let Some(part) = far_part(radar, samples).filter(|part| *part > MIN_FAR_PART) {
        doubts.push(format!(
            "{:.0} % of the power stands in the far half of the range axis. Where echoes were nearer, recording.beat_sign is the other one.",
            100.0 * part
        ));
    }
    doubts
}

/// Part of the power in the far half of the range axis, that of the negative frequencies; `None` below [`MIN_SAMPLES`] or without power.
fn far_part(radar: &Radar, samples: &Recorded) -> Option<f64> {
    if radar.samples < MIN_SAMPLES {
        return None;
    }
    let arrays = match samples {
        Recorded::All(signal) => vec![signal.samples.view()],
        Recorded::Ends(ends) => vec![ends.first.view(), ends.last.view()],
    };
    let (mut far, mut all) = (0.0, 0.0);
    for array in arrays {
        for row in channels_range_transform(radar, array).profiles.outer_iter() {
            // The constant part is in bin 0 and, by the window, in the bins beside it: it belongs to neither half.
            for (bin, value) in row.iter().enumerate().take(radar.samples - 1).skip(2) {
                all += value.norm_sqr();
                far += if bin > radar.samples / 2 { value.norm_sqr() } else { 0.0 };
            }
        }
    }
    (all > 0.0).then(|| far / all)
}
