//! Commands that change what the user chose.

use crate::app::state::{Command, Projection, Settings, Units};
use crate::signal::Floor;

/// Does those commands, and hands others on.
pub fn apply(settings: &mut Settings, command: Command) -> Option<Command> {
    match command {
        Command::ToggleProjection => {
            settings.projection = match settings.projection {
                Projection::RangeAngle => Projection::Cartesian,
                Projection::Cartesian => Projection::RangeAngle,
            }
        }
        Command::SetProjection(projection) => settings.projection = projection,
        Command::ToggleUnits => {
            settings.units = match settings.units {
                Units::Lambda => Units::Decibels,
                Units::Decibels => Units::Lambda,
            }
        }
        Command::SetUnits(units) => settings.units = units,
        Command::ToggleAbsoluteDifference => settings.difference.absolute ^= true,
        Command::ToggleWholeDifference => settings.difference.whole ^= true,
        Command::Colours(colours) => settings.colours = colours,
        Command::Normalise(normalisation) => settings.normalisation = normalisation,
        Command::SetFloor(floor) => {
            settings.floor = floor;
            match floor {
                Floor::Snr(snr) => settings.snr = snr,
                Floor::Level(level) => settings.level = level,
                Floor::Thesis | Floor::Exact => {}
            }
        }
        Command::SetNextRandom { seed, number } => (settings.random_seed, settings.random_number) = (seed, number),
        Command::SetTargetEta(eta) => settings.target_eta = eta,
        Command::SetMethodEta(method, Some(eta)) => _ = settings.method_eta.insert(method.to_owned(), eta),
        Command::SetMethodEta(method, None) => _ = settings.method_eta.remove(method),
        Command::SetSnap(snap) => settings.snap = snap,
        Command::SetCoordinates(coordinates) => settings.coordinates = coordinates,
        Command::SetBounds(bounds) => settings.bounds = bounds,
        Command::MarkReflectors => settings.show_reflectors = true,
        Command::ToggleReflectors => settings.show_reflectors ^= true,
        Command::ToggleFound => settings.show_found ^= true,
        Command::ToggleFieldsOfView => settings.show_fields_of_view ^= true,
        Command::SetSeveral(several) => settings.several = *several,
        Command::ToggleTheory => settings.show_theory ^= true,
        Command::MarkKinds => settings.show_kinds = true,
        Command::ToggleKinds => settings.show_kinds ^= true,
        Command::SetCompare(compare) => settings.compare = *compare,
        Command::Swipe(edge) => settings.compare.swipe(edge),
        Command::Method(name) => settings.method = name.to_owned(),
        other => return Some(other),
    }
    None
}
