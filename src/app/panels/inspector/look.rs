//! Names, units and ranges of the fields of objects.

use crate::app::widgets::Quantity;
use crate::interact::Field;

/// Name, tooltip, unit and range of a field.
pub fn look(field: Field) -> Quantity {
    let metres = Quantity::metres;
    let spread = |name| metres(name, "Standard deviation").with(" m", [0.0, 1e4], 0.02, 3);
    let degrees = |name, tooltip| metres(name, tooltip).with("°", [-360.0, 360.0], 0.5, 2);
    let velocity = |name, tooltip| metres(name, tooltip).with(" m/s", [-1e3, 1e3], 0.05, 2);
    match field {
        Field::X => metres("x", "Along the array; a line's first reflector, a cluster's centre"),
        Field::Y => metres("y", "Ahead of the array; a line's first reflector, a cluster's centre"),
        Field::Range => {
            let tooltip = "From the middle of the array; the direction stays";
            metres("range", tooltip).with(" m", [1e-3, 1e4], 0.02, 3)
        }
        Field::CosTheta => {
            let tooltip = "Of the angle to the array's axis: the range stays";
            metres("cos θ", tooltip).with("", [-1.0, 1.0], 0.002, 4)
        }
        Field::AngleDegrees => {
            let tooltip = "0° straight ahead, positive to the right, beyond ±90° behind the array";
            metres("angle", tooltip).with("°", [-180.0, 180.0], 0.5, 2)
        }
        Field::Spacing => metres("spacing", "Between neighbours").with(" m", [1e-3, 100.0], 0.001, 4),
        Field::Direction => degrees(
            "direction",
            "Where the line leads from its first reflector: 0° straight ahead, 90° along the array to the right",
        ),
        Field::SpreadX => spread("spread in x"),
        Field::SpreadY => spread("spread in y"),
        Field::Length | Field::Width | Field::Angle | Field::Radius | Field::Roughness => look_of_body(field),
        Field::Count => metres("count", "Number of reflectors").with("", [1.0, 10_000.0], 0.2, 0),
        Field::Seed => {
            let tooltip = "Another seed scatters the reflectors, or roughens the surface, otherwise";
            metres("seed", tooltip).with("", [0.0, u64::MAX as f64], 0.05, 0)
        }
        Field::VelocityX => velocity("velocity in x", "Along the array, to the right; metres a second"),
        Field::VelocityY => velocity("velocity in y", "Away from the array; metres a second"),
        Field::CrossSection => {
            let tooltip = "The reflectivity as radar cross section of each reflector: σ 1 is 1 m², 0 dBsm";
            metres("cross section", tooltip).with(" dBsm", [-300.0, 200.0], 0.1, 1)
        }
        Field::Reflectivity => {
            let tooltip = "σ of each reflector, the thesis uses 1; the reflection coefficient of a body, 1 for metal";
            metres("reflectivity", tooltip).with("", [-1e6, 1e6], 0.01, 3)
        }
    }
}

/// The same for the fields of bodies.
fn look_of_body(field: Field) -> Quantity {
    let of = |name, tooltip| Quantity::metres(name, tooltip);
    match field {
        Field::Length => of("length", "Of the wall or the box, metres").with(" m", [1e-3, 1e4], 0.02, 3),
        Field::Width => of("width", "Of the box, across its length").with(" m", [1e-3, 1e4], 0.02, 3),
        Field::Angle => {
            let tooltip = "From the array's axis to the right, counter-clockwise";
            of("angle of the length", tooltip).with("°", [-360.0, 360.0], 0.5, 2)
        }
        Field::Radius => of("radius", "Of the post").with(" m", [0.01, 100.0], 0.005, 3),
        _ => {
            let tooltip = "Standard deviation of the surface's height: 0 is smooth, 1 mm takes 11 dB from a glint";
            of("roughness", tooltip).with(" mm", [0.0, 100.0], 0.01, 3)
        }
    }
}
