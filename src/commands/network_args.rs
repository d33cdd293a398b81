//! Arguments that choose a network's weights and the backend that computes it.

use super::CommandError;
use super::own_method::OwnMethodArgs;
use crate::methods;
use crate::reconstruct::Reconstructor;
use std::sync::Arc;

/// Which weights the networks have, and what computes them.
#[derive(Debug, Clone, clap::Args)]
pub struct NetworkArgs {
    /// Weights in place of the shipped ones: safetensors, or a PyTorch checkpoint (.pt) of the thesis' or the live network. A
    /// checkpoint holds a state_dict, by itself or under model, state_dict or model_state_dict. Of a checkpoint of the training programs
    /// the averaged weights are used
    #[cfg(feature = "network")]
    #[arg(long, value_name = "FILE")]
    weights: Option<std::path::PathBuf>,

    /// Backend of the thesis' networks (live has its own)
    #[cfg(feature = "network")]
    #[arg(long, value_name = "NAME", default_value = "flex", help = format!("Backend: {}", crate::network::backend::Backend::names()))]
    backend: crate::network::backend::Backend,

    #[command(flatten)]
    own: OwnMethodArgs,
}

impl NetworkArgs {
    /// Starts the commands of --method-command, which are methods then; their names.
    pub fn start_own(&self) -> Result<Vec<&'static str>, CommandError> {
        self.own.start()
    }

    /// The methods called `names`, networks with the chosen weights and backend.
    pub fn methods(&self, names: &[String]) -> Result<Vec<Arc<dyn Reconstructor>>, CommandError> {
        let own = self.networks(names)?;
        names
            .iter()
            .map(|name| match own.iter().find(|method| method.name() == name.trim()) {
                Some(method) => Ok(method.clone()),
                None => Ok(methods::by_name(name.trim())?),
            })
            .collect()
    }

    #[cfg(feature = "network")]
    fn networks(&self, names: &[String]) -> Result<Vec<Arc<dyn Reconstructor>>, CommandError> {
        let mut own = Vec::new();
        if let Some(path) = &self.weights {
            let method = crate::network::from_file(path, self.backend)?;
            if !names.iter().any(|name| name.trim() == method.name()) {
                let (file, name) = (path.display(), method.name());
                let message =
                    format!("{file} holds weights of \"{name}\", which --method doesn't name; add --method {name}");
                return Err(CommandError(message));
            }
            own.push(method);
        }
        own.extend(crate::network::shipped_on(self.backend));
        Ok(own)
    }

    #[cfg(not(feature = "network"))]
    fn networks(&self, _: &[String]) -> Result<Vec<Arc<dyn Reconstructor>>, CommandError> {
        Ok(Vec::new())
    }
}
