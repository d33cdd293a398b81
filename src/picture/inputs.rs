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
    /// Lambda.
    pub lambda: RangeAngleMap,
}

impl InputMap {
    /// The input maps of both ends.
    pub(super) fn of_ends(radar: &Radar, ends: [&LogMap; 2], normalisation: Normalisation) -> Vec<InputMap> {
        let of_end = |(number, (end, map)): (usize, (End, &LogMap))| {
            let elements = radar.end_range(end);
            let title = format!("Input {number}: elements {} to {}", elements.start, elements.end - 1);
            InputMap { title, lambda: map.normalise(normalisation) }
        };
        End::BOTH.into_iter().zip(ends).enumerate().map(of_end).collect()
    }
}

/// Letters of a layout's name for which a title has room.
const MAX_NAME_LETTERS: usize = 16;

/// The samples of a layout's elements, and their map.
pub(super) struct HeardByLayout {
    pub(super) samples: Arc<LayoutSamples>,
    pub(super) input: InputMap,
}

impl HeardByLayout {
    /// The samples and the map of `layout`, from the samples of every element; `signal` is `None` where the two ends alone were recorded.
    /// # Errors
    /// [`ComposeError`] where `radar` has no such elements, or their samples are missing.
    pub(super) fn of(
        radar: &Radar,
        elements: &BuiltArray,
        signal: Option<&BeatSignal>,
        layout: &LayoutKind,
        normalisation: Normalisation,
    ) -> Result<Self, ComposeError> {
        let numbers = layout.numbers(radar)?;
        let signal = signal.ok_or_else(|| ComposeError::EndsAlone(layout.to_string()))?;
        let samples = signal.of_layout(&numbers);
        let name = layout.to_string();
        let title =
            if name.len() > MAX_NAME_LETTERS { "Input: listed elements".to_owned() } else { format!("Input: {name}") };
        let lambda = layout_map(radar, elements, &samples).log_magnitude().normalise(normalisation);
        Ok(HeardByLayout { samples: Arc::new(samples), input: InputMap { title, lambda } })
    }
}
