#![no_main]

use cobotwire_fuzz::{laws, subjects};

libfuzzer_sys::fuzz_target!(
    init: {
        subjects::all();
    },
    |data: &[u8]| laws::framing::events_equal_those_of_the_oracle(data)
);
