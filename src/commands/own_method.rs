//! Programs of one's own as methods.

use super::CommandError;
use super::arguments::real;
use crate::external::{CommandLine, start};
use crate::methods;
use crate::task::Task;
use std::sync::Arc;
use std::time::Duration;

/// Commands that compute maps.
#[derive(Debug, Clone, clap::Args)]
pub struct OwnMethodArgs {
    /// Start this command and use it as a method: a network of your own, in any language (docs/own-network.md). The method has the name that the
    /// command says. Several commands are several methods
    #[arg(long, value_name = "COMMAND")]
    method_command: Vec<CommandLine>,

    /// Seconds that a command of --method-command may take to start, and for each answer
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0, value_parser = real(0.01..=86_400.0))]
    method_seconds: f64,
}

impl OwnMethodArgs {
    /// Starts the commands and adds them to the methods; their names.
    pub fn start(&self) -> Result<Vec<&'static str>, CommandError> {
        let mut names = Vec::new();
        for command in &self.method_command {
            let limit = Duration::from_secs_f64(self.method_seconds);
            let method = start(command.clone(), limit, &Task::default())?;
            let name = crate::reconstruct::Reconstructor::name(&method);
            if names.contains(&name) {
                let message = format!("{command}: another command of --method-command is called \"{name}\" too");
                return Err(CommandError(message));
            }
            names.push(name);
            methods::add(Arc::new(method)).map_err(|e| CommandError(format!("{command}: {e}")))?;
        }
        Ok(names)
    }
}
