//! The double reflection at an inner corner, in both orders of its arms.
//!
//! Each order is the face formula on the second arm with the transmitter replaced by its image in the first, on the stretch that the image
//! sees through the first. At a right angle the two orders add up to one echo at the apex.

use super::face::Face;
use super::geometry::V;
use super::{AntennaPlaces, EchoKind, PathEcho, Wave};

/// Sign of a further reflection: -1 for E along z, +1 for H along z.
const BOUNCE_SIGN: f64 = -1.0;

/// A direction that misses the second arm's line by less is taken to be parallel to it, metres.
const MIN_DISTANCE_METRES: f64 = 1e-9;

/// The six echoes of the corner between two arms, the first order first; `first` ends where `second` begins.
pub fn echoes(wave: &Wave, antennas: &AntennaPlaces, first: &Face, second: &Face) -> [PathEcho; 6] {
    let [a, b, c] = one_order(wave, antennas, first, second);
    let [d, e, f] = one_order(wave, antennas, second, first);
    [a, b, c, d, e, f]
}

fn one_order(wave: &Wave, antennas: &AntennaPlaces, first: &Face, second: &Face) -> [PathEcho; 3] {
    let transmitter = V::from(antennas.transmitter_metres);
    let image = mirrored(transmitter, first);
    let outside = |place: V, face: &Face| (place - face.from).dot(face.outward());
    let receives = outside(V::from(antennas.receiver_metres), second) > 0.0;
    let sends = outside(transmitter, first) > 0.0;
    let is_open = sends && receives && outside(image, second) > MIN_DISTANCE_METRES;
    // Places on the line of the second arm that rays from the image through the ends of the first arm meet.
    let hit = |end: V| {
        let ray = end - image;
        let down = ray.dot(second.outward());
        // A ray that never comes down: lit to infinity on that side.
        let down = if down >= -MIN_DISTANCE_METRES { -MIN_DISTANCE_METRES } else { down };
        let part = -outside(image, second) / down;
        (image - second.from).dot(second.along) + part * ray.dot(second.along)
    };
    let hits = [first.from, first.place(first.length_metres)].map(hit);
    let clip = |u: f64| u.clamp(0.0, second.length_metres);
    let lit = if is_open { [clip(hits[0].min(hits[1])), clip(hits[0].max(hits[1]))] } else { [0.0, 0.0] };
    let both =
        Face { is_two_sided: false, reflectivity: BOUNCE_SIGN * first.reflectivity * second.reflectivity, ..*second };
    let seen = AntennaPlaces { transmitter_metres: image.into(), ..*antennas };
    both.lit_echoes(wave, &seen, lit).map(|echo| PathEcho { kind: EchoKind::DoubleBounce, ..echo })
}

pub(super) fn mirrored(place: V, face: &Face) -> V {
    let to = place - face.from;
    face.from + face.along * (2.0 * to.dot(face.along)) - to
}
