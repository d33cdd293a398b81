//! Detections with a constant false-alarm rate in the maps on screen, computed only while such a detector is in use.

use super::memo::Memo;
use crate::app::shared::Shared;
use crate::engine::EngineFrame;
use crate::maps::cfar::Cfar;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::capitalised;
use std::sync::Arc;

/// Maps whose detected cells are 1 and others 0.
#[derive(Debug, Clone, Default)]
pub struct Detected {
    pub target: Option<Arc<RangeAngleMap>>,
    pub outputs: [Option<Arc<RangeAngleMap>>; 2],
    pub error: Option<String>,
}

type Detection = (Shared<RangeAngleMap>, LambdaScale, Cfar);

/// A detector that keeps its last detections: of the target, then of both outputs.
#[derive(Default)]
pub struct Detector {
    kept: [Memo<Detection, Arc<RangeAngleMap>>; 3],
}

impl Detector {
    /// Detections in the target, where a panel shows them, and in the given outputs; none without a detector.
    pub fn detect(
        &mut self,
        cfar: Option<Cfar>,
        frame: &EngineFrame,
        target_is_wanted: bool,
        outputs: [Option<&Arc<RangeAngleMap>>; 2],
    ) -> Detected {
        let mut detected = Detected::default();
        let Some(cfar) = cfar else {
            self.kept = Default::default();
            return detected;
        };
        let Some(full) = frame.full.as_ref() else {
            let error = "The detector needs the power of every cell, which an output has only beside a target.";
            detected.error = outputs.iter().any(Option::is_some).then(|| error.to_owned());
            return detected;
        };
        let target = Some(&full.lambda).filter(|_| target_is_wanted);
        let mut found = [target, outputs[0], outputs[1]].into_iter().enumerate().map(|(slot, map)| {
            let found = self.kept[slot].try_of((map?.into(), full.scale, cfar), |(map, scale, cfar)| {
                let detected = cfar.detect_lambda(map, *scale).map_err(|e| sentence(&e.to_string()))?;
                Ok(Arc::new(detected.as_map()))
            });
            found.cloned().map_err(|error: String| detected.error = Some(error)).ok()
        });
        let [target, first, second] = [0; 3].map(|_| found.next().flatten());
        drop(found);
        Detected { target, outputs: [first, second], ..detected }
    }
}

/// The message with a capital letter and a full stop.
fn sentence(message: &str) -> String {
    capitalised(message) + "."
}
