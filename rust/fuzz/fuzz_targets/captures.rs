#![no_main]

use cobotwire_fuzz::{laws, subjects};

libfuzzer_sys::fuzz_target!(
    init: {
        subjects::all();
    },
    |data: &[u8]| laws::captures::captures_are_read_like_the_plain_reader_does(data)
);
