//! Weight files: header, lengths, shapes.
#![no_main]

use apertura::network::weights::WeightFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(file) = WeightFile::parse("fuzz", bytes) {
        let _any = (file.network().len(), file.all_values().len(), file.provenance.eta());
        let renamed = file.renamed(|name| format!("x.{name}")).expect("names can be changed");
        WeightFile::parse("renamed", &renamed).expect("and the file is still whole");
    }
});
