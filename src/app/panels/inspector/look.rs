//! How the numbers of objects are called, and within which bounds they are dragged.

use crate::interact::Field;

/// How a number is shown and edited.
pub struct Look {
    pub name: &'static str,
    pub tooltip: &'static str,
    pub unit: &'static str,
    pub speed: f64,
    pub low: f64,
    pub high: f64,
    pub digits: usize,
}

/// How the number of a field is shown.
pub fn look(field: Field) -> Look {
    let metres = |name, tooltip| Look { name, tooltip, unit: " m", speed: 0.02, low: -1e4, high: 1e4, digits: 3 };
    let spread = |name| Look { low: 0.0, ..metres(name, "Standard deviation") };
    let degrees =
        |name, tooltip| Look { unit: "°", speed: 0.5, low: -360.0, high: 360.0, digits: 2, ..metres(name, tooltip) };
    let plain = |name, tooltip| Look { unit: "", ..metres(name, tooltip) };
    let velocity =
        |name, tooltip| Look { unit: " m/s", speed: 0.05, low: -1e3, high: 1e3, digits: 2, ..metres(name, tooltip) };
    let whole = |name, tooltip| Look { digits: 0, speed: 0.2, ..plain(name, tooltip) };
    match field {
        Field::X => metres("x", "Along the array; a line's first reflector, a cluster's centre"),
        Field::Y => metres("y", "Ahead of the array; a line's first reflector, a cluster's centre"),
        Field::Range => Look { low: 1e-3, ..metres("range", "From the middle of the array; the direction stays") },
        Field::CosTheta => Look {
            speed: 0.002,
            low: -1.0,
            high: 1.0,
            digits: 4,
            ..plain("cos θ", "Of the angle to the array's axis: the range stays")
        },
        Field::AngleDegrees => Look {
            low: -180.0,
            high: 180.0,
            ..degrees("angle", "0° straight ahead, positive to the right, beyond ±90° behind the array")
        },
        Field::Spacing => {
            Look { speed: 0.001, low: 1e-3, high: 100.0, digits: 4, ..metres("spacing", "Between neighbours") }
        }
        Field::Direction => degrees(
            "direction",
            "Where the line leads from its first reflector: 0° straight ahead, 90° along the array to the right",
        ),
        Field::SpreadX => spread("spread in x"),
        Field::SpreadY => spread("spread in y"),
        Field::Length | Field::Width | Field::Angle | Field::Radius | Field::Roughness => {
            look_of_body(field, metres, degrees)
        }
        Field::Count => Look { low: 1.0, high: 10_000.0, ..whole("count", "Number of reflectors") },
        Field::Seed => Look {
            speed: 0.05,
            low: 0.0,
            high: u64::MAX as f64,
            ..whole("seed", "Another seed scatters the reflectors, or roughens the surface, otherwise")
        },
        Field::VelocityX => velocity("velocity in x", "Along the array, to the right; metres a second"),
        Field::VelocityY => velocity("velocity in y", "Away from the array; metres a second"),
        Field::CrossSection | Field::Reflectivity => look_of_strength(field, plain),
    }
}

/// The same for how much is reflected.
fn look_of_strength(field: Field, plain: impl Fn(&'static str, &'static str) -> Look) -> Look {
    match field {
        Field::CrossSection => Look {
            unit: " dBsm",
            speed: 0.1,
            low: -300.0,
            high: 200.0,
            digits: 1,
            ..plain("cross section", "The reflectivity as radar cross section of each reflector: σ 1 is 1 m², 0 dBsm")
        },
        _ => Look {
            speed: 0.01,
            low: -1e6,
            high: 1e6,
            ..plain(
                "reflectivity",
                "σ of each reflector, the thesis uses 1; the reflection coefficient of a body, 1 for metal",
            )
        },
    }
}

/// The same for the numbers of bodies.
fn look_of_body(
    field: Field,
    metres: impl Fn(&'static str, &'static str) -> Look,
    degrees: impl Fn(&'static str, &'static str) -> Look,
) -> Look {
    match field {
        Field::Length => Look { low: 1e-3, ..metres("length", "Of the wall or the box, metres") },
        Field::Width => Look { low: 1e-3, ..metres("width", "Of the box, across its length") },
        Field::Angle => degrees("angle of the length", "From the array's axis to the right, counter-clockwise"),
        Field::Radius => Look { low: 0.01, high: 100.0, speed: 0.005, ..metres("radius", "Of the post") },
        _ => Look {
            unit: " mm",
            speed: 0.01,
            low: 0.0,
            high: 100.0,
            ..metres(
                "roughness",
                "Standard deviation of the surface's height: 0 is smooth, 1 mm takes 11 dB from a glint",
            )
        },
    }
}
