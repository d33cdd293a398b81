//! Fresnel's transition: `T(w) = erfcx(e^{j pi/4} w) / 2`, from 1/2 on the boundary of light and shadow to that of a bare edge far from it.
//!
//! Kouyoumjian's and Pathak's function is `F(w^2) = 2 sqrt(pi) e^{j pi/4} w T(w)`.

use num_complex::Complex64;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Least argument for which the series for large arguments is used.
const SERIES_ARGUMENT: f64 = 6.0;

/// `e^{j pi/4}`.
pub const EIGHTH_TURN: Complex64 = Complex64::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2);

/// Coefficients of `T` over Chebyshev's polynomials of `2 w / SERIES_ARGUMENT - 1`; the largest relative error is 1e-10.
const CHEBYSHEV_COEFFICIENTS: [[f64; 2]; 27] = [
    [0.15220033138621655, -0.059032052451183564],
    [-0.1852116021916685, 0.021792813603750957],
    [0.09903855073599477, 0.017599819526617037],
    [-0.04529174585391403, -0.02473164880696622],
    [0.01673880808509429, 0.019001953579509515],
    [-0.0041243510185567465, -0.011205951737976677],
    [-0.00018686433872824537, 0.005427365908721844],
    [0.0010106564803717456, -0.002165085708231804],
    [-0.0007676947910585378, 0.0006710690683822449],
    [0.00040522098779780967, -0.00012122575449707297],
    [-0.00016900503070435002, -2.5144738407187895e-05],
    [5.5728468657583186e-05, 3.778388094255902e-05],
    [-1.2832556317644504e-05, -2.2516937395451327e-05],
    [5.154411646784985e-07, 9.743789086574251e-06],
    [1.4661906691876281e-06, -3.2847048751277754e-06],
    [-1.017749343962815e-06, 8.084681550435402e-07],
    [4.5290653341564793e-07, -8.481344986321915e-08],
    [-1.5288441393090935e-07, -4.849157782704783e-08],
    [3.8019742129302706e-08, 3.9548932573851835e-08],
    [-4.785356354231052e-09, -1.7819952316533438e-08],
    [-1.487311967404703e-09, 5.922268722438617e-09],
    [1.369493146385903e-09, -1.4430888994887425e-09],
    [-6.111511111073221e-10, 1.8493101189287488e-10],
    [1.9673677853493387e-10, 4.5690172201240385e-11],
    [-4.5906613371782255e-11, -4.3138227712180564e-11],
    [5.476399056458803e-12, 1.8592078154799906e-11],
    [1.4402505577049141e-12, -5.7058691105282834e-12],
];

/// `T(w)` for `w >= 0`: within 2e-10 of its size.
pub fn transition(w: f64) -> Complex64 {
    if w < SERIES_ARGUMENT {
        // Clenshaw's recurrence.
        let x2 = 2.0 * (2.0 * w / SERIES_ARGUMENT - 1.0);
        let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
        for c in CHEBYSHEV_COEFFICIENTS[1..].iter().rev() {
            // Summed so that a step waits for one product and one sum of the step before.
            let next = [x2 * a[0] + (c[0] - b[0]), x2 * a[1] + (c[1] - b[1])];
            (b, a) = (a, next);
        }
        let x = x2 / 2.0;
        let [re, im] = [0, 1].map(|i| CHEBYSHEV_COEFFICIENTS[0][i] + x * a[i] - b[i]);
        return Complex64::new(re, im);
    }
    // erfcx(z) = (1 - 1/(2 z^2) + 3/(2 z^2)^2 - ...) / (sqrt(pi) z); z^2 = j w^2.
    let over = 0.5 / (w * w);
    let (mut re, mut im, mut term) = (0.0, 0.0, 1.0);
    for k in 0..11 {
        // Powers of 1/j = -j, with the signs of the series.
        match k % 4 {
            0 => re += term,
            1 => im += term,
            2 => re -= term,
            _ => im -= term,
        }
        term *= f64::from(2 * k + 1) * over;
    }
    Complex64::new(re, im) * EIGHTH_TURN.conj() * (0.5 / (PI.sqrt() * w))
}

/// Field that passes the edge of a half plane, relative to the free field: `w > 0` lies in the shadow.
pub fn passing(w: f64) -> Complex64 {
    let t = transition(w.abs()) * Complex64::cis(-w * w);
    if w >= 0.0 { t } else { 1.0 - t }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By Simpson's rule of `erfc(z) = 2/sqrt(pi) int exp(-(z + s)^2) ds`, along which nothing oscillates.
    fn by_quadrature(w: f64) -> Complex64 {
        let z = EIGHTH_TURN * w;
        let (steps, top) = (20_000, 8.0);
        let h = top / f64::from(steps);
        let f = |s: f64| (-(2.0 * z * s + s * s)).exp();
        let weight = |i: i32| if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
        (0..=steps).map(|i| f(f64::from(i) * h) * weight(i)).sum::<Complex64>() * (h / 3.0 / PI.sqrt())
    }

    #[test]
    fn the_transition_is_its_integral() {
        for i in 0..200 {
            let w = 0.061 * f64::from(i);
            let (found, expected) = (transition(w), by_quadrature(w));
            assert!((found - expected).norm() < 3e-10 * expected.norm(), "{w}: {found} {expected}");
        }
    }

    #[test]
    fn it_begins_at_one_half() {
        assert!((transition(0.0) - 0.5).norm() < 1e-10);
        let far = EIGHTH_TURN.conj() / (2.0 * PI.sqrt() * 1e3);
        assert!((transition(1e3) / far - 1.0).norm() < 1e-6 && (passing(0.0) - 0.5).norm() < 1e-10);
        assert!((passing(-30.0) - 1.0).norm() < 0.011 && passing(30.0).norm() < 0.011);
    }
}
