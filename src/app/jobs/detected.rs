//! What a detector with a constant false-alarm rate finds in the maps on screen; computed only while one is in use.

use super::scene_maps::MapsRequest;
use crate::app::state::{MapKind, MethodSlot};
use crate::engine::Frame;
use crate::maps::cfar::Cfar;
use crate::maps::{LambdaScale, RangeAngleMap};
use std::sync::Arc;

/// The threshold that gives a detector's cells from [`Detected`]'s maps.
pub const DETECTED: f32 = 0.5;

/// Maps whose detected cells are 1 and others 0.
#[derive(Debug, Clone, Default)]
pub struct Detected {
    /// Of the target.
    pub target: Option<Arc<RangeAngleMap>>,
    /// Of either method's output.
    pub outputs: [Option<Arc<RangeAngleMap>>; 2],
    /// Why there are none.
    pub error: Option<String>,
}

/// One map's detections, and what they belong to.
struct Kept {
    map: Arc<RangeAngleMap>,
    scale: LambdaScale,
    cfar: Cfar,
    detected: Arc<RangeAngleMap>,
}

/// Detects, and keeps what it found last: target, then both outputs.
#[derive(Default)]
pub struct Detector {
    kept: [Option<Kept>; 3],
}

impl Detector {
    /// What the request's detector finds in the maps that somebody looks at; nothing where it has none.
    pub fn detect(&mut self, request: &MapsRequest, frame: &Frame) -> Detected {
        let Some(cfar) = request.cfar else {
            self.kept = [None, None, None];
            return Detected::default();
        };
        let mut detected = Detected::default();
        let shows = |kind| request.pictures.contains(&kind);
        let Some(full) = frame.full.as_ref() else {
            let looked_at = shows(MapKind::OutputAbove) || shows(MapKind::SecondAbove);
            let error = "The detector needs the power of every cell, which an output has only beside a target.";
            return Detected { error: looked_at.then(|| error.to_owned()), ..detected };
        };
        let mut found = |slot: usize, map: &Arc<RangeAngleMap>| match self.find(slot, map, full.scale, cfar) {
            Ok(found) => Some(found),
            Err(error) => {
                detected.error = Some(error);
                None
            }
        };
        if shows(MapKind::TargetAbove) || request.scores {
            detected.target = found(0, &full.lambda);
        }
        for (slot, above) in MethodSlot::BOTH.into_iter().zip([MapKind::OutputAbove, MapKind::SecondAbove]) {
            let pair = request.pairs[slot as usize].as_ref().filter(|_| shows(above) || request.scores);
            detected.outputs[slot as usize] = pair.and_then(|pair| found(1 + slot as usize, &pair.output));
        }
        detected
    }

    fn find(
        &mut self,
        slot: usize,
        map: &Arc<RangeAngleMap>,
        scale: LambdaScale,
        cfar: Cfar,
    ) -> Result<Arc<RangeAngleMap>, String> {
        let last = self.kept[slot].as_ref();
        if let Some(kept) = last.filter(|k| Arc::ptr_eq(&k.map, map) && (k.scale, k.cfar) == (scale, cfar)) {
            return Ok(kept.detected.clone());
        }
        let detected = Arc::new(cfar.detect_lambda(map, scale).map_err(|e| sentence(&e.to_string()))?.as_map());
        self.kept[slot] = Some(Kept { map: map.clone(), scale, cfar, detected: detected.clone() });
        Ok(detected)
    }
}

/// A message as a sentence of its own.
fn sentence(message: &str) -> String {
    let mut letters = message.chars();
    let first = letters.next().map_or_else(String::new, |first| first.to_uppercase().collect());
    format!("{first}{}.", letters.as_str())
}
