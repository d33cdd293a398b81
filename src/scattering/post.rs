//! A round post: the echo of its specular point, with the next term of the asymptotic series for E along the post (Ruck, *Radar Cross
//! Section Handbook*, chapter 4).

use super::geometry::{V, root};
use super::{AntennaPlaces, EchoKind, PathEcho, REFERENCE_LENGTH_METRES, Wave};
use num_complex::Complex64;

/// Least size, as physical wave number times radius, from which the next term improves the first.
const MIN_REFINED_SIZE: f64 = 5.0;

const STEPS: usize = 3;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    centre: V,
    radius_metres: f64,
    reflectivity: f64,
}

impl Circle {
    /// The circle around (x, y), in metres.
    pub fn new(centre_metres: [f64; 2], radius_metres: f64, reflectivity: f64) -> Self {
        Circle { centre: centre_metres.into(), radius_metres, reflectivity }
    }

    /// The post's echo; none where an antenna stands inside. `refined` adds the next term of the series.
    pub fn echo(&self, wave: &Wave, antennas: &AntennaPlaces, refined: bool) -> PathEcho {
        let Circle { centre, radius_metres: radius, reflectivity } = *self;
        let [t, r] = [antennas.transmitter_metres, antennas.receiver_metres].map(|p| V::from(p) - centre);
        let (far_t, far_r) = (t.norm(), r.norm());
        if !(radius > 0.0 && far_t > radius && far_r > radius) {
            return PathEcho::silent(centre.into(), EchoKind::Post);
        }
        let normal = if antennas.transmitter_metres == antennas.receiver_metres {
            t * far_t.recip()
        } else {
            specular(t, r, radius, t * far_t.recip() + r * far_r.recip())
        };
        let nearest = normal * radius;
        let (leg_t, leg_r) = ((t - nearest).norm(), (r - nearest).norm());
        let cos = (t - nearest).dot(normal) / leg_t;
        let spread = (leg_t.recip() + leg_r.recip()) / 2.0 + 1.0 / (radius * cos);
        let strength = wave.power_watts * reflectivity / (root(REFERENCE_LENGTH_METRES * spread) * leg_t * leg_r);
        let over = wave.radians_per_metre * radius;
        let second = if refined && over / 2.0 >= MIN_REFINED_SIZE { -5.0 / (8.0 * over) } else { 0.0 };
        let silent = PathEcho::silent((centre + nearest).into(), EchoKind::Post);
        let amplitude = Complex64::new(strength, strength * second);
        PathEcho { range_metres: (leg_t + leg_r) / 2.0, amplitude, cos_incidence: cos, ..silent }
    }
}

/// The direction from the centre in which the way over a circle of `radius` is shortest, by Newton's method from `start`.
fn specular(t: V, r: V, radius: f64, start: V) -> V {
    let mut angle = start.1.atan2(start.0);
    for _ in 0..STEPS {
        let (sin, cos) = angle.sin_cos();
        let (normal, tangent) = (V(cos, sin), V(-sin, cos));
        let (mut first, mut second) = (0.0, 0.0);
        for antenna in [t, r] {
            let way = normal * radius - antenna;
            let length = way.norm();
            let gradient = way.dot(tangent) / length;
            first += gradient;
            second += (1.0 - gradient * gradient) / length - way.dot(normal) / (length * radius);
        }
        angle -= first / second / radius;
    }
    let (sin, cos) = angle.sin_cos();
    V(cos, sin)
}
