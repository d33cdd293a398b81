//! Calibration of the elements by the selected reflector.

use super::derived::{Failure, Query};
use super::source::Source;
use crate::app::state::State;
use crate::radar::BuiltArray;
use crate::scene::{Object, Reflector};
use crate::signal::{Calibration as Found, calibrate};
use crate::task::Task;

#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    pub name: String,
    /// Gain and phase of each element.
    pub calibration: Found,
    /// Errors of the elements that remain after the correction.
    pub left: BuiltArray,
}

#[derive(Clone, PartialEq)]
pub struct CalibrationQuery {
    source: Source,
    name: String,
    reflector: Reflector,
}

impl CalibrationQuery {
    /// The query of the selected point; `None` where no single point is selected.
    pub fn of(state: &State) -> Option<Self> {
        let index = state.editor.selection().single()?;
        let scene = state.editor.scene();
        let Object::Point(point) = scene.objects.get(index)? else { return None };
        let (x_metres, y_metres, reflectivity) = (point.x_metres, point.y_metres, point.reflectivity);
        Some(CalibrationQuery {
            source: Source { scene: scene.into(), ..Source::of(state) },
            name: format!("point {}", index + 1),
            reflector: Reflector { x_metres, y_metres, reflectivity },
        })
    }
}

impl Query for CalibrationQuery {
    type Value = Calibrated;
    type State = ();
    const WHAT: &'static str = "The calibration";
    const ADVICE: &'static str = "Select another point to try again.";

    fn compute(&self, (): &mut (), _: &Task) -> Result<Calibrated, Failure> {
        let CalibrationQuery { source, name, reflector } = self;
        let signal = source.signal("The recording has the two ends alone; calibration looks at every element.")?;
        let calibration = calibrate(&source.radar, &signal, reflector)
            .ok_or_else(|| format!("No element hears {name}, so that it calibrates nothing."))?;
        let left = source.scene.disturbances.elements.corrected(&calibration.array);
        Ok(Calibrated { name: name.clone(), calibration, left })
    }
}
