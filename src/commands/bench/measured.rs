//! Measuring a front while a bar shows how far it is.

use crate::benchmark::front::{self, Front, FrontRequest, FrontRow};
use crate::commands::CommandError;
use crate::radar::Radar;

pub fn measured(request: &FrontRequest) -> Result<Front, CommandError> {
    let bar = indicatif::ProgressBar::new(1000);
    let on_row = |part: f32, _: &FrontRow| bar.set_position((1e3 * part) as u64);
    let front = front::measure(&Radar::default(), request, on_row, || false).map_err(CommandError::failed)?;
    bar.finish_and_clear();
    Ok(front)
}
