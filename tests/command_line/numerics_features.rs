//! Program, Python module and bare library compile the same numerical kernels.
//!
//! Cargo unites the features that all crates of a build ask for: without the features that this crate fixes, burn would give the program's
//! matrix products other instructions than those of a build without burn, and other bits.

use crate::cli::*;
use std::collections::BTreeMap;
use std::process::Command;

/// Crates whose kernels round: products, decompositions, transforms.
const NUMERICS: &str = "faer faer-traits gemm-c64 gemm-common gemm-f64 matrixmultiply nano-gemm nano-gemm-f64 ndarray \
                        private-gemm-x86 pulp rustfft";

fn is_numerics(name: &str) -> bool {
    NUMERICS.split(' ').any(|known| known == name)
}

/// Features that choose threads and number formats that no matrix of ours has, not the instructions of a kernel.
const WITHOUT_EFFECT: [&str; 4] = ["f16", "half", "rayon", "wasm-simd128-enable"];

fn features(arguments: &[&str]) -> BTreeMap<String, BTreeSet<String>> {
    let mut cargo = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
    cargo.current_dir(env!("CARGO_MANIFEST_DIR")).args(["tree", "--offline", "--edges", "normal", "--prefix", "none"]);
    let output = cargo.args(["--format", "{p}|{f}"]).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let crates = text.lines().filter_map(|line| line.split_once('|')).filter_map(|(package, features)| {
        let name = package.split(' ').next().filter(|name| is_numerics(name))?;
        let features = features.trim_end_matches(" (*)").split(',').filter(|f| !WITHOUT_EFFECT.contains(f));
        Some((name.to_owned(), features.map(str::to_owned).collect()))
    });
    crates.collect()
}

#[test]
fn every_build_has_the_same_numerical_kernels() {
    let program = features(&[]);
    assert!(program.len() > 9, "found {:?}", program.keys());
    for arguments in [&["--no-default-features"][..], &["--no-default-features", "--features", "external,live"]] {
        assert_eq!(features(arguments), program, "{arguments:?}");
    }
}

#[test]
fn program_and_module_lock_the_same_numerical_crates() {
    let versions = |lock: &str| -> BTreeSet<(String, String)> {
        let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(lock)).unwrap();
        let lock: toml::Table = text.parse().unwrap();
        let package =
            |p: &toml::Value| Some((p.get("name")?.as_str()?.to_owned(), p.get("version")?.as_str()?.to_owned()));
        let packages = lock["package"].as_array().unwrap().iter().filter_map(package);
        packages.filter(|(name, _)| is_numerics(name)).collect()
    };
    let program = versions("Cargo.lock");
    assert!(program.len() > 9, "found {program:?}");
    assert_eq!(versions("python/Cargo.lock"), program);
}
