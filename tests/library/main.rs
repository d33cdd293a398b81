//! The library as other programs use it.

mod accuracy;
mod baseline_tables;
mod captures;
mod conventions;
mod damage;
mod echo_lists;
mod failures;
mod house;
mod lessons;
mod lessons_of_bodies;
mod lessons_of_detectors;
mod lessons_of_pairs;
#[cfg(feature = "network")]
mod live_network;
#[path = "../common/captures.rs"]
mod made_captures;
mod memory;
mod methods;
#[cfg(feature = "network")]
mod noise_alone;
mod off_line;
mod older_files;
mod pairs;
mod physical_captures;
mod prelude;
mod radars;
mod readme;
mod snapshot;
mod street;
#[cfg(all(unix, feature = "live"))]
mod tables;
mod taught;
mod which_radar;
mod whole_files;

/// Damaged files are read in bounded memory: allocations are counted.
#[global_allocator]
static ALLOCATOR: damage::allocation::Counting = damage::allocation::Counting;
