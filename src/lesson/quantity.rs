//! Quantities a learner may be asked for, from the radar and the scene by formula.

use crate::radar::budget::cross_section_dbsm;
use crate::radar::{End, Radar};
use crate::scene::{Object, Scene};
use serde::{Deserialize, Serialize};

/// Index of an object in a file, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ObjectNumber(pub usize);

impl ObjectNumber {
    /// The index from 0, where there is such an object.
    pub fn index(self, objects: usize) -> Result<usize, String> {
        match self.0 {
            number if (1..=objects).contains(&number) => Ok(number - 1),
            number => Err(format!("object {number} is asked for; the scene has objects 1 to {objects}")),
        }
    }

    /// The object of this number.
    /// # Errors
    /// As [`ObjectNumber::index`].
    pub fn of(self, scene: &Scene) -> Result<&Object, String> {
        self.index(scene.objects.len()).map(|index| &scene.objects[index])
    }
}

/// A number that follows from the radar, or from the radar and an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// c / 2B, metres.
    RangeBinMetres,
    /// Samples times the range bin, metres.
    MaximumRangeMetres,
    ApertureMetres,
    /// Least range of the whole array's far field ([`Radar::far_field_metres`]), metres.
    FarFieldMetres,
    /// Columns of one beam of an end: the map's columns over the end's elements.
    EndBeamColumns,
    /// Distance in cos(theta) from a reflector to its grating lobe: wavelength over spacing and over the carrier's turns per wavelength,
    /// at the frequency that the middle of the chirp has ([`Radar::fold_period_cos`]).
    GratingLobeCos,
    /// The range at which an object appears: its own, wrapped at the maximum, metres.
    ApparentRangeMetres,
    /// Difference of the two ends' distances from an object, range bins.
    EndsDifferenceBins,
    /// The largest radial velocity that has a column of its own, metres a second.
    UnambiguousVelocityMetresPerSecond,
    /// Difference of velocity between two columns of a range-Doppler map, metres a second.
    VelocityColumnMetresPerSecond,
    /// The radial velocity at which a range-Doppler map shows an object: its own, folded, metres a second; below 0 it comes nearer.
    ApparentVelocityMetresPerSecond,
    /// SNR of an object by the whole array, its elements added in phase, by the radar's link budget, dB; of one reflector, where it has several.
    SnrDecibels,
}

impl Quantity {
    pub fn name(self) -> &'static str {
        self.words().0
    }

    pub fn unit(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        match self {
            Quantity::RangeBinMetres => ("a range bin", "m"),
            Quantity::MaximumRangeMetres => ("a maximum range", "m"),
            Quantity::ApertureMetres => ("an aperture", "m"),
            Quantity::FarFieldMetres => ("a far-field distance", "m"),
            Quantity::EndBeamColumns => ("a beam of an end", "columns"),
            Quantity::GratingLobeCos => ("a distance to the grating lobe", "in cos θ"),
            Quantity::ApparentRangeMetres => ("an apparent range", "m"),
            Quantity::SnrDecibels => ("an SNR by the whole array", "dB"),
            Quantity::EndsDifferenceBins => ("a difference between the ends", "range bins"),
            Quantity::UnambiguousVelocityMetresPerSecond => ("an unambiguous velocity", "m/s"),
            Quantity::VelocityColumnMetresPerSecond => ("a column of velocity", "m/s"),
            Quantity::ApparentVelocityMetresPerSecond => ("an apparent radial velocity", "m/s"),
        }
    }

    /// The quantity's value, in its unit.
    /// # Errors
    /// A sentence where the quantity needs an object that is not named or not there.
    pub fn of(self, radar: &Radar, scene: &Scene, object: Option<ObjectNumber>) -> Result<f64, String> {
        let thing = || -> Result<&Object, String> {
            let number =
                object.ok_or_else(|| "this quantity belongs to an object; expected object = NUMBER".to_owned())?;
            number.of(scene)
        };
        let centre = || thing().map(Object::centre_metres);
        Ok(match self {
            Quantity::RangeBinMetres => radar.range_resolution_metres(),
            Quantity::MaximumRangeMetres => radar.max_range_metres(),
            Quantity::ApertureMetres => radar.aperture_metres(),
            Quantity::FarFieldMetres => radar.far_field_metres(),
            Quantity::EndBeamColumns => radar.elements as f64 / radar.end_elements as f64,
            Quantity::GratingLobeCos => radar.fold_period_cos(),
            Quantity::ApparentRangeMetres => {
                let [x, y] = centre()?;
                x.hypot(y).rem_euclid(radar.max_range_metres())
            }
            Quantity::SnrDecibels => {
                let ([x, y], number) = (centre()?, object.map_or(1, |number| number.0));
                let own = &scene.objects[number - 1];
                if own.body().is_some() {
                    return Err(format!("object {number} is a body, which has no cross section of its own"));
                }
                let range = x.hypot(y);
                radar.link(cross_section_dbsm(own.reflectivity()), range, y / range).array.0
            }
            Quantity::EndsDifferenceBins => {
                let [x, y] = centre()?;
                let from = |end| (x - radar.end_centre_metres(end)).hypot(y);
                radar.bin_of_range((from(End::First) - from(End::Last)).abs())
            }
            Quantity::UnambiguousVelocityMetresPerSecond => radar.unambiguous_velocity_metres_per_second(),
            Quantity::VelocityColumnMetresPerSecond => radar.velocity_resolution_metres_per_second(),
            Quantity::ApparentVelocityMetresPerSecond => {
                radar.apparent_velocity_metres_per_second(thing()?.radial_velocity_metres_per_second())
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_of_table_3_1() {
        let (radar, scene) = (Radar::default(), Scene::of_points([(18.0, 8.717), (0.0, 60.0)]));
        let of = |q: Quantity, o| q.of(&radar, &scene, o).unwrap();
        assert!((of(Quantity::RangeBinMetres, None) - 0.07495).abs() < 1e-4);
        assert!((of(Quantity::GratingLobeCos, None) - 2.053).abs() < 1e-3);
        // The two ends see a point at cos 0.9 and 20 m some 24 bins apart.
        assert!((of(Quantity::EndsDifferenceBins, Some(ObjectNumber(1))) - 24.0).abs() < 1.0);
        let wrapped = of(Quantity::ApparentRangeMetres, Some(ObjectNumber(2)));
        assert!((wrapped - (60.0 - radar.max_range_metres())).abs() < 1e-9);
        let velocity = of(Quantity::ApparentVelocityMetresPerSecond, Some(ObjectNumber(1)));
        assert_eq!(velocity, 0.0, "nothing moves");
        let most = of(Quantity::UnambiguousVelocityMetresPerSecond, None);
        assert!((most - 78.1).abs() < 0.1 && of(Quantity::VelocityColumnMetresPerSecond, None) == 2.0 * most);
        let told = |o| Quantity::ApparentRangeMetres.of(&radar, &scene, o).unwrap_err();
        assert!(!told(None).is_empty() && told(Some(ObjectNumber(3))).contains("1 to 2"));
    }
}
