//! The library `apertura` as a Python module. `apertura/_apertura.pyi` has the arguments and results of each name.

mod arrays;
mod bounds;
mod budget;
mod dataset;
mod doppler;
mod errors;
mod evaluate;
mod examples;
mod function;
mod maps;
mod methods;
mod metrics;
mod objects;
mod pool;
mod radar;
mod radar_fields;
mod reconstruction;
mod recording;
mod robustness;
mod rows;
mod scene;
mod statistics;
mod threshold;
mod work;

#[pyo3::pymodule]
mod _apertura {
    #[pymodule_export]
    use crate::{
        bounds::{ambiguity, cramer_rao, layout},
        budget::LinkBudget,
        dataset::dataset,
        doppler::{chirp_samples, range_doppler},
        evaluate::evaluate,
        examples::{Examples, live_input},
        maps::{Maps, maps, pickled as pickled_maps},
        methods::{Method, method, methods},
        metrics::{cfar, metrics, roc},
        objects::built_elements,
        pool::{set_threads, threads},
        radar::Radar,
        reconstruction::{Reconstruction, reconstruction},
        recording::{Recording, pickled as pickled_recording},
        robustness::robustness,
        rows::{read_rows, write_rows_to},
        scene::{Scene, kinds},
        statistics::paired,
        threshold::threshold,
    };
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::pool::remember_process();
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("ROW_COLUMNS", crate::rows::row_columns(module.py()))
    }
}
