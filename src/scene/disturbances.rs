//! Disturbances that the formulas leave out: element errors, an interfering radar, a mirror.

use super::{MIN_ELEMENT_DISTANCE_METRES, Reflector, SceneError};
use crate::radar::{BuiltArray, ElementError, Radar};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// All disturbances of a scene; none by default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Disturbances {
    #[serde(skip_serializing_if = "BuiltArray::is_ideal")]
    pub elements: BuiltArray,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interferer: Option<Interferer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mirror: Option<Mirror>,
}

/// A radar whose chirps are not synchronised with ours. While its frequency crosses ours, the difference, itself a chirp, passes the
/// receiver's filter. It propagates one way, so its amplitude falls with the distance, not with its square.
///
/// After G. M. Brooker, "Mutual interference of millimeter-wave radar systems" (2007).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Interferer {
    pub x_metres: f64,
    pub y_metres: f64,
    /// Strength of its amplitude: at the array it is the radar's power times this over the distance in metres.
    pub strength: f64,
    /// Time at which its frequency crosses ours, as a part of our chirp: 0 at the first sample, 1 after the last.
    pub crossing: f64,
    pub duration: f64,
}

impl Default for Interferer {
    fn default() -> Self {
        Interferer { x_metres: 6.0, y_metres: 25.0, strength: 0.1, crossing: 0.6, duration: 0.1 }
    }
}

impl Interferer {
    /// The default interferer, at the same fraction of the maximum range of `radar` as for table 3.1.
    pub fn before(radar: &Radar) -> Self {
        let far = radar.max_range_metres() / Radar::default().max_range_metres();
        let Interferer { x_metres, y_metres, .. } = Interferer::default();
        let centimetres = |metres: f64| (100.0 * far * metres).round() / 100.0;
        Interferer { x_metres: centimetres(x_metres), y_metres: centimetres(y_metres), ..Interferer::default() }
    }
}

/// A straight wall that mirrors objects on the radar's side of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Mirror {
    /// A point of the plane, along the array's axis, metres.
    pub x_metres: f64,
    /// The same point ahead of the array, metres.
    pub y_metres: f64,
    /// Direction of the plane: 0 along the array, 90 straight ahead.
    pub direction_degrees: f64,
    /// Amplitude reflection coefficient.
    pub reflection: f64,
}

impl Default for Mirror {
    fn default() -> Self {
        Mirror { x_metres: -5.0, y_metres: 0.0, direction_degrees: 90.0, reflection: 0.5 }
    }
}

impl Mirror {
    /// Signed distance of a place from the plane, metres.
    fn distance_metres(&self, x_metres: f64, y_metres: f64) -> f64 {
        let (sin, cos) = self.direction_degrees.to_radians().sin_cos();
        (y_metres - self.y_metres) * cos - (x_metres - self.x_metres) * sin
    }

    /// Whether a place stands on the side of the array's centre.
    pub fn is_before(&self, x_metres: f64, y_metres: f64) -> bool {
        self.distance_metres(0.0, 0.0) * self.distance_metres(x_metres, y_metres) > 0.0
    }

    /// Mirror image of a place, (x, y) in metres.
    pub fn image_metres(&self, x_metres: f64, y_metres: f64) -> [f64; 2] {
        let (sin, cos) = self.direction_degrees.to_radians().sin_cos();
        let twice = 2.0 * self.distance_metres(x_metres, y_metres);
        [x_metres + twice * sin, y_metres - twice * cos]
    }

    /// The ghosts of a reflector, as reflectors with the same echo: its mirror image, for two reflections at the wall, and two at the mean
    /// range, for one reflection, in the directions of image and reflector. None where the wall hides the reflector from the array's centre.
    ///
    /// As F. Kraus, N. Scheiner, W. Ritter and K. Dietmayer sort them in "Using machine learning to detect ghost images in automotive
    /// radar" (2020), by which of reflector and wall the echo leaves last.
    pub fn ghosts(&self, radar: &Radar, of: &Reflector) -> Vec<Reflector> {
        let [own, side] = [self.distance_metres(0.0, 0.0), self.distance_metres(of.x_metres, of.y_metres)];
        if own * side <= 0.0 {
            return Vec::new();
        }
        let [x, y] = self.image_metres(of.x_metres, of.y_metres);
        let (there, image) = (radar.polar_of(of.x_metres, of.y_metres), radar.polar_of(x, y));
        let mean = (there.range_metres + image.range_metres) / 2.0;
        // An echo over one way each falls with the product of both ranges.
        let one_way = of.reflectivity * self.reflection * mean * mean / (there.range_metres * image.range_metres);
        // Elements of a pattern send one way and hear the other; a point in one of the two directions would have the pattern twice.
        let left = |y: f64, range: f64| radar.pattern().map_or(1.0, |pattern| pattern.amplitude(y / range));
        let both = left(of.y_metres, there.range_metres) * left(y, image.range_metres);
        let towards = |x: f64, y: f64, range: f64| {
            let reflectivity = one_way * (both / left(y, range).powi(2));
            Reflector::at([x * mean / range, y * mean / range], reflectivity)
        };
        vec![
            Reflector::at([x, y], of.reflectivity * self.reflection.powi(2)),
            towards(x, y, image.range_metres),
            towards(of.x_metres, of.y_metres, there.range_metres),
        ]
    }
}

impl Disturbances {
    /// Whether there are no disturbances.
    pub fn is_none(&self) -> bool {
        self.elements.is_ideal() && self.interferer.is_none() && self.mirror.is_none()
    }

