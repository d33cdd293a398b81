//! The line of elements that antennas of a capture form.

use super::boards::{self, Board};
use crate::radar::SPEED_OF_LIGHT;
use crate::recording::layout::Counts;
use crate::recording::profile::{CHIP_RECEIVERS, RadarProfile, bits};

/// Carrier where none is known, hertz.
pub(super) const USUAL_CARRIER_HZ: f64 = 77e9;

/// Antennas that form a line of elements.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ElementLine {
    /// Chirps of a loop whose transmitters form the line.
    pub chirps: Vec<usize>,
    /// Indices of the receivers that form the line; `None` for all.
    pub receivers: Option<Vec<usize>>,
    pub transmitter_x_metres: Vec<f64>,
    pub receiver_x_metres: Vec<f64>,
    /// Name of the board whose places are used.
    pub board: Option<&'static str>,
    /// Assumptions, and antennas that were left out, a sentence each.
    pub doubts: Vec<String>,
}

/// A transmitter: the chirp of a loop that it sends, and its place across and up, half wavelengths.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sender {
    chirp: usize,
    across: f64,
    up: f64,
}

/// Elements half a wavelength apart, for antennas at unknown places.
pub(super) fn uniform(counts: Counts, carrier_hz: f64) -> ElementLine {
    let Counts { receivers, chirps, .. } = counts;
    let apart = match chirps {
        1 => String::new(),
        chirps => format!("{chirps} transmitters {receivers} half wavelengths apart and "),
    };
    let doubt = format!(
        "Nothing says where the antennas stand: {apart}{receivers} receivers half a wavelength apart are taken for granted."
    );
    let senders: Vec<Sender> =
        (0..chirps).map(|chirp| Sender { chirp, across: (chirp * receivers) as f64, up: 0.0 }).collect();
    let receivers: Vec<f64> = (0..receivers).map(|n| n as f64).collect();
    line_in_metres(&senders, &receivers, None, carrier_hz, vec![doubt])
}

/// The line of a board's first antennas, without a `.cfg`; `None` where the board has too few.
fn line_of_board(counts: Counts, board: &'static Board) -> Option<ElementLine> {
    let (places, receivers) = (board.transmitters.get(..counts.chirps)?, board.receivers.get(..counts.receivers)?);
    let sender = |(chirp, [across, up]): (usize, &[f64; 2])| Sender { chirp, across: *across, up: *up };
    let senders: Vec<Sender> = places.iter().enumerate().map(sender).collect();
    let doubt =
        format!("The transmitters of the {} are taken to send one after another in the order of its list.", board.name);
    Some(line_of_senders(board, &senders, receivers, USUAL_CARRIER_HZ, vec![doubt]))
}

/// The line of the senders of a board that are at one height.
fn line_of_senders(
    board: &Board,
    senders: &[Sender],
    receivers: &[f64],
    carrier_hz: f64,
    mut doubts: Vec<String>,
) -> ElementLine {
    let (senders, note) = at_one_height(senders);
    doubts.extend(note);
    ElementLine { board: Some(board.name), ..line_in_metres(&senders, receivers, None, carrier_hz, doubts) }
}

/// The line of a capture: by `board`, by the places in the `.cfg`, or by the most usual board with these transmitters.
pub(super) fn element_line(
    counts: Counts,
    profile: Option<&RadarProfile>,
    board: Option<&'static Board>,
) -> ElementLine {
    let Some(profile) = profile else {
        let line_of_board = board.and_then(|board| line_of_board(counts, board));
        return line_of_board.unwrap_or_else(|| uniform(counts, USUAL_CARRIER_HZ));
    };
    let carrier_hz = profile.carrier_hz();
    if board.is_none()
        && let Some((senders, taken, receivers)) = line_of_geometry(profile)
    {
        let doubt =
            "Elements stand where the .cfg's antGeometry lines say; the longest line of elements at one height counts."
                .to_owned();
        return line_in_metres(&senders, &receivers, Some(taken), carrier_hz, vec![doubt]);
    }
    let transmitters: Vec<usize> = profile.chirp_transmitters.iter().flat_map(|mask| bits(*mask)).collect();
    let taken_board = board.unwrap_or_else(|| boards::likely(&transmitters));
    let mut doubts = Vec::new();
    if board.is_none() {
        let all: Vec<&str> = boards::ALL.iter().map(|b| b.name).collect();
        doubts.push(format!(
            "Antennas are taken to stand as on the {}; apertura import --board names another ({}).",
            taken_board.name,
            all.join(", ")
        ));
    }
    let place = |n: &usize| taken_board.receivers.get(*n).copied().unwrap_or(*n as f64);
    let receivers: Vec<f64> = profile.receiver_numbers.iter().map(place).collect();
    line_of_senders(taken_board, &senders(profile, taken_board), &receivers, carrier_hz, doubts)
}

