//! Every reconstruction method by name: the list behind the command line, the tables and the app.

use crate::radar::Radar;
use crate::reconstruct::search::Nomp;
use crate::reconstruct::{
    BARTLETT, Baseline, CAPON, CAPON_PEAKS, ESPRIT, Fista, Hybrid, IAA, LINEAR_PREDICTION, LINEAR_PREDICTION_PEAKS,
    MUSIC, MUSIC_PEAKS, MatchedFilter, Omp, ROOT_MUSIC, ROOT_MUSIC_PEAKS, Reconstructor, SBL,
};
use std::sync::{Arc, PoisonError, RwLock};

static ADDED: RwLock<Vec<Arc<dyn Reconstructor>>> = RwLock::new(Vec::new());

/// Every method of this build and every added one, in the order of menus and tables.
pub fn all() -> Vec<Arc<dyn Reconstructor>> {
    let mut methods = shipped();
    methods.extend(ADDED.read().unwrap_or_else(PoisonError::into_inner).iter().cloned());
    methods
}

/// Adds a method to [`all`], in place of an added one of the same name.
/// # Errors
/// [`NameTaken`] where a method of this build has the name.
pub fn add(method: Arc<dyn Reconstructor>) -> Result<(), NameTaken> {
    let name = method.name();
    if shipped().iter().any(|m| m.name() == name) {
        return Err(NameTaken { name });
    }
    let mut added = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    added.retain(|m| m.name() != name);
    added.push(method);
    Ok(())
}

/// Adds the live network with the weights of the file at `path` to [`all`], under a name made of the file's.
/// # Errors
/// A sentence that names the file: it can't be read, is damaged or another network's, or its name is another method's.
#[cfg(feature = "live")]
pub fn add_weights(path: &std::path::Path) -> Result<Arc<dyn Reconstructor>, String> {
    let name = crate::network::name_of_weights(path);
    let method: Arc<dyn Reconstructor> =
        Arc::new(crate::network::live_from_file(path, &name).map_err(|error| error.to_string())?);
    add(method.clone()).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(method)
}

/// A method's name that another method has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a method of this program is called \"{name}\"; expected another name")]
pub struct NameTaken {
    name: &'static str,
}

fn shipped() -> Vec<Arc<dyn Reconstructor>> {
    #[cfg(feature = "live")]
    let networks = crate::network::shipped();
    #[cfg(not(feature = "live"))]
    let networks: Vec<Arc<dyn Reconstructor>> = Vec::new();
    let live = networks.iter().find(|m| m.name() == "live").cloned();
    let fallback = live.unwrap_or_else(|| Arc::new(MatchedFilter::Incoherent));
    let mut methods: Vec<Arc<dyn Reconstructor>> = vec![
        Arc::new(Baseline),
        Arc::new(BARTLETT),
        Arc::new(MatchedFilter::Coherent),
        Arc::new(MatchedFilter::Incoherent),
        Arc::new(CAPON),
        Arc::new(CAPON_PEAKS),
        Arc::new(MUSIC),
        Arc::new(MUSIC_PEAKS),
        Arc::new(ROOT_MUSIC),
        Arc::new(ROOT_MUSIC_PEAKS),
        Arc::new(ESPRIT),
        Arc::new(LINEAR_PREDICTION),
        Arc::new(LINEAR_PREDICTION_PEAKS),
        Arc::new(Fista::default()),
        Arc::new(Omp::default()),
        Arc::new(IAA),
        Arc::new(SBL),
        Arc::new(Nomp::default()),
        Arc::new(Hybrid::new(fallback)),
    ];
    methods.extend(networks);
    methods
}

/// The method whose output is shown by default.
pub fn preferred() -> Arc<dyn Reconstructor> {
    by_name("live").unwrap_or_else(|_| Arc::new(Baseline))
}

/// The method whose output is shown for samples of `radar` by default: the preferred one where it takes them.
pub fn preferred_for(radar: &Radar) -> Arc<dyn Reconstructor> {
    let preferred = preferred();
    if preferred.check_array(radar).is_ok() {
        return preferred;
    }
    by_name("iaa").unwrap_or_else(|_| Arc::new(MatchedFilter::Incoherent))
}

/// The method whose output is shown by default for samples of the elements of `layout`.
pub fn preferred_for_layout(radar: &Radar, layout: &[usize]) -> Arc<dyn Reconstructor> {
    let iaa: Arc<dyn Reconstructor> = Arc::new(IAA);
    let is_usable = iaa.check_elements(radar, layout).is_ok();
    if is_usable { iaa } else { Arc::new(MatchedFilter::Coherent) }
}

/// A method's name that is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown method \"{name}\"; known: {known}")]
pub struct UnknownMethod {
    name: String,
    known: String,
}

/// The method called `name`.
/// # Errors
/// [`UnknownMethod`] lists the known names.
pub fn by_name(name: &str) -> Result<Arc<dyn Reconstructor>, UnknownMethod> {
    let all = all();
    let known = || all.iter().map(|m| m.name()).collect::<Vec<_>>().join(", ");
    all.iter()
        .find(|m| m.name() == name)
        .cloned()
        .ok_or_else(|| UnknownMethod { name: name.to_owned(), known: known() })
}
