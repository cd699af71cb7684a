#![no_main]

use cobotwire_fuzz::{laws, subjects};

libfuzzer_sys::fuzz_target!(
    init: {
        subjects::all();
    },
    |data: &[u8]| laws::linear::work_grows_with_the_input(data)
);
