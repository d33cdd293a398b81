//! See what a 1024-element automotive radar sees, and how much of it 24 of those elements recover.
//!
//! The crate follows the thesis *Machine Learning Methods for Super-Resolution in Sparse Sensor Arrays* (MIT MEng, 2021): a
//! frequency-modulated radar with a uniform line of 1024 elements looks at point reflectors; a sparse sensor keeps the twelve elements
//! at either end; a reconstruction tries to draw the whole array's range-angle map from those two ends.
//!
//! # A tour of the pipeline
//!
//! ```
//! use apertura::evaluate::Metrics;
//! use apertura::maps::{LogMaps, Normalisation};
//! use apertura::radar::Radar;
//! use apertura::reconstruct::{Baseline, Reconstructor, Request};
//! use apertura::scene::Scene;
//! use apertura::signal::{Floor, simulate};
//!
//! // The radar of table 3.1, and two points before it: (x, y) in metres, y ahead.
//! let radar = Radar::default();
//! let scene = Scene::of_points([(-4.0, 12.5), (3.0, 20.0)]);
//!
//! // What every element samples, [elements, samples], over the rounding floor of the thesis' program.
//! let signal = simulate(&radar, &scene, Floor::Thesis, 0)?;
//!
//! // Range-angle maps of the two ends and of the whole array: decades of amplitude, then Lambda in [0, 1].
//! let maps = LogMaps::of_signal(&radar, &signal);
//! let target = maps.full.normalise(Normalisation::MinMax);
//! assert_eq!(target.lambda.dim(), (512, 1024));
//!
//! // What a method makes of the two ends alone, and how far that is from the target.
//! let output = Baseline.reconstruct(&radar, &signal.two_ends(&radar), &Request::default())?;
//! let metrics = Metrics::of(&target, &output.lambda, Baseline.eta());
//! assert!(metrics.squared_error > 1000.0, "one end alone draws a blurred picture");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Map of modules
//!
//! | module | from | to |
//! |---|---|---|
//! | [`radar`] | | every constant of the radar, validated |
//! | [`scene`] | files, presets, seeds | objects, and the reflectors they stand for |
//! | [`recording`] | what a radar measured | samples of its elements |
//! | [`scattering`] | walls, boxes, posts, polygons | their echoes at each pair of antennas |
//! | [`signal`] | echoes | the sampled beat signal, over a named floor |
//! | [`maps`] | the beat signal | range-angle maps, Lambda, masks, Cartesian views |
//! | [`reconstruct`], [`methods`] | the two ends' samples | an estimate of the whole array's map |
//! | `external` | a command | a method that another program computes |
//! | `network` | the two ends' samples | the live network and the thesis' networks |
//! | [`bounds`] | a layout and a noise level | the least error of any unbiased estimator |
//! | [`theory`] | a radar and a place | predictions of the map: peak, beam width, lobes, comb, streak, squint |
//! | [`evaluate`] | target and output | SE, P_D, P_FA, ROC, the thesis' tables |
//! | [`benchmark`] | scenes of any size | run time against error, and whether numerics hold |
//! | [`engine`], [`interact`] | edits of a scene | the changed and visible maps only |
//! | [`picture`] | a scene and its maps | colours and panels, without a display |
//! | [`lesson`] | lesson files | questions, judged on the maps |
//! | [`view`] | | the settings of a view: floor, normalisation, method, thresholds, colours, marks |
//! | [`share`] | what is on screen | one line of text, and back |
//! | [`figures`] | the thesis' scenes | every figure of the thesis, as sheets of panels |
//! | [`files`], [`commands`] | | whole-or-nothing files, the command line |
#![warn(missing_docs)]

#[cfg(feature = "app")]
#[allow(missing_docs)] // A part of the program: names of fields say what is in them.
pub mod app;
#[allow(missing_docs)] // A part of the program: names of fields say what is in them.
pub mod benchmark;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod bounds;
#[cfg(feature = "command-line")]
#[allow(missing_docs)] // A part of the program: names of fields say what is in them.
pub mod commands;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod engine;
pub mod evaluate;
#[cfg(feature = "external")]
pub mod external;
#[cfg(all(feature = "network", feature = "pictures"))]
#[allow(missing_docs)] // A part of the program: names of fields say what is in them.
pub mod figures;
pub mod files;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod interact;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod lesson;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod maps;
pub mod methods;
#[cfg(feature = "live")]
pub mod network;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod picture;
pub mod platform;
pub mod radar;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod reconstruct;
pub mod recording;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod scattering;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod scene;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod share;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod signal;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod task;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod theory;
#[allow(missing_docs)] // Names of fields say what is in them.
pub mod view;
