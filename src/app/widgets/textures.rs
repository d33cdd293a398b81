//! Textures on the graphics card, uploaded only after a change.

use crate::picture::ColourMap;
use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use ndarray::ArrayView2;
use std::sync::Arc;

/// A picture and its texture on the graphics card, once uploaded.
#[derive(Default)]
pub struct Texture(Option<(Arc<ColorImage>, TextureHandle)>);

impl Texture {
    /// The texture of `image`, which is uploaded unless it is the same `Arc` as before.
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

/// Lambda as a picture, `cells[[0, 0]]` at its upper left.
pub fn picture(cells: ArrayView2<'_, f32>, colours: ColourMap) -> Arc<ColorImage> {
    let table = colour_table(colours);
    let pixels = cells.iter().map(|v| table[(v.clamp(0.0, 1.0) * 255.0) as usize]).collect();
    Arc::new(ColorImage::new([cells.ncols(), cells.nrows()], pixels))
}

/// The table of a colour map in egui's colours.
pub fn colour_table(colours: ColourMap) -> [Color32; 256] {
    colours.table().map(|[r, g, b]| Color32::from_rgb(r, g, b))
}
