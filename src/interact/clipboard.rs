//! Objects as text: the same TOML as a scene file, so that a copy can be pasted into one.

use crate::radar::Radar;
use crate::scene::{Object, Scene, SceneError};

/// A reason for which text can't be pasted.
#[derive(Debug, thiserror::Error)]
pub enum PasteError {
    #[error(
        "the clipboard holds no objects: {0}; expected TOML such as [[object]] kind = \"point\" x_metres = 0.0 y_metres = 10.0"
    )]
    Toml(String),
    #[error("the clipboard holds a scene without objects")]
    Empty,
    #[error("the clipboard's {0}")]
    Scene(#[from] SceneError),
}

pub fn to_text(objects: Vec<Object>) -> String {
    toml::to_string(&Scene { objects, ..Scene::default() }).unwrap_or_default()
}

/// The objects in `text`.
/// # Errors
/// [`PasteError`] says what is wrong with the text.
pub fn from_text(text: &str, radar: &Radar) -> Result<Vec<Object>, PasteError> {
    let scene: Scene = toml::from_str(text).map_err(|e| PasteError::Toml(e.message().to_owned()))?;
    if scene.objects.is_empty() {
        return Err(PasteError::Empty);
    }
    scene.validate(radar)?;
    Ok(scene.objects)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_text_is_told() {
        let radar = Radar::default();
        for (text, part) in [
            ("hello", "holds no objects"),
            ("", "without objects"),
            ("[[object]]\nkind = \"point\"\nx_metres = nan\ny_metres = 1.0", "x_metres"),
        ] {
            let message = from_text(text, &radar).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
