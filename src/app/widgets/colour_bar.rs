//! Pictures and their colours: textures, which are uploaded only after a change, and a bar of colours with their values.

use super::axes::{self, Axis, Tick};
use crate::picture::ColourMap;
use eframe::egui::{
    Align2, Color32, ColorImage, Context, Mesh, Painter, Rect, Shape, Stroke, TextureHandle, TextureId, TextureOptions,
    Ui, pos2,
};
use ndarray::ArrayView2;
use std::sync::Arc;

const BAR_WIDTH_POINTS: f32 = 9.0;

/// Gaps between map and colours, and between colours and labels, points.
const BAR_GAPS_POINTS: [f32; 2] = [7.0, 5.0];

/// Margin right of labels and title, points.
const RIGHT_MARGIN_POINTS: f32 = 4.0;

/// Width of the shortest title of a map's axis, points.
const AXIS_TITLE: f32 = 60.0;

pub struct Bar {
    pub table: [Color32; 256],
    pub low: f64,
    pub high: f64,
    /// Quantity, and after a comma its scale.
    pub title: &'static str,
    /// The lowest value with a label: lower ones are no echoes.
    pub told_from: f64,
}

impl Bar {
    /// A bar from `low` to `high` with labels everywhere.
    pub fn new(table: [Color32; 256], low: f64, high: f64, title: &'static str) -> Bar {
        Bar { table, low, high, title, told_from: f64::NEG_INFINITY }
    }

    /// Labels of a bar `height` points high.
    fn labels(&self, height: f32) -> Vec<Tick> {
        let mut labels = self.axis().upwards(height);
        labels.retain(|tick| tick.value >= self.told_from);
        labels
    }

    fn axis(&self) -> Axis<'static> {
        Axis::new(self.low, self.high, self.title)
    }

    pub fn draw(&self, ui: &Ui, painter: &Painter, map: Rect) {
        let left = map.right() + BAR_GAPS_POINTS[0];
        let rect = Rect::from_x_y_ranges(left..=left + BAR_WIDTH_POINTS, map.y_range());
        let mut mesh = Mesh::default();
        let steps = 64;
        for i in 0..=steps {
            let part = i as f32 / steps as f32;
            let y = rect.bottom() - part * rect.height();
            let colour = self.table[(part * 255.0) as usize];
            mesh.colored_vertex(pos2(rect.left(), y), colour);
            mesh.colored_vertex(pos2(rect.right(), y), colour);
            if i > 0 {
                let v = 2 * i as u32;
                mesh.add_triangle(v - 2, v - 1, v);
                mesh.add_triangle(v - 1, v, v + 1);
            }
        }
        painter.add(Shape::mesh(mesh));
        let (ink, axis) = (ui.visuals().weak_text_color(), self.axis());
        for tick in self.labels(rect.height()) {
            let y = rect.bottom() - axis.part(tick.value) * rect.height();
            painter.hline(rect.right()..=rect.right() + 3.0, y, Stroke::new(1.0, ink));
            axes::text(painter, pos2(rect.right() + BAR_GAPS_POINTS[1], y), Align2::LEFT_CENTER, &tick.text, ink);
        }
        let at = pos2(map.right() + axes::RIGHT - RIGHT_MARGIN_POINTS, rect.bottom() + 18.0);
        axes::text(painter, at, Align2::RIGHT_TOP, self.title_for(painter, map.width()), ink);
    }

    /// The title, or its first part where a map of `width` points has no room for more beside its axis' title.
    fn title_for(&self, painter: &Painter, width: f32) -> &'static str {
        let short = self.title.split(',').next().unwrap_or_default();
        axes::fitting(painter, axes::RIGHT - RIGHT_MARGIN_POINTS + (width - AXIS_TITLE) / 2.0, &[self.title, short])
    }

    /// Width of the title's part beneath a map of `width` points.
    pub fn overhang(&self, painter: &Painter, width: f32) -> f32 {
        (axes::width(painter, self.title_for(painter, width)) + BAR_GAPS_POINTS[0]
            - (axes::RIGHT - RIGHT_MARGIN_POINTS))
            .max(0.0)
    }
}

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
