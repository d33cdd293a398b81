//! Colours and spacing of the interface.

use eframe::egui::style::{ScrollFadeStyle, ScrollStyle};
use eframe::egui::{self, Color32, Context, CornerRadius, ThemePreference, Visuals};

/// The colour of the dark or of the light theme.
fn ink(is_dark: bool, dark: [u8; 3], light: [u8; 3]) -> Color32 {
    let [r, g, b] = if is_dark { dark } else { light };
    Color32::from_rgb(r, g, b)
}

/// Colours of the scene and of marks over maps.
#[derive(Debug, Clone, Copy)]
pub struct Inks {
    /// Ground that the radar can see.
    pub ground: Color32,
    /// Ground beyond the radar's view.
    pub beyond: Color32,
    pub grid: Color32,
    pub grid_text: Color32,
    pub reflector: Color32,
    pub selected: Color32,
    /// The array's first and last end.
    pub ends: [Color32; 2],
    pub array: Color32,
    /// Reflectors that a method found.
    pub found: Color32,
}

impl Inks {
    pub fn of(visuals: &Visuals) -> Self {
        let ink = |dark, light| ink(visuals.dark_mode, dark, light);
        Inks {
            ground: ink([24, 28, 36], [252, 253, 255]),
            beyond: ink([14, 16, 20], [226, 230, 237]),
            grid: ink([54, 61, 75], [206, 212, 222]),
            grid_text: ink([140, 150, 168], [92, 102, 120]),
            reflector: ink([236, 240, 248], [30, 38, 52]),
            selected: ink([255, 176, 59], [214, 110, 0]),
            ends: [ink([92, 184, 255], [0, 112, 206]), ink([255, 122, 148], [204, 32, 84])],
            array: ink([140, 150, 168], [92, 102, 120]),
            found: ink([120, 230, 140], [0, 138, 62]),
        }
    }
}

/// Marks over maps: readable on any colour map.
pub const MARK: Color32 = Color32::WHITE;
pub const MARK_SELECTED: Color32 = Color32::from_rgb(255, 176, 59);
pub const MARK_EDGE: Color32 = Color32::from_black_alpha(200);

/// Background and text of captions over maps and scene.
pub const CAPTION: Color32 = Color32::from_rgb(24, 64, 120);
pub const CAPTION_INK: Color32 = Color32::WHITE;

/// Cells below a threshold, and above it.
pub fn mask(dark: bool) -> [Color32; 2] {
    [ink(dark, [18, 22, 30], [252, 253, 255]), ink(dark, [255, 214, 90], [176, 84, 0])]
}

/// Colour of a right or a wrong answer.
pub fn verdict(visuals: &Visuals, is_right: bool) -> Color32 {
    if is_right { ink(visuals.dark_mode, [120, 220, 150], [0, 104, 52]) } else { visuals.warn_fg_color }
}

/// Colour of the ring around the control with the keyboard's focus.
pub fn focus(dark: bool) -> Color32 {
    ink(dark, [120, 190, 255], [0, 92, 200])
}

/// Scroll bars that are always visible, with faded edges of scrolled content.
fn scroll() -> ScrollStyle {
    ScrollStyle {
        floating_width: 4.0,
        floating_allocated_width: 6.0,
        dormant_background_opacity: 0.3,
        dormant_handle_opacity: 0.6,
        fade: ScrollFadeStyle { strength: 0.95, size: 26.0 },
        ..ScrollStyle::floating()
    }
}

/// Sets up both themes and selects `theme`.
pub fn apply(ctx: &Context, theme: ThemePreference) {
    for of in [egui::Theme::Dark, egui::Theme::Light] {
        ctx.style_mut_of(of, |style| {
            style.visuals.widgets.noninteractive.corner_radius = CornerRadius::same(4);
            style.spacing.item_spacing = egui::vec2(6.0, 4.0);
            style.spacing.slider_width = 110.0;
            style.spacing.scroll = scroll();
            let visuals = &mut style.visuals;
            let ink = |dark, light| ink(of == egui::Theme::Dark, dark, light);
            visuals.panel_fill = ink([30, 33, 40], [245, 247, 250]);
            visuals.extreme_bg_color = ink([18, 20, 25], [255; 3]);
            visuals.override_text_color = Some(ink([218, 223, 232], [34, 40, 52]));
            visuals.weak_text_color = Some(ink([172, 180, 194], [78, 88, 106]));
            visuals.error_fg_color = ink([255, 140, 130], [176, 24, 32]);
            visuals.warn_fg_color = ink([255, 190, 92], [140, 78, 0]);
            visuals.hyperlink_color = ink([116, 180, 255], [0, 92, 184]);
            visuals.selection.bg_fill = ink([38, 92, 150], [176, 210, 250]);
            // Boxes that are not ticked, and the rails of sliders.
            visuals.widgets.inactive.bg_fill = ink([104, 112, 128], [138, 146, 160]);
        });
    }
    ctx.set_theme(theme);
}

/// Contrast of two opaque colours as the WCAG defines it, 1 to 21.
#[cfg(test)]
pub fn contrast(a: Color32, b: Color32) -> f32 {
    let luminance = |colour: Color32| {
        let linear = egui::Rgba::from(colour);
        0.2126 * linear.r() + 0.7152 * linear.g() + 0.0722 * linear.b()
    };
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_that_is_not_ticked_is_seen_in_dark_and_light() {
        let ctx = Context::default();
        apply(&ctx, ThemePreference::Dark);
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            let visuals = ctx.style_of(theme).visuals.clone();
            for ground in [visuals.panel_fill, visuals.window_fill] {
                let seen = contrast(visuals.widgets.inactive.bg_fill, ground);
                assert!(seen >= 2.5, "{theme:?}: {seen}");
            }
        }
    }

    #[test]
    fn every_text_is_readable_in_dark_and_light() {
        let ctx = Context::default();
        apply(&ctx, ThemePreference::Dark);
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            let visuals = ctx.style_of(theme).visuals.clone();
            let inks = Inks::of(&visuals);
            let (weak, error) = (visuals.weak_text_color(), visuals.error_fg_color);
            for ground in [visuals.panel_fill, visuals.extreme_bg_color, visuals.window_fill] {
                let verdicts = [true, false].map(|is_right| verdict(&visuals, is_right));
                let others = [visuals.text_color(), weak, error, visuals.warn_fg_color, visuals.hyperlink_color];
                for ink in others.into_iter().chain(verdicts) {
                    let seen = contrast(ink, ground);
                    assert!(seen >= 4.5, "{theme:?}: {ink:?} on {ground:?}: {seen}");
                }
            }
            for ground in [inks.ground, inks.beyond] {
                assert!(contrast(inks.grid_text, ground) >= 4.5, "{theme:?}: the scene's grid");
            }
            assert!(error.r() < 255 || error.g() > 100, "{theme:?}: pure red flickers");
            assert!(contrast(CAPTION_INK, CAPTION) >= 7.0, "captions");
        }
    }
}
