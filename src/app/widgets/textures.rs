//! Pictures on the graphics card: sent there only when they changed.

use crate::picture::ColourMap;
use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use std::sync::Arc;

/// A picture that was sent to the graphics card, if one was.
#[derive(Default)]
pub struct Texture(Option<(Arc<ColorImage>, TextureHandle)>);

impl Texture {
    /// The texture of `image`, which is sent only where it isn't the one that is there.
    pub fn of(&mut self, ctx: &Context, name: &str, image: &Arc<ColorImage>, options: TextureOptions) -> TextureId {
        match &mut self.0 {
            Some((shown, handle)) => {
                if !Arc::ptr_eq(shown, image) {
                    handle.set(image.clone(), options);
                    *shown = image.clone();
                }
                handle.id()
            }
            none => none.insert((image.clone(), ctx.load_texture(name, image.clone(), options))).1.id(),
        }
    }
}

/// The table of a colour map as egui's colours.
pub fn colour_table(colours: ColourMap) -> [Color32; 256] {
    colours.table().map(|[r, g, b]| Color32::from_rgb(r, g, b))
}
