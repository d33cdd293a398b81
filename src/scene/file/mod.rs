//! Scene files: TOML, and the thesis author's `.npz` archives.
//!
//! ```toml
//! name = "A pair and a wall"
//! notes = "What to look for."
//! noise_seed = 12          # optional; picks the noise of the floor, 0 otherwise
//!
//! [radar]                  # optional; only what differs from table 3.1
//! carrier = "two-way"
//! chirps = 128             # 1 otherwise
//! chirp_interval_seconds = 25.6e-6
//!
//! [radar.budget]           # optional; see `radar::budget`
//! transmit_power_dbm = 12.0
//! antenna_gain_dbi = 10.0
//! noise_figure_db = 12.0
//! half_power_width_degrees = 80.0 # optional; elements are isotropic otherwise
//!
//! [disturbances.mirror]   # optional; a wall that makes ghosts
//! x_metres = -5.0
//! y_metres = 0.0
//! direction_degrees = 90.0
//! reflection = 0.5
//!
//! [disturbances.interferer] # optional; another radar, heard while its frequency crosses ours
//! x_metres = 6.0
//! y_metres = 25.0
//! strength = 0.1
//! crossing = 0.6
//! duration = 0.1
//!
//! [disturbances.elements] # optional; elements as they are built: one number an element, or no list at all
//! count = 1024
//! gain_db = []
//! phase_degrees = []
//! position_millimetres = []
//! forward_millimetres = [] # off the line, towards the scene
//! dead = [17]
//!
//! [[object]]
//! kind = "point"           # or "line", "gaussian"
//! name = "post"            # optional; with `format = 2` as the first line
//! x_metres = -4.0
//! y_metres = 12.5
//! reflectivity = 0.5       # optional, 1 otherwise; or cross_section_dbsm = -6.02
//! velocity_x_metres_per_second = 2.0 # optional, 0 otherwise; likewise y; the place is that of time 0
//!
//! [over]                   # optional; what the app lays the objects over; commands look at the scene alone
//! recording = "post.toml"  # beside this file, or the name of one that comes with the program
//! ```
//!
//! Every error names the line and what was expected there.

mod content;
mod disk;
mod losses;
mod objects;
mod radar;
mod read;
mod write;

pub use content::{MAX_FILE_BYTES, SceneFile, SceneFileError, SceneFormat, SceneTextError};
pub use disk::{load, load_beside, save, save_beside};
pub use radar::radar_of;
pub use read::{from_toml, from_toml_beside};
pub use write::{to_toml, to_toml_beside};
