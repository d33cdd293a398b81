//! Long vertical lines of the tables' scenes and a few points beside them, every sample of every atom written out: for what walls begun from two
//! of their reflectors don't reach.
//!
//! | file | what it is |
//! |---|---|
//! | `atom` | the dictionary: one reflector, or a line of them |
//! | `detect` | strongest cell of a residual, both ends registered |
//! | `lines` | lines that a residual may hold |
//! | `place` | one more atom at its best place |
//! | `fit` | Levenberg-Marquardt on positions, gains projected out |
//! | `search` | the greedy loop and its second thoughts |
//! | `finish` | one gain for both ends, reflectivities |

pub(super) mod atom;
mod detect;
mod finish;
mod fit;
mod lines;
mod place;
mod search;

pub(super) use search::find;
