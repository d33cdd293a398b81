//! The thesis author's scene archives: `all_point_x` and `all_point_y`, one number a reflector, in metres.

use super::{MAX_REFLECTORS, Object, Scene};
use crate::files::npz::{Npz, NpzError, NpzOutput, write_npz};
use ndarray::{Array1, Ix1};
use std::path::Path;

/// Key of the reflectors' x in metres, f64 `[L]`.
pub const X_KEY: &str = "all_point_x";
/// Key of the reflectors' y in metres, f64 `[L]`.
pub const Y_KEY: &str = "all_point_y";

/// Most bytes of either array: [`MAX_REFLECTORS`] numbers of f64 and the longest header.
const MAX_ARRAY_BYTES: u64 = 8 * MAX_REFLECTORS as u64 + 1024;

/// Reads the reflectors of an archive as points of reflectivity 1; other arrays in it are left alone.
/// # Errors
/// [`NpzError`] when a key is missing, is not one row of finite numbers, or the two differ in length.
pub fn read(path: &Path) -> Result<Scene, NpzError> {
    let mut npz = Npz::open(path)?.at_most(MAX_ARRAY_BYTES);
    let (x, y) = (npz.reals::<Ix1>(X_KEY)?, npz.reals::<Ix1>(Y_KEY)?);
    if x.len() != y.len() {
        return Err(NpzError::Shape {
            key: Y_KEY.to_owned(),
            found: format!("[{}]", y.len()),
            expected: format!("[{}] as {X_KEY} has", x.len()),
        });
    }
    Ok(Scene::of_points(x.into_iter().zip(y)))
}

/// Writes the reflectors' positions, and the echoes of bodies at the array's middle as points; all else of a scene is lost.
/// # Errors
/// [`NpzError::Io`] when the file can't be written.
pub fn write(path: &Path, scene: &Scene) -> Result<(), NpzError> {
    write_npz(path, |out| add_positions(out, scene))
}

/// Adds the two position arrays to an archive that holds more.
/// # Errors
/// [`NpzError::Io`] when the file can't be written.
pub fn add_positions(out: &mut NpzOutput, scene: &Scene) -> Result<(), NpzError> {
    let places = |object: &Object| match object.body() {
        Some(body) => body.echo_places_metres([0.0, 0.0]),
        None => object.reflectors().iter().map(|r| [r.x_metres, r.y_metres]).collect(),
    };
    let places: Vec<[f64; 2]> = scene.objects.iter().flat_map(places).collect();
    out.add(X_KEY, &places.iter().map(|p| p[0]).collect::<Array1<f64>>())?;
    out.add(Y_KEY, &places.iter().map(|p| p[1]).collect::<Array1<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn lengths_must_agree() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.npz");
        write_npz(&path, |out| {
            out.add(X_KEY, &array![1.0, 2.0])?;
            out.add(Y_KEY, &array![1.0])
        })
        .unwrap();
        let message = read(&path).unwrap_err().to_string();
        assert!(message.contains("all_point_y") && message.contains("[1]") && message.contains("[2]"), "{message}");
    }
}
