//! Boards by name, with the places of their antennas.

/// A board with the places of its antennas, in half wavelengths of the carrier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Board {
    /// Name.
    pub name: &'static str,
    /// The manufacturer's document with these places.
    pub guide: &'static str,
    /// Places of the transmitters by their bit in a mask: across and up.
    pub transmitters: &'static [[f64; 2]],
    /// Places of the receivers across.
    pub receivers: &'static [f64],
}

const FOUR_RECEIVERS: &[f64] = &[0.0, 1.0, 2.0, 3.0];

/// Two transmitters two wavelengths apart, and one between them half a wavelength higher.
const THREE_TRANSMITTERS: &[[f64; 2]] = &[[0.0, 0.0], [2.0, 1.0], [4.0, 0.0]];

/// Boards whose antennas are known.
pub const ALL: &[Board] = &[
    Board {
        name: "xWR1642",
        guide: "xWR1642 Evaluation Module (xWR1642BOOST) Single-Chip mmWave Sensing Solution, SWRU521",
        transmitters: &[[0.0, 0.0], [4.0, 0.0]],
        receivers: FOUR_RECEIVERS,
    },
    Board {
        name: "xWR1443",
        guide: "xWR1443 Evaluation Module (xWR1443BOOST) mmWave Sensing Solution, SWRU518",
        transmitters: THREE_TRANSMITTERS,
        receivers: FOUR_RECEIVERS,
    },
    Board {
        name: "xWR1843",
        guide: "xWR1843 Evaluation Module (xWR1843BOOST) Single-Chip mmWave Sensing Solution, SPRUIM4",
        transmitters: THREE_TRANSMITTERS,
        receivers: FOUR_RECEIVERS,
    },
    Board {
        name: "xWR6843ISK",
        guide: "60GHz mmWave Sensor EVMs, SWRU546",
        transmitters: THREE_TRANSMITTERS,
        receivers: FOUR_RECEIVERS,
    },
    CASCADE,
];

/// Four chips as one radar, receivers from the left.
const CASCADE: Board = Board {
    name: "cascade",
    guide: "Imaging Radar Using Cascaded mmWave Sensor Reference Design (TIDEP-01012), TIDUEN5",
    transmitters: &[
        [0.0, 0.0],
        [4.0, 0.0],
        [8.0, 0.0],
        [12.0, 0.0],
        [16.0, 0.0],
        [20.0, 0.0],
        [24.0, 0.0],
        [28.0, 0.0],
        [32.0, 0.0],
        [9.0, 1.0],
        [10.0, 4.0],
        [11.0, 6.0],
    ],
    receivers: &[0.0, 1.0, 2.0, 3.0, 11.0, 12.0, 13.0, 14.0, 46.0, 47.0, 48.0, 49.0, 50.0, 51.0, 52.0, 53.0],
};

/// The cascade in the order in which its four chips count their receivers: master, slave1, slave2, slave3, as in captures of TI's programs.
pub(super) const BY_CHIP: Board = Board {
    receivers: &[11.0, 12.0, 13.0, 14.0, 50.0, 51.0, 52.0, 53.0, 46.0, 47.0, 48.0, 49.0, 0.0, 1.0, 2.0, 3.0],
    ..CASCADE
};

/// The board called `name`; the case of letters does not matter.
pub fn by_name(name: &str) -> Option<&'static Board> {
    ALL.iter().find(|board| board.name.eq_ignore_ascii_case(name))
}

/// The most usual board with these transmitters, by their bits.
pub(super) fn likely(bits: &[usize]) -> &'static Board {
    let highest = bits.iter().max().copied().unwrap_or(0);
    match highest {
        0 | 1 => &ALL[0],
        2 => &ALL[2],
        _ => &ALL[4],
    }
}
