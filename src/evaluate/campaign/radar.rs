//! The column of rows that names their radar.

use crate::radar::Radar;

/// The radar as rows name it: each constant that differs from table 3.1, without the carrier's reading. Empty for table 3.1.
pub(super) fn text(radar: &Radar) -> String {
    let fields = |radar: &Radar| match serde_json::to_value(radar) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    };
    let usual = fields(&Radar::default());
    // Rows are of one chirp.
    let mut differing: Vec<String> = fields(&radar.of_one_chirp())
        .iter()
        .filter(|(name, value)| *name != "carrier" && usual.get(*name) != Some(*value))
        .flat_map(|(name, value)| match value {
            serde_json::Value::String(text) => vec![format!("{name}={text}")],
            // The constants of the link budget.
            serde_json::Value::Object(numbers) => numbers.iter().map(|(key, v)| format!("{name}.{key}={v}")).collect(),
            value => vec![format!("{name}={value}")],
        })
        .collect();
    differing.sort();
    differing.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Carrier;

    #[test]
    fn a_radar_is_known_by_what_differs_from_table_3_1() {
        assert_eq!(text(&Radar { carrier: Carrier::TwoWay, ..Radar::default() }), "");
        let radar = Radar { elements: 64, window: crate::radar::WindowFunction::Blackman, ..Radar::default() };
        assert_eq!(text(&radar), "elements=64 window=blackman");
        let radar = Radar { elements: 64, budget: Some(crate::radar::LinkBudget::default()), ..Radar::default() };
        let budget = "budget.antenna_gain_dbi=10.0 budget.noise_figure_db=12.0 budget.transmit_power_dbm=12.0";
        assert_eq!(text(&radar), format!("{budget} elements=64"));
    }
}
