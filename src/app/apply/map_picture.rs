//! A map's picture for the clipboard.

use crate::app::jobs::Jobs;
use crate::app::state::{MapKind, Panel, State};
use eframe::egui::{ColorImage, Context};

/// Most pixels of a picture for the clipboard. The clipboard holds several copies of it.
const MAX_PIXELS: usize = 1 << 24;

/// Copies the picture of a map to the clipboard. Returns the message for the user.
///
/// # Errors
/// The message where there is no picture.
pub fn copy(ctx: &Context, state: &State, jobs: &Jobs, kind: MapKind) -> Result<String, String> {
    let title = kind.title();
    let image = picture(state, jobs, kind).map_err(|error| format!("{title} was not copied: {error}"))?;
    let [width, height] = image.size;
    ctx.copy_image(image);
    Ok(format!("Copied {title}, {width} × {height} pixels."))
}

/// The whole map's picture with a pixel per cell, the farthest range on top as on screen.
fn picture(state: &State, jobs: &Jobs, kind: MapKind) -> Result<ColorImage, String> {
    if state.is_predicting() {
        return Err("it is hidden until you have predicted".to_owned());
    }
    let painted = jobs.pipeline.maps.result().and_then(|r| r.pictures.get(&kind));
    let Some(picture) = painted.filter(|_| state.arrangement.shown().contains(&Panel::Map(kind))) else {
        return Err("bring it into sight first".to_owned());
    };
    upright(&picture.image)
}

/// The image with its rows in reverse order.
fn upright(image: &ColorImage) -> Result<ColorImage, String> {
    let [width, height] = image.size;
    if image.pixels.len() > MAX_PIXELS {
        return Err(format!(
            "{width} × {height} pixels are more than the {MAX_PIXELS} that fit the clipboard; export the maps"
        ));
    }
    let rows = image.pixels.chunks_exact(width.max(1)).rev();
    Ok(ColorImage::new(image.size, rows.flatten().copied().collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Color32;

    #[test]
    fn a_picture_hangs_upright_or_is_refused_as_too_large() {
        let pixels = [Color32::RED, Color32::GREEN, Color32::BLUE, Color32::WHITE].to_vec();
        let image = upright(&ColorImage::new([2, 2], pixels)).unwrap();
        assert_eq!(image.pixels, [Color32::BLUE, Color32::WHITE, Color32::RED, Color32::GREEN]);
        let error = upright(&ColorImage::filled([4097, 4096], Color32::RED)).unwrap_err();
        assert!(error.contains("4097 × 4096"), "{error}");
    }
}