    /// Whether `radar` hears every echo undisturbed: there are no disturbances, and no gaps in its line.
    pub fn is_none_to(&self, radar: &Radar) -> bool {
        self.is_none() && radar.gaps() == 0
    }

    /// The elements, with those at gaps of `radar` dead.
    pub fn elements_of(&self, radar: &Radar) -> Cow<'_, BuiltArray> {
        let Some(antennas) = radar.antennas.as_ref().filter(|antennas| antennas.gaps() > 0) else {
            return Cow::Borrowed(&self.elements);
        };
        let of = |(n, pair): (usize, &Option<[usize; 2]>)| {
            let own = self.elements.element(n);
            ElementError { dead: own.dead || pair.is_none(), ..own }
        };
        Cow::Owned(BuiltArray { elements: antennas.pairs().iter().enumerate().map(of).collect() })
    }

    /// Checks that every number is usable and that the elements are those of `radar`.
    /// # Errors
    /// [`SceneError`] names the fault.
    pub fn validate(&self, radar: &Radar) -> Result<(), SceneError> {
        self.elements.validate(radar).map_err(SceneError::Elements)?;
        let check = |what, field, value: f64, low: f64, high: f64| {
            let usable = (low..=high).contains(&value);
            usable.then_some(()).ok_or(SceneError::Disturbance { what, field, value, low, high })
        };
        if let Some(i) = &self.interferer {
            for (field, value, low, high) in [
                ("x_metres", i.x_metres, -1e6, 1e6),
                ("y_metres", i.y_metres, -1e6, 1e6),
                ("strength", i.strength, 0.0, 1e6),
                ("crossing", i.crossing, -10.0, 10.0),
                ("duration", i.duration, 1e-6, 1e3),
            ] {
                check("interferer", field, value, low, high)?;
            }
            let at = Reflector::at([i.x_metres, i.y_metres], 1.0);
            if super::touched_element(radar, &at).is_some() {
                check("interferer", "y_metres", i.y_metres, MIN_ELEMENT_DISTANCE_METRES, 1e6)?;
            }
        }
        if let Some(m) = &self.mirror {
            for (field, value, low, high) in [
                ("x_metres", m.x_metres, -1e6, 1e6),
                ("y_metres", m.y_metres, -1e6, 1e6),
                ("direction_degrees", m.direction_degrees, -3600.0, 3600.0),
                ("reflection", m.reflection, 0.0, 1.0),
            ] {
                check("mirror", field, value, low, high)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_metres: f64, y_metres: f64) -> Reflector {
        Reflector { x_metres, y_metres, reflectivity: 2.0 }
    }

    #[test]
    fn mirror_ghosts_stand_where_geometry_says() {
        let mirror = Mirror { x_metres: -5.0, reflection: 0.5, ..Mirror::default() };
        let [x, y] = mirror.image_metres(3.0, 20.0);
        assert!((x + 13.0).abs() < 1e-12 && (y - 20.0).abs() < 1e-12);
        let radar = Radar::default();
        let ghosts = mirror.ghosts(&radar, &at(3.0, 20.0));
        let [image, first, second] = ghosts[..] else { panic!("{ghosts:?}") };
        assert_eq!((image.x_metres, image.reflectivity), (x, 0.5));
        let mean = (3f64.hypot(20.0) + 13f64.hypot(20.0)) / 2.0;
        for (ghost, cos) in [(first, -13.0 / 13f64.hypot(20.0)), (second, 3.0 / 3f64.hypot(20.0))] {
            let place = radar.polar_of(ghost.x_metres, ghost.y_metres);
            assert!((place.range_metres - mean).abs() < 1e-9 && (place.cos_theta - cos).abs() < 1e-12);
            // Power over both ranges: sigma rho / (R R').
            let amplitude = ghost.reflectivity / place.range_metres.powi(2);
            assert!((amplitude * 3f64.hypot(20.0) * 13f64.hypot(20.0) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn behind_the_wall_there_are_no_ghosts() {
        let mirror = Mirror { x_metres: 0.0, y_metres: 10.0, direction_degrees: 0.0, reflection: 1.0 };
        assert_eq!(mirror.ghosts(&Radar::default(), &at(1.0, 12.0)), []);
        let before = mirror.ghosts(&Radar::default(), &at(1.0, 8.0));
        assert!((before[0].y_metres - 12.0).abs() < 1e-12 && (before[0].x_metres - 1.0).abs() < 1e-12);
    }

    #[test]
    fn unusable_numbers_are_named() {
        let radar = Radar::default();
        let told = |d: Disturbances| d.validate(&radar).unwrap_err().to_string();
        let mirror = Some(Mirror { reflection: 1.5, ..Mirror::default() });
        let error = told(Disturbances { mirror, ..Disturbances::default() });
        assert!(error.contains("mirror: reflection is 1.5"), "{error}");
        let on = Interferer { x_metres: radar.element_x_metres(3), y_metres: 0.0, ..Interferer::default() };
        let error = told(Disturbances { interferer: Some(on), ..Disturbances::default() });
        assert!(error.contains("interferer: y_metres is 0"), "{error}");
        let nan = Interferer { duration: f64::NAN, ..Interferer::default() };
        let error = told(Disturbances { interferer: Some(nan), ..Disturbances::default() });
        assert!(error.contains("duration is NaN"), "{error}");
        assert!(Disturbances::default().validate(&radar).is_ok() && Disturbances::default().is_none());
    }
}