/// The line of senders and receivers at these places, half wavelengths.
fn line_in_metres(
    senders: &[Sender],
    receivers: &[f64],
    taken: Option<Vec<usize>>,
    carrier_hz: f64,
    doubts: Vec<String>,
) -> ElementLine {
    let half_wave = SPEED_OF_LIGHT / carrier_hz / 2.0;
    ElementLine {
        chirps: senders.iter().map(|s| s.chirp).collect(),
        receivers: taken,
        transmitter_x_metres: senders.iter().map(|s| s.across * half_wave).collect(),
        receiver_x_metres: receivers.iter().map(|x| x * half_wave).collect(),
        board: None,
        doubts,
    }
}

/// The sender of each chirp of a loop. Several transmitters that send at once and can't be separated count as one in their middle.
fn senders(profile: &RadarProfile, board: &Board) -> Vec<Sender> {
    let place = |bit: usize| board.transmitters.get(bit).copied().unwrap_or([4.0 * bit as f64, 0.0]);
    if profile.both_transmitters {
        let all = profile.chirp_transmitters.first().map_or(0, |mask| *mask);
        return bits(all).map(place).enumerate().map(|(chirp, [across, up])| Sender { chirp, across, up }).collect();
    }
    let mean = |chirp: usize, mask: u32| {
        let count = f64::from(mask.count_ones().max(1));
        let sum = bits(mask).map(place).fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y]);
        Sender { chirp, across: sum[0] / count, up: sum[1] / count }
    };
    profile.chirp_transmitters.iter().enumerate().map(|(chirp, mask)| mean(chirp, *mask)).collect()
}

/// The senders at the height with most places, each place once, and a note on those left out.
fn at_one_height(senders: &[Sender]) -> (Vec<Sender>, Option<String>) {
    let mut best: Vec<Sender> = Vec::new();
    for height in senders {
        let mut found: Vec<Sender> = Vec::new();
        for sender in senders.iter().filter(|s| s.up == height.up) {
            if found.iter().all(|f| f.across != sender.across) {
                found.push(*sender);
            }
        }
        if found.len() > best.len() {
            best = found;
        }
    }
    let higher: Vec<String> =
        senders.iter().filter(|s| best.first().is_some_and(|b| b.up != s.up)).map(|s| s.chirp.to_string()).collect();
    let note = (!higher.is_empty()).then(|| {
        format!(
            "Chirps {} of a loop are sent at another height than the others: they are left out of the line.",
            higher.join(", ")
        )
    });
    (best, note)
}

/// The longest line of elements at one height by the `.cfg`'s antGeometry lines: senders, indices of receivers and their places.
fn line_of_geometry(profile: &RadarProfile) -> Option<(Vec<Sender>, Vec<usize>, Vec<f64>)> {
    let [across, up] = &profile.element_places;
    let receivers = profile.receivers;
    let bits = profile.senders();
    // The values have every receiver of the chip, or only those that are on.
    let last = bits.iter().max()?;
    let of_chip = |r: usize| profile.receiver_numbers.get(r).copied().unwrap_or(r);
    let names_chip =
        receivers <= CHIP_RECEIVERS && last * CHIP_RECEIVERS + (0..receivers).map(of_chip).max()? < across.len();
    if !names_chip && across.len() != bits.len() * receivers {
        return None;
    }
    // Without the second list all elements are at one height.
    let level = vec![0.0; across.len()];
    let up = if up.is_empty() { &level } else { up };
    if up.len() < across.len() {
        return None;
    }
    let at = |chirp: usize, r: usize| match names_chip {
        true => bits[chirp] * CHIP_RECEIVERS + of_chip(r),
        false => chirp * receivers + r,
    };
    let mut best: Option<(Vec<Sender>, Vec<usize>, Vec<f64>)> = None;
    for first in 0..bits.len() {
        for height in (0..receivers).map(|r| up[at(first, r)]) {
            let taken: Vec<usize> = (0..receivers).filter(|r| up[at(first, *r)] == height).collect();
            let places: Vec<f64> = taken.iter().map(|r| across[at(first, *r)]).collect();
            let same = |chirp: &usize| {
                let shift = across[at(*chirp, taken[0])] - places[0];
                taken
                    .iter()
                    .zip(&places)
                    .all(|(r, x)| up[at(*chirp, *r)] == height && across[at(*chirp, *r)] - x == shift)
            };
            let sender = |chirp: usize| Sender { chirp, across: across[at(chirp, taken[0])] - places[0], up: height };
            let (senders, _) = at_one_height(&(0..bits.len()).filter(same).map(sender).collect::<Vec<_>>());
            if best.as_ref().is_none_or(|(s, t, _)| senders.len() * taken.len() > s.len() * t.len()) {
                best = Some((senders, taken, places));
            }
        }
    }
    best
}
