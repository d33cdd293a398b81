//! A ring around the control with the keyboard's focus, alike for all controls.

use super::theme::focus;
use eframe::egui::{Context, LayerId, Rect, Stroke, StrokeKind};

/// Layer and rectangle of the control with the focus; `None` where none has it or it is out of sight.
pub fn place(ctx: &Context) -> Option<(LayerId, Rect)> {
    let id = ctx.memory(|m| m.focused())?;
    // A control that went with its dialog keeps the focus for a pass.
    let is_drawn = ctx.viewport(|viewport| viewport.this_pass.widgets.contains(id));
    let response = ctx.read_response(id).filter(|_| is_drawn)?;
    Some((response.layer_id, response.interact_rect)).filter(|(_, rect)| rect.is_positive())
}

/// Draws the ring over the earlier content of the same layer.
pub fn draw(ctx: &Context) {
    let Some((layer, rect)) = place(ctx) else { return };
    let stroke = Stroke::new(2.0, focus(ctx.style_of(ctx.theme()).visuals.dark_mode));
    // Inside the window, even around a control at its edge.
    let around = rect.expand(1.5).intersect(ctx.content_rect().shrink(1.0));
    ctx.layer_painter(layer).rect_stroke(around, 3.0, stroke, StrokeKind::Middle);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use eframe::egui::{self, Key, Shape};

    fn rings<S>(harness: &Harness<'_, S>) -> Vec<Rect> {
        let shapes = harness.output().shapes.iter().filter_map(|s| match &s.shape {
            Shape::Rect(r) if [true, false].map(focus).contains(&r.stroke.color) => Some(r.rect),
            _ => None,
        });
        shapes.collect()
    }

    #[test]
    fn the_ring_goes_away_with_its_control() {
        let mut panel = Harness::new_ui_state(
            |ui, is_there: &mut bool| {
                if *is_there {
                    _ = ui.button("one");
                }
                draw(ui.ctx());
            },
            true,
        );
        panel.presses(&[Key::Tab]);
        assert_eq!(rings(&panel).len(), 1);
        *panel.state_mut() = false;
        panel.step();
        assert!(rings(&panel).is_empty(), "in the first pass without it");
    }

    #[test]
    fn the_ring_goes_with_the_focus_to_every_kind_of_control() {
        let mut number = 1.0;
        let mut panel = Harness::new_ui(move |ui| {
            _ = ui.button("one");
            ui.add(egui::DragValue::new(&mut number).prefix("two "));
            _ = ui.selectable_label(false, "three");
            draw(ui.ctx());
        });
        panel.run();
        assert!(rings(&panel).is_empty(), "nothing has the focus");
        let mut seen = Vec::new();
        for _ in 0..3 {
            panel.presses(&[Key::Tab]);
            let rings = rings(&panel);
            assert_eq!(rings.len(), 1);
            seen.push(rings[0]);
        }
        for (ring, name) in [(seen[0], "one"), (seen[2], "three")] {
            let control = panel.get_by_label(name).rect();
            assert!(ring.contains_rect(control) && ring.width() < control.width() + 8.0, "{ring} around {control}");
        }
        assert!(seen[1].top() > seen[0].bottom() - 4.0 && seen[1].bottom() < seen[2].top() + 4.0);
    }
}
