//! Scenes the thesis talks about.
