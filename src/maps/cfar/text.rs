//! A detector as text.

use super::{Cfar, CfarError, Statistic};
use std::fmt;
use std::str::FromStr;

impl FromStr for Cfar {
    type Err = CfarError;

    fn from_str(text: &str) -> Result<Cfar, CfarError> {
        let wrong = || CfarError::Text(text.chars().take(80).collect());
        let mut parts = text.split(':');
        let statistic = parts.next().and_then(|name| Statistic::ALL.into_iter().find(|s| s.names()[2] == name));
        let statistic = statistic.ok_or_else(wrong)?;
        let mut cfar = Cfar { statistic, ..Cfar::default() };
        let cells = |text: &str| -> Option<[usize; 2]> {
            let (bins, columns) = text.split_once('x')?;
            Some([bins.parse().ok()?, columns.parse().ok()?])
        };
        for part in parts {
            let (name, value) = part.split_once('=').ok_or_else(wrong)?;
            match name {
                "guard" => cfar.guard = cells(value).ok_or_else(wrong)?,
                "training" => cfar.training = cells(value).ok_or_else(wrong)?,
                "rate" => cfar.false_alarm = value.parse().map_err(|_| wrong())?,
                _ => return Err(wrong()),
            }
        }
        cfar.check().map(|()| cfar)
    }
}

impl fmt::Display for Cfar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.statistic.names()[2];
        let ([g0, g1], [t0, t1]) = (self.guard, self.training);
        write!(f, "{name}:guard={g0}x{g1}:training={t0}x{t1}:rate={}", self.false_alarm)
    }
}

impl TryFrom<String> for Cfar {
    type Error = CfarError;

    fn try_from(text: String) -> Result<Cfar, CfarError> {
        text.parse()
    }
}

impl From<Cfar> for String {
    fn from(cfar: Cfar) -> String {
        cfar.to_string()
    }
}
