//! The page that shows all figures beside one another, with the tables.

use super::Figure;
use crate::evaluate::campaign::{Campaign, CampaignError};
use crate::evaluate::sets::SceneSet;
use crate::evaluate::tables::{PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed, Tally};
use crate::radar::Radar;
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use crate::task::Task;
use std::fmt::Write;

/// Methods of the tables, each beside the column the thesis prints for it.
pub const TABLE_METHODS: [(&str, Option<[Printed; 3]>); 5] = [
    ("baseline", Some(PRINTED_BASELINE)),
    ("thesis-1", Some(PRINTED_EXPERIMENT_1)),
    ("thesis", Some(PRINTED_EXPERIMENT_2)),
    ("live", None),
    ("hybrid", None),
];

/// Markdown for one figure; its picture is expected at `folder/NUMBER.png`.
pub fn entry(figure: &Figure, folder: &str) -> String {
    let Figure { number, shows, differs, sheet } = figure;
    let kept = if sheet.is_none() { " Kept as drawn." } else { "" };
    format!(
        "### Figure {number}\n\n![{shows}]({folder}/{number}.png)\n\n{shows}\n\n*Beside the printed one:* {differs}{kept}\n\n"
    )
}

/// Tables 4.1 to 4.3 as Markdown: `methods` over `scenes` test scenes a set, seed 0, beside the printed values.
/// # Errors
/// [`CampaignError`] when a method fails.
pub fn tables(methods: &[&dyn Reconstructor], scenes: u32) -> Result<String, CampaignError> {
    let campaign = Campaign { count: scenes, ..Campaign::default() };
    let mut text = String::from("## Tables 4.1 to 4.3\n\n");
    let _ = writeln!(text, "{scenes} test scenes a set, seed 0; P_D and P_FA at each method's own threshold.");
    let weights = weights(methods, &campaign.radar);
    let _ = writeln!(text, "Tables and figures are made over the thesis' floor, with {weights}.\n");
    let sets = Kind::TEST_SETS.map(SceneSet::Generated);
    let rows = campaign.run(&sets, methods, &Task::default(), |_| ())?;
    for (set, scenes) in sets.iter().enumerate() {
        let scenes = scenes.to_string();
        let _ = writeln!(text, "**Set {}**\n\n| | SE | P_D % | P_FA % |\n|---|---|---|---|", set + 1);
        for name in methods.iter().map(|m| m.name()) {
            let tally = Tally::of(rows.iter().filter(|row| row.method == name && *row.set == *scenes));
            if let Some((_, Some(printed))) = TABLE_METHODS.iter().find(|(n, _)| *n == name) {
                let Printed { squared_error, detection, false_alarm } = printed[set];
                let (detection, false_alarm) = (100.0 * detection, 100.0 * false_alarm);
                let _ = writeln!(text, "| {name}, printed | {squared_error:.0} | {detection:.2} | {false_alarm:.2} |");
            }
            let _ = writeln!(text, "| {name} | {} |", cells(&tally));
        }
        text.push('\n');
    }
    Ok(text)
}

fn weights(methods: &[&dyn Reconstructor], radar: &Radar) -> String {
    let named = methods.iter().filter_map(|m| Some(format!("`{}` {}", m.name(), m.weights(radar)?.sha256)));
    let named: Vec<String> = named.collect();
    if named.is_empty() { "no weights".to_owned() } else { format!("the weights {}", named.join(", ")) }
}

fn cells(tally: &Tally) -> String {
    let error = tally.squared_error();
    let [detection, false_alarm] = [tally.detection(), tally.false_alarm()].map(|part| 100.0 * part.mean);
    format!("{:.0} ± {:.0} | {detection:.2} | {false_alarm:.2}", error.mean, error.standard_error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::by_number;
    use crate::reconstruct::Baseline;

    #[test]
    fn an_entry_shows_its_picture() {
        let text = entry(by_number("5-1").unwrap(), "figures");
        assert!(text.starts_with("### Figure 5-1") && text.contains("(figures/5-1.png)"), "{text}");
        assert!(text.contains(" Kept as drawn."), "{text}");
    }

    #[test]
    fn tables_stand_beside_the_printed_values() {
        let text = tables(&[&Baseline], 1).unwrap();
        assert!(text.contains("baseline, printed | 20565 | 12.40 | 0.20"), "{text}");
        assert_eq!(text.matches("\n| baseline | ").count(), 3);
    }
}
