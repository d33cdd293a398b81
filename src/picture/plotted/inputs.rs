//! Input maps of a picture: those of the two ends, or of a layout.

use super::error::ComposeError;
use crate::maps::focus::layout_map;
use crate::maps::{LogMap, Normalisation, RangeAngleMap};
use crate::radar::{BuiltArray, End, LayoutKind, Radar};
use crate::signal::{BeatSignal, LayoutSamples};
use std::sync::Arc;

/// Lambda of an input, `[range bins, columns]`.
#[derive(Debug, Clone)]
pub struct InputMap {
    /// The elements that heard it, in words.
    pub title: String,
    pub lambda: RangeAngleMap,
}

impl InputMap {
    /// The input maps of both ends, or that of a layout, with its samples.
    pub(super) fn of(
        radar: &Radar,
        elements: &BuiltArray,
        signal: Option<&BeatSignal>,
        ends: [&LogMap; 2],
        (layout, normalisation): (Option<&LayoutKind>, Normalisation),
    ) -> Result<(Option<Arc<LayoutSamples>>, Vec<InputMap>), ComposeError> {
        let Some(layout) = layout else {
            let of_end = |(number, (end, map)): (usize, (End, &LogMap))| {
                let elements = radar.end_range(end);
                let title = format!("Input {number}: elements {} to {}", elements.start, elements.end - 1);
                InputMap { title, lambda: map.normalise(normalisation) }
            };
            return Ok((None, End::BOTH.into_iter().zip(ends).enumerate().map(of_end).collect()));
        };
        let samples = layout_samples(radar, signal, layout)?;
        let name = layout.to_string();
        let name = if name.len() > MAX_NAME_LETTERS { "listed elements".to_owned() } else { name };
        let lambda = layout_map(radar, elements, &samples).log_magnitude().normalise(normalisation);
        Ok((Some(samples), vec![InputMap { title: format!("Input: {name}"), lambda }]))
    }
}

/// Letters of a layout's name for which a title has room.
const MAX_NAME_LETTERS: usize = 16;

/// The samples of `layout`, from those of every element; `signal` is `None` where the two ends alone were recorded.
pub(super) fn layout_samples(
    radar: &Radar,
    signal: Option<&BeatSignal>,
    layout: &LayoutKind,
) -> Result<Arc<LayoutSamples>, ComposeError> {
    let numbers = layout.numbers(radar).map_err(ComposeError::Layout)?;
    let signal = signal.ok_or_else(|| ComposeError::EndsAlone(layout.to_string()))?;
    Ok(Arc::new(signal.of_layout(&numbers)))
}
