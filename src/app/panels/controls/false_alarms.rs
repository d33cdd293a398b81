//! Choice of the output's threshold by its rate of false alarms.

use crate::app::state::{Command, WorkCommand};
use crate::app::widgets::{
    NumberField, bar, kind_boxes, kind_names, labelled, rarely, row, row_of, start_or_cancel, ticking_menu,
};
use crate::evaluate::threshold::ThresholdSearch;
use crate::radar::counted;
use crate::scene::generate::Kind;
use eframe::egui::{Label, RichText, Ui};

/// State of the threshold search.
#[derive(Debug, Clone, Copy, Default)]
pub struct Search<'a> {
    /// Completed part of the search, 0 to 1, while it runs.
    pub progress: Option<f32>,
    /// Message of the last search, where it did not succeed.
    pub note: Option<&'a str>,
}

/// Tooltip of the rate: its meaning, and the condition under which it holds.
const KEEP: &str = "Part of the target's dark cells that may exceed η, on average over further scenes. Condition: these scenes are exchangeable \
    with the validation scenes that η was tried on, that is, drawn alike, of the same kinds, with the same radar, floor and normalisation. In a \
    single scene P_FA may be higher.";

/// The reason why no search can begin, if there is one.
fn problem(chosen: &ThresholdSearch) -> Option<String> {
    match chosen.kinds.is_empty() {
        true => Some("Choose scenes first.".to_owned()),
        false => chosen.check().err().map(|error| error.to_string()),
    }
}

/// Tooltip of the number of scenes, with the P_FA that remains on them where they are enough.
fn price(chosen: &ThresholdSearch) -> String {
    let scenes = chosen.count as usize * chosen.kinds.len();
    let price = chosen.check().is_ok().then(|| format!(": {}", chosen.told_left(scenes)));
    format!("Scenes of each kind. More scenes give a lower η{}", price.unwrap_or_default())
}

/// Draws the fields and the button, folded away at first.
pub fn show(ui: &mut Ui, method: &str, search: &Search<'_>, chosen: &mut ThresholdSearch, asked: &mut Vec<Command>) {
    rarely(ui, "η by false alarms", |ui| {
        ui.add_enabled_ui(search.progress.is_none(), |ui| choose(ui, chosen));
        row_of(ui, "", "", |ui| start(ui, method, search, chosen, asked));
        let told = match (search.progress, problem(chosen)) {
            (None, Some(problem)) => Some(problem),
            (None, None) => search.note.map(str::to_owned),
            (Some(_), _) => None,
        };
        if let Some(told) = told {
            ui.add(Label::new(RichText::new(told).color(ui.visuals().warn_fg_color)).wrap());
        }
    });
}

fn choose(ui: &mut Ui, chosen: &mut ThresholdSearch) {
    row(ui, "Keep below", KEEP, |ui| {
        ui.add(NumberField::new(&mut chosen.false_alarm_percent).range(0.01..=50.0).speed(0.02).suffix(" %"))
    });
    row_of(ui, "Tried on", "Validation scenes, which no figure is reported of", |ui| {
        let menu = ticking_menu(ui, &format!("Kinds: {}", kind_names(&chosen.kinds, None)), |ui| {
            kind_boxes(ui, Kind::all().filter(|kind| *kind != Kind::Noise), &mut chosen.kinds);
        });
        menu.on_hover_text("Kinds of scenes that the method is tried on: choose those that it is to be used on");
        let tip = price(chosen);
        labelled(ui, "of each", &tip, NumberField::new(&mut chosen.count).range(1..=100_000));
    });
}

/// Draws the button Find η, or Cancel while a search runs.
fn start(ui: &mut Ui, method: &str, search: &Search<'_>, chosen: &ThresholdSearch, asked: &mut Vec<Command>) {
    let problem = problem(chosen);
    let scenes = counted(chosen.count as usize * chosen.kinds.len(), "validation scene", "validation scenes");
    let tip = format!(
        "Try {method} on {scenes} in the background, with the radar, floor and normalisation in use, and set its η to the lowest that keeps \
         the rate (conformal risk control). {KEEP}"
    );
    let tips = [problem.as_deref().unwrap_or(&tip), "Stop the search; η stays as it is"];
    let button = ("Find η", WorkCommand::CancelThreshold);
    if start_or_cancel(ui, button, search.progress.is_some(), problem.is_none(), tips, asked) {
        asked.push(WorkCommand::FindThreshold(Box::new(chosen.clone())).into());
    }
    bar(ui, search.progress, 100.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, User};
    use eframe::egui::Vec2;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// The drawn search, the fields, and the returned commands.
    struct Drawn {
        search: Search<'static>,
        chosen: ThresholdSearch,
        asked: Vec<Command>,
    }

    fn fields(chosen: ThresholdSearch) -> Harness<'static, Drawn> {
        let draw = |ui: &mut Ui, drawn: &mut Drawn| {
            show(ui, "capon", &drawn.search, &mut drawn.chosen, &mut drawn.asked);
        };
        let drawn = Drawn { search: Search::default(), chosen, asked: Vec::new() };
        let mut fields = Harness::builder().with_size(Vec2::new(300.0, 400.0)).build_ui_state(draw, drawn);
        fields.clicks(&["η by false alarms"]);
        fields
    }

    #[test]
    fn the_search_is_one_command() {
        let mut fields = fields(ThresholdSearch { false_alarm_percent: 0.5, count: 80, ..ThresholdSearch::default() });
        seen::assert_readable(fields.output());
        fields.clicks(&["Find η"]);
        let search = fields.state().chosen.clone();
        assert_eq!(fields.state().asked, [WorkCommand::FindThreshold(Box::new(search)).into()]);
    }

    #[test]
    fn the_condition_stands_beside_the_rate() {
        let mut fields = fields(ThresholdSearch::default());
        fields.get_by_label("Keep below").hover();
        fields.run_steps(40);
        let told = fields.query_by_label_contains("exchangeable with the validation scenes");
        assert!(told.is_some());
    }

    #[test]
    fn the_price_of_few_scenes_stands_beside_their_number() {
        let price = super::price(&ThresholdSearch::default());
        assert!(price.contains("P_FA on 300 scenes may be 0.670 %") && price.contains("from 990 scenes on"), "{price}");
        let too_few = super::price(&ThresholdSearch { count: 20, ..ThresholdSearch::default() });
        assert!(too_few.ends_with("give a lower η"), "{too_few}");
    }

    #[test]
    fn a_search_tells_why_it_does_not_begin_or_succeed() {
        type Case = (u32, fn(&mut Drawn), &'static str);
        let cases: [Case; 3] = [
            (20, |_| (), "60 scenes can't keep a rate of 1 %; take 99 scenes or more"),
            (33, |drawn| drawn.search.note = Some("no threshold keeps 1 %"), "no threshold keeps 1 %"),
            (33, |drawn| drawn.chosen.kinds.clear(), "Choose scenes first."),
        ];
        for (count, change, told) in cases {
            let mut fields = fields(ThresholdSearch { count, ..ThresholdSearch::default() });
            change(fields.state_mut());
            fields.run();
            let _told = fields.get_by_label(told);
            fields.clicks(&["Find η"]);
            assert_eq!(fields.state().asked.is_empty(), fields.state().search.note.is_none(), "{told}");
        }
    }
}
