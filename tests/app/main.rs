//! Drives the whole app without a display: pointer, keys, files; asserts on state and on the work that was done and not done.

mod age;
mod compare;
mod detection;
mod documents;
mod failures;
mod figures;
mod keyboard;
mod layouts;
mod left;
mod lessons;
mod monkey;
mod motion;
mod names;
mod older_files;
mod panels;
mod pictures;
mod presentation;
mod radars;
mod recordings;
mod scene;
mod session;
mod work;
