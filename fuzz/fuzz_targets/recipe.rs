//! Training recipes.
#![no_main]

use apertura::network::recipe::Recipe;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(recipe) = Recipe::parse("fuzz", text) {
        let _rate = recipe.learning_rate(recipe.epochs);
    }
});
