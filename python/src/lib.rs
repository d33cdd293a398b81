//! The library `apertura` as a Python module. `apertura/_apertura.pyi` has the arguments and results of each name.

mod arrays;
mod bounds;
mod budget;
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

use pyo3::prelude::*;

#[pymodule]
fn _apertura(module: &Bound<'_, PyModule>) -> PyResult<()> {
    pool::remember_process();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ROW_COLUMNS", rows::row_columns(module.py()))?;
    module.add_class::<radar::Radar>()?;
    module.add_class::<budget::LinkBudget>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<maps::Maps>()?;
    module.add_class::<methods::Method>()?;
    module.add_class::<reconstruction::Reconstruction>()?;
    module.add_class::<recording::Recording>()?;
    module.add_class::<examples::Examples>()?;
    module.add_function(wrap_pyfunction!(examples::dataset, module)?)?;
    module.add_function(wrap_pyfunction!(examples::live_input, module)?)?;
    module.add_function(wrap_pyfunction!(maps::maps, module)?)?;
    module.add_function(wrap_pyfunction!(doppler::range_doppler, module)?)?;
    module.add_function(wrap_pyfunction!(methods::method, module)?)?;
    module.add_function(wrap_pyfunction!(methods::methods, module)?)?;
    module.add_function(wrap_pyfunction!(reconstruction::reconstruction, module)?)?;
    module.add_function(wrap_pyfunction!(maps::pickled, module)?)?;
    module.add_function(wrap_pyfunction!(recording::pickled, module)?)?;
    module.add_function(wrap_pyfunction!(scene::kinds, module)?)?;
    module.add_function(wrap_pyfunction!(robustness::robustness, module)?)?;
    module.add_function(wrap_pyfunction!(doppler::chirp_samples, module)?)?;
    module.add_function(wrap_pyfunction!(metrics::metrics, module)?)?;
    module.add_function(wrap_pyfunction!(metrics::roc, module)?)?;
    module.add_function(wrap_pyfunction!(metrics::cfar, module)?)?;
    module.add_function(wrap_pyfunction!(statistics::paired, module)?)?;
    module.add_function(wrap_pyfunction!(statistics::rules_of, module)?)?;
    module.add_function(wrap_pyfunction!(threshold::threshold, module)?)?;
    module.add_function(wrap_pyfunction!(evaluate::evaluate, module)?)?;
    module.add_function(wrap_pyfunction!(rows::read_rows, module)?)?;
    module.add_function(wrap_pyfunction!(rows::write_rows_to, module)?)?;
    module.add_function(wrap_pyfunction!(bounds::cramer_rao, module)?)?;
    module.add_function(wrap_pyfunction!(bounds::layout, module)?)?;
    module.add_function(wrap_pyfunction!(bounds::ambiguity, module)?)?;
    module.add_function(wrap_pyfunction!(objects::built_elements, module)?)?;
    module.add_function(wrap_pyfunction!(pool::set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(pool::threads, module)?)?;
    Ok(())
}
