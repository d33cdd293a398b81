//! Text of pictures in the program's own fonts, measured and drawn the same on every system. In a browser's workers plotters has no fonts.

use super::canvas::PictureError;
use ab_glyph::{Font, FontRef, ScaleFont};
use plotters::backend::DrawingBackend;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind, FontFamily, FontStyle, FontTransform,
    text_anchor,
};
use std::convert::Infallible;

pub(super) const NORMAL: &[u8] = include_bytes!("../../../assets/fonts/DejaVuSans.ttf");
pub(super) const BOLD: &[u8] = include_bytes!("../../../assets/fonts/DejaVuSans-Bold.ttf");

/// A size of text over that of its em square.
const SIZE_OVER_EM: f64 = 1.24;

/// A backend whose text is set in the program's own fonts.
pub(super) struct Lettered<B> {
    backend: B,
    fonts: [FontRef<'static>; 2],
}

impl<B: DrawingBackend> Lettered<B> {
    /// `backend` with the fonts.
    pub fn new(backend: B) -> Result<Self, PictureError> {
        let font = |bytes| FontRef::try_from_slice(bytes).map_err(|_| PictureError::new("the embedded font is broken"));
        Ok(Lettered { backend, fonts: [font(NORMAL)?, font(BOLD)?] })
    }

    fn font(&self, style: FontStyle) -> FontRef<'static> {
        self.fonts[usize::from(matches!(style, FontStyle::Bold))].clone()
    }
}

/// A style with the font that it is drawn in.
struct Lettering<'a, S> {
    style: &'a S,
    font: FontRef<'static>,
}

impl<S: BackendTextStyle> Lettering<'_, S> {
    /// The glyphs of a line, each with its distance from the line's start in pixels, and the length of the line.
    fn glyphs(&self, text: &str) -> (Vec<(char, f32)>, f32) {
        let font = self.font.as_scaled(self.style.size() as f32);
        let (mut glyphs, mut x, mut last) = (Vec::new(), 0.0, None);
        for letter in text.chars() {
            let glyph = font.glyph_id(letter);
            x += last.map_or(0.0, |last| font.kern(last, glyph));
            glyphs.push((letter, x));
            x += font.h_advance(glyph);
            last = Some(glyph);
        }
        (glyphs, x)
    }
}

impl<S: BackendTextStyle> BackendTextStyle for Lettering<'_, S> {
    type FontError = Infallible;

    fn color(&self) -> BackendColor {
        self.style.color()
    }

    fn size(&self) -> f64 {
        self.style.size()
    }

    fn transform(&self) -> FontTransform {
        self.style.transform()
    }

    fn style(&self) -> FontStyle {
        self.style.style()
    }

    fn anchor(&self) -> text_anchor::Pos {
        self.style.anchor()
    }

    fn family(&self) -> FontFamily<'_> {
        self.style.family()
    }

    fn layout_box(&self, text: &str) -> Result<((i32, i32), (i32, i32)), Infallible> {
        Ok(((0, 0), (self.glyphs(text).1 as i32, (self.size() / SIZE_OVER_EM) as i32)))
    }

    fn draw<E, F: FnMut(i32, i32, BackendColor) -> Result<(), E>>(
        &self,
        text: &str,
        (left, top): BackendCoord,
        mut draw: F,
    ) -> Result<Result<(), E>, Infallible> {
        let font = self.font.as_scaled(self.size() as f32);
        let colour = self.color();
        for (letter, start) in self.glyphs(text).0 {
            let Some(outline) = font.outline_glyph(font.scaled_glyph(letter)) else { continue };
            let lowered = (self.size() as f32 / 2.0 + outline.px_bounds().min.y) as i32;
            let mut told = Ok(());
            outline.draw(|x, y, covered| {
                if told.is_ok() && covered > 0.0 {
                    let colour = BackendColor { alpha: colour.alpha * f64::from(covered), ..colour };
                    told = draw(left + start as i32 + x as i32, top + lowered + y as i32, colour);
                }
            });
            if told.is_err() {
                return Ok(told);
            }
        }
        Ok(Ok(()))
    }
}

type Drawn<B, T = ()> = Result<T, DrawingErrorKind<<B as DrawingBackend>::ErrorType>>;

impl<B: DrawingBackend> DrawingBackend for Lettered<B> {
    type ErrorType = B::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.backend.get_size()
    }

    fn ensure_prepared(&mut self) -> Drawn<B> {
        self.backend.ensure_prepared()
    }

    fn present(&mut self) -> Drawn<B> {
        self.backend.present()
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> Drawn<B> {
        self.backend.draw_pixel(at, colour)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn<B> {
        self.backend.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S, fill: bool) -> Drawn<B> {
        self.backend.draw_rect(from, to, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn<B> {
        self.backend.draw_path(path, style)
    }

    fn draw_circle<S: BackendStyle>(&mut self, centre: BackendCoord, radius: u32, style: &S, fill: bool) -> Drawn<B> {
        self.backend.draw_circle(centre, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn<B> {
        self.backend.fill_polygon(path, style)
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn<B> {
        let font = self.font(style.style());
        self.backend.draw_text(text, &Lettering { style, font }, at)
    }

    fn estimate_text_size<S: BackendTextStyle>(&self, text: &str, style: &S) -> Drawn<B, (u32, u32)> {
        self.backend.estimate_text_size(text, &Lettering { style, font: self.font(style.style()) })
    }

    fn blit_bitmap(&mut self, at: BackendCoord, size: (u32, u32), pixels: &[u8]) -> Drawn<B> {
        self.backend.blit_bitmap(at, size, pixels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::prelude::*;

    #[test]
    fn text_of_pictures_is_as_that_of_charts() {
        super::super::text::register_fonts().unwrap();
        let style = super::super::text::style(28, super::super::text::Weight::Normal, &BLACK);
        let text = "Range bin 12.5 m, AV";
        let drawn = |is_own: bool| {
            let mut pixels = vec![255; 400 * 60 * 3];
            let backend = BitMapBackend::with_buffer(&mut pixels, (400, 60));
            let size = if is_own {
                let area = Lettered::new(backend).unwrap().into_drawing_area();
                area.draw(&Text::new(text, (4, 4), style.clone())).unwrap();
                area.estimate_text_size(text, &style).unwrap()
            } else {
                let area = backend.into_drawing_area();
                area.draw(&Text::new(text, (4, 4), style.clone())).unwrap();
                area.estimate_text_size(text, &style).unwrap()
            };
            (pixels, size)
        };
        let (own, others) = (drawn(true), drawn(false));
        assert!(own.0.iter().any(|v| *v < 64), "text is there");
        assert_eq!(own.1, others.1);
        let unlike = own.0.iter().zip(&others.0).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert_eq!(unlike, 0, "{unlike} values differ");
    }
}
