//! Methods that use both ends together, on the cells of the whole array's polar grid.

mod backprojector;
mod cells;
mod fista;
mod layout_filter;
mod matched_filter;
mod omp;
mod pursuit;

pub use fista::Fista;
pub use layout_filter::layout_matched_filter;
pub use matched_filter::MatchedFilter;
pub use omp::Omp;
