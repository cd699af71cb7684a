#![no_main]

use cobotwire_fuzz::{laws, subjects};

libfuzzer_sys::fuzz_target!(
    init: {
        subjects::all();
    },
    |data: &[u8]| laws::columns::columns_hold_the_values_of_their_frames(data)
);
