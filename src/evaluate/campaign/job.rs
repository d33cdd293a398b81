//! All methods on one scene of a campaign.

use super::error::{CampaignError, set_name};
use crate::evaluate::rows::Row;
use crate::evaluate::sets::SceneSet;
use crate::evaluate::trial::{TimedAnswer, Trial};
use crate::maps::cfar::{Cfar, CfarError};
use crate::reconstruct::{Reconstructor, Request};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

pub(super) struct SceneJob<'a> {
    pub cfar: Option<Cfar>,
    pub set: &'a SceneSet,
    pub index: u32,
    pub trial: &'a Trial,
    pub request: &'a Request,
    /// The rows without figures, one a method.
    pub empty: &'a [Row],
}

impl SceneJob<'_> {
    pub fn answer(&self, method: &dyn Reconstructor) -> Result<TimedAnswer, CampaignError> {
        self.trial.ask(method, self.request).map_err(|source| CampaignError::Method {
            method: method.name(),
            set: set_name(self.set),
            index: self.index,
            source,
        })
    }

    fn row(&self, empty: &Row, answer: &TimedAnswer) -> Result<Row, CampaignError> {
        let empty = Row { index: self.index, ..empty.clone() };
        let row = self.trial.filled(empty, answer, self.set.false_alarm());
        let Some(cfar) = &self.cfar else { return Ok(row) };
        let failed = |error: CfarError| {
            CampaignError::Refused(format!("the detector on scene {} of {}: {error}", self.index, set_name(self.set)))
        };
        let by_cfar = self.trial.cfar_metrics(answer, cfar).map_err(failed)?;
        Ok(Row { cfar_detection: by_cfar.detection, cfar_false_alarm: Some(by_cfar.false_alarm), ..row })
    }

    /// The rows of the methods with the indices `order`, in the order of the indices; `on_failure` decides whether the job continues after a failure.
    pub fn rows(
        &self,
        methods: &[&dyn Reconstructor],
        mut order: Vec<usize>,
        on_row: &mut impl FnMut(&Row, &Trial, &TimedAnswer),
        on_failure: &mut impl FnMut(CampaignError) -> Result<(), CampaignError>,
    ) -> Result<Vec<Row>, CampaignError> {
        order.shuffle(&mut ChaCha8Rng::seed_from_u64(u64::from(self.index)));
        let mut found = Vec::new();
        for i in order {
            let answer = match self.answer(methods[i]) {
                Ok(answer) => answer,
                Err(error) => {
                    on_failure(error)?;
                    continue;
                }
            };
            let row = self.row(&self.empty[i], &answer)?;
            on_row(&row, self.trial, &answer);
            found.push((i, row));
        }
        found.sort_by_key(|(i, _)| *i);
        Ok(found.into_iter().map(|(_, row)| row).collect())
    }
}
