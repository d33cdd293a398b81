//! All methods on one scene of a campaign.

use super::error::{CampaignError, set_name};
use crate::evaluate::rows::{CfarRates, Origin, Row};
use crate::evaluate::sets::SceneSet;
use crate::evaluate::trial::{Answer, RowPlace, Trial};
use crate::maps::cfar::Cfar;
use crate::reconstruct::{Reconstructor, Request};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;

/// All methods on one scene.
pub(super) struct Job<'a> {
    /// The campaign's detector, if it has one.
    pub cfar: Option<Cfar>,
    /// Seed of its generated scenes.
    pub seed: u64,
    pub set: &'a SceneSet,
    pub index: u32,
    pub trial: &'a Trial,
    pub request: &'a Request,
    /// One a method.
    pub origins: &'a [Arc<Origin>],
}

impl Job<'_> {
    /// What a method makes of the scene.
    pub fn answer(&self, method: &dyn Reconstructor) -> Result<Answer, CampaignError> {
        self.trial.ask(method, self.request).map_err(|source| CampaignError::Method {
            method: method.name(),
            set: set_name(self.set),
            index: self.index,
            source,
        })
    }

    /// P_D and P_FA by the campaign's detector, if it has one.
    fn cfar_rates(&self, answer: &Answer) -> Result<Option<CfarRates>, CampaignError> {
        let rates = self.cfar.map(|cfar| self.trial.cfar_rates(answer, &cfar));
        rates.transpose().map_err(|source| CampaignError::Detector {
            set: set_name(self.set),
            index: self.index,
            source,
        })
    }

    /// The rows of the methods of these places, in their order.
    pub fn rows(
        &self,
        methods: &[&dyn Reconstructor],
        mut order: Vec<usize>,
        on_row: &mut impl FnMut(&Row, &Trial, &Answer),
    ) -> Result<Vec<Row>, CampaignError> {
        let set = self.set.to_string();
        let seed = if matches!(self.set, SceneSet::Generated(_)) { self.seed } else { 0 };
        order.shuffle(&mut ChaCha8Rng::seed_from_u64(u64::from(self.index)));
        let mut found = Vec::new();
        for i in order {
            let answer = self.answer(methods[i])?;
            let place = RowPlace { set: &set, index: self.index, seed, origin: Some(&self.origins[i]) };
            let mut row = self.trial.row(&place, methods[i].name(), &answer, self.set.false_alarm());
            row.cfar = self.cfar_rates(&answer)?;
            on_row(&row, self.trial, &answer);
            found.push((i, row));
        }
        found.sort_by_key(|(i, _)| *i);
        Ok(found.into_iter().map(|(_, row)| row).collect())
    }
}
