#![no_main]

use cobotwire_fuzz::{laws, subjects};

libfuzzer_sys::fuzz_target!(
    init: {
        subjects::all();
    },
    |data: &[u8]| laws::decoding::frames_decode_as_in_the_oracle(data)
);
